//! Maps of equal cells: every job is in them with its values.

use crate::synthetic::{done, failed, partial_study, periodic, row, with};
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::publish::chart::{Axis, Cell, Chart, Layer, Sample, Tip};
use tribosweep_output::report::figure::{Plot, figures};
use tribosweep_output::report::{JobRow, RowState, View};

/// The charts of some rows.
pub fn charts(rows: &[JobRow], plot: Plot) -> Vec<Chart> {
    let all = figures(rows, &View::default(), plot);
    all.into_iter().map(|figure| figure.chart).collect()
}

pub fn only(rows: &[JobRow], plot: Plot) -> Chart {
    let mut all = charts(rows, plot);
    assert_eq!(all.len(), 1);
    all.remove(0)
}

/// The cells of all panels.
pub fn cells(chart: &Chart) -> Vec<&Cell> {
    fn of_layer(layer: &Layer) -> &[Cell] {
        if let Layer::Cells(cells) = layer { cells } else { &[] }
    }
    let layers = chart.panels.iter().flat_map(|panel| &panel.layers);
    layers.flat_map(of_layer).collect()
}

/// The value of an attribute of a tooltip; an empty text if it has none of that name.
pub fn data<'a>(tip: &'a Tip, name: &str) -> &'a str {
    tip.data.iter().find(|(own, _)| *own == name).map_or("", |(_, value)| value)
}

/// The cell of a job, and its tooltip.
pub fn cell<'a>(chart: &'a Chart, job: &str) -> (&'a Cell, &'a Tip) {
    let with_tips = cells(chart).into_iter().filter_map(|cell| Some((cell, cell.tip.as_ref()?)));
    let mut own = with_tips.filter(|(_, tip)| data(tip, "job") == job);
    let found = own.next().unwrap_or_else(|| panic!("no {job}"));
    assert!(own.next().is_none(), "{job} has one cell");
    found
}

/// The texts of a legend.
pub fn legend(chart: &Chart) -> Vec<&str> {
    chart.legend.iter().map(|entry| entry.text.as_str()).collect()
}

/// Protects: the regime map has a cell for every job, done or not, at the right position and with the letter of `status`.
/// The letters that occur are explained. Speed increases to the right, and friction upwards.
#[test]
fn every_job_has_its_cell() {
    let rows = partial_study();
    let chart = only(&rows, Plot::RegimeMap);
    assert_eq!(cells(&chart).len(), rows.len());
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
        let (cell, tip) = cell(&chart, job);
        assert_eq!((cell.text.as_str(), data(tip, "value")), (letter, letter), "{job}");
        let meaning = chart.legend.iter().find(|entry| {
            matches!(&entry.sample, Sample::Cell(fill, own) if own == letter && Some(*fill) == cell.fill)
        });
        assert!(meaning.is_some(), "the legend has {letter}");
    }
    let panel = &chart.panels[0];
    let names = |names: &[&str]| Axis::Names(names.iter().map(|name| (*name).to_owned()).collect());
    assert_eq!(panel.x.axis, names(&["1", "2", "5", "10", "50", "100"]));
    assert_eq!(panel.y.axis, names(&["0.2", "0.3", "0.4"]));
    assert_eq!([&panel.x.label, &panel.y.label], ["disk speed ω [rpm]", "local friction coefficient μ"]);
    let place = |job| (cell(&chart, job).0.x, cell(&chart, job).0.y);
    assert_eq!(place("job-2-0.2"), ([0.5, 1.5], [-0.5, 0.5]));
    assert_eq!(place("job-50-0.4"), ([3.5, 4.5], [1.5, 2.5]));
    let legend = legend(&chart);
    for words in ["stable", "stick–slip–separation, not periodic", "failed"] {
        assert!(legend.contains(&words), "{words} in {legend:?}");
    }
}

/// Protects: several jobs at one point share a cell, and none hides another one.
#[test]
fn several_jobs_share_a_cell() {
    let mut rows = vec![
        row(7.0, 0.4, periodic(0.3)),
        row(7.0, 0.4, failed("no")),
        row(9.0, 0.4, periodic(0.3)),
        row(9.0, 0.3, periodic(0.3)),
    ];
    rows[1].job = "other".to_owned();
    let chart = only(&rows, Plot::RegimeMap);
    let [first, other, alone] = ["job-7-0.4", "other", "job-9-0.4"]
        .map(|job| (cell(&chart, job).0.x, cell(&chart, job).0.text.as_str()));
    assert_eq!([first, other, alone], [([-0.5, 0.0], "K"), ([0.0, 0.5], "!"), ([0.5, 1.5], "K")]);
}

