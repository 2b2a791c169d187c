//! The bifurcation diagram, the maps on true axes and the waterfall: every job is at its values.

use crate::maps;
use crate::svg::{self, Element};
use crate::synthetic::{done, partial_study, periodic, record, report, row, with};
use std::fs;
use std::path::Path;
use tribosweep::analysis::{ObservedNode, Outcome, Regime};
use tribosweep::publish::chart::{Axis, Scale};
use tribosweep::report::figure::{Plot, figures};
use tribosweep::report::{JobRow, RowState, View, inspections, write};

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

/// A job whose N/F is within `range`, with an observed node that moves by `reach_m`.
fn oscillating(omega_rpm: f64, outcome: Outcome, range: [f64; 2], reach_m: f64) -> JobRow {
    let mut own = record(outcome, Regime::StickSlip, 0.3);
    [own.n_over_f_min, own.n_over_f_max] = range;
    own.nodes = vec![ObservedNode {
        name: "front_centre".to_owned(),
        y_peak_to_peak_m: reach_m,
        lift_max_m: 0.0,
        sigma_n_max_pa: 1e6,
        slip_speed_max_m_s: 0.1,
    }];
    row(omega_rpm, 0.4, RowState::Done(Box::new(own)))
}

/// Protects: the diagram has both ends of N/F and the amplitudes of every job with a result, at their values. Steady sliding
/// is a single point on the level of 1, and a job without a result is not drawn.
#[test]
fn a_limit_cycle_has_two_ends_and_steady_sliding_has_one() {
    let rows = [
        oscillating(1.0, Outcome::Decayed, [1.0, 1.0], 0.0),
        oscillating(5.0, Outcome::Periodic, [0.5, 1.5], 3e-6),
        oscillating(25.0, Outcome::NotPeriodic, [0.0, 2.0], 6e-6),
        row(50.0, 0.4, RowState::Pending),
    ];
    let elements = only(&rows, Plot::Bifurcation);
    let at = |job: &str, kind: &str| -> (f64, f64) {
        let all = targets(&elements, job);
        let own = all.iter().find(|target| target.is("data-kind", kind)).expect("a marker");
        (number(own, "cx"), number(own, "cy"))
    };
    let (highest, lowest) = ("n_over_f_max", "n_over_f_min");
    assert_eq!(at("job-1-0.4", highest), at("job-1-0.4", lowest), "one point");
    let level = at("job-1-0.4", highest).1;
    // Equal distances above and below the level, and twice the distance for twice the range, to a pixel.
    for (job, reach) in [("job-5-0.4", 1.0), ("job-25-0.4", 2.0)] {
        let unit = (at("job-5-0.4", lowest).1 - at("job-5-0.4", highest).1) / 2.0;
        assert!((at(job, highest).1 - (level - reach * unit)).abs() <= 2.0, "{job}");
        assert!((at(job, lowest).1 - (level + reach * unit)).abs() <= 2.0, "{job}");
        assert_eq!(at(job, highest).0, at(job, lowest).0, "{job}");
    }
    let reach = |job| at(job, "front_centre_y_peak_to_peak_m").1;
    let (none, one, two) = (reach("job-1-0.4"), reach("job-5-0.4"), reach("job-25-0.4"));
    assert!((none - one - (one - two)).abs() <= 2.0 && one < none, "{none} {one} {two}");
    assert_eq!(at("job-5-0.4", highest).0, at("job-5-0.4", "lift_max_m").0, "a common abscissa");
    assert!(targets(&elements, "job-50-0.4").is_empty());
    let texts = texts(&elements);
    for label in
        ["N/F", "range of y [µm]", "lift [µm]", "disk speed ω [rpm]", "μ = 0.4", "hollow: not periodic"]
    {
        assert!(texts.contains(&label), "{label} in {texts:?}");
    }
}

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

/// Protects: without numbers on an axis there is no map on true axes, and the page says so. The other figures exist.
#[test]
fn names_have_no_true_axis() {
    let rows = ["whole_top", "inner_side"].map(|side| {
        with(row(7.0, 0.4, done(Outcome::Periodic, Regime::StickSlip, 0.35)), "clamp_side", side)
    });
    for plot in [Plot::RegimePlane, Plot::GrowthRate] {
        assert_eq!(figures(&rows, &View::default(), plot).expect("no figure").len(), 0);
    }
    assert!(texts(&only(&rows, Plot::Bifurcation)).contains(&"inner_side"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&report(&rows), folder.path()).expect("the report is written");
    assert!(!folder.path().join("regime_plane.svg").exists());
    let page = fs::read_to_string(folder.path().join("report.html")).expect("the page is there");
    assert!(page.contains("no map on true axes, because an axis has names"), "the page says why");
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
/// figure, and the page says how to get them.
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
    assert!(!path.join("waterfall.svg").exists() && page().contains("--all --only spectrum"));

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
        let own = targets(&elements, job);
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
    assert!(targets(&elements, "job-4-0.3").is_empty());
    let found = texts(&elements);
    for text in ["μ = 0.3", "μ = 0.4", "frequency [kHz]", "26"] {
        assert!(found.contains(&text), "{text} in {found:?}");
    }
    let lines = fs::read_to_string(path.join("waterfall.csv")).expect("the data");
    assert_eq!(lines.lines().count(), 1 + 4 * 101);
    assert!(lines.contains("job-16-0.4,16,0.4,20000,2\n"), "{lines}");
    let page = page();
    assert!(page.contains("waterfall.csv") && !page.contains("--all --only spectrum"));
}
