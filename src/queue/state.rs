/// The state of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
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

    pub(super) fn from_column(name: &str) -> Self {
        match name {
            "pending" => Self::Pending,
            "running" => Self::Running,
            "done" => Self::Done,
            "failed" => Self::Failed,
            "cancelled" => Self::Cancelled,
            other => unreachable!("the table's CHECK constraint excludes the state `{other}`"),
        }
    }
}
