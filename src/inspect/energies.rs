//! The table of the energies of the hysteresis loops, for the page.

use super::loops::LoopEnergies;
use super::summary::Summary;
use crate::publish::html::table;
use crate::publish::value::{MISSING, fixed, significant};
use maud::{Markup, html};

/// Energies of the observed nodes and of the whole face over a cycle, and the check against the energy balance.
pub fn table_of(summary: &Summary) -> Markup {
    let header =
        ["energy per cycle", "disk [µJ]", "friction [µJ]", "pin [µJ]", "friction/disk"].map(str::to_owned);
    let line = |name: &str, energies: &LoopEnergies| -> Vec<Markup> {
        let LoopEnergies { friction_j, into_pin_j, drive_j } = *energies;
        let share = if drive_j > 0.0 { fixed(friction_j / drive_j, 3) } else { MISSING.to_owned() };
        let mut cells = vec![html! { span.words { (name) } }];
        cells.extend([drive_j, friction_j, into_pin_j].map(|j| html! { (significant(j * 1e6, 4)) }));
        cells.push(html! { (share) });
        cells
    };
    let nodes = summary.nodes.iter().zip(&summary.loops.nodes);
    let mut lines: Vec<Vec<Markup>> =
        nodes.map(|(node, energies)| line(&node.name.replace('_', " "), energies)).collect();
    lines.push(line("whole contact face", &summary.loops.face));
    html! {
        (table(&header, &lines))
        p {
            "Disk: work of the disk's motion. Friction: what friction dissipates. Pin: what friction gives to the pin, where \
             damping and impacts use it up."
        }
        @if let Some(audited) = summary.loops.audited {
            p {
                "Check: between two audits of the energy balance in this cycle friction dissipates "
                (significant(audited.loops_j * 1e6, 6)) " µJ by the loops of all nodes and "
                (significant(audited.balance_j * 1e6, 6)) " µJ by the balance."
            }
        }
    }
}
