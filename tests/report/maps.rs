//! Maps: every job is in them with its values.

use crate::svg::{self, Element};
use crate::synthetic::{done, failed, partial_study, periodic, row, with};
use tribosweep::analysis::{Outcome, Regime};
use tribosweep::report::figure::{Plot, figures};
use tribosweep::report::{JobRow, RowState, View};

fn only(rows: &[JobRow], plot: Plot) -> Vec<Element> {
    let mut all = figures(rows, &View::default(), plot).expect("a string takes everything");
    assert_eq!(all.len(), 1);
    svg::parse(&all.remove(0).svg)
}

fn number(element: &Element, name: &str) -> f64 {
    element.attribute(name).expect(name).parse().expect("a number")
}

/// The shapes that have tooltips of jobs.
fn targets(elements: &[Element]) -> Vec<&Element> {
    elements.iter().filter(|element| element.attribute("data-job").is_some()).collect()
}

fn target<'a>(elements: &'a [Element], job: &str) -> &'a Element {
    targets(elements)
        .into_iter()
        .find(|target| target.is("data-job", job))
        .unwrap_or_else(|| panic!("no {job}"))
}

/// The text in the middle of a shape.
fn text_in<'a>(elements: &'a [Element], target: &Element) -> &'a str {
    let inside = |text: &&Element| {
        let (x, y) = (number(text, "x") - number(target, "x"), number(text, "y") - number(target, "y"));
        x > 0.0 && x < number(target, "width") && y > 0.0 && y < number(target, "height")
    };
    elements.iter().filter(|element| element.name == "text").find(inside).map_or("", |text| &text.text)
}

/// Protects: the regime map has a cell for every job, done or not, at the right position and with the letter of `status`.
/// The letters that occur are explained. Speed increases to the right, and friction upwards.
#[test]
fn every_job_has_its_cell() {
    let rows = partial_study();
    let elements = only(&rows, Plot::RegimeMap);
    assert_eq!(targets(&elements).len(), rows.len());
    for (job, letter) in [
        ("job-1-0.2", "S"),
        ("job-1-0.3", "K"),
        ("job-10-0.3", "X"),
        ("job-10-0.4", "x"),
        ("job-100-0.3", "P"),
        ("job-50-0.3", "!"),
        ("job-1-0.4", ">"),
        ("job-50-0.4", "."),
    ] {
        let cell = target(&elements, job);
        assert_eq!((text_in(&elements, cell), cell.attribute("data-value")), (letter, Some(letter)), "{job}");
    }
    let place = |job| (number(target(&elements, job), "x"), number(target(&elements, job), "y"));
    let (slow, fast, rough) = (place("job-2-0.2"), place("job-50-0.2"), place("job-2-0.4"));
    assert!(slow.0 < fast.0 && slow.1 == fast.1 && rough.0 == slow.0 && rough.1 < slow.1);
    let texts: Vec<&str> =
        elements.iter().filter(|e| e.name == "text").map(|element| element.text.as_str()).collect();
    for label in
        ["stable", "stick–slip–separation, not periodic", "failed", "0.3", "50", "disk speed ω [rpm]"]
    {
        assert!(texts.contains(&label), "{label} in {texts:?}");
    }
}

/// Protects: several jobs at one point share a cell, and none hides another one.
#[test]
fn several_jobs_share_a_cell() {
    let mut rows =
        vec![row(7.0, 0.4, periodic(0.3)), row(7.0, 0.4, failed("no")), row(9.0, 0.4, periodic(0.3))];
    rows[1].job = "other".to_owned();
    let elements = only(&rows, Plot::RegimeMap);
    let (first, other, alone) =
        (target(&elements, "job-7-0.4"), target(&elements, "other"), target(&elements, "job-9-0.4"));
    assert!(number(first, "x") + number(first, "width") <= number(other, "x"));
    assert!(number(other, "x") + number(other, "width") <= number(alone, "x"));
    assert_eq!((text_in(&elements, first), text_in(&elements, other)), ("K", "!"));
}

/// Protects: the map of frequencies has rounded numbers in the cells and exact ones in the attributes, and a letter for a
/// job without a frequency. The colours follow the numbers.
#[test]
fn frequencies_are_numbers_and_colours() {
    let at = |omega: f64, frequency| {
        let mut row = row(omega, 0.4, periodic(0.3));
        if let RowState::Done(record) = &mut row.state {
            record.frequency_hz = Some(frequency);
        }
        row
    };
    let rows = [
        at(1.0, 9_876.5),
        at(2.0, 15_432.1),
        at(5.0, 9_876.5),
        row(7.0, 0.4, done(Outcome::Decayed, Regime::Stable, 0.4)),
        row(9.0, 0.4, done(Outcome::NotPeriodic, Regime::StickSlip, 0.4)),
    ];
    let elements = only(&rows, Plot::FrequencyMap);
    let shown = |job: &str| {
        (text_in(&elements, target(&elements, job)), target(&elements, job).attribute("data-value"))
    };
    assert_eq!(shown("job-1-0.4"), ("9.9", Some("9876.5")));
    assert_eq!(shown("job-2-0.4"), ("15.4", Some("15432.1")));
    assert_eq!(shown("job-7-0.4"), ("S", Some("")));
    assert_eq!(shown("job-9-0.4"), ("14.5~", Some("14512.4")));
    let fill = |job: &str| {
        let target = target(&elements, job);
        let same = |e: &&Element| {
            e.name == "rect" && e.is("x", target.attribute("x").unwrap()) && e.attribute("fill").is_some()
        };
        elements.iter().find(same).and_then(|cell| cell.attribute("fill")).unwrap()
    };
    assert_eq!(fill("job-1-0.4"), fill("job-5-0.4"));
    assert_eq!((fill("job-1-0.4"), fill("job-2-0.4")), ("#440154", "#B5DE2B"), "the ends of the scale");
}

/// Protects: the maps of a study without speeds have the names of its parameter, and a study without results or jobs is
/// no error.
#[test]
fn odd_studies_have_maps() {
    let rows =
        ["whole_top", "inner_side"].map(|side| with(row(7.0, 0.4, periodic(0.35)), "clamp_side", side));
    for plot in [Plot::RegimeMap, Plot::FrequencyMap] {
        let elements = only(&rows, plot);
        assert!(elements.iter().any(|e| e.text == "inner_side"), "{plot:?}");
        assert_eq!(targets(&elements).len(), 2, "{plot:?}");
        only(&[], plot);
        only(&[row(7.0, 0.4, RowState::Pending)], plot);
    }
}

/// Protects: every shape has a title, and text that looks like markup is text.
#[test]
fn titles_are_text() {
    let rows = [with(row(7.0, 0.4, failed("<script>alert(1)</script> & more")), "note", "<b>\"")];
    let elements = only(&rows, Plot::RegimeMap);
    let titles: Vec<&str> = elements.iter().filter(|e| e.name == "title").map(|e| e.text.as_str()).collect();
    assert_eq!(titles.len(), 1);
    assert!(
        titles[0].contains("failed: <script>alert(1)</script> & more") && titles[0].contains("note = <b>\""),
        "{titles:?}"
    );
}
