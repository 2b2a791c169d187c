//! Tables of points: each of them has every parameter that the study varies, whatever is along the axes.

use crate::synthetic::{periodic, record, report, row, with};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tribosweep_mechanics::analysis::program::ProgramWindow;
use tribosweep_mechanics::analysis::{Outcome, Regime, SlidingStability, UnknownError};
use tribosweep_output::report::{
    Basin, BranchPoint, Crossing, Findings, JobRow, Minimum, Report, RowState, StabilityPoint, write,
};

const WIDTHS_M: [f64; 3] = [0.002, 0.003, 0.004];

/// Tables of points are all files but these.
const OTHERS: [&str; 1] = ["waves.csv"];

/// A job with a window, so that the report has a table of windows.
fn job(study: &str, omega_rpm: f64, mu: f64, width_m: f64) -> JobRow {
    let mut record = record(Outcome::Completed, Regime::StickSlip, mu);
    record.windows = vec![ProgramWindow::example()];
    let mut job = with(row(omega_rpm, mu, RowState::Done(Box::new(record))), "clamp_width_m", width_m);
    study.clone_into(&mut job.study);
    job.job = format!("{study}-{}", job.job);
    job
}

fn point(row: &JobRow) -> StabilityPoint {
    let mu = row.parameters.mu();
    let growth_rate_per_s = 1000.0 * (mu - 0.3);
    let mut stability = SlidingStability { mu_star: mu, ..SlidingStability::example() };
    stability.modes[0].growth_rate_per_s = growth_rate_per_s;
    StabilityPoint {
        parameters: row.parameters.clone(),
        on_grid: true,
        stands_alone: Some(UnknownError::NoCoarserMesh),
        stability,
    }
}

/// Boundaries and minima along both parameters.
fn findings(rows: &[JobRow]) -> Findings {
    let without = |over: &str| -> Vec<(String, Value)> {
        rows[0].parameters.of_grid().iter().filter(|(name, _)| name != over).cloned().collect()
    };
    let crossing = |over: &str| Crossing {
        rest: without(over),
        over: over.to_owned(),
        between: ["a".to_owned(), "b".to_owned()],
        range: [0.002, 0.003],
        wanted: 0.001,
    };
    let minimum = |over: &str| Minimum {
        rest: without(over),
        over: over.to_owned(),
        of: "mu_star".to_owned(),
        at: 0.003,
        value: 0.25,
        neighbours: [Some(0.002), None],
        wanted: 0.001,
        is_flat: false,
    };
    let parameters = rows[0].parameters.of_grid().to_vec();
    Findings {
        waves: vec![BTreeMap::from([("curve".to_owned(), 3)])],
        state: "finished".to_owned(),
        crossings: ["clamp_width_m", "mu"].map(crossing).into(),
        minima: ["mu", "clamp_width_m"].map(minimum).into(),
        branches: vec![BranchPoint { parameters: parameters.clone(), up: None, down: None }],
        basins: vec![Basin { parameters, end: None, jobs: 1, of: 2 }],
        calibration: None,
    }
}

/// Points that are no grid.
fn samples() -> Vec<JobRow> {
    let sample = |i: i32| {
        let x = f64::from(i);
        job("one", 7.0 + x, 0.2 + 0.013 * x, 0.002 + 0.0001 * x)
    };
    (0..8).map(sample).collect()
}

/// The lines of the tables of a folder by their columns.
fn tables(folder: &Path) -> BTreeMap<String, Vec<BTreeMap<String, String>>> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files = files.filter(|path| path.extension().is_some_and(|extension| extension == "csv"));
    let read = |path: std::path::PathBuf| {
        let mut reader = csv::Reader::from_path(&path).unwrap();
        let lines = reader.deserialize().map(|line| line.unwrap()).collect();
        (path.file_name().unwrap().to_str().unwrap().to_owned(), lines)
    };
    files.map(read).collect()
}

/// Asserts that each table of a report's points has a value of each of the parameters in every line.
fn assert_complete(report: &Report, parameters: &[&str], least: usize) {
    let folder = tempfile::tempdir().unwrap();
    write(report, folder.path()).unwrap();
    let tables = tables(folder.path());
    assert!(tables.len() >= least, "{:?}", tables.keys());
    for (file, lines) in tables.iter().filter(|(file, _)| !OTHERS.contains(&file.as_str())) {
        assert!(!lines.is_empty(), "{file}");
        for (line, parameter) in lines.iter().flat_map(|line| parameters.iter().map(move |own| (line, own))) {
            let is_own = |(name, cell): (&String, &String)| {
                // A parameter of the curves is a column for each of its values; a threshold is a value of its parameter.
                let is_curve = name.starts_with(&format!("{parameter}="));
                let is_threshold = file == "thresholds.csv"
                    && name.strip_prefix(parameter).is_some_and(|end| end.starts_with('_'));
                (name == parameter || is_curve || is_threshold) && !cell.is_empty()
            };
            assert!(line.iter().any(is_own), "{file} has no {parameter}: {line:?}");
        }
    }
}

