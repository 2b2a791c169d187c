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
use crate::publish::chart::Chart;

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
    /// What it shows.
    pub picture: Picture,
}

/// What a figure shows.
#[derive(Debug, Clone, PartialEq)]
pub enum Picture {
    /// Numbers over axes.
    Chart(Chart),
    /// A sketch as SVG.
    Sketch(String),
}

impl InspectionFigure {
    /// The name of its file.
    pub fn file(&self) -> String {
        format!("{}.svg", self.stem)
    }

    /// The drawing.
    pub fn svg(&self) -> String {
        match &self.picture {
            Picture::Chart(chart) => chart.svg(&self.caption),
            Picture::Sketch(svg) => svg.clone(),
        }
    }
}

/// A figure: stem, heading, caption, data, and what draws it.
type Row = (&'static str, &'static str, &'static str, &'static [&'static str], Draw);

#[derive(Clone, Copy)]
enum Draw {
    Chart(fn(&Inspection) -> Chart),
    Sketch(fn(&Inspection, &str) -> String),
}

/// In place of the histories of all observed nodes.
const HISTORIES: &str = "node_*.csv";
/// In place of what a node that slips has.
const LIMIT: &str = "{limit}";

const FIGURES: [Row; 10] = [
    (
        "figure2a",
        "Displacements and velocity",
        "Displacements in the three directions and velocity in y of the observed nodes (the paper's Figure 2a).",
        &[HISTORIES],
        Draw::Chart(histories::displacements),
    ),
    (
        "figure2b",
        "Stick, slip and separation",
        "Equivalent friction coefficient |τ/σ_n| and velocity in y (Figure 2b): {limit} is slip, less is stick, 0 is \
         separation.",
        &[HISTORIES, "phases.csv"],
        Draw::Chart(histories::friction),
    ),
    (
        "figure3a",
        "Trajectories",
        "Trajectories of the contact nodes in the y–z plane over one cycle (Figure 3a): all of them about their means, \
         and those on three lines where the nodes are, displacements in y enlarged.",
        &["face.csv"],
        Draw::Chart(face::trajectories),
    ),
    (
        "figure3b",
        "Phase planes",
        "Phase plane of the observed nodes (Figure 3b): the level is the velocity of the disk under the node.",
        &[HISTORIES],
        Draw::Chart(histories::phase_planes),
    ),
    (
        "figure4",
        "One cycle",
        "Normal contact stress (after a zero-phase low-pass filter) and velocity in y over one cycle (Figure 4). Contact \
         begins at t_A, stick at t_B, the stress is largest at t_C, stick ends at t_D, contact at t_E, and the separation \
         at t_F.",
        &[HISTORIES, "instants.csv"],
        Draw::Chart(histories::cycles),
    ),
    (
        "figure5",
        "Snapshots",
        "Four instants of a cycle (Figure 5): velocities in the middle plane of the pin with the contact forces under it, \
         and the contact face from above with the states and friction forces of its nodes.",
        &["face.csv", "fields.pvd"],
        Draw::Sketch(snapshots::draw),
    ),
    (
        "wave",
        "Waves",
        "States of the nodes along the middle of the contact face over one cycle: the front is below, the rear above.",
        &["face.csv", "wave.csv"],
        Draw::Chart(face::waves),
    ),
    (
        "loops",
        "Hysteresis loops",
        "Friction force over the slip and over the displacement of the observed nodes in the last cycles, and of the whole \
         contact face in one cycle. The area under friction over slip is the energy that friction dissipates. The area \
         inside friction over displacement is the energy that friction gives to the pin.",
        &["loops.csv"],
        Draw::Chart(loops::loops),
    ),
    (
        "totals",
        "Total forces",
        "Total normal contact force N and tangential force T at the clamp: the whole run, and the last cycles with their \
         starts, where the filtered N rises through F (the filter delays by a constant time).",
        &["run.csv", "totals.csv", "cycles.csv"],
        Draw::Chart(totals::forces),
    ),
    (
        "spectrum",
        "Spectrum",
        "Spectrum of the total normal contact force over the averaging window.",
        &["spectrum.csv"],
        Draw::Chart(totals::spectrum),
    ),
];

/// All figures of an inspection.
pub fn figures(inspection: &Inspection) -> Vec<InspectionFigure> {
    let limit = limit::in_words(&inspection.spec.scene.contact);
    let files = |name: &&str| -> Vec<String> {
        match *name {
            HISTORIES => {
                let nodes = inspection.observed.iter();
                nodes.map(|observed| format!("node_{}.csv", observed.node.name)).collect()
            }
            name => vec![name.to_owned()],
        }
    };
    let figure = |(stem, heading, caption, data, draw): Row| {
        let caption = caption.replace(LIMIT, &limit);
        let picture = match draw {
            Draw::Chart(chart) => Picture::Chart(chart(inspection)),
            Draw::Sketch(sketch) => Picture::Sketch(sketch(inspection, &caption)),
        };
        InspectionFigure { stem, heading, caption, data: data.iter().flat_map(files).collect(), picture }
    };
    FIGURES.map(figure).into()
}
