//! The maps on true axes: every job is at its values.

use crate::maps;
use crate::synthetic::{done, partial_study, periodic, record, report, row, with};
use std::fs;
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::publish::chart::{Axis, Scale};
use tribosweep_output::report::figure::{Plot, figures};
use tribosweep_output::report::{JobRow, RowState, View, write};

/// Protects: cells of the map of regimes end half-way to their neighbours, on the axis of speeds in the logarithm, so that
/// their sizes are those of the grid and not equal. A dot is at the place of the job, and ticks are at the jobs' values.
#[test]
fn cells_are_on_true_axes() {
    let speeds = [1.0, 10.0, 20.0, 40.0];
    let rows: Vec<JobRow> =
        [0.1, 0.2, 0.6].into_iter().flat_map(|mu| speeds.map(|omega| row(omega, mu, periodic(mu)))).collect();
    let chart = maps::only(&rows, Plot::RegimePlane);
    let across = |at: f64, [low, high]: [f64; 2], expected: [f64; 2]| {
        // A mean of two numbers has two roundings, and one in the logarithm a few more.
        let is_near = |a: f64, b: f64| (a - b).abs() <= 16.0 * f64::EPSILON * b;
        assert!(is_near(low, expected[0]) && is_near(high, expected[1]), "{at}: {low} {high} {expected:?}");
    };
    let half = 10f64.sqrt();
    let [second, third, last] = [200f64.sqrt(), 800f64.sqrt(), 40.0 * 2f64.sqrt()];
    for (omega, x) in
        speeds.into_iter().zip([[1.0 / half, half], [half, second], [second, third], [third, last]])
    {
        for (mu, y) in [(0.1, [0.05, 0.15]), (0.2, [0.15, 0.4]), (0.6, [0.4, 0.8])] {
            let (cell, tip) = maps::cell(&chart, &format!("job-{omega}-{mu}"));
            across(omega, cell.x, x);
            across(mu, cell.y, y);
            assert_eq!(
                (cell.dot, cell.text.as_str(), maps::data(tip, "value")),
                (Some((omega, mu)), "K", "K")
            );
        }
    }
    let panel = &chart.panels[0];
    assert!(matches!(panel.x.axis, Axis::Log(_)) && matches!(panel.y.axis, Axis::Linear(_)));
    let labels = |scale: &Scale| scale.ticks.iter().map(|(_, label)| label.clone()).collect::<Vec<_>>();
    assert_eq!(
        (labels(&panel.x), labels(&panel.y)),
        (
            vec!["1", "10", "20", "40"].into_iter().map(str::to_owned).collect(),
            vec!["0.1".to_owned(), "0.2".to_owned(), "0.6".to_owned()]
        )
    );
    assert_eq!([&panel.x.label, &panel.y.label], ["disk speed ω [rpm]", "local friction coefficient μ"]);
    assert_eq!(maps::legend(&chart), ["stick–slip"]);
}

/// Protects: the map has every job of an incomplete study, also several at one point, and points that are on no grid have
/// small cells of their own instead of stripes.
#[test]
fn every_job_is_in_the_plane() {
    let mut rows = partial_study();
    rows.push(JobRow { job: "other".to_owned(), ..rows[0].clone() });
    let chart = maps::only(&rows, Plot::RegimePlane);
    for row in &rows {
        maps::cell(&chart, &row.job);
    }
    let [first, other] = [rows[0].job.as_str(), "other"].map(|job| maps::cell(&chart, job).0.x);
    assert_eq!(first[1], other[0], "none hides another one");
    // Both parts are equally wide on the logarithmic axis.
    assert!((first[1] / first[0] / (other[1] / other[0]) - 1.0).abs() < 16.0 * f64::EPSILON);

    let scattered: Vec<JobRow> =
        (1..=10).map(|k| row(f64::from(k), 0.1 + 0.05 * f64::from(k * 7 % 10), periodic(0.3))).collect();
    let chart = maps::only(&scattered, Plot::RegimePlane);
    let panel = &chart.panels[0];
    let widths: Vec<[f64; 2]> = scattered
        .iter()
        .map(|row| {
            let cell = maps::cell(&chart, &row.job).0;
            let share = |axis: &Axis, [low, high]: [f64; 2]| axis.place(high) - axis.place(low);
            [share(&panel.x.axis, cell.x), share(&panel.y.axis, cell.y)]
        })
        .collect();
    let is_small =
        |[wide, high]: &[f64; 2]| (wide - widths[0][0]).abs() < 1e-12 && *wide < 0.05 && *high < 0.05;
    assert!(widths.iter().all(is_small), "{widths:?}");
}

/// Protects: the colours of growth rates have the sign: decay is blue, growth is red, and a job without a rate is grey with
/// its letter. The number is in the cell, and in full precision in its attribute.
#[test]
fn growth_rates_have_their_sign() {
    let with_rate = |omega: f64, mu: f64, rate: Option<f64>, regime| {
        let mut own = record(Outcome::Decayed, regime, 0.3);
        own.growth_rate_per_s = rate;
        row(omega, mu, RowState::Done(Box::new(own)))
    };
    let rows = [
        with_rate(1.0, 0.4, Some(-233.04), Regime::Stable),
        with_rate(5.0, 0.4, Some(100.0), Regime::Undecided),
        with_rate(25.0, 0.3, None, Regime::StickSlip),
    ];
    let chart = maps::only(&rows, Plot::GrowthRate);
    let own = rows.each_ref().map(|row| maps::cell(&chart, &row.job));
    assert_eq!(own.map(|(_, tip)| maps::data(tip, "value")), ["-233.04", "100", ""]);
    assert_eq!(own.map(|(cell, _)| cell.text.as_str()), ["−233", "100", "K"]);
    let [decays, grows, neither] = own.map(|(cell, _)| cell.fill.expect("a colour"));
    assert!(decays.2 > decays.0, "{decays:?}");
    assert!(grows.0 > grows.2, "{grows:?}");
    assert!(neither.0 == neither.1 && neither.1 == neither.2, "{neither:?}");
    assert_eq!(chart.colours.as_ref().expect("a scale").title, "growth rate [1/s]");
    assert_eq!(maps::legend(&chart), ["grows", "decays", "stick–slip"]);
    let none = maps::only(&[row(7.0, 0.4, periodic(0.3)), row(8.0, 0.3, periodic(0.3))], Plot::GrowthRate);
    assert!(maps::legend(&none).contains(&"no growth rates") && none.colours.is_none());
}

/// Protects: without numbers on an axis there is no map on true axes. The other figures exist.
#[test]
fn names_have_no_true_axis() {
    let rows = ["whole_top", "inner_side"].map(|side| {
        with(row(7.0, 0.4, done(Outcome::Periodic, Regime::StickSlip, 0.35)), "clamp_side", side)
    });
    for plot in [Plot::RegimePlane, Plot::GrowthRate] {
        assert_eq!(figures(&rows, &View::default(), plot).len(), 0);
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&report(&rows), folder.path()).expect("the report is written");
    assert!(!folder.path().join("regime_plane.svg").exists());
    let page = fs::read_to_string(folder.path().join("report.html")).expect("the page is there");
    assert!(!page.contains("true axes"), "no word about a figure that does not exist");
}
