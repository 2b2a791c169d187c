use super::error::QueueError;
use serde::Serialize;

/// The state of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum JobState {
    /// The job waits to be claimed.
    Pending,
    /// A worker has claimed the job. It is running, unless the worker's process has died.
    Running,
    /// The job ended with a record.
    Done,
    /// The job ended with an error.
    Failed,
    /// No study requests the job any more.
    Cancelled,
}

impl JobState {
    /// The name in the database and in output.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Pending => "pending",
            Self::Running => "running",
            Self::Done => "done",
            Self::Failed => "failed",
            Self::Cancelled => "cancelled",
        }
    }

    /// The state that the table has. Its CHECK constraint allows no other one, but a damaged page or an editor may.
    pub(super) fn from_column(name: &str) -> Result<Self, QueueError> {
        Ok(match name {
            "pending" => Self::Pending,
            "running" => Self::Running,
            "done" => Self::Done,
            "failed" => Self::Failed,
            "cancelled" => Self::Cancelled,
            other => {
                let other: String = other.escape_debug().take(40).collect();
                return Err(QueueError::Inconsistent(format!(
                    "a job has the state `{other}`, and there is no such state"
                )));
            }
        })
    }
}
