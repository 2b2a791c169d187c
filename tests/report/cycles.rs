//! The bifurcation diagram and the waterfall of spectra.

use crate::charts::{only, point, points, texts};
use crate::svg::{self, Element};
use crate::synthetic::{periodic, record, report, row, with};
use std::fs;
use std::path::Path;
use tribosweep_mechanics::analysis::{JobRecord, Outcome, Regime};
use tribosweep_output::publish::chart::Axis;
use tribosweep_output::report::figure::Plot;
use tribosweep_output::report::{JobRow, RowState, inspections, write};

/// A job whose N/F is within `range`, with an observed node that moves by `reach_m`.
fn oscillating(omega_rpm: f64, outcome: Outcome, range: [f64; 2], reach_m: f64) -> JobRow {
    let mut own = record(outcome, Regime::StickSlip, 0.3);
    [own.n_over_f_min, own.n_over_f_max] = range;
    own.nodes = JobRecord::example().nodes;
    own.nodes.truncate(1);
    own.nodes[0].y_peak_to_peak_m = reach_m;
    row(omega_rpm, 0.4, RowState::Done(Box::new(own)))
}

/// Protects: the diagram has both ends of N/F and the amplitudes of every job with a result, at their values. Steady sliding
/// is a single point on the level of 1, and a job without a result is not drawn.
#[test]
fn a_limit_cycle_has_two_ends_and_steady_sliding_has_one() {
    let rows = [
        oscillating(1.0, Outcome::Decayed, [1.0, 1.0], 0.0),
        oscillating(5.0, Outcome::Periodic, [0.5, 1.5], 2f64.powi(-18)),
        oscillating(25.0, Outcome::NotPeriodic, [0.0, 2.0], 2f64.powi(-17)),
        row(50.0, 0.4, RowState::Pending),
    ];
    let chart = only(&rows, Plot::Bifurcation);
    let labels: Vec<&str> = chart.panels.iter().map(|panel| panel.y.label.as_str()).collect();
    assert_eq!((labels.as_slice(), chart.columns), (["N/F", "range of y [µm]", "lift [µm]"].as_slice(), 1));
    let expected = [
        (0, "n_over_f_max", [1.0, 1.5, 2.0]),
        (0, "n_over_f_min", [1.0, 0.5, 0.0]),
        (1, "front_centre_y_peak_to_peak_m", [0.0, 1e6 / 262_144.0, 1e6 / 131_072.0]),
        (2, "lift_max_m", [3.0e-7 * 1e6; 3]),
    ];
    for (number, kind, values) in expected {
        let panel = &chart.panels[number];
        assert_eq!(panel.x, chart.panels[0].x, "a common abscissa");
        for ((omega, y), is_hollow) in [1.0, 5.0, 25.0].into_iter().zip(values).zip([false, false, true]) {
            let own = point(panel, &format!("job-{omega}-0.4"), kind).expect("a marker");
            assert_eq!((own.at, own.marker.is_hollow), ((omega, y), is_hollow), "{kind}");
        }
        assert_eq!(point(panel, "job-50-0.4", kind), None);
        assert!(panel.y.axis.place(values[2]) < 1.0 && panel.y.axis.place(values[2]) > 0.0);
    }
    assert!(point(&chart.panels[1], "job-5-0.4", "rear_centre_y_peak_to_peak_m").is_none(), "not observed");
    let legend = texts(&chart.legend);
    for label in ["μ = 0.4", "largest N/F", "front centre", "hollow: not periodic"] {
        assert!(legend.contains(&label), "{label} in {legend:?}");
    }
}

/// Protects: the diagram of a study without speeds is over the names of its parameter.
#[test]
fn the_diagram_of_names_is_over_names() {
    let names = ["whole_top", "inner_side"];
    let rows = names.map(|side| with(row(7.0, 0.4, periodic(0.35)), "clamp_side", side));
    let chart = only(&rows, Plot::Bifurcation);
    assert_eq!(chart.panels[0].x.axis, Axis::Names(names.map(str::to_owned).into()));
    assert_eq!(points(&chart.panels[0]).len(), 4);
}

fn number(element: &Element, name: &str) -> f64 {
    element.attribute(name).expect(name).parse().expect("a number")
}

