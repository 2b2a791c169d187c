//! The table of the energies of the hysteresis loops, for the page.

use super::loops::LoopEnergies;
use super::summary::{SUMMARY, Summary};
use crate::publish::page::{Block, Grid};
use crate::publish::value::{MISSING, fixed, significant};

/// Energies of the observed nodes and of the whole face over a cycle, and the check against the energy balance.
pub fn blocks(summary: &Summary) -> Vec<Block> {
    let heads = ["energy per cycle", "disk [µJ]", "friction [µJ]", "pin [µJ]", "friction/disk"];
    let line = |(name, energies): (String, &LoopEnergies)| {
        let LoopEnergies { friction_j, into_pin_j, drive_j } = *energies;
        let share = if drive_j > 0.0 { fixed(friction_j / drive_j, 3) } else { MISSING.to_owned() };
        let [disk, friction, pin] = [drive_j, friction_j, into_pin_j].map(|j| significant(j * 1e6, 4));
        vec![name, disk, friction, pin, share]
    };
    let nodes = summary.nodes.iter().map(|node| node.name.replace('_', " ")).zip(&summary.loops.nodes);
    let lines = nodes.chain([("whole contact face".to_owned(), &summary.loops.face)]).map(line);
    let mut blocks = vec![
        Block::Table(Grid::of(&heads, lines, SUMMARY)),
        Block::text(
            "Disk: work of the disk's motion. Friction: what friction dissipates. Pin: what friction gives to the pin, where \
             damping and impacts use it up.",
        ),
    ];
    blocks.extend(summary.loops.audited.map(|audited| {
        Block::text(&format!(
            "Check: between two audits of the energy balance in this cycle friction dissipates {} µJ by the loops of all \
             nodes and {} µJ by the balance.",
            significant(audited.loops_j * 1e6, 6),
            significant(audited.balance_j * 1e6, 6)
        ))
    }));
    blocks
}
