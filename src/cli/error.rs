//! What ends a command, beyond the failure of a job.

use crate::publish::PublishError;
use crate::queue::QueueError;
use crate::study::StudyError;
use crate::worker::WorkError;
use thiserror::Error;

/// Bad input or an environment that does not let the command do its work.
#[derive(Debug, Error)]
pub enum CliError {
    /// The study file.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Arguments that do not go together.
    #[error("{0}")]
    Usage(String),
    /// The study cannot be simulated as it is.
    #[error("{0}")]
    Plan(String),
    /// The database.
    #[error(transparent)]
    Queue(#[from] QueueError),
    /// The worker.
    #[error(transparent)]
    Work(#[from] WorkError),
    /// A report or a look into a job.
    #[error(transparent)]
    Publish(#[from] PublishError),
    /// A file that cannot be written or read.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: String,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// Standard output.
    #[error("cannot write to standard output: {0}")]
    Output(#[from] std::io::Error),
    /// Something in the database that this version cannot read.
    #[error("{0}")]
    Unreadable(String),
}
