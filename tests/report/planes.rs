//! The maps on true axes: every job is at its values.

use crate::svg::{self, Element};
use crate::synthetic::{done, partial_study, periodic, record, report, row, with};
use std::fs;
use tribosweep::analysis::{Outcome, Regime};
use tribosweep::report::figure::{Plot, figures};
use tribosweep::report::{JobRow, RowState, View, write};

fn only(rows: &[JobRow], plot: Plot) -> Vec<Element> {
    let mut all = figures(rows, &View::default(), plot).expect("a string takes everything");
    assert_eq!(all.len(), 1);
    svg::parse(&all.remove(0).svg)
}

fn number(element: &Element, name: &str) -> f64 {
    element.attribute(name).expect(name).parse().expect("a number")
}

/// The shapes that have tooltips of a job.
fn targets<'a>(elements: &'a [Element], job: &str) -> Vec<&'a Element> {
    elements.iter().filter(|element| element.is("data-job", job)).collect()
}

fn texts(elements: &[Element]) -> Vec<&str> {
    elements.iter().filter(|element| element.name == "text").map(|element| element.text.as_str()).collect()
}

/// Protects: cells of the map of regimes end half-way to their neighbours, on the axis of speeds in the logarithm, so that
/// their sizes are those of the grid and not equal.
#[test]
fn cells_are_on_true_axes() {
    let speeds = [1.0, 10.0, 20.0, 40.0];
    let rows: Vec<JobRow> =
        [0.1, 0.2, 0.6].into_iter().flat_map(|mu| speeds.map(|omega| row(omega, mu, periodic(mu)))).collect();
    let elements = only(&rows, Plot::RegimePlane);
    let cell = |omega: f64, mu: f64| {
        let own = targets(&elements, &format!("job-{omega}-{mu}"))[0];
        assert_eq!(own.attribute("data-value"), Some("K"));
        ["x", "y", "width", "height"].map(|name| number(own, name))
    };
    let decade = cell(1.0, 0.1)[2];
    // From 1 to 10 half a decade on both sides of 1; from there, cells of ln 2 with a half on each side.
    for (omega, decades) in [(10.0, (1.0 + 2f64.log10()) / 2.0), (20.0, 2f64.log10()), (40.0, 2f64.log10())] {
        assert!((cell(omega, 0.1)[2] - decades * decade).abs() <= 1.5, "{omega}");
    }
    let unit = cell(1.0, 0.1)[3] / 0.1;
    for (mu, height) in [(0.2, 0.25), (0.6, 0.4)] {
        assert!((cell(1.0, mu)[3] - height * unit).abs() <= 1.5, "{mu}");
    }
    let (low, high) = (cell(1.0, 0.2), cell(1.0, 0.6));
    assert!(
        (high[1] + high[3] - low[1]).abs() <= 1.0 && high[1] < low[1],
        "they touch, and friction goes up"
    );
    let texts = texts(&elements);
    for label in ["disk speed ω [rpm]", "local friction coefficient μ", "stick–slip", "K"] {
        assert!(texts.contains(&label), "{label} in {texts:?}");
    }
}

/// Protects: the map has every job of an incomplete study, also several at one point, and points that are on no grid have
/// small cells of their own instead of stripes.
#[test]
fn every_job_is_in_the_plane() {
    let mut rows = partial_study();
    rows.push(JobRow { job: "other".to_owned(), ..rows[0].clone() });
    let elements = only(&rows, Plot::RegimePlane);
    for row in &rows {
        assert_eq!(targets(&elements, &row.job).len(), 1, "{}", row.job);
    }
    let (first, other) = (targets(&elements, &rows[0].job)[0], targets(&elements, "other")[0]);
    assert!(number(first, "x") + number(first, "width") <= number(other, "x"), "none hides another one");

    let scattered: Vec<JobRow> =
        (1..=10).map(|k| row(f64::from(k), 0.1 + 0.05 * f64::from(k * 7 % 10), periodic(0.3))).collect();
    let elements = only(&scattered, Plot::RegimePlane);
    let widths: Vec<f64> =
        scattered.iter().map(|row| number(targets(&elements, &row.job)[0], "width")).collect();
    assert!(widths.iter().all(|width| *width == widths[0] && *width < 50.0), "{widths:?}");
}

/// Protects: the colours of growth rates have the sign: decay is blue, growth is red, and a job without a rate is grey with
/// its letter. The number is in the cell, and in full precision in its attribute.
#[test]
fn growth_rates_have_their_sign() {
    let with_rate = |omega: f64, rate: Option<f64>, regime| {
        let mut own = record(Outcome::Decayed, regime, 0.3);
        own.growth_rate_per_s = rate;
        row(omega, 0.4, RowState::Done(Box::new(own)))
    };
    let rows = [
        with_rate(1.0, Some(-233.04), Regime::Stable),
        with_rate(5.0, Some(100.0), Regime::Undecided),
        with_rate(25.0, None, Regime::StickSlip),
    ];
    let elements = only(&rows, Plot::GrowthRate);
    let values: Vec<Option<&str>> =
        rows.iter().map(|row| targets(&elements, &row.job)[0].attribute("data-value")).collect();
    assert_eq!(values, [Some("-233.04"), Some("100"), Some("")]);
    // The cell of a job is drawn as a rectangle of the size of its target.
    let fill = |row: &JobRow| {
        let target = targets(&elements, &row.job)[0];
        let same = |e: &&Element| {
            e.name == "rect"
                && e.attribute("data-job").is_none()
                && ["x", "y"].iter().all(|name| e.attribute(name) == target.attribute(name))
        };
        let colour = elements.iter().rfind(same).expect("a cell").attribute("fill").expect("a colour");
        let channel = |at: usize| u8::from_str_radix(&colour[at..at + 2], 16).expect("a colour");
        [channel(1), channel(3), channel(5)]
    };
    let [decays, grows, neither] = [0, 1, 2].map(|at| fill(&rows[at]));
    assert!(decays[2] > decays[0], "{decays:?}");
    assert!(grows[0] > grows[2], "{grows:?}");
    assert!(neither[0] == neither[1] && neither[1] == neither[2], "{neither:?}");
    let found = texts(&elements);
    for text in ["−233", "100", "K", "growth rate [1/s]", "decays"] {
        assert!(found.contains(&text), "{text} in {found:?}");
    }
    let none = only(&[row(7.0, 0.4, periodic(0.3))], Plot::GrowthRate);
    assert!(texts(&none).contains(&"no growth rates"));
}

/// Protects: without numbers on an axis there is no map on true axes, and the page says so. The other figures exist.
#[test]
fn names_have_no_true_axis() {
    let rows = ["whole_top", "inner_side"].map(|side| {
        with(row(7.0, 0.4, done(Outcome::Periodic, Regime::StickSlip, 0.35)), "clamp_side", side)
    });
    for plot in [Plot::RegimePlane, Plot::GrowthRate] {
        assert_eq!(figures(&rows, &View::default(), plot).expect("no figure").len(), 0);
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&report(&rows), folder.path()).expect("the report is written");
    assert!(!folder.path().join("regime_plane.svg").exists());
    let page = fs::read_to_string(folder.path().join("report.html")).expect("the page is there");
    assert!(page.contains("no map on true axes, because an axis has names"), "the page says why");
}
