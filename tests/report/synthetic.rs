//! Synthetic jobs: plausible results without a simulation.

use serde_json::Value;
use std::sync::LazyLock;
use tribosweep_mechanics::analysis::{CoarseStart, JobRecord, Outcome, Regime};
use tribosweep_output::publish::{Drawing, Sheet, SheetGroup, SheetLine};
use tribosweep_output::report::{
    JobNumerics, JobRow, MeasuredValue, Measurement, Parameters, Report, RowState, View,
};

/// The usual axes.
pub static VIEW: LazyLock<View> = LazyLock::new(View::default);

/// Two drawings and an input.
static SHEET: LazyLock<Sheet> = LazyLock::new(|| {
    let drawing =
        |stem| Drawing { stem, svg: "<svg ></svg>".to_owned(), caption: format!("drawing of {stem}") };
    let line = SheetLine {
        symbol: "E_d",
        name: "Young's modulus <b>".to_owned(),
        value: "0.5 GPa".to_owned(),
        key: "disk_young_modulus_pa",
        origin: "study",
        varies: false,
    };
    let group = SheetGroup { heading: "Disk", lines: vec![line] };
    Sheet { drawings: ["scene", "track"].map(drawing).into(), groups: vec![group] }
});

/// The report of these rows, without provenance.
pub fn report(rows: &[JobRow]) -> Report<'_> {
    Report { title: "Reference", rows, view: &VIEW, sheet: Some(&SHEET), ..Report::default() }
}

/// A measured point of the file `rig.csv`.
pub fn measured(omega_rpm: f64, mu: f64, mu_star: f64, error: Option<f64>) -> JobRow {
    let value = MeasuredValue { name: "mu_star".to_owned(), value: mu_star, error };
    JobRow {
        study: "rig".to_owned(),
        job: format!("rig.csv:{omega_rpm}"),
        parameters: Parameters::new(omega_rpm, mu, Vec::new()),
        ..row(omega_rpm, mu, RowState::Measured(Measurement { values: vec![value], squeals: None }))
    }
}

pub fn record(outcome: Outcome, regime: Regime, mu_star: f64) -> JobRecord {
    JobRecord {
        outcome,
        regime,
        mu_star,
        mu_star_contact: mu_star,
        frequency_hz: (regime != Regime::Stable).then_some(14_512.4),
        growth_rate_per_s: None,
        obstacle: None,
        stability: None,
        accuracy_reached: None,
        start: None,
        disk: None,
        holder: Vec::new(),
        windows: Vec::new(),
        nodes: Vec::new(),
        ..JobRecord::example()
    }
}

pub fn done(outcome: Outcome, regime: Regime, mu_star: f64) -> RowState {
    RowState::Done(Box::new(record(outcome, regime, mu_star)))
}

pub fn periodic(mu_star: f64) -> RowState {
    done(Outcome::Periodic, Regime::StickSlip, mu_star)
}

pub fn failed(error: &str) -> RowState {
    RowState::Failed { error: error.to_owned() }
}

/// Those of a grid of speeds and friction coefficients.
pub fn parameters(omega_rpm: f64, mu: f64) -> Parameters {
    let grid = [("omega_rpm", omega_rpm), ("mu", mu)];
    Parameters::new(f64::NAN, f64::NAN, grid.map(|(name, x)| (name.to_owned(), x.into())).into())
}

pub fn row(omega_rpm: f64, mu: f64, state: RowState) -> JobRow {
    JobRow {
        study: "reference".to_owned(),
        job: format!("job-{omega_rpm}-{mu}"),
        parameters: parameters(omega_rpm, mu),
        has_one_mu: true,
        state,
        wall_s: Some(12.5),
        numerics: None,
        wave: 0,
        why: None,
        inputs: Vec::new(),
    }
}

/// The row with a run on a mesh of half as many elements in each direction, which ended in the same regime with this μ\* and this frequency.
pub fn after(mut row: JobRow, coarser_mu_star: f64, coarser_hz: f64) -> JobRow {
    if let RowState::Done(record) = &mut row.state {
        record.elements = Some([24, 30, 20]);
        record.start = Some(CoarseStart {
            elements: [12, 15, 10],
            outcome: Some(record.outcome),
            only_compared: false,
            regime: Some(record.regime),
            same_clamp: Some(true),
            modes: Vec::new(),
            simulated_s: 0.002,
            mu_star: Some(coarser_mu_star),
            frequency_hz: Some(coarser_hz),
            start: None,
        });
    }
    row
}

pub fn with(mut row: JobRow, name: &str, value: impl Into<Value>) -> JobRow {
    let value = value.into();
    row.job = format!("{}-{value}", row.job);
    row.parameters.extend([(name.to_owned(), value)]);
    row
}

/// Three friction coefficients over six speeds, with every outcome: 14 jobs have results, one has
/// failed, one is running, and two are pending.
pub fn partial_study() -> Vec<JobRow> {
    let mut rows = Vec::new();
    for mu in [0.2, 0.3, 0.4] {
        for omega in [1.0, 2.0, 5.0, 10.0, 50.0, 100.0] {
            let state = match (mu, omega) {
                (0.3, 50.0) => failed("the mesh has no node row at the clamp's width"),
                (0.4, 1.0) => RowState::Running,
                (0.4, 50.0 | 100.0) => RowState::Pending,
                (0.4, 10.0) => done(Outcome::NotPeriodic, Regime::StickSlipSeparation, 0.35),
                (0.2, _) => done(Outcome::Decayed, Regime::Stable, 0.2),
                (_, 10.0) => done(Outcome::Periodic, Regime::StickSlipSeparation, 0.9 * mu),
                (_, 100.0) => done(Outcome::Periodic, Regime::SlipSeparation, 0.95 * mu),
                _ => periodic(mu * (0.8 + omega / 50.0)),
            };
            rows.push(row(omega, mu, state));
        }
    }
    rows
}

/// A cube of n × n × n elements of 1/n mm; the step is in proportion.
pub fn numerics(n: usize, safety_factor: f64) -> JobNumerics {
    JobNumerics {
        case: "one".to_owned(),
        elements: [n, n, n],
        element_size_m: 1.0e-3 / n as f64,
        nodes: (n as u64 + 1).pow(3),
        beta2: 0.5,
        beta_r_s: 5.0e-8,
        alpha_r_per_s: 0.0,
        safety_factor: Some(safety_factor),
        limit_s: 0.01,
        stop_early: false,
        average_last_fraction: 0.4,
        cycles: 20,
        tolerance: 0.01,
        drift_tolerance: 0.001,
        precision: "double".into(),
        start: "rest".into(),
    }
}
