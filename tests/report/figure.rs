//! The figures: every result has a marker, and every μ has a curve and an entry in the legend.

use crate::svg::{self, Element};
use crate::synthetic::{done, partial_study, periodic, record, row, with};
use std::collections::HashSet;
use std::sync::Arc;
use tribosweep::analysis::{Outcome, Regime};
use tribosweep::report::figure::{Plot, figures};
use tribosweep::report::{Discretisation, JobRow, MeshError, RowState, View};

/// The first colours of the palette, in the order of ascending μ.
const COLOURS: [&str; 3] = ["#0072B2", "#D55E00", "#009E73"];
const CURVE_WIDTH: &str = "4";

fn only(rows: &[JobRow], plot: Plot) -> Vec<Element> {
    let mut all = figures(rows, &View::default(), plot).expect("a string takes everything");
    assert_eq!(all.len(), 1);
    svg::parse(&all.remove(0).svg)
}

fn texts(elements: &[Element]) -> Vec<&str> {
    elements.iter().filter(|element| element.name == "text").map(|element| element.text.as_str()).collect()
}

/// Points of every line of a curve's width in this colour: the curve's stretches and its legend entry.
fn lines(elements: &[Element], colour: &str) -> Vec<Vec<(i32, i32)>> {
    elements
        .iter()
        .filter(|e| e.name == "polyline" && e.is("stroke", colour) && e.is("stroke-width", CURVE_WIDTH))
        .map(|e| {
            let point = |pair: &str| {
                let (x, y) = pair.split_once(',').expect("a pair");
                (x.parse().expect("a pixel"), y.parse().expect("a pixel"))
            };
            e.attribute("points").expect("points").split_whitespace().map(point).collect()
        })
        .collect()
}

/// Number of markers (polygons, circles) in this colour.
fn markers(elements: &[Element], shape: &str, colour: &str) -> usize {
    elements.iter().filter(|element| element.name == shape && element.is("fill", colour)).count()
}

fn all_markers(elements: &[Element], colour: &str) -> usize {
    markers(elements, "circle", colour) + markers(elements, "polygon", colour)
}

/// Protects the figure's completeness: one curve, one legend entry and one guide per μ, one marker per
/// result.
#[test]
fn each_mu_has_a_curve_and_each_result_a_marker() {
    let elements = only(&partial_study(), Plot::MuStar);
    for (colour, results) in COLOURS.into_iter().zip([6, 5, 3]) {
        let lines = lines(&elements, colour);
        let lengths: Vec<usize> = lines.iter().map(Vec::len).collect();
        assert_eq!(lengths, [results, 2], "curve and legend entry of {colour}");
        assert!(lines[1].iter().all(|entry| lines[0].iter().all(|point| point.0 < entry.0)), "legend apart");
        assert_eq!(all_markers(&elements, colour), results, "markers of {colour}");
        let dashes =
            |e: &&Element| e.name == "polyline" && e.is("stroke", colour) && e.is("stroke-width", "3");
        assert!(elements.iter().filter(dashes).count() > 10, "a dashed guide in {colour}");
    }
    let texts = texts(&elements);
    for label in ["0.2", "0.3", "0.4", "μ* = μ", "stable", "stick–slip", "stick–slip–separation"] {
        assert!(texts.contains(&label), "{label} in {texts:?}");
    }
    assert!(!texts.contains(&"undecided"), "a regime that does not occur is not in the legend");
}

/// Protects: both axes of both figures have quantity, symbol and unit.
#[test]
fn axes_carry_quantity_and_unit() {
    let mu_star = only(&partial_study(), Plot::MuStar);
    assert!(texts(&mu_star).contains(&"disk speed ω [rpm]"));
    assert!(texts(&mu_star).contains(&"macroscopic friction coefficient μ*"));
    let frequency = only(&partial_study(), Plot::Frequency);
    assert!(texts(&frequency).contains(&"disk speed ω [rpm]"));
    assert!(texts(&frequency).contains(&"frequency [Hz]"));
}