/// Protects: the map of frequencies has rounded numbers in the cells and exact ones in the attributes, and a letter for a
/// job without a frequency. The colours follow the numbers, and their scale names both ends.
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
        row(9.0, 0.3, RowState::Pending),
    ];
    let chart = only(&rows, Plot::FrequencyMap);
    let shown = |job: &str| {
        let (cell, tip) = cell(&chart, job);
        (cell.text.as_str(), data(tip, "value"))
    };
    assert_eq!(shown("job-1-0.4"), ("9.9", "9876.5"));
    assert_eq!(shown("job-2-0.4"), ("15.4", "15432.1"));
    assert_eq!(shown("job-7-0.4"), ("S", ""));
    assert_eq!(shown("job-9-0.4"), ("14.5~", "14512.4"));
    let fill = |job: &str| cell(&chart, job).0.fill.expect("a colour").to_string();
    assert_eq!(fill("job-1-0.4"), fill("job-5-0.4"));
    assert_eq!([fill("job-1-0.4"), fill("job-2-0.4")], ["#440154", "#B5DE2B"], "the ends of the scale");
    assert_eq!(fill("job-9-0.4"), fill("job-7-0.4"), "what is not periodic has no colour");
    let scale = chart.colours.as_ref().expect("a scale");
    assert_eq!(scale.title, "frequency [kHz]");
    let (at, label) = &scale.ticks[0];
    let value: f64 = label.parse().expect("a number");
    assert!((at - (value - 9.8765) / (15.4321 - 9.8765)).abs() < 1e-12, "{at} {value}");
    let legend = legend(&chart);
    assert!(legend.contains(&"not periodic [kHz]") && legend.contains(&"pending"), "{legend:?}");
}

/// Protects: a map has two rows and two columns or more; the figures that show one row better remain.
#[test]
fn one_row_is_no_map() {
    let at = |omega: f64, mu: f64| row(omega, mu, periodic(0.3));
    let row = [at(1.0, 0.4), at(2.0, 0.4), at(5.0, 0.4)];
    let column = [at(1.0, 0.3), at(1.0, 0.4)];
    for plot in [Plot::RegimeMap, Plot::FrequencyMap, Plot::RegimePlane, Plot::GrowthRate] {
        for rows in [&row[..], &column, &[]] {
            assert_eq!(charts(rows, plot), [], "{plot:?} of {} jobs", rows.len());
        }
        only(&[at(1.0, 0.3), at(2.0, 0.4)], plot);
    }
    assert_eq!(figures(&row, &View::default(), Plot::Frequency).len(), 1);
}

/// Protects: combinations of further parameters are panels with their names, and the map of a study without speeds has the
/// names of its parameter.
#[test]
fn combinations_are_panels_and_names_are_labels() {
    let rows: Vec<JobRow> = [0.3, 0.4]
        .into_iter()
        .flat_map(|mu| {
            ["whole_top", "inner_side"].map(|side| with(row(7.0, mu, periodic(0.35)), "clamp_side", side))
        })
        .collect();
    for plot in [Plot::RegimeMap, Plot::FrequencyMap] {
        let chart = only(&rows, plot);
        let expected = Axis::Names(vec!["whole_top".to_owned(), "inner_side".to_owned()]);
        assert_eq!((&chart.panels[0].x.axis, cells(&chart).len()), (&expected, 4), "{plot:?}");
    }
    let of = |load: i32| partial_study().into_iter().map(move |row| with(row, "load_n", load));
    let rows: Vec<JobRow> = of(10).chain(of(30)).collect();
    let chart = only(&rows, Plot::RegimeMap);
    let titles: Vec<&str> = chart.panels.iter().map(|panel| panel.title.as_str()).collect();
    assert_eq!(titles, ["load = 10 N", "load = 30 N"]);
    assert_eq!(cells(&chart).len(), rows.len());
}

/// Protects: every cell has a title, and the title has the text of an error as it is.
#[test]
fn titles_are_text() {
    let failing =
        |mu: f64, note: &str| with(row(7.0, mu, failed("<script>alert(1)</script> & more")), "note", note);
    let rows = [failing(0.3, "<b>\""), failing(0.4, "plain")];
    let chart = only(&rows, Plot::RegimeMap);
    let titles: Vec<&str> = chart.tips().map(|tip| tip.title.as_str()).collect();
    assert_eq!(titles.len(), 2);
    assert!(
        titles[0].contains("failed: <script>alert(1)</script> & more") && titles[0].contains("note = <b>\""),
        "{titles:?}"
    );
    assert!(!chart.svg("").contains("<script>"));
}
