//! The drawings: the paper's figures 2 to 5 for one job, its figure 8 for several jobs, and others.

mod face;
mod histories;
mod loops;
mod overlay;
mod snapshots;
mod style;
mod totals;

pub use overlay::overlay;

use super::inspection::Inspection;
use super::limit;
use crate::publish::plot::panel::stack;
use crate::publish::{FigureError, Folder, PublishError};

/// A figure of an inspection.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectionFigure {
    /// The name of its file without the ending.
    pub stem: &'static str,
    /// Its heading.
    pub heading: &'static str,
    /// Its caption.
    pub caption: String,
    /// The names of the tables with its data.
    pub data: Vec<String>,
    /// The drawing as SVG.
    pub svg: String,
}

/// Draws and writes all figures.
///
/// # Errors
/// The first figure that could not be drawn or written.
pub fn write(inspection: &Inspection, folder: &mut Folder) -> Result<Vec<InspectionFigure>, PublishError> {
    let mut figures = Vec::new();
    for (stem, heading, caption, data, draw) in of_nodes(inspection).into_iter().chain(of_all(inspection)) {
        let name = format!("{stem}.svg");
        let svg = draw().map_err(|source| PublishError::Figure { path: folder.path_of(&name), source })?;
        folder.write_text(&name, &svg)?;
        figures.push(InspectionFigure { stem, heading, caption, data, svg });
    }
    Ok(figures)
}

/// A figure before it is drawn: stem, heading, caption, data, drawing.
type Part<'a> = (&'static str, &'static str, String, Vec<String>, Drawing<'a>);

fn only(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

/// The figures of the motion of nodes.
fn of_nodes(inspection: &Inspection) -> Vec<Part<'_>> {
    let histories: Vec<String> =
        inspection.observed.iter().map(|observed| format!("node_{}.csv", observed.node.name)).collect();
    let with = |more: &[&str]| -> Vec<String> { histories.iter().cloned().chain(only(more)).collect() };
    let limit = limit::in_words(&inspection.spec.scene.contact);
    vec![
        (
            "figure2a",
            "Displacements and velocity",
            "Displacements in the three directions and velocity in y of the observed nodes (the paper's Figure 2a)."
                .to_owned(),
            histories.clone(),
            Box::new(|| stack(&histories::displacements(inspection))),
        ),
        (
            "figure2b",
            "Stick, slip and separation",
            format!(
                "Equivalent friction coefficient |τ/σ_n| and velocity in y (Figure 2b): {limit} is slip, less is stick, \
                 0 is separation."
            ),
            with(&["phases.csv"]),
            Box::new(|| stack(&histories::friction(inspection))),
        ),
        (
            "figure3a",
            "Trajectories",
            "Trajectories of the contact nodes in the y–z plane over one cycle (Figure 3a): all of them about their \
             means, and those on three lines where the nodes are, displacements in y enlarged."
                .to_owned(),
            only(&["face.csv"]),
            Box::new(|| stack(&face::trajectories(inspection))),
        ),
        (
            "figure3b",
            "Phase planes",
            "Phase plane of the observed nodes (Figure 3b): the level is the velocity of the disk under the node."
                .to_owned(),
            histories.clone(),
            Box::new(|| stack(&histories::phase_planes(inspection))),
        ),
        (
            "figure4",
            "One cycle",
            "Normal contact stress (after a zero-phase low-pass filter) and velocity in y over one cycle (Figure 4). Contact \
             begins at t_A, stick at t_B, the stress is largest at t_C, stick ends at t_D, contact at t_E, and the \
             separation at t_F."
                .to_owned(),
            with(&["instants.csv"]),
            Box::new(|| stack(&histories::cycles(inspection))),
        ),
    ]
}

/// The figures of the pin, of its contact face and of forces.
fn of_all(inspection: &Inspection) -> Vec<Part<'_>> {
    vec![
        (
            "figure5",
            "Snapshots",
            "Four instants of a cycle (Figure 5): velocities in the middle plane of the pin with the contact forces \
             under it, and the contact face from above with the states and friction forces of its nodes."
                .to_owned(),
            only(&["face.csv", "fields.pvd"]),
            Box::new(|| snapshots::draw(inspection)),
        ),
        (
            "wave",
            "Waves",
            "States of the nodes along the middle of the contact face over one cycle: the front is below, the rear \
             above."
                .to_owned(),
            only(&["face.csv", "wave.csv"]),
            Box::new(|| stack(&[face::waves(inspection)])),
        ),
        (
            "loops",
            "Hysteresis loops",
            "Friction force over the slip and over the displacement of the observed nodes in the last cycles, and of the \
             whole contact face in one cycle. The area under friction over slip is the energy that friction dissipates. \
             The area inside friction over displacement is the energy that friction gives to the pin."
                .to_owned(),
            only(&["loops.csv"]),
            Box::new(|| stack(&loops::loops(inspection))),
        ),
        (
            "totals",
            "Total forces",
            "Total normal contact force N and tangential force T at the clamp: the whole run, and the last cycles \
             with their starts, where the filtered N rises through F (the filter delays by a constant time)."
                .to_owned(),
            only(&["run.csv", "totals.csv", "cycles.csv"]),
            Box::new(|| stack(&totals::forces(inspection))),
        ),
        (
            "spectrum",
            "Spectrum",
            "Spectrum of the total normal contact force over the averaging window.".to_owned(),
            only(&["spectrum.csv"]),
            Box::new(|| stack(&[totals::spectrum(inspection)])),
        ),
    ]
}

type Drawing<'a> = Box<dyn Fn() -> Result<String, FigureError> + 'a>;
