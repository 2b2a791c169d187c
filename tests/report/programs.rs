//! Jobs whose speed or load changes in time.

use crate::charts::{coloured, lines, points, texts};
use crate::synthetic::{record, report, row};
use std::fs;
use tribosweep_mechanics::analysis::program::{Direction, ProgramWindow};
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::publish::chart::Layer;
use tribosweep_output::publish::chart::palette::{BLUE, VERMILLION};
use tribosweep_output::report::columns::ExportColumn;
use tribosweep_output::report::{JobRow, RowState, program_chart, write};

/// A run up to 40 rpm and down again in nine windows, with 0.02 more friction on the way up.
fn up_and_down(mu: f64) -> JobRow {
    let window = |k: i32| {
        let (direction, more) = match k {
            0 => (Direction::Start, 0.0),
            1..=4 => (Direction::Up, 0.02),
            _ => (Direction::Down, 0.0),
        };
        let omega_rpm = 10.0 * f64::from(if k <= 4 { k } else { 9 - k });
        ProgramWindow {
            time_s: [0.01 * f64::from(k), 0.01 * f64::from(k + 1)],
            direction,
            omega_rpm,
            mu_star: mu - 0.001 * omega_rpm + more,
            mu_star_contact: mu,
            frequency_hz: (k % 2 == 1).then_some(15e3),
            ..ProgramWindow::example()
        }
    };
    let mut record = record(Outcome::Completed, Regime::StickSlip, mu);
    record.windows = (0..9).map(window).collect();
    row(40.0, mu, RowState::Done(Box::new(record)))
}

/// Protects: the figure has every window on its way, over the speed and over time, with the frequencies that are known.
#[test]
fn every_window_is_in_the_figure() {
    let row = up_and_down(0.3);
    let windows = &row.record().expect("a result").windows;
    let chart = program_chart(&row).expect("a figure");
    assert!(chart.title.ends_with("hysteresis 0.0200 at 40 rpm"), "{}", chart.title);
    let [over_lead, in_time, frequency] = &chart.panels[..] else { panic!("three panels") };
    let of_way =
        |colour| -> Vec<(f64, f64)> { coloured(over_lead, colour).iter().map(|point| point.at).collect() };
    let expected = |direction| -> Vec<(f64, f64)> {
        let own = windows.iter().filter(|window| window.direction == direction);
        own.map(|window| (window.omega_rpm, window.mu_star)).collect()
    };
    assert_eq!(of_way(VERMILLION), expected(Direction::Up));
    assert_eq!(of_way(BLUE), expected(Direction::Down));
    assert_eq!(points(over_lead).len(), 9);
    let over_time = |read: fn(&ProgramWindow) -> f64| -> Vec<(f64, f64)> {
        windows.iter().map(|window| (window.middle_s(), read(window))).collect()
    };
    assert_eq!(lines(in_time)[0].0, over_time(|window| window.mu_star));
    assert_eq!(lines(in_time)[1].0, over_time(|window| window.omega_rpm));
    assert_eq!(lines(frequency)[0].0, over_time(|window| window.n_amplitude));
    assert_eq!(points(frequency).len(), 4, "only windows with a frequency");
    assert_eq!(texts(&in_time.legend), ["μ*", "ω [rpm] (right axis)", "up", "down"]);
    let Layer::Cells(ways) = &in_time.layers[0] else { panic!("the ways are behind the curves") };
    let spans: Vec<[f64; 2]> = ways.iter().map(|way| way.x).collect();
    assert_eq!(
        spans,
        [[windows[1].time_s[0], windows[4].time_s[1]], [windows[5].time_s[0], windows[8].time_s[1]]]
    );
}

/// Protects: a report has a figure, the windows and the hysteresis of every such job, the page says so, and the export has the
/// hysteresis. A job without windows has none.
#[test]
fn a_report_has_the_windows_and_their_hysteresis() {
    let constant = row(40.0, 0.6, RowState::Done(Box::new(record(Outcome::Decayed, Regime::Stable, 0.6))));
    let rows = [up_and_down(0.3), constant, up_and_down(0.4)];
    let folder = tempfile::tempdir().unwrap();
    write(&report(&rows), folder.path()).unwrap();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();

    let csv = read("windows.csv");
    assert_eq!(csv.lines().count(), 1 + 2 * 9, "{csv}");
    let first = csv.lines().nth(2).unwrap();
    let own = format!("reference,{},\"", rows[0].job);
    assert!(first.starts_with(&own), "{first}");
    assert!(first.contains(",0.01,0.02,up,10,30,0.31,0.3,15000,0.25,"), "{first}");
    assert!(read("program.svg").contains("hysteresis 0.0200") && !read("program-2.svg").is_empty());
    assert!(!folder.path().join("program-3.svg").exists());

    let page = read("report.md");
    assert!(page.contains("## Speed and load in time") && page.contains("0.0200"), "{page}");
    assert!(page.contains("(windows.csv)") && page.contains("(program-2.svg)"), "{page}");
    assert!(
        page.contains("jobs done: 3 of 3 (0 periodic, 1 decayed, 0 not periodic, 2 completed)"),
        "{page}"
    );
    assert!(!page.contains("# Not periodic"), "{page}");
    assert!(read("report.html").contains("Speed and load in time"));

    let hysteresis = ExportColumn::find("hysteresis").unwrap();
    let found = hysteresis.value(&rows[0]).as_f64().unwrap();
    assert!((found - 0.02).abs() < 1e-12, "{found}");
    assert!(hysteresis.value(&rows[1]).is_null());
}
