//! The page of an inspection: one file with all of it except for the tables that are too large.

use super::energies;
use super::fields::FIELDS;
use super::figures::InspectionFigure;
use super::inspection::Inspection;
use super::summary::{NodeSummary, SUMMARY, Summary};
use super::waves::Wave;
use crate::publish::Sheet;
use crate::publish::page::{Block, Figure, Grid, Page, Section, Text, Tile};
use crate::publish::rounding::{at_place, last_place};
use crate::publish::value::{MISSING, fixed, number, significant};
use std::collections::BTreeMap;

/// The title of the page, and the program that made it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageHeader {
    /// The study and the job's parameters.
    pub title: String,
    /// The program that ran the job.
    pub made_with: String,
    /// The job's key; empty if it is not known. A report finds the inspections of its jobs by it.
    pub key: String,
    /// What was simulated: drawings and all inputs.
    pub sheet: Sheet,
}

/// The page. `tables` are the CSV files that it contains, by name.
pub fn of(
    inspection: &Inspection,
    summary: &Summary,
    figures: &[InspectionFigure],
    tables: &BTreeMap<String, String>,
    header: &PageHeader,
) -> Page {
    let mut sections = vec![Section::new("scene", "What was simulated", header.sheet.blocks())];
    sections.extend(figures.iter().map(|own| {
        let (svg, caption) = (own.svg(), own.caption.clone());
        let data = own.data.iter().map(|name| (name.clone(), tables.get(name).cloned()));
        let mut blocks = vec![
            Block::figure(Figure { file: own.file(), svg, caption, data: None }),
            Block::Data(data.collect()),
        ];
        match own.stem {
            "wave" => blocks.extend(waves(&summary.waves)),
            "loops" => blocks.extend(energies::blocks(summary)),
            _ => {}
        }
        Section::new(own.stem, own.heading, blocks)
    }));
    sections.push(Section::new("nodes", "Nodes in numbers", nodes(summary)));
    sections.push(Section::new("files", "Files", files(&header.made_with)));
    let lead = lead(inspection, summary);
    Page { title: header.title.clone(), lead, sections, ..Page::default() }
}

fn lead(inspection: &Inspection, summary: &Summary) -> Vec<Block> {
    let record = &summary.record;
    // As on the page of a report: numbers end at the digit in which the larger error begins.
    let of_mesh = record.mesh_error();
    let error = record.mu_star_se.abs().max(of_mesh.map_or(0.0, |of_mesh| of_mesh.mu_star));
    let finest = if of_mesh.is_ok() { -4 } else { -3 };
    let place = last_place(error).unwrap_or(finest).clamp(finest, -1);
    let mu = number(summary.job.scene.contact.mu);
    let errors = format!(
        "at μ = {mu}; errors: statistics {}, mesh {}",
        significant(record.mu_star_se, 2),
        of_mesh.map_or_else(|why| format!("unknown ({})", why.reason()), |own| significant(own.mu_star, 2))
    );
    let frequency = record.frequency_hz.map_or_else(|| "none".to_owned(), |f| format!("{f:.0} Hz"));
    let shares = [record.stick_share, record.slip_share, record.separated_share];
    let shares = shares.map(|share| format!("{share:.2}")).join(" / ");
    let loops = format!("{} of {}", summary.face.counter_clockwise, summary.face.separating);
    let sense = "of the nodes that separate go counter-clockwise (y to the right, z upwards)";
    let tiles = vec![
        Tile::new("μ*", at_place(record.mu_star, place), errors),
        Tile::new("frequency", frequency, "of the total normal force"),
        Tile::new("regime", record.regime.label(), record.outcome.label()),
        Tile::new("stick / slip / separated", shares, "shares of the node-time"),
        Tile::new("loops", loops, sense),
    ];
    let without_cycles = "This job has no limit cycle. The end of its run is shown instead, in periods of 4h/c_s: those of \
                          the pin as a quarter-wave resonator in shear.";
    let warning = (!summary.cycles).then(|| Block::Warning(without_cycles.into(), Vec::new()));
    warning.into_iter().chain([Block::Text(numerics(inspection).into()), Block::Tiles(tiles)]).collect()
}

/// Mesh, step and disk in a line.
fn numerics(inspection: &Inspection) -> String {
    let elements = match inspection.mesh().block() {
        Some(block) => block.elements().map(|n| n.to_string()).join(" × "),
        None => inspection.mesh().element_count().to_string(),
    };
    let record = &inspection.survey.record;
    let disk = if inspection.capture.model.ring().is_some() { "an elastic disk" } else { "a rigid disk" };
    format!(
        "{elements} elements on {disk}, {} steps of {} s; {} cycles are shown.",
        record.steps,
        significant(record.time_step_s, 3),
        inspection.survey.windows.cycle_count
    )
}

