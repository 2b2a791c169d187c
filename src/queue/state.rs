/// Where a job is in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum JobState {
    /// Waits to be claimed.
    Pending,
    /// Claimed by a process, and running there unless that process died.
    Running,
    /// Ended with a record.
    Done,
    /// Ended with an error.
    Failed,
    /// Not wanted any more by any study.
    Cancelled,
}

impl JobState {
    /// The name used in the database and in output.
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
            other => unreachable!("the table's CHECK admits no state `{other}`"),
        }
    }
}
