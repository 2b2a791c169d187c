//! Jobs whose speed or load changes in time.

use crate::synthetic::{record, report, row};
use std::fs;
use tribosweep::analysis::program::{Direction, ProgramWindow};
use tribosweep::analysis::{Outcome, Regime};
use tribosweep::report::columns::ExportColumn;
use tribosweep::report::{JobRow, RowState, write};

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
            load_n: 30.0,
            mu_star: mu - 0.001 * omega_rpm + more,
            mu_star_contact: mu,
            frequency_hz: (k % 2 == 1).then_some(15e3),
            n_amplitude: 0.25,
            y_peak_to_peak_m: 1e-6,
            stick_share: 0.25,
            slip_share: 0.5,
            separated_share: 0.25,
        }
    };
    let mut record = record(Outcome::Completed, Regime::StickSlip, mu);
    record.windows = (0..9).map(window).collect();
    row(40.0, mu, RowState::Done(Box::new(record)))
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
    for svg in ["program.svg", "program-2.svg"] {
        let svg = read(svg);
        assert!(
            svg.contains("hysteresis 0.0200") && svg.contains("ω [rpm]") && svg.contains("down"),
            "{svg}"
        );
    }
    assert!(!folder.path().join("program-3.svg").exists());

    let page = read("report.md");
    assert!(page.contains("## Speed and load in time") && page.contains("0.0200"), "{page}");
    assert!(page.contains("(windows.csv)") && page.contains("(program-2.svg)"), "{page}");
    assert!(page.contains("3 of 3 jobs done (0 periodic, 1 decayed, 0 not periodic, 2 completed)"), "{page}");
    assert!(!page.contains("## Not periodic"), "{page}");
    assert!(read("report.html").contains("Speed and load in time"));

    let hysteresis = ExportColumn::find("hysteresis").unwrap();
    let found = hysteresis.value(&rows[0]).as_f64().unwrap();
    assert!((found - 0.02).abs() < 1e-12, "{found}");
    assert!(hysteresis.value(&rows[1]).is_null());
}