/// Ticks of the abscissa with their pixel, from left to right.
fn x_ticks(elements: &[Element]) -> Vec<(String, i32)> {
    let texts: Vec<&Element> = elements.iter().filter(|element| element.name == "text").collect();
    let height =
        |element: &Element| element.attribute("y").and_then(|y| y.parse::<i32>().ok()).expect("a pixel");
    // The lowest line of text is the axis label; the ticks are the line above it.
    let label = texts.iter().map(|text| height(text)).max().expect("a label");
    let line = texts.iter().map(|text| height(text)).filter(|y| *y < label).max().expect("ticks");
    let place =
        |text: &&Element| (text.text.clone(), text.attribute("x").and_then(|x| x.parse().ok()).expect("x"));
    let mut ticks: Vec<(String, i32)> = texts.iter().filter(|text| height(text) == line).map(place).collect();
    ticks.sort_by_key(|tick| tick.1);
    ticks
}

/// Protects: the ticks of the logarithmic axis are 0.5 1 2 5 … 100, and every doubling has the same length.
#[test]
fn speed_is_on_a_logarithmic_axis() {
    let rows = [0.5, 6.0, 35.0, 100.0].map(|omega| row(omega, 0.4, periodic(0.3)));
    let ticks = x_ticks(&only(&rows, Plot::MuStar));
    let labels: Vec<&str> = ticks.iter().map(|tick| tick.0.as_str()).collect();
    assert_eq!(labels, ["0.5", "1", "2", "5", "10", "20", "50", "100"]);
    let doubling = ticks[1].1 - ticks[0].1;
    assert!(doubling > 50);
    assert!((ticks[2].1 - ticks[1].1 - doubling).abs() <= 1, "{ticks:?}");
    assert!((ticks[7].1 - ticks[6].1 - doubling).abs() <= 1, "{ticks:?}");
}

/// Protects: a disk at rest is drawn too, because the axis is linear if there is ω = 0.
#[test]
fn zero_speed_makes_the_axis_linear() {
    let rows = [0.0, 5.0, 10.0, 20.0].map(|omega| row(omega, 0.4, periodic(0.3)));
    let elements = only(&rows, Plot::MuStar);
    assert_eq!(all_markers(&elements, COLOURS[0]), 4);
    let ticks = x_ticks(&elements);
    assert_eq!(ticks[0].0, "0");
    let steps: Vec<i32> = ticks.windows(2).map(|pair| pair[1].1 - pair[0].1).collect();
    assert!(steps.iter().all(|step| (step - steps[0]).abs() <= 1), "{ticks:?}");
}

/// Protects: the shape of a marker is the regime, and a hollow marker means that the state is not periodic.
#[test]
fn shape_is_the_regime_and_hollow_is_not_periodic() {
    let shape = |outcome, regime| {
        let elements = only(&[row(7.0, 0.4, done(outcome, regime, 0.3))], Plot::MuStar);
        let own: Vec<&Element> = elements
            .iter()
            .filter(|e| matches!(e.name.as_str(), "circle" | "polygon") && e.is("fill", COLOURS[0]))
            .collect();
        assert_eq!(own.len(), 1);
        let corners: Vec<&str> = own[0].attribute("points").unwrap_or_default().split_whitespace().collect();
        let heights: HashSet<&str> =
            corners.iter().filter_map(|corner| Some(corner.split_once(',')?.1)).collect();
        let name = match (corners.len(), heights.len()) {
            (0, 0) => own[0].name.as_str(),
            (3, 2) => "triangle",
            (4, 2) => "square",
            (4, 3) => "diamond",
            other => panic!("{other:?} corners and heights"),
        };
        // White circles and polygons are holes, in the plot and in the legend. The background is a rectangle.
        (name.to_owned(), all_markers(&elements, "#FFFFFF"))
    };
    let expected = [
        (Outcome::Decayed, Regime::Stable, "circle", 0),
        (Outcome::Periodic, Regime::StickSlip, "triangle", 0),
        (Outcome::Periodic, Regime::StickSlipSeparation, "square", 0),
        (Outcome::Periodic, Regime::SlipSeparation, "diamond", 0),
        (Outcome::NotPeriodic, Regime::StickSlip, "triangle", 2),
        (Outcome::NotPeriodic, Regime::Undecided, "circle", 2),
    ];
    for (outcome, regime, name, holes) in expected {
        assert_eq!(shape(outcome, regime), (name.to_owned(), holes), "{outcome:?} {regime:?}");
    }
}

