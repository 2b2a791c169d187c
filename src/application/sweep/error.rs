//! What can go wrong in a sweep.

use super::measured::MeasuredError;
use crate::analysis::JobError;
use crate::publish::PublishError;
use crate::queue::{Location, QueueError};
use crate::study::{StudyError, Warning};
use crate::worker::WorkError;
use thiserror::Error;

/// Why a step of a sweep failed. The text says what to do about it where something can be done.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A file of measured points that a calibration cannot use.
    #[error("{0}")]
    CalibrationData(String),
    /// The study or the selection of one of its jobs.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A job of the study would be refused before its first step.
    #[error("{}{source_name}: {reason}{}{}", causes(.doubts), at(.point, *.jobs, *.of), lines(.doubts))]
    RefusedJob {
        /// The study's file as given.
        source_name: String,
        /// Why the job is refused.
        reason: Box<JobError>,
        /// Grid parameters of the job as `name = value`, with commas between them; empty without a grid.
        point: String,
        /// Number of jobs that are refused.
        jobs: usize,
        /// Number of all jobs.
        of: usize,
        /// What is doubtful about the study, and may be the reason.
        doubts: Vec<Warning>,
    },
    /// The database.
    #[error(transparent)]
    Queue(#[from] QueueError),
    /// The worker.
    #[error(transparent)]
    Work(#[from] WorkError),
    /// A report or a comparison could not be written.
    #[error(transparent)]
    Publish(#[from] PublishError),
    /// A study cannot have this name.
    #[error("`{name}` is no name for a study: {reason}")]
    BadName {
        /// The name as given.
        name: String,
        /// Why no study can have it.
        reason: String,
    },
    /// The database is both the source and the target of a transfer.
    #[error("{0} is both what is read and what is written; give two databases")]
    SameDatabase(Location),
    /// No job has a key that begins with the given characters.
    #[error("no job{} has a key that begins with `{prefix}`; {advice}", of(.study.as_deref()))]
    NoSuchJob {
        /// The study that was searched; absent if it was the whole database.
        study: Option<String>,
        /// The given characters.
        prefix: String,
        /// How to name a job.
        advice: &'static str,
    },
    /// Several jobs have keys that begin with the given characters.
    #[error(
        "several jobs{} have keys that begin with `{prefix}`: {}, {}, …; give more of the key",
        of(.study.as_deref()), .keys[0], .keys[1]
    )]
    AmbiguousJob {
        /// The study that was searched; absent if it was the whole database.
        study: Option<String>,
        /// The given characters.
        prefix: String,
        /// Keys of the first two of these jobs.
        keys: [String; 2],
    },
    /// Something in the database that this version cannot read.
    #[error(
        "{subject}: another version of tribosweep wrote the {what}, or they are damaged ({reason}); submit the study again, \
         which writes them anew, or submit it to a new database"
    )]
    Unreadable {
        /// The job or study.
        subject: String,
        /// The part that cannot be read.
        what: &'static str,
        /// Why it cannot be read.
        reason: serde_json::Error,
    },
    /// A value cannot be written as JSON.
    #[error("cannot write a job as JSON: {0}")]
    Encode(serde_json::Error),
    /// A file of measured points.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// An axis or a quantity of a report that does not exist.
    #[error("{option} {name}: {message}")]
    NoSuchAxis {
        /// The option: `--x`, `--by` or `--y`.
        option: &'static str,
        /// The name as given.
        name: String,
        /// What is wrong and which names there are.
        message: String,
    },
    /// A study that grows is to be divided between databases.
    #[error(
        "a study with `refine`, `continue` or `calibrate` cannot be divided into shards: its next jobs depend on the results of all"
    )]
    GrowingShard,
    /// A source of a comparison is given twice.
    #[error("{0} is given twice; expected different studies and files")]
    RepeatedSource(String),
    /// The output of an export cannot be written.
    #[error("cannot write the export: {0}")]
    Output(std::io::Error),
    /// The asynchronous runtime of [`block_on`](super::block_on) cannot be started.
    #[error("cannot start the runtime for the database: {0}")]
    Runtime(std::io::Error),
}

impl SweepError {
    /// A refused job with what is doubtful about its study.
    pub(super) fn with_doubts(mut self, found: Vec<Warning>) -> Self {
        if let Self::RefusedJob { doubts, .. } = &mut self {
            *doubts = found;
        }
        self
    }
}

fn at(point: &str, jobs: usize, of: usize) -> String {
    match (point, jobs) {
        ("", _) => String::new(),
        (point, 1) => format!(" (at {point})"),
        (point, jobs) => format!(" (in {jobs} of {of} jobs, first at {point})"),
    }
}

/// A value that looks like another unit is the likely reason, so that it comes before what follows from it.
fn is_cause(doubt: &Warning) -> bool {
    doubt.kind == "unit"
}

/// A line for each likely reason.
fn causes(doubts: &[Warning]) -> String {
    doubts.iter().filter(|doubt| is_cause(doubt)).map(|cause| cause.to_string() + "\n").collect()
}

/// A line for each other warning.
fn lines(doubts: &[Warning]) -> String {
    let others = doubts.iter().filter(|doubt| !is_cause(doubt));
    others.fold(String::new(), |text, warning| text + "\nwarning: " + &warning.to_string())
}

fn of(study: Option<&str>) -> String {
    study.map_or_else(String::new, |name| format!(" of {name}"))
}
