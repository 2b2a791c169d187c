//! The data of the figures as CSV.

use super::capture::NodeStep;
use super::envelope::Bin;
use super::inspection::Inspection;
use super::loops::{self, LoopPoint};
use super::phases::{Instants, Phase};
use super::spectrum::Spectrum;
use super::waves::{Change, Station, stations};
use crate::analysis::quantity::{DELAYED_STRESS, NODE, TOTALS, of_holder};
use crate::analysis::sample::{NodeSample, Sample};
use crate::publish::table::Column;
#[cfg(feature = "cli")]
use crate::publish::table::FileColumns;
use crate::publish::{Folder, PublishError};
use crate::solver::interface::ContactState;
use std::borrow::Borrow;
use std::collections::BTreeMap;

/// Largest table that the page contains [bytes]. Larger ones are in the folder only.
const MAX_EMBEDDED_BYTES: u64 = 400_000;

/// Writes all tables; returns those that are not too large for the page, by name.
///
/// # Errors
/// The first file that could not be written.
pub fn write(inspection: &Inspection, folder: &mut Folder) -> Result<BTreeMap<String, String>, PublishError> {
    let Inspection { survey, capture, observed, .. } = inspection;
    let mut tables = Tables { folder, small: BTreeMap::new() };
    tables.add("run.csv", &RUN, survey.envelope.bins())?;
    tables.add("cycles.csv", &CYCLES, survey.passages_s.iter().copied().enumerate())?;
    let moves = inspection.spec.scene.holder.directions().map(|direction| direction.is_some());
    let totals: Vec<Column<Sample>> = TOTALS.into_iter().chain(of_holder(moves)).map(Column::from).collect();
    tables.add("totals.csv", &totals, &capture.totals)?;
    tables.add(SPECTRUM_FILE, &SPECTRUM, inspection.spectrum.lines())?;
    let history = history();
    for (observed, steps) in observed.iter().zip(&capture.nodes) {
        tables.add(&format!("node_{}.csv", observed.node.name), &history, steps)?;
    }
    let of_nodes = || observed.iter().map(|observed| (&observed.node.name, observed));
    let phases =
        of_nodes().flat_map(|(name, own)| own.phases.iter().map(move |phase| (name.clone(), *phase)));
    tables.add("phases.csv", &PHASES, phases)?;
    let instants = of_nodes().flat_map(|(name, own)| {
        let named = own.instants.as_ref().map_or_else(Vec::new, Instants::named);
        named.into_iter().map(move |(letter, time_s)| (name.clone(), letter, time_s))
    });
    tables.add("instants.csv", &INSTANTS, instants)?;
    let face = capture.face.iter().flat_map(|step| {
        step.nodes.iter().enumerate().map(|(slave, node)| FaceNode {
            time_s: step.time_s,
            slave,
            at_m: inspection.mesh().coordinates_m(slave),
            node: *node,
        })
    });
    tables.add("face.csv", &of_face(), face)?;
    tables.add("wave.csv", &WAVE, stations(inspection))?;
    let of_place = |place: &str, points: Vec<LoopPoint>| {
        let place = place.to_owned();
        points.into_iter().map(move |point| (place.clone(), point))
    };
    let nodes = of_nodes().enumerate();
    let nodes = nodes.flat_map(|(number, (name, _))| of_place(name, loops::of_node(inspection, number)));
    tables.add("loops.csv", &LOOPS, nodes.chain(of_place("face", loops::of_face(inspection))))?;
    Ok(tables.small)
}

/// The columns of all files of an inspection, for the page of columns.
#[cfg(feature = "cli")]
pub fn described() -> Vec<FileColumns> {
    let totals: Vec<Column<Sample>> = TOTALS.into_iter().map(Column::from).collect();
    let holder = "A line is a step of the last cycles. With a holder that moves, there are columns of its displacement and acceleration.";
    let step = "A line is a step of a cycle.";
    vec![
        FileColumns::new(&["run.csv"], "A line is a part of the run.", &RUN),
        FileColumns::new(&["cycles.csv"], "A line is a cycle.", &CYCLES),
        FileColumns::new(&["totals.csv"], holder, &totals),
        FileColumns::new(&["node_NODE.csv"], step, &history()),
        FileColumns::new(&["face.csv"], "A line is a node of the contact face at a step.", &of_face()),
        FileColumns::new(&["phases.csv"], "A line is a phase of an observed node.", &PHASES),
        FileColumns::new(&["instants.csv"], "A line is an instant of an observed node.", &INSTANTS),
        FileColumns::new(&["wave.csv"], "A line is a node on the middle line of the contact face.", &WAVE),
        FileColumns::new(&["loops.csv"], "A line is a point of a loop.", &LOOPS),
        FileColumns::new(&[SPECTRUM_FILE], "A line is a line of the spectrum of N.", &SPECTRUM),
    ]
}

struct Tables<'a, 'b> {
    folder: &'a mut Folder<'b>,
    /// Those that are not too large for the page.
    small: BTreeMap<String, String>,
}

impl Tables<'_, '_> {
    fn add<T>(
        &mut self,
        name: &str,
        columns: &[Column<T>],
        subjects: impl IntoIterator<Item = impl Borrow<T>>,
    ) -> Result<(), PublishError> {
        self.folder.write_lines(name, columns, subjects)?;
        let path = self.folder.path_of(name);
        if path.metadata().is_ok_and(|file| file.len() <= MAX_EMBEDDED_BYTES)
            && let Ok(text) = std::fs::read_to_string(path)
        {
            self.small.insert(name.to_owned(), text);
        }
        Ok(())
    }
}

