//! The export: other programs rely on its field names, their order and the empty cells.

use crate::synthetic::{failed, partial_study, periodic, record, row, with};
use serde_json::{Value, json};
use std::io;
use tribosweep::analysis::{Outcome, Regime};
use tribosweep::report::{JobRow, RowState, export};

const HEADER: &str = "study,job,omega_rpm,mu,status,regime,mu_star,mu_star_se,mu_star_contact,frequency_hz,\
                      stick_share,slip_share,separated_share,n_over_f_min,n_over_f_max,sigma_n_max_pa,\
                      slip_speed_max_m_s,cycles,simulated_s,steps,time_step_s,energy_residual,\
                      identity_residual,wall_s,error";

fn csv(rows: &[JobRow]) -> String {
    let mut out = Vec::new();
    export::csv(rows, &mut out).expect("a vector takes everything");
    String::from_utf8(out).expect("the export is UTF-8")
}

fn json_lines(rows: &[JobRow]) -> Vec<Value> {
    let mut out = Vec::new();
    export::json_lines(rows, &mut out).expect("a vector takes everything");
    let text = String::from_utf8(out).expect("the export is UTF-8");
    text.lines().map(|line| serde_json::from_str(line).expect("each line is JSON")).collect()
}

/// Header and cells of the first job as the csv reader sees them.
fn first_cells(rows: &[JobRow]) -> Vec<(String, String)> {
    let text = csv(rows);
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let line = reader.records().next().expect("a line").expect("as many cells as the header");
    header.iter().map(str::to_owned).zip(line.iter().map(str::to_owned)).collect()
}

fn cell(cells: &[(String, String)], name: &str) -> String {
    cells.iter().find(|(own, _)| own == name).unwrap_or_else(|| panic!("no column {name}")).1.clone()
}

/// Protects: the names and the order of the fields are the documented ones, because scripts use them.
#[test]
fn header_is_exactly_the_documented_one() {
    assert_eq!(csv(&partial_study()).lines().next(), Some(HEADER));
    assert_eq!(csv(&[]).trim_end(), HEADER);
}

/// Protects: every value is in its own column.
#[test]
fn each_figure_is_in_its_own_column() {
    let state = RowState::Done(Box::new(record(Outcome::Periodic, Regime::StickSlip, 0.3512)));
    let line = csv(&[row(7.0, 0.4, state)]).lines().nth(1).expect("one line").to_owned();
    assert_eq!(
        line,
        "reference,job-7-0.4,7,0.4,periodic,stick_slip,0.3512,0.0005,0.3512,14512.4,0.25,0.5,0.25,0.5,1.5,\
         1250000,0.125,40,0.0875,350000,2.5e-7,1.5e-9,0.0003,12.5,"
    );
}

/// Protects: pending and running jobs have no results.
#[test]
fn a_job_without_result_has_empty_cells() {
    for (state, status) in [(RowState::Pending, "pending"), (RowState::Running, "running")] {
        let mut job = row(7.0, 0.4, state);
        job.wall_s = None;
        let cells = first_cells(&[job.clone()]);
        assert_eq!(cell(&cells, "status"), status);
        assert_eq!(cell(&cells, "omega_rpm"), "7");
        for (name, value) in &cells[5..] {
            assert_eq!(value, "", "{name} of a {status} job");
        }
        let object = &json_lines(&[job])[0];
        assert_eq!(object["status"], status);
        assert_eq!(object["mu_star"], Value::Null);
        assert_eq!(object["error"], Value::Null);
    }
}

/// Protects: the status is the outcome of a job that is done, or `failed`, `pending`, `running`.
#[test]
fn status_tells_the_outcomes_apart() {
    let statuses: Vec<Value> =
        json_lines(&partial_study()).iter().map(|line| line["status"].clone()).collect();
    let count = |status: &str| statuses.iter().filter(|own| *own == status).count();
    let counts = ["periodic", "decayed", "not_periodic", "failed", "running", "pending"].map(count);
    assert_eq!(counts, [7, 6, 1, 1, 1, 2]);
}

