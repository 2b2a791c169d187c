//! The data of the figures as CSV.

use super::capture::NodeStep;
use super::inspection::Inspection;
use super::loops::{self, LoopPoint};
use super::phases::Instants;
use super::spectrum::Spectrum;
use super::waves::{Change, stations};
use crate::analysis::sample::{NodeSample, Sample};
use crate::publish::value::number;
use crate::publish::{Folder, PublishError};
use std::collections::BTreeMap;
use std::io;

/// Largest table that the page contains [bytes]. Larger ones are in the folder only.
const MAX_EMBEDDED_BYTES: usize = 400_000;

/// Writes all tables; returns those that are not too large for the page, by name.
///
/// # Errors
/// The first file that could not be written.
pub fn write(inspection: &Inspection, folder: &mut Folder) -> Result<BTreeMap<String, String>, PublishError> {
    let mut tables = BTreeMap::new();
    let mut add = |name: &str, header: &[&str], lines: &mut dyn Iterator<Item = Vec<String>>| {
        folder.write_with(name, |out| {
            csv(header, lines, out)?;
            if out.len() <= MAX_EMBEDDED_BYTES {
                tables.insert(name.to_owned(), String::from_utf8_lossy(out).into_owned());
            }
            Ok(())
        })
    };
    add("run.csv", &RUN, &mut run_lines(inspection))?;
    add("cycles.csv", &CYCLES, &mut cycle_lines(inspection))?;
    let moves = inspection.spec.scene.holder.directions().map(|direction| direction.is_some());
    let header: Vec<&str> = TOTALS.into_iter().chain(of_moving(moves, HOLDER).flatten()).collect();
    let lines = inspection.capture.totals.iter();
    add("totals.csv", &header, &mut lines.map(|sample| totals_line(sample, moves)))?;
    add(SPECTRUM_FILE, &SPECTRUM, &mut spectrum_lines(&inspection.spectrum))?;
    for (observed, steps) in inspection.observed.iter().zip(&inspection.capture.nodes) {
        let name = format!("node_{}.csv", observed.node.name);
        add(&name, &history_header(), &mut steps.iter().map(history_line))?;
    }
    add("phases.csv", &PHASES, &mut phase_lines(inspection))?;
    add("instants.csv", &INSTANTS, &mut instant_lines(inspection))?;
    let mut header = vec!["time_s", "node", "x_m", "y_m"];
    header.extend(NODE);
    // As in the record: after a causal low-pass filter, which delays.
    header.push("sigma_n_delayed_pa");
    add("face.csv", &header, &mut face_lines(inspection))?;
    add("wave.csv", &WAVE, &mut wave_lines(inspection))?;
    add("loops.csv", &LOOPS, &mut loop_lines(inspection))?;
    Ok(tables)
}

/// Writes a header and lines as CSV.
pub fn csv(header: &[&str], lines: impl Iterator<Item = Vec<String>>, out: &mut Vec<u8>) -> io::Result<()> {
    let mut writer = ::csv::Writer::from_writer(out);
    writer.write_record(header).map_err(io::Error::other)?;
    for line in lines {
        writer.write_record(line).map_err(io::Error::other)?;
    }
    writer.flush()
}

fn optional(value: Option<f64>) -> String {
    value.map_or_else(String::new, number)
}

const RUN: [&str; 5] =
    ["start_s", "normal_min_n", "normal_max_n", "clamp_tangential_min_n", "clamp_tangential_max_n"];

fn run_lines(inspection: &Inspection) -> impl Iterator<Item = Vec<String>> {
    inspection.survey.envelope.bins().iter().map(|bin| {
        let [[low, high], [left, right]] = [bin.normal_n, bin.tangential_n];
        [bin.start_s, low, high, left, right].map(number).to_vec()
    })
}

const CYCLES: [&str; 3] = ["passage", "start_s", "end_s"];

fn cycle_lines(inspection: &Inspection) -> impl Iterator<Item = Vec<String>> {
    let passages = inspection.survey.passages_s.iter().enumerate();
    passages.map(|(at, [start_s, end_s])| vec![at.to_string(), number(*start_s), number(*end_s)])
}

/// The file of the spectrum.
pub const SPECTRUM_FILE: &str = "spectrum.csv";
const SPECTRUM: [&str; 2] = ["frequency_hz", "normal_amplitude_n"];

fn spectrum_lines(spectrum: &Spectrum) -> impl Iterator<Item = Vec<String>> {
    spectrum.lines().map(|(frequency_hz, amplitude_n)| vec![number(frequency_hz), number(amplitude_n)])
}

/// Writes a spectrum as CSV.
///
/// # Errors
/// Those of the writer.
pub fn spectrum(spectrum: &Spectrum, out: &mut Vec<u8>) -> io::Result<()> {
    csv(&SPECTRUM, spectrum_lines(spectrum), out)
}

const TOTALS: [&str; 11] = [
    "time_s",
    "load_n",
    "normal_n",
    "smooth_normal_n",
    "clamp_tangential_n",
    "contact_tangential_n",
    "contact_sideways_n",
    "mu_eq",
    "stick_nodes",
    "slip_nodes",
    "separated_nodes",
];

/// Columns of the holder in x, y and z.
const HOLDER: [[&str; 2]; 3] = [
    ["holder_x_m", "holder_x_acceleration_m_s2"],
    ["holder_y_m", "holder_y_acceleration_m_s2"],
    ["holder_z_m", "holder_z_acceleration_m_s2"],
];