/// Protects: in a report of two studies at one speed, over a clamp's width and μ, with stability, windows, and everything that plans can
/// find, each table of points has μ and the width, which is the abscissa.
#[test]
fn each_table_of_points_has_every_parameter() {
    let grid =
        |study| WIDTHS_M.into_iter().flat_map(move |width| [0.2, 0.4].map(|mu| job(study, 7.0, mu, width)));
    let rows: Vec<JobRow> = grid("one").chain(grid("two")).collect();
    let points: Vec<StabilityPoint> = rows[..6].iter().map(point).collect();
    let findings = findings(&rows);
    let report = Report { findings: Some(&findings), stability: &points, ..report(&rows) };
    assert_complete(&report, &["mu", "clamp_width_m"], 19);
}

/// Protects: the same for points that are no grid.
#[test]
fn tables_of_samples_have_every_parameter() {
    let rows = samples();
    let points: Vec<StabilityPoint> = rows.iter().map(point).collect();
    let report = Report { stability: &points, ..report(&rows) };
    assert_complete(&report, &["omega_rpm", "mu", "clamp_width_m"], 13);
}

/// Protects: drawn points have no diagrams that join or stack neighbours, and their tables on the page have every parameter.
#[test]
fn samples_are_drawn_as_points() {
    let rows = samples();
    let folder = tempfile::tempdir().unwrap();
    write(&report(&rows), folder.path()).unwrap();
    let has = |stem: &str| folder.path().join(format!("{stem}.svg")).exists();
    assert!(has("mu_star") && !has("shares") && !has("bifurcation"));
    let page = fs::read_to_string(folder.path().join("report.md")).unwrap();
    let head =
        page.lines().find(|line| line.contains("| clamp_width_m |")).unwrap_or_else(|| panic!("{page}"));
    assert!(
        [" mu |", "| omega_rpm |", "friction coefficient μ"].iter().all(|own| head.contains(own)),
        "{head}"
    );
}

/// Protects: what a plan has found stands in the sentences at the head of the page.
#[test]
fn findings_are_at_the_head() {
    let rows: Vec<JobRow> = WIDTHS_M.into_iter().map(|width| job("one", 7.0, 0.2, width)).collect();
    let mut findings = findings(&rows);
    // Another line of jobs, with another boundary of the same kind.
    let rest = vec![("omega_rpm".to_owned(), 7.0.into()), ("mu".to_owned(), 0.4.into())];
    findings.crossings.push(Crossing { range: [0.0035, 0.0075], rest, ..findings.crossings[0].clone() });
    let folder = tempfile::tempdir().unwrap();
    write(&Report { findings: Some(&findings), ..report(&rows) }, folder.path()).unwrap();
    let page = fs::read_to_string(folder.path().join("report.md")).unwrap();
    let head = page.split("\n## ").next().unwrap();
    let expected = "The boundary from a to b lies between clamp_width = 2 mm and 7.5 mm in 2 places (1 of them not yet as near as was \
                    asked for).";
    assert!(head.contains(expected), "{head}");
    let single =
        "The boundary from a to b lies between μ = 0.002 and 0.003 at ω = 7 rpm, clamp_width = 2 mm.";
    assert!(head.contains(single), "{head}");
}

/// Protects: samples are compared where all of their parameters are equal, and nothing is interpolated between them.
#[test]
fn samples_are_compared_at_equal_points_alone() {
    let sample = |study: &str, i: i32, shift: f64| {
        let x = f64::from(i);
        let mut row =
            with(row(7.0 + x, 0.2 + 0.013 * x + shift, periodic(0.3)), "clamp_width_m", 0.002 + 0.0001 * x);
        row.study = study.to_owned();
        row
    };
    let mut rows: Vec<JobRow> = (0..8).map(|i| sample("one", i, 0.0)).collect();
    rows.extend([sample("two", 3, 0.0), sample("two", 5, 0.001)]);
    let folder = tempfile::tempdir().unwrap();
    write(&report(&rows), folder.path()).unwrap();
    let lines = &tables(folder.path())["differences.csv"];
    let speeds: Vec<&str> = lines
        .iter()
        .filter(|line| line["quantity"] == "mu_star")
        .map(|line| line["omega_rpm"].as_str())
        .collect();
    assert_eq!(speeds, ["10"]);
}
