//! The page of an inspection: one file with all of it except for the tables that are too large.

use super::energies;
use super::fields::FIELDS;
use super::figures::InspectionFigure;
use super::inspection::Inspection;
use super::summary::{NodeSummary, Summary};
use crate::publish::Sheet;
use crate::publish::html::{self, download, figure, navigation, section, table, tiles, warning};
use crate::publish::rounding::{at_place, last_place};
use crate::publish::value::{MISSING, fixed, number, significant};
use maud::{Markup, html};
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
    /// The largest error of μ\* that mesh and time step make, relative to μ\*, if it was measured with such a mesh.
    pub mu_star_relative_error: Option<f64>,
    /// What is known about the error that mesh and time step make, in a sentence; may be empty.
    pub accuracy: String,
}

/// The page. `tables` are the CSV files that it contains, by name.
pub fn of(
    inspection: &Inspection,
    summary: &Summary,
    figures: &[InspectionFigure],
    tables: &BTreeMap<String, String>,
    header: &PageHeader,
) -> String {
    let links = figures.iter().map(|figure| (figure.stem, figure.heading));
    let first = [("scene", "What was simulated")];
    let last = [("nodes", "Nodes in numbers"), ("files", "Files")];
    let sections: Vec<(&str, &str)> = first.into_iter().chain(links).chain(last).collect();
    let body = html! {
        (head(inspection, summary, header))
        @if !header.accuracy.is_empty() { div.accuracy { p { strong { "Accuracy. " } (header.accuracy) } } }
        (navigation(sections))
        (section("scene", first[0].1, &html::sheet(&header.sheet)))
        @for drawn in figures {
            (section(drawn.stem, drawn.heading, &html! {
                (figure(&drawn.svg, &drawn.caption, None))
                p { "Data: " @for name in &drawn.data { (data(name, tables)) " " } }
                @if drawn.stem == "wave" { (waves(summary)) }
                @if drawn.stem == "loops" { (energies::table_of(summary)) }
            }))
        }
        (section("nodes", last[0].1, &nodes(summary)))
        (section("files", last[1].1, &html! { (files()) p { "Made with " (header.made_with) "." } }))
    };
    html::page(&header.title, None, &body)
}

fn head(inspection: &Inspection, summary: &Summary, header: &PageHeader) -> Markup {
    let record = &summary.record;
    // As on the page of a report: numbers end at the digit in which the larger error begins.
    let error =
        record.mu_star_se.abs().max(header.mu_star_relative_error.unwrap_or(0.0) * record.mu_star.abs());
    let finest = if header.mu_star_relative_error.is_some() { -4 } else { -3 };
    let place = last_place(error).unwrap_or(finest).clamp(finest, -1);
    let frequency = record.frequency_hz.map_or_else(|| "none".to_owned(), |f| format!("{f:.0} Hz"));
    let numbers = [
        (
            "μ*",
            at_place(record.mu_star, place),
            format!(
                "at μ = {}; standard error {}",
                number(summary.job.scene.contact.mu),
                significant(record.mu_star_se, 2)
            ),
        ),
        ("frequency", frequency, "of the total normal force".to_owned()),
        ("regime", record.regime.name().replace('_', "–"), record.outcome.name().replace('_', " ")),
        (
            "stick / slip / separated",
            [record.stick_share, record.slip_share, record.separated_share]
                .map(|share| format!("{share:.2}"))
                .join(" / "),
            "shares of the node-time".to_owned(),
        ),
        (
            "loops",
            format!("{} of {}", summary.face.counter_clockwise, summary.face.separating),
            "of the nodes that separate go counter-clockwise (y to the right, z upwards)".to_owned(),
        ),
    ];
    html! {
        @if !summary.cycles {
            (warning(&html! { "This job has no limit cycle. The end of its run is shown instead, in periods of 4h/c_s: those "
                "of the pin as a quarter-wave resonator in shear." }))
        }
        p { (numerics(inspection)) }
        (tiles(&numbers))
    }
}

