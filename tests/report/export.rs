//! The export: other programs rely on its field names, their order and the empty cells.

use crate::synthetic::{failed, partial_study, periodic, record, row, with};
use serde_json::{Value, json};
use std::io;
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::publish::table::Format;
use tribosweep_output::report::{JobRow, RowState, export};

const HEADER: &str = "study,job,omega_rpm,mu,status,regime,mu_star,mu_star_se,mu_star_mesh_error,\
                      mu_star_contact,frequency_hz,frequency_mesh_error_hz,stick_share,slip_share,separated_share,n_over_f_min,n_over_f_max,sigma_n_max_pa,\
                      slip_speed_max_m_s,cycles,simulated_s,steps,time_step_s,energy_residual,\
                      identity_residual,wall_s,error";

/// The cells of the first job by their columns.
fn first_cells(rows: &[JobRow]) -> Vec<(String, Value)> {
    let table = export::table(rows);
    table.names().map(str::to_owned).zip(table.lines[0].iter().cloned()).collect()
}

fn cell(cells: &[(String, Value)], name: &str) -> Value {
    cells.iter().find(|(own, _)| own == name).unwrap_or_else(|| panic!("no column {name}")).1.clone()
}

/// Protects: the names and the order of the fields are the documented ones, because scripts use them.
#[test]
fn header_is_exactly_the_documented_one() {
    let names = |rows: &[JobRow]| export::table(rows).names().collect::<Vec<_>>().join(",");
    assert_eq!(names(&partial_study()), HEADER);
    assert_eq!(names(&[]), HEADER);
}

/// Protects: every value is in its own column.
#[test]
fn each_figure_is_in_its_own_column() {
    let state = RowState::Done(Box::new(record(Outcome::Periodic, Regime::StickSlip, 0.3512)));
    let mut csv = Vec::new();
    export::write(&[row(7.0, 0.4, state)], Format::Csv, &mut csv).expect("a vector takes everything");
    let csv = String::from_utf8(csv).expect("the export is UTF-8");
    assert_eq!(
        csv.lines().nth(1).expect("one line"),
        "reference,job-7-0.4,7,0.4,periodic,stick_slip,0.3512,0.0005,,0.3512,14512.4,,0.25,0.5,0.25,0.5,1.5,\
         1250000,0.125,40,0.0875,350000,2.5e-7,1.5e-9,0.0003,12.5,"
    );
}

/// Protects: pending and running jobs have no results.
#[test]
fn a_job_without_result_has_empty_cells() {
    for (state, status) in [(RowState::Pending, "pending"), (RowState::Running, "running")] {
        let mut job = row(7.0, 0.4, state);
        job.wall_s = None;
        let cells = first_cells(&[job]);
        assert_eq!(cell(&cells, "status"), status);
        assert_eq!(cell(&cells, "omega_rpm"), 7.0);
        for (name, value) in &cells[5..] {
            assert!(value.is_null(), "{name} of a {status} job");
        }
    }
}

/// Protects: the status is the outcome of a job that is done, or `failed`, `pending`, `running`.
#[test]
fn status_tells_the_outcomes_apart() {
    let table = export::table(&partial_study());
    let at = table.names().position(|name| name == "status").expect("a column");
    let count = |status: &str| table.lines.iter().filter(|line| line[at] == status).count();
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
    let table = export::table(&rows);
    let fixed = table.heads.len() - 3;
    assert_eq!(table.names().collect::<Vec<_>>().join(","), format!("{HEADER},elements,beta_r_s,clamp_side"));
    assert_eq!(table.lines[0][fixed..], [json!([12, 15, 10]), json!(1e-7), Value::Null]);
    assert_eq!(table.lines[1][fixed..], [Value::Null, Value::Null, json!("outer_side")]);
    assert!(table.csv().lines().nth(1).is_some_and(|line| line.ends_with(",12x15x10,1e-7,")));
}

/// Protects: a parameter with the name of a result has its own column, and no JSON object has two equal keys.
#[test]
fn a_parameter_named_like_a_result_gets_a_column_of_its_own() {
    let cells = first_cells(&[with(row(7.0, 0.4, periodic(0.35)), "time_step_s", 1e-7)]);
    assert_eq!(cell(&cells, "time_step_s"), 2.5e-7);
    assert_eq!(cell(&cells, "parameter_time_step_s"), 1e-7);
}

/// Protects: the text of an error is in its column, and there is no result.
#[test]
fn a_failed_job_has_its_error() {
    let error = "first line, with \"quotes\"\nsecond line; a comma, and a\r\nthird";
    let cells = first_cells(&[row(7.0, 0.4, failed(error))]);
    assert_eq!((cell(&cells, "error"), cell(&cells, "status")), (error.into(), "failed".into()));
    assert_eq!(cell(&cells, "mu_star"), Value::Null);
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
        assert_eq!(cell(&cells, name), Value::Null, "{name}");
    }
    assert_eq!(cell(&cells, "cycles"), 40);
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
    for format in [Format::Csv, Format::JsonLines] {
        let result = export::write(&partial_study(), format, Closed);
        assert_eq!(result.map_err(|error| error.kind()), Err(io::ErrorKind::BrokenPipe));
    }
}