const RUN: [Column<Bin>; 5] = [
    Column::new("start_s", "s", "beginning of a part of the run", |bin| bin.start_s.into()),
    Column::new("normal_min_n", "N", "smallest normal contact force N in it, smoothed", |bin| {
        bin.normal_n[0].into()
    }),
    Column::new("normal_max_n", "N", "largest N, smoothed", |bin| bin.normal_n[1].into()),
    Column::new("clamp_tangential_min_n", "N", "smallest tangential force T of the clamp", |bin| {
        bin.tangential_n[0].into()
    }),
    Column::new("clamp_tangential_max_n", "N", "largest T", |bin| bin.tangential_n[1].into()),
];

const CYCLES: [Column<(usize, [f64; 2])>; 3] = [
    Column::new("passage", "", "number of the cycle, from 0", |(number, _)| (*number).into()),
    Column::new("start_s", "s", "its beginning", |(_, [start_s, _])| (*start_s).into()),
    Column::new("end_s", "s", "its end", |(_, [_, end_s])| (*end_s).into()),
];

/// The file of the spectrum.
pub const SPECTRUM_FILE: &str = "spectrum.csv";

const SPECTRUM: [Column<(f64, f64)>; 2] = [
    Column::new("frequency_hz", "Hz", "frequency", |(frequency_hz, _)| (*frequency_hz).into()),
    Column::new("normal_amplitude_n", "N", "amplitude of N at the frequency", |(_, amplitude_n)| {
        (*amplitude_n).into()
    }),
];

/// Writes a spectrum.
///
/// # Errors
/// If the file cannot be written.
pub fn write_spectrum(spectrum: &Spectrum, folder: &mut Folder) -> Result<(), PublishError> {
    folder.write_lines(SPECTRUM_FILE, &SPECTRUM, spectrum.lines())
}

/// The columns of a node's history.
pub fn history() -> Vec<Column<NodeStep>> {
    let of_node = NODE.map(|quantity| Column::from(quantity).within(|step: &NodeStep| &step.node));
    let stresses = [
        Column::new("tau_x_pa", "Pa", "shear stress in x, smoothed", |step: &NodeStep| {
            step.stress_pa[0].into()
        }),
        Column::new("tau_y_pa", "Pa", "shear stress in y, smoothed", |step| step.stress_pa[1].into()),
        Column::new("sigma_n_pa", "Pa", "normal stress, smoothed", |step| step.stress_pa[2].into()),
    ];
    let time = Column::new("time_s", "s", "simulated time", |step: &NodeStep| step.time_s.into());
    [time].into_iter().chain(of_node).chain(stresses).collect()
}

const PHASES: [Column<(String, Phase)>; 4] = [
    Column::new("node", "", "name of the observed node", |(node, _)| node.as_str().into()),
    Column::new("state", "", "contact state of the phase", |(_, phase)| phase.state.name().into()),
    Column::new("start_s", "s", "beginning of the phase", |(_, phase)| phase.start_s.into()),
    Column::new("end_s", "s", "its end", |(_, phase)| phase.end_s.into()),
];

const INSTANTS: [Column<(String, char, f64)>; 3] = [
    Column::new("node", "", "name of the observed node", |(node, ..)| node.as_str().into()),
    Column::new("instant", "", "letter of the instant, as in figure4.svg", |(_, letter, _)| {
        format!("t_{letter}").into()
    }),
    Column::new("time_s", "s", "its time", |(.., time_s)| (*time_s).into()),
];

/// A contact node at a step.
struct FaceNode {
    time_s: f64,
    slave: usize,
    at_m: [f64; 3],
    node: NodeSample,
}

fn of_face() -> Vec<Column<FaceNode>> {
    let place = [
        Column::new("time_s", "s", "simulated time", |at: &FaceNode| at.time_s.into()),
        Column::new("node", "", "number of the node of the contact face", |at| at.slave.into()),
        Column::new("x_m", "m", "its place in x", |at| at.at_m[0].into()),
        Column::new("y_m", "m", "its place in y", |at| at.at_m[1].into()),
    ];
    let of_node = NODE.into_iter().chain([DELAYED_STRESS]);
    let of_node = of_node.map(|quantity| Column::from(quantity).within(|at: &FaceNode| &at.node));
    place.into_iter().chain(of_node).collect()
}

const WAVE: [Column<Station>; 6] = [
    Column::new("y_m", "m", "place of a node on the middle line of the contact face", |at| at.y_m.into()),
    Column::new("contact_s", "s", "time at which it touches", |at| at.at(Change::Contact).into()),
    Column::new("stick_s", "s", "time at which it begins to stick", |at| at.at(Change::Stick).into()),
    Column::new("peak_s", "s", "time of its largest normal stress", |at| {
        at.instants.map(|instants| instants.peak_s).into()
    }),
    Column::new("slip_s", "s", "time at which it begins to slip", |at| at.at(Change::Slip).into()),
    Column::new("separation_s", "s", "time at which it lifts off", |at| at.at(Change::Separation).into()),
];

const LOOPS: [Column<(String, LoopPoint)>; 7] = [
    Column::new("place", "", "name of an observed node, or face", |(place, _)| place.as_str().into()),
    Column::new("time_s", "s", "simulated time", |(_, point)| point.time_s.into()),
    Column::new("slip_y_m", "m", "slip in y since the cycle began", |(_, point)| point.slip_m.into()),
    Column::new("displacement_y_m", "m", "displacement in y", |(_, point)| point.y_m.into()),
    Column::new("friction_y_n", "N", "friction force in y", |(_, point)| point.friction_n.into()),
    Column::new("clamp_tangential_n", "N", "tangential force T of the clamp, for the face", |(_, point)| {
        point.clamp_n.into()
    }),
    Column::new("state", "", "contact state, for a node", |(_, point)| {
        point.state.map(ContactState::name).into()
    }),
];
