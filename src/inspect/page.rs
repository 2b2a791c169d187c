//! The page of a look: all of it in one file, but for the tables that are too large.

use super::figures::LookFigure;
use super::look::Look;
use super::summary::{NodeSummary, Summary};
use super::write::Origin;
use crate::publish::html::{self, download, figure, navigation, section, table, tiles, warning};
use crate::publish::value::{MISSING, fixed, number};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// Larger tables [bytes] are beside the page, not in it.
const LARGEST: usize = 400_000;

/// Titles of the figures, in their order.
const TITLES: [(&str, &str); 9] = [
    ("figure2a", "Displacements and velocity"),
    ("figure2b", "Stick, slip and separation"),
    ("figure3a", "Trajectories"),
    ("figure3b", "Phase planes"),
    ("figure4", "One cycle"),
    ("figure5", "Snapshots"),
    ("wave", "Waves"),
    ("totals", "Total forces"),
    ("spectrum", "Spectrum"),
];

/// The page; `tables` are the CSV files by their names.
pub fn of(
    look: &Look,
    summary: &Summary,
    figures: &[LookFigure],
    tables: &BTreeMap<String, String>,
    origin: &Origin,
) -> String {
    let heading = |stem: &str| TITLES.iter().find(|(name, _)| *name == stem).map_or("", |(_, title)| *title);
    let links = figures.iter().map(|figure| (figure.stem, heading(figure.stem)));
    let last = [("nodes", "Nodes in numbers"), ("files", "Files")];
    let sections: Vec<(&str, &str)> = links.chain(last).collect();
    let body = html! {
        (head(look, summary))
        (navigation(sections))
        @for drawn in figures {
            (section(drawn.stem, heading(drawn.stem), &html! {
                (figure(&drawn.svg, &drawn.caption, None))
                p { "Data: " @for name in &drawn.data { (data(name, tables)) " " } }
            }))
        }
        (section("nodes", last[0].1, &nodes(summary)))
        (section("files", last[1].1, &html! { (files()) p { "Made with " (origin.made_with) "." } }))
    };
    html::page(&origin.title, None, &body)
}

fn head(look: &Look, summary: &Summary) -> Markup {
    let record = &summary.record;
    let frequency = record.frequency_hz.map_or_else(|| "none".to_owned(), |f| format!("{f:.0} Hz"));
    let [_, ly, _] = look.mesh().size_m();
    let numbers = [
        (
            "μ*",
            fixed(record.mu_star, 4),
            format!("± {} at μ = {}", fixed(record.mu_star_se, 4), number(summary.job.scene.contact.mu)),
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
            "separation, front to rear",
            delay(summary.waves.separation_s, ly),
            "later at the rear; negative: it travels from the rear to the front".to_owned(),
        ),
        (
            "loops",
            format!("{} of {}", summary.face.counter_clockwise, summary.face.separating),
            "of the nodes that separate go counter-clockwise (y to the right, z upwards)".to_owned(),
        ),
    ];
    html! {
        @if !summary.cycles {
            (warning(&html! { "This job has no limit cycle: the end of its run is shown, over periods of 4h/c_s, "
                "the pin's as a quarter-wave resonator in shear." }))
        }
        (tiles(&numbers))
    }
}

fn delay(delay_s: Option<f64>, length_m: f64) -> String {
    delay_s.map_or_else(
        || MISSING.to_owned(),
        |delay_s| format!("{:+.1} µs ({:.0} m/s)", delay_s * 1e6, (length_m / delay_s).abs()),
    )
}

/// A table to download, or where it is.
fn data(name: &str, tables: &BTreeMap<String, String>) -> Markup {
    if let Some(text) = tables.get(name).filter(|text| text.len() <= LARGEST) {
        download(name, text)
    } else {
        html! { code { (name) } " (beside this page)" }
    }
}

/// A line of the table of nodes: its name and the value of a node.
type NodeLine = (&'static str, fn(&NodeSummary) -> String);

fn nodes(summary: &Summary) -> Markup {
    let header: Vec<String> =
        std::iter::once(String::new()).chain(summary.nodes.iter().map(|node| node.title.clone())).collect();
    let figures: [NodeLine; 8] = [
        ("velocity of the disk [mm/s]", |node| fixed(node.target_velocity_m_s * 1e3, 1)),
        ("peak-to-peak displacement x, y, z [µm]", |node| {
            node.peak_to_peak_m.map(|range| fixed(range * 1e6, 2)).join(", ")
        }),
        ("largest gap [µm]", |node| fixed(node.lift_max_m * 1e6, 3)),
        ("largest normal stress [MPa]", |node| fixed(node.sigma_n_max_pa * 1e-6, 3)),
        ("largest slip speed [mm/s]", |node| fixed(node.slip_speed_max_m_s * 1e3, 0)),
        ("largest speed relative to the disk [mm/s]", |node| fixed(node.relative_speed_max_m_s * 1e3, 0)),
        ("shares of stick, slip, separation", |node| node.shares.map(|share| fixed(share, 2)).join(", ")),
        ("its own frequency [Hz]", |node| {
            node.frequency_hz.map_or_else(|| MISSING.to_owned(), |f| fixed(f, 0))
        }),
    ];
    let line = |(name, figure): &NodeLine| -> Vec<Markup> {
        std::iter::once(html! { (name) })
            .chain(summary.nodes.iter().map(|node| html! { (figure(node)) }))
            .collect()
    };
    let lines: Vec<Vec<Markup>> = figures.iter().map(line).collect();
    let instants = summary.nodes.iter().flat_map(|node| {
        let at = node.instants.iter().flat_map(|instants| &instants.at);
        at.map(move |(name, time_s, stress_pa, velocity_m_s)| {
            vec![
                html! { (node.title) " " (name) },
                html! { (fixed((time_s - summary.shown_s[0]) * 1e6, 2)) },
                html! { (fixed(stress_pa * 1e-6, 3)) },
                html! { (fixed(velocity_m_s * 1e3, 1)) },
            ]
        })
    });
    let columns =
        ["instant", "time [µs]", "normal stress [MPa]", "velocity in y relative to the disk [mm/s]"]
            .map(str::to_owned);
    html! {
        (table(&header, &lines))
        (table(&columns, &instants.collect::<Vec<_>>()))
    }
}

fn files() -> Markup {
    html! {
        ul {
            li { code { "inspection.json" } " – all numbers of this page, with the job's specification and record" }
            li { code { "node_*.csv" } " – histories of the observed nodes; " code { "phases.csv" } ", " code { "instants.csv" } }
            li { code { "face.csv" } " – every contact node at every step of a cycle; " code { "wave.csv" } }
            li { code { "totals.csv" } ", " code { "run.csv" } ", " code { "cycles.csv" } ", " code { "spectrum.csv" } }
            li { code { "fields.pvd" } " – the pin over a cycle, for ParaView: displacement, velocity, contact force, "
                "normal contact stress, gap, contact state (−1 no contact node, 0 separated, 1 stick, 2 slip) and stress" }
        }
    }
}