/// An inspection of a job with a spectrum of two lines at 10 and 20 kHz, on a floor of a thousandth of the first one.
fn store_spectrum(report: &Path, folder: &str, job: &str, second_n: f64) {
    let folder = report.join("inspect").join(folder);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("inspection.json"), format!("{{\"key\": \"{job}\"}}")).expect("a file");
    let line = |k: i32| {
        let amplitude_n = [(10, 20.0), (20, second_n)].into_iter().find(|(at, _)| *at == k);
        format!("{},{}\n", 1000 * k, amplitude_n.map_or(0.02, |(_, n)| n))
    };
    let lines: String = (0..=100).map(line).collect();
    fs::write(folder.join("spectrum.csv"), format!("frequency_hz,normal_amplitude_n\n{lines}"))
        .expect("a file");
}

/// Protects: the report draws the spectra that inspections of its jobs stored, one strip each at the job's speed, in panels of
/// their μ, and writes their lines. Jobs of other studies and unreadable files are left out. Without spectra there is no
/// figure, and no word about it.
#[test]
fn stored_spectra_make_a_waterfall() {
    let rows: Vec<JobRow> = [0.3, 0.4]
        .into_iter()
        .flat_map(|mu| [2.0, 4.0, 16.0].map(|omega| row(omega, mu, periodic(0.3))))
        .collect();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path();
    let page = || fs::read_to_string(path.join("report.html")).expect("the page is there");
    write(&report(&rows), path).expect("the report is written");
    assert!(!path.join("waterfall.svg").exists() && !page().contains("waterfall"));

    for (name, job) in [("a", "job-2-0.4"), ("b", "job-4-0.4"), ("c", "job-16-0.4"), ("d", "job-2-0.3")] {
        store_spectrum(path, name, job, 2.0);
    }
    store_spectrum(path, "e", "of-another-study", 1.0);
    fs::create_dir(path.join("inspect/broken")).expect("a folder");
    fs::write(path.join("inspect/broken/inspection.json"), "{").expect("a file");
    let found = inspections(path);
    let jobs: Vec<&str> = found.iter().map(|inspection| inspection.job.as_str()).collect();
    assert_eq!(jobs, ["job-2-0.4", "job-4-0.4", "job-16-0.4", "job-2-0.3", "of-another-study"]);
    assert!(found.iter().all(|inspection| inspection.page().is_none()));

    write(&report(&rows), path).expect("the report is written");
    let elements = svg::parse(&fs::read_to_string(path.join("waterfall.svg")).expect("the figure"));
    // The middle and the lower edge of a strip.
    let place = |job: &str| {
        let own: Vec<&Element> = elements.iter().filter(|element| element.is("data-job", job)).collect();
        assert_eq!(own.len(), 1, "{job}");
        assert_eq!(number(own[0], "data-y"), 10_000.0, "the strongest line");
        let (top, height) = (number(own[0], "y"), number(own[0], "height"));
        (top + height / 2.0, top + height)
    };
    // The outer strips are symmetric about their places. The one between begins half-way to the lower one.
    let (slow, fast) = (place("job-2-0.4").0, place("job-16-0.4").0);
    let twice = 2.0 * place("job-4-0.4").1 - slow;
    // 16 is three times as far from 2 as 4 on a logarithmic axis. Halves of pixels are rounded.
    assert!(((slow - fast) / (slow - twice) - 3.0).abs() < 0.1, "{slow} {twice} {fast}");
    assert!(place("job-2-0.3").0 < fast, "the panel of the other μ is above");
    assert!(!elements.iter().any(|element| element.is("data-job", "job-4-0.3")));
    let found: Vec<&str> = elements.iter().map(|element| element.text.as_str()).collect();
    for text in ["μ = 0.3", "μ = 0.4", "frequency [kHz]", "26"] {
        assert!(found.contains(&text), "{text} in {found:?}");
    }
    let lines = fs::read_to_string(path.join("waterfall.csv")).expect("the data");
    assert_eq!(lines.lines().count(), 1 + 4 * 101);
    assert!(lines.contains("job-16-0.4,16,0.4,20000,2\n"), "{lines}");
    let page = page();
    assert!(page.contains("waterfall.csv") && !page.contains("--all --only spectrum"));
}
