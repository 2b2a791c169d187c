//! The errors that end a command. The failure of a job is not one of them.

use crate::publish::PublishError;
use crate::queue::QueueError;
use crate::study::StudyError;
use crate::sweep::SweepError;
use crate::worker::WorkError;
use thiserror::Error;

/// Why a command cannot do its work: bad input, or something in its environment.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// A step of the sweep.
    #[error(transparent)]
    Sweep(SweepError),
    /// The study or the selection of one of its jobs.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Arguments that do not go together or have no meaning.
    #[error("{0}")]
    Usage(String),
    /// The command cannot be carried out for this study or job.
    #[error("{0}")]
    Refused(String),
    /// The database.
    #[error(transparent)]
    Queue(#[from] QueueError),
    /// The worker.
    #[error(transparent)]
    Work(#[from] WorkError),
    /// A report or an inspection could not be written.
    #[error(transparent)]
    Publish(#[from] PublishError),
    /// A file that cannot be written or read.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: String,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// Standard output cannot be written.
    #[error("cannot write to standard output: {0}")]
    Output(#[from] std::io::Error),
    /// A result cannot be written as JSON.
    #[error("cannot write the result as JSON: {0}")]
    Encode(#[from] serde_json::Error),
}

impl From<SweepError> for CliError {
    fn from(error: SweepError) -> Self {
        // The output of an export is standard output or a file. The caller knows which file.
        if let SweepError::Output(source) = error { Self::Output(source) } else { Self::Sweep(error) }
    }
}

impl CliError {
    /// An error of the file at `path`.
    pub(crate) fn file(path: &std::path::Path, source: std::io::Error) -> Self {
        Self::File { path: path.display().to_string(), source }
    }
}
