//! One job as a report sees it.

use super::measurement::Measurement;
use super::parameters::{Parameters, SOURCE};
use crate::analysis::{JobRecord, MeshError, Outcome};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// One job of a study, or one measured point: its parameters and its state.
#[derive(Debug, Clone, PartialEq)]
pub struct JobRow {
    /// Name of its source: of the study, or of the file of measured points.
    pub study: String,
    /// Key of the job; file and line of a measured point.
    pub job: String,
    /// Its parameters.
    pub parameters: Parameters,
    /// Whether the friction law is known to have no coefficient but μ, so that steady sliding has μ\* = μ.
    pub has_one_mu: bool,
    /// The state of the job.
    pub state: RowState,
    /// The job's share of the time of its thread \[s\]. Jobs that are advanced together have equal shares.
    pub wall_s: Option<f64>,
    /// The job's numerics; none of a measured point, and of a job that is no part of a study.
    pub numerics: Option<JobNumerics>,
    /// The wave in which the program added the job; 0 for a job that the study's author asked for.
    pub wave: u64,
    /// Why the program added the job: `curve`, `minimum`, `boundary`.
    pub why: Option<String>,
    /// The values of all inputs, for an export that has them; otherwise empty.
    pub inputs: Vec<Value>,
}

/// What a job's accuracy and cost depend on besides the physics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JobNumerics {
    /// Key of the physical case: equal for jobs that differ only in the fields below.
    pub case: String,
    /// Number of elements in x, y and z.
    pub elements: [usize; 3],
    /// Element size h \[m\]: the cube root of an element's volume.
    pub element_size_m: f64,
    /// Number of nodes.
    pub nodes: u64,
    /// β₂ of the time scheme.
    pub beta2: f64,
    /// Stiffness-proportional damping β_R \[s\].
    pub beta_r_s: f64,
    /// Mass-proportional damping α_R \[1/s\], which belongs to the case.
    #[serde(default)]
    pub alpha_r_per_s: f64,
    /// Time step as a fraction of the stability limit; none where the time step itself is given.
    pub safety_factor: Option<f64>,
    /// Largest simulated time \[s\] of the run.
    pub limit_s: f64,
    /// Whether the run stops once the state is periodic or has decayed.
    pub stop_early: bool,
    /// The last fraction of a run up to its time limit that is averaged.
    pub average_last_fraction: f64,
    /// Number of limit cycles that must repeat.
    pub cycles: usize,
    /// Largest spread of a per-cycle figure over these cycles.
    pub tolerance: f64,
    /// Largest drift of its mean between their first and second half.
    pub drift_tolerance: f64,
    /// Precision of the run.
    pub precision: String,
    /// What state the run starts from.
    pub start: String,
}

impl JobNumerics {
    /// The way in which the job is solved, in words.
    pub fn way(&self) -> String {
        format!("{}, from {}", self.precision, if self.start == "nested" { "a coarser mesh" } else { "rest" })
    }
}

/// The state of a job.
#[derive(Debug, Clone, PartialEq)]
pub enum RowState {
    /// It waits for a worker.
    Pending,
    /// It runs.
    Running,
    /// No study needs it any more.
    Cancelled,
    /// It ended without a result.
    Failed {
        /// The reason.
        error: String,
    },
    /// It has ended, and what is stored of it cannot be read.
    Unreadable {
        /// Why.
        reason: String,
    },
    /// It has a result.
    Done(Box<JobRecord>),
    /// It is no job but a point from a file, for comparison.
    Measured(Measurement),
}

impl JobRow {
    /// The name of the job's state in CSV: `pending`, `running`, `cancelled`, `failed`, `unreadable`, `measured` or the outcome of
    /// its run.
    pub fn status(&self) -> &'static str {
        match &self.state {
            RowState::Pending => "pending",
            RowState::Running => "running",
            RowState::Cancelled => "cancelled",
            RowState::Failed { .. } => "failed",
            RowState::Unreadable { .. } => "unreadable",
            RowState::Done(record) => record.outcome.name(),
            RowState::Measured(_) => "measured",
        }
    }

    /// The result, if there is one.
    pub fn record(&self) -> Option<&JobRecord> {
        match &self.state {
            RowState::Done(record) => Some(record),
            _ => None,
        }
    }

    /// The error that its mesh makes; none if there is no result, or if it is not known.
    pub fn mesh_error(&self) -> Option<MeshError> {
        self.record()?.mesh_error().ok()
    }

    /// Why what is stored of the job cannot be read; none if it can.
    pub fn unreadable(&self) -> Option<&str> {
        match &self.state {
            RowState::Unreadable { reason } => Some(reason),
            _ => None,
        }
    }

    /// Whether there is a result: of a job that is done, or a measured one.
    pub(super) fn has_result(&self) -> bool {
        matches!(self.state, RowState::Done(_) | RowState::Measured(_))
    }

    /// Whether the program added the job at a boundary between kinds of jobs. Such jobs are points of maps, and of no curve or table.
    pub(super) fn is_at_boundary(&self) -> bool {
        self.why.as_deref() == Some("boundary")
    }

    /// Whether it has a run that is not periodic.
    pub fn is_open(&self) -> bool {
        self.record().is_some_and(|record| record.outcome == Outcome::NotPeriodic)
    }

    /// Whether this is a measured point and no job.
    pub fn is_measured(&self) -> bool {
        matches!(self.state, RowState::Measured(_))
    }

    /// Whether it squeals: a limit cycle, or a mode that grows. None if nobody knows: a run that did not settle, a measured point
    /// without a frequency.
    pub fn squeals(&self) -> Option<bool> {
        match &self.state {
            RowState::Measured(measurement) => measurement.squeals,
            RowState::Done(record) => match record.outcome {
                Outcome::Periodic | Outcome::Unstable => Some(true),
                Outcome::Decayed => Some(false),
                Outcome::NotPeriodic | Outcome::Completed => None,
            },
            _ => None,
        }
    }

    /// The value of a parameter or the source; null where this job has no parameter of that name.
    pub fn parameter(&self, name: &str) -> Value {
        if name == SOURCE {
            return self.study.as_str().into();
        }
        self.parameters.get(name).cloned().unwrap_or_default()
    }
}