/// Mesh, step and disk in a line.
fn numerics(inspection: &Inspection) -> String {
    let elements = inspection.mesh().element_count();
    let elements = match inspection.mesh().block() {
        Some(block) => block.elements().map(|n| n.to_string()).join(" × "),
        None => elements.to_string(),
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
fn waves(summary: &Summary) -> Markup {
    let header = ["change", "y from … to [mm]", "begins [µs]", "takes [µs]", "speed [m/s], towards"]
        .map(str::to_owned);
    let lines: Vec<Vec<Markup>> = summary
        .waves
        .iter()
        .map(|wave| {
            let [from, to] = wave.from_to_m.map(|y| y * 1e3);
            let speed = wave.speed_m_s().map_or_else(
                || MISSING.to_owned(),
                |speed| format!("{:.0}, {}", speed.abs(), if speed > 0.0 { "rear" } else { "front" }),
            );
            vec![
                html! { (wave.change.name()) },
                html! { (fixed(from, 2)) " … " (fixed(to, 2)) },
                html! { (fixed(wave.start_s * 1e6, 1)) },
                html! { (fixed(wave.delay_s.abs() * 1e6, 1)) },
                html! { (speed) },
            ]
        })
        .collect();
    html! {
        @if lines.is_empty() { p { "No change of state travels over neighbouring nodes of this line." } }
        @else {
            (table(&header, &lines))
            p { "A wave is a run of neighbouring nodes that all have the change; \"begins\" is the time at its foremost "
                "node since the start of the cycle." }
        }
    }
}

/// A table to download, or the name of its file.
fn data(name: &str, tables: &BTreeMap<String, String>) -> Markup {
    if let Some(text) = tables.get(name) {
        download(name, text)
    } else {
        html! { code { (name) } " (in the folder of this page)" }
    }
}

/// A line of the table of nodes: its heading, and the value of a node.
type NodeLine = (&'static str, fn(&NodeSummary) -> String);

fn nodes(summary: &Summary) -> Markup {
    let header: Vec<String> = std::iter::once(String::new())
        .chain(summary.nodes.iter().map(|node| node.name.replace('_', " ")))
        .collect();
    let figures: [NodeLine; 8] = [
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
    let line = |(name, figure): &NodeLine| -> Vec<Markup> {
        std::iter::once(html! { span.words { (name) } })
            .chain(summary.nodes.iter().map(|node| html! { (figure(node)) }))
            .collect()
    };
    let lines: Vec<Vec<Markup>> = figures.iter().map(line).collect();
    let columns = ["", "time [µs]", "state", "σ_n [MPa]", "v_y − disk [mm/s]"].map(str::to_owned);
    html! {
        (table(&header, &lines))
        @for node in &summary.nodes {
            h3 { (node.title) }
            (table(&columns, &instants(node, summary.shown_s[0])))
        }
    }
}

/// The lines of the table of instants.
fn instants(node: &NodeSummary, from_s: f64) -> Vec<Vec<Markup>> {
    let at = node.instants.iter().flat_map(|instants| &instants.at);
    at.map(|(name, time_s, stress_pa, velocity_m_s, state)| {
        vec![
            html! { (name) },
            html! { (fixed((time_s - from_s) * 1e6, 2)) },
            html! { (state) },
            html! { (fixed(stress_pa * 1e-6, 3)) },
            html! { (fixed(velocity_m_s * 1e3, 1)) },
        ]
    })
    .collect()
}

fn files() -> Markup {
    html! {
        ul {
            li { code { "inspection.json" } " – all numbers of this page, with the job's specification and record" }
            li { code { "node_*.csv" } " – histories of the observed nodes; " code { "phases.csv" } ", " code { "instants.csv" } }
            li { code { "face.csv" } " – every contact node at every step of a cycle; " code { "wave.csv" } }
            li { code { "loops.csv" } " – friction over slip and displacement, of the observed nodes and of the whole face" }
            li { code { "totals.csv" } ", " code { "run.csv" } ", " code { "cycles.csv" } ", " code { "spectrum.csv" } }
            li { code { "fields.pvd" } " – the pin over a cycle, for ParaView, with these fields at the nodes:" }
        }
        (fields())
    }
}

/// The fields of the files for ParaView, with the colours of the contact states.
fn fields() -> Markup {
    let header = ["field", "meaning"].map(str::to_owned);
    let lines: Vec<Vec<Markup>> = FIELDS
        .iter()
        .map(|(name, meaning)| vec![html! { (name) }, html! { span.words { (meaning) } }])
        .collect();
    table(&header, &lines)
}