/// Protects: a curve goes from left to right in any order of the jobs.
#[test]
fn a_curve_runs_from_left_to_right() {
    let rows = [50.0, 1.0, 20.0, 5.0].map(|omega| row(omega, 0.4, periodic(0.3)));
    let curve = &lines(&only(&rows, Plot::MuStar), COLOURS[0])[0];
    assert_eq!(curve.len(), 4);
    assert!(curve.windows(2).all(|pair| pair[0].0 < pair[1].0), "{curve:?}");
}

/// Protects: of two jobs at one point both are drawn, and the curve goes through their mean.
#[test]
fn duplicates_are_both_drawn() {
    let rows = [
        row(5.0, 0.4, periodic(0.30)),
        row(7.0, 0.4, periodic(0.32)),
        row(7.0, 0.4, periodic(0.36)),
        row(9.0, 0.4, periodic(0.34)),
    ];
    let elements = only(&rows, Plot::MuStar);
    assert_eq!(all_markers(&elements, COLOURS[0]), 4);
    let curve = &lines(&elements, COLOURS[0])[0];
    assert_eq!(curve.len(), 3);
    assert!((curve[1].1 - curve[2].1).abs() <= 1, "the mean of 0.32 and 0.36 is as high as 0.34: {curve:?}");
}

/// Protects: the frequency curve is interrupted at a speed at which nothing oscillates.
#[test]
fn a_stable_job_interrupts_the_frequency_curve() {
    let state = |omega: f64| {
        if omega == 5.0 { done(Outcome::Decayed, Regime::Stable, 0.4) } else { periodic(0.3) }
    };
    let rows = [1.0, 2.0, 5.0, 10.0, 20.0].map(|omega| row(omega, 0.4, state(omega)));
    let elements = only(&rows, Plot::Frequency);
    let lengths: Vec<usize> = lines(&elements, COLOURS[0]).iter().map(Vec::len).collect();
    assert_eq!(lengths, [2, 2, 2], "two stretches and the legend entry");
    assert_eq!(all_markers(&elements, COLOURS[0]), 4);
}

/// Protects: error bars are drawn if they are longer than the marker, and only then.
#[test]
fn error_bars_show_where_they_are_visible() {
    let bars = |error: f64| {
        let mut own = record(Outcome::Periodic, Regime::StickSlip, 0.35);
        own.mu_star_se = error;
        let rows = [row(5.0, 0.4, periodic(0.3)), row(7.0, 0.4, RowState::Done(Box::new(own)))];
        let elements = only(&rows, Plot::MuStar);
        let bar =
            |e: &&Element| e.name == "polyline" && e.is("stroke", COLOURS[0]) && e.is("stroke-width", "2");
        elements.iter().filter(bar).count()
    };
    assert_eq!(bars(0.02), 3, "a bar with two caps");
    assert_eq!(bars(1e-5), 0);
    assert_eq!(bars(f64::NAN), 0);
}

/// Protects: a result that is NaN has no marker, and the drawing has no NaN.
#[test]
fn a_result_that_is_not_finite_is_not_drawn() {
    let mut rows = partial_study();
    let before = all_markers(&only(&rows, Plot::MuStar), COLOURS[1]);
    rows[6].state = done(Outcome::NotPeriodic, Regime::Undecided, f64::NAN);
    let all = figures(&rows, &View::default(), Plot::MuStar).expect("a string takes everything");
    assert!(!all[0].svg.contains("NaN") && !all[0].svg.contains("inf"));
    assert_eq!(all_markers(&svg::parse(&all[0].svg), COLOURS[1]), before - 1);
}

/// Protects: every combination has its panel with its own caption in one figure, and all panels have the same axes. With
/// more than twelve combinations there are more figures, each with a name of its own.
#[test]
fn each_combination_has_its_panel() {
    let named = |names: &[String]| -> Vec<JobRow> {
        let rows = names
            .iter()
            .map(|name| partial_study().into_iter().map(move |row| with(row, "note", name.as_str())));
        rows.flatten().collect()
    };
    let names = ["a/b", "a b", "<&\u{1}\">"].map(str::to_owned);
    let elements = only(&named(&names), Plot::MuStar);
    let texts = texts(&elements);
    for caption in ["note = a/b", "note = a b", "note = <& \">"] {
        assert!(texts.contains(&caption), "{caption} in {texts:?}");
    }
    assert_eq!(all_markers(&elements, COLOURS[1]), 3 * 5, "the results of every panel");
    assert_eq!(texts.iter().filter(|text| **text == "100").count(), 3, "the same ticks in every panel");
    assert_eq!(texts.iter().filter(|text| **text == "disk speed ω [rpm]").count(), 1);

    let many: Vec<String> = (0..25).map(|number| format!("n{number}")).collect();
    let all = figures(&named(&many), &View::default(), Plot::MuStar).expect("a string takes everything");
    let parts: Vec<(&str, &str)> =
        all.iter().map(|figure| (figure.suffix.as_str(), figure.caption.as_str())).collect();
    let expected = [
        ("", "combinations 1 to 12 of 25"),
        ("-2", "combinations 13 to 24 of 25"),
        ("-3", "combinations 25 to 25 of 25"),
    ];
    assert_eq!(parts, expected);
}

