//! What can go wrong in a sweep.

use crate::publish::PublishError;
use crate::queue::{Location, QueueError};
use crate::solver::SolverError;
use crate::study::StudyError;
use crate::worker::WorkError;
use thiserror::Error;

/// Why a step of a sweep failed. The text says what to do about it where something can be done.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The study or the selection of one of its jobs.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The solver refuses a job of the study before its first step.
    #[error("{source_name}: {reason}{}", at(.point))]
    RefusedJob {
        /// The study's file as given.
        source_name: String,
        /// Why the solver refuses the job.
        reason: Box<SolverError>,
        /// Grid parameters of the job as `name = value`, with commas between them; empty without a grid.
        point: String,
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
        "{subject}: another version of tribosweep wrote the {what} ({reason}); submit the study to a new database"
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
    /// The output of an export cannot be written.
    #[error("cannot write the export: {0}")]
    Output(std::io::Error),
    /// The asynchronous runtime of [`block_on`](super::block_on) cannot be started.
    #[error("cannot start the runtime for the database: {0}")]
    Runtime(std::io::Error),
}

fn at(point: &str) -> String {
    if point.is_empty() { String::new() } else { format!(" (at {point})") }
}

fn of(study: Option<&str>) -> String {
    study.map_or_else(String::new, |name| format!(" of {name}"))
}