/// The table of waves.
fn waves(waves: &[Wave]) -> Vec<Block> {
    if waves.is_empty() {
        return vec![Block::text("No change of state travels over neighbouring nodes of this line.")];
    }
    let heads = ["change", "y from … to [mm]", "begins [µs]", "takes [µs]", "speed [m/s], towards"];
    let lines = waves.iter().map(|wave| {
        let [from, to] = wave.from_to_m.map(|y| fixed(y * 1e3, 2));
        let speed = wave.speed_m_s().map_or_else(
            || MISSING.to_owned(),
            |speed| format!("{:.0}, {}", speed.abs(), if speed > 0.0 { "rear" } else { "front" }),
        );
        let [begins, takes] = [wave.start_s, wave.delay_s.abs()].map(|time_s| fixed(time_s * 1e6, 1));
        vec![wave.change.name().to_owned(), format!("{from} … {to}"), begins, takes, speed]
    });
    vec![
        Block::Table(Grid::of(&heads, lines, SUMMARY)),
        Block::text(
            "A wave is a run of neighbouring nodes that all have the change; \"begins\" is the time at its foremost node \
             since the start of the cycle.",
        ),
    ]
}

/// A line of the table of nodes: its heading, and the value of a node.
type NodeLine = (&'static str, fn(&NodeSummary) -> String);

const NODE_LINES: [NodeLine; 8] = [
    ("x, y [mm]", |node| node.at_m.map(|at| format!("{:.2}", at * 1e3)).join(", ")),
    ("range of x, y, z [µm]", |node| node.peak_to_peak_m.map(|range| fixed(range * 1e6, 2)).join(", ")),
    ("largest gap [µm]", |node| fixed(node.lift_max_m * 1e6, 3)),
    ("largest σ_n [MPa], as in the record", |node| fixed(node.sigma_n_max_pa * 1e-6, 3)),
    ("largest slip speed [mm/s]", |node| fixed(node.slip_speed_max_m_s * 1e3, 0)),
    ("largest speed relative to the disk [mm/s]", |node| fixed(node.relative_speed_max_m_s * 1e3, 0)),
    ("stick, slip, separated", |node| node.shares.map(|share| fixed(share, 2)).join(", ")),
    ("frequency of separation, or of stick [Hz]", |node| {
        node.frequency_hz.map_or_else(|| MISSING.to_owned(), |f| fixed(f, 0))
    }),
];

fn nodes(summary: &Summary) -> Vec<Block> {
    let names: Vec<String> = summary.nodes.iter().map(|node| node.name.replace('_', " ")).collect();
    let heads: Vec<&str> = std::iter::once("").chain(names.iter().map(String::as_str)).collect();
    let lines = NODE_LINES.into_iter().map(|(name, value)| {
        std::iter::once(name.to_owned()).chain(summary.nodes.iter().map(value)).collect::<Vec<_>>()
    });
    let of_node = |node: &NodeSummary| {
        let heads = ["", "time [µs]", "state", "σ_n [MPa]", "v_y − disk [mm/s]"];
        let instants = Grid::of(&heads, instants(node, summary.shown_s[0]), "instants.csv");
        [Block::Heading(node.title.clone()), Block::Table(instants)]
    };
    let table = Block::Table(Grid::of(&heads, lines, SUMMARY).with_words());
    std::iter::once(table).chain(summary.nodes.iter().flat_map(of_node)).collect()
}

/// The lines of the table of instants.
fn instants(node: &NodeSummary, from_s: f64) -> impl Iterator<Item = Vec<String>> {
    let at = node.instants.iter().flat_map(|instants| &instants.at);
    at.map(move |(name, time_s, stress_pa, velocity_m_s, state)| {
        let time = fixed((time_s - from_s) * 1e6, 2);
        vec![name.clone(), time, state.clone(), fixed(stress_pa * 1e-6, 3), fixed(velocity_m_s * 1e3, 1)]
    })
}

const FILES: [&str; 6] = [
    "`inspection.json` – all numbers of this page, with the job's specification and record",
    "`node_*.csv` – histories of the observed nodes; `phases.csv`, `instants.csv`",
    "`face.csv` – every contact node at every step of a cycle; `wave.csv`",
    "`loops.csv` – friction over slip and displacement, of the observed nodes and of the whole face",
    "`totals.csv`, `run.csv`, `cycles.csv`, `spectrum.csv`",
    "`fields.pvd` – the pin over a cycle, for ParaView, with these fields at the nodes:",
];

/// The files, and the fields of those for ParaView.
fn files(made_with: &str) -> Vec<Block> {
    let fields = FIELDS.iter().map(|(name, meaning)| vec![*name, *meaning]);
    vec![
        Block::list(FILES.map(Text::marked)),
        Block::Table(Grid::of(&["field", "meaning"], fields, "fields.pvd").with_words()),
        Block::Text(format!("Made with {made_with}.").into()),
    ]
}