/// What belongs to the directions in which the holder moves.
fn of_moving<T>(moves: [bool; 3], all: [T; 3]) -> impl Iterator<Item = T> {
    all.into_iter().zip(moves).filter_map(|(one, moves)| moves.then_some(one))
}

fn totals_line(sample: &Sample, moves: [bool; 3]) -> Vec<String> {
    let mut line = [
        sample.time_s,
        sample.load_n,
        sample.normal_n,
        sample.smooth_normal_n,
        sample.clamp_tangential_n,
        sample.contact_tangential_n,
        sample.contact_sideways_n,
        sample.equivalent_friction(),
    ]
    .map(number)
    .to_vec();
    line.extend([sample.stick, sample.slip, sample.separated].map(|count| count.to_string()));
    let of_holder = of_moving(moves, sample.holder);
    line.extend(of_holder.flat_map(|holder| [holder.displacement_m, holder.acceleration_m_s2].map(number)));
    line
}

/// Columns for a contact node during a step.
const NODE: [&str; 11] = [
    "ux_m",
    "uy_m",
    "uz_m",
    "y_velocity_m_s",
    "gap_m",
    "friction_x_n",
    "friction_y_n",
    "normal_n",
    "slip_speed_m_s",
    "mu_eq",
    "state",
];

fn node_cells(node: &NodeSample) -> Vec<String> {
    let [ux, uy, uz] = node.u_m;
    let [x, y, n] = node.force_n;
    let mut cells = [
        ux,
        uy,
        uz,
        node.y_velocity_m_s,
        node.gap_m,
        x,
        y,
        n,
        node.slip_speed_m_s,
        node.equivalent_friction(),
    ]
    .map(number)
    .to_vec();
    cells.push(node.state.name().to_owned());
    cells
}

/// Columns of a node's history.
pub fn history_header() -> Vec<&'static str> {
    let mut header = vec!["time_s"];
    header.extend(NODE);
    header.extend(["tau_x_pa", "tau_y_pa", "sigma_n_pa"]);
    header
}

/// A step of a node's history.
pub fn history_line(step: &NodeStep) -> Vec<String> {
    let mut line = vec![number(step.time_s)];
    line.extend(node_cells(&step.node));
    line.extend(step.stress_pa.map(number));
    line
}

const PHASES: [&str; 4] = ["node", "state", "start_s", "end_s"];

fn phase_lines(inspection: &Inspection) -> impl Iterator<Item = Vec<String>> {
    inspection.observed.iter().flat_map(|observed| {
        observed.phases.iter().map(|phase| {
            let (start, end) = (number(phase.start_s), number(phase.end_s));
            vec![observed.node.name.clone(), phase.state.name().to_owned(), start, end]
        })
    })
}

const INSTANTS: [&str; 3] = ["node", "instant", "time_s"];

fn instant_lines(inspection: &Inspection) -> impl Iterator<Item = Vec<String>> {
    inspection.observed.iter().flat_map(|observed| {
        let named = observed.instants.as_ref().map_or_else(Vec::new, Instants::named);
        let name = observed.node.name.clone();
        named
            .into_iter()
            .map(move |(letter, time_s)| vec![name.clone(), format!("t_{letter}"), number(time_s)])
    })
}

fn face_lines(inspection: &Inspection) -> impl Iterator<Item = Vec<String>> {
    inspection.capture.face.iter().flat_map(|step| {
        step.nodes.iter().enumerate().map(|(slave, node)| {
            let [x, y, _] = inspection.mesh().coordinates_m(slave);
            let mut line = vec![number(step.time_s), slave.to_string(), number(x), number(y)];
            line.extend(node_cells(node));
            line.push(number(node.sigma_n_pa));
            line
        })
    })
}

const WAVE: [&str; 6] = ["y_m", "contact_s", "stick_s", "peak_s", "slip_s", "separation_s"];

fn wave_lines(inspection: &Inspection) -> impl Iterator<Item = Vec<String>> {
    stations(inspection).into_iter().map(|station| {
        let of = |change: Change| optional(station.at(change));
        let peak = optional(station.instants.map(|instants| instants.peak_s));
        let [contact, stick, slip, separation] = Change::ALL.map(of);
        vec![number(station.y_m), contact, stick, peak, slip, separation]
    })
}

const LOOPS: [&str; 7] =
    ["place", "time_s", "slip_y_m", "displacement_y_m", "friction_y_n", "clamp_tangential_n", "state"];

fn loop_lines(inspection: &Inspection) -> impl Iterator<Item = Vec<String>> {
    let line = |place: &str, point: &LoopPoint| {
        let LoopPoint { time_s, slip_m, y_m, friction_n, state, clamp_n } = *point;
        vec![
            place.to_owned(),
            number(time_s),
            number(slip_m),
            optional(y_m),
            number(friction_n),
            optional(clamp_n),
            state.map_or_else(String::new, |state| state.name().to_owned()),
        ]
    };
    let nodes = inspection.observed.iter().enumerate().flat_map(move |(number, observed)| {
        let points = loops::of_node(inspection, number);
        points.into_iter().map(move |point| line(&observed.node.name, &point))
    });
    nodes.chain(loops::of_face(inspection).into_iter().map(move |point| line("face", &point)))
}