/// Protects: further grid parameters are the last columns. ω and μ are not among them, arrays are
/// readable, and parameters that a job does not have are empty.
#[test]
fn further_parameters_are_the_last_columns() {
    let rows = [
        with(with(row(7.0, 0.4, periodic(0.35)), "elements", json!([12, 15, 10])), "beta_r_s", 1e-7),
        with(row(8.0, 0.4, periodic(0.36)), "clamp_side", "outer_side"),
    ];
    let text = csv(&rows);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], format!("{HEADER},elements,beta_r_s,clamp_side"));
    assert!(lines[1].ends_with(",12x15x10,1e-7,"), "{}", lines[1]);
    assert!(lines[2].ends_with(",,,outer_side"), "{}", lines[2]);

    let objects = json_lines(&rows);
    assert_eq!(objects[0]["elements"], json!([12, 15, 10]));
    assert_eq!(objects[0]["beta_r_s"], json!(1e-7));
    assert_eq!(objects[1]["elements"], Value::Null);
}

/// Protects: a parameter with the name of a result has its own column, and no JSON object has two equal keys.
#[test]
fn a_parameter_named_like_a_result_gets_a_column_of_its_own() {
    let cells = first_cells(&[with(row(7.0, 0.4, periodic(0.35)), "time_step_s", 1e-7)]);
    assert_eq!(cell(&cells, "time_step_s"), "2.5e-7");
    assert_eq!(cell(&cells, "parameter_time_step_s"), "1e-7");
}

/// Protects: text with special characters of CSV is read back unchanged.
#[test]
fn error_text_survives_the_csv_reader() {
    let error = "first line, with \"quotes\"\nsecond line; a comma, and a\r\nthird";
    let cells = first_cells(&[row(7.0, 0.4, failed(error))]);
    assert_eq!(cell(&cells, "error"), error);
    assert_eq!(cell(&cells, "status"), "failed");
    assert_eq!(cell(&cells, "mu_star"), "");
    assert_eq!(json_lines(&[row(7.0, 0.4, failed(error))])[0]["error"], error);
}

/// Protects: numbers that are not finite are empty cells.
#[test]
fn figures_that_are_not_finite_are_empty() {
    let mut broken = record(Outcome::NotPeriodic, Regime::Undecided, f64::NAN);
    broken.mu_star_se = f64::INFINITY;
    broken.frequency_hz = Some(f64::NAN);
    broken.macroscopic_identity_residual = f64::NAN;
    broken.energy_identity_residual = f64::NAN;
    let rows = [row(7.0, 0.4, RowState::Done(Box::new(broken)))];
    let cells = first_cells(&rows);
    for name in ["mu_star", "mu_star_se", "frequency_hz", "identity_residual"] {
        assert_eq!(cell(&cells, name), "", "{name}");
        assert_eq!(json_lines(&rows)[0][name], Value::Null, "{name}");
    }
    assert_eq!(cell(&cells, "cycles"), "40");
}

/// Protects: every number is read back as the same double.
#[test]
fn floats_read_back_exactly() {
    for x in [0.1 + 0.2, 1.0 / 3.0, 2.5e-7, 1.234_567_890_123_456_7e-300, 6.02e23, -1e-5, 0.0] {
        let state = RowState::Done(Box::new(record(Outcome::Periodic, Regime::StickSlip, x)));
        let text = cell(&first_cells(&[row(7.0, 0.4, state)]), "mu_star");
        assert_eq!(text.parse::<f64>().ok(), Some(x), "{text}");
        assert!(text.len() <= 24, "{text} is not the shortest form");
    }
}

/// Protects: a closed pipe, as in `tribosweep … | head`, is recognisable by its error kind.
#[test]
fn a_closed_pipe_keeps_its_kind() {
    struct Closed;
    impl io::Write for Closed {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::BrokenPipe.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let kind = |result: io::Result<()>| result.map_err(|error| error.kind());
    assert_eq!(kind(export::csv(&partial_study(), Closed)), Err(io::ErrorKind::BrokenPipe));
    assert_eq!(kind(export::json_lines(&partial_study(), Closed)), Err(io::ErrorKind::BrokenPipe));
}