/// Protects: a study without speeds has the names of another parameter on the axis, in the order of the study.
#[test]
fn a_named_parameter_makes_a_named_axis() {
    let rows = ["whole_top", "inner_side", "both_ends"]
        .map(|side| with(row(7.0, 0.4, periodic(0.35)), "clamp_side", side));
    let elements = only(&rows, Plot::MuStar);
    let labels: Vec<String> = x_ticks(&elements).into_iter().map(|tick| tick.0).collect();
    assert_eq!(labels, ["whole_top", "inner_side", "both_ends"]);
    assert!(texts(&elements).contains(&"clamp_side"));
}

/// Protects: all curves have different colours, even if there are more of them than the palette has.
#[test]
fn many_coefficients_have_many_colours() {
    let rows: Vec<JobRow> = (1..=20)
        .flat_map(|k| [5.0, 7.0].map(|omega| row(omega, f64::from(k) * 0.05, periodic(f64::from(k) * 0.04))))
        .collect();
    let elements = only(&rows, Plot::MuStar);
    let curves: HashSet<&str> = elements
        .iter()
        .filter(|e| e.name == "polyline" && e.is("stroke-width", CURVE_WIDTH))
        .filter_map(|e| e.attribute("stroke"))
        .collect();
    assert_eq!(curves.len(), 20);
    let lowest = elements.iter().filter_map(|e| e.attribute("y")?.parse::<i32>().ok()).max();
    assert!(lowest.is_some_and(|y| y <= 1120), "the legend stays on the page");
}

/// Protects: a figure without results says that there are none.
#[test]
fn a_study_without_results_says_so() {
    for plot in [Plot::MuStar, Plot::Frequency] {
        for rows in [vec![], vec![row(7.0, 0.4, RowState::Pending)]] {
            let elements = only(&rows, plot);
            assert!(texts(&elements).iter().any(|text| text.contains("no results yet")));
        }
    }
}

/// Protects: a curve has a band as wide as the error of mesh and step, a single point has one too, and there is none where
/// the error is not measured.
#[test]
fn the_error_of_the_mesh_is_a_band() {
    let error = MeshError { mu_star_relative: 0.1, ..MeshError::default() };
    let job = |omega, mu, discretisation: &Discretisation| {
        let mut row = row(omega, mu, periodic(0.8 * mu));
        row.discretisation = discretisation.clone();
        row
    };
    let opacity = |element: &Element| element.attribute("opacity").and_then(|text| text.parse::<f64>().ok());
    let bands = |discretisation: Discretisation| {
        let rows = [(2.0, 0.2), (7.0, 0.2), (7.0, 0.4)].map(|(omega, mu)| job(omega, mu, &discretisation));
        let elements = only(&rows, Plot::MuStar);
        let of_curve = |name: &str, colour: &str| -> Vec<Element> {
            let is_band =
                |e: &&Element| e.name == name && e.is("fill", colour) && opacity(e).is_some_and(|o| o < 0.5);
            elements.iter().filter(is_band).cloned().collect()
        };
        let legend = texts(&elements).contains(&"error of mesh and step");
        (of_curve("polygon", COLOURS[0]), of_curve("rect", COLOURS[1]), legend)
    };
    let (curve, point, legend) = bands(Discretisation::Measured(Arc::new(error.clone())));
    assert_eq!((curve.len(), point.len(), legend), (1, 1, true));
    let (pale, _, _) = bands(Discretisation::Indicative(Arc::new(error)));
    assert!(opacity(&pale[0]) < opacity(&curve[0]));
    let (curve, point, legend) = bands(Discretisation::NotMeasured);
    assert_eq!((curve.len(), point.len(), legend), (0, 0, false));
}
