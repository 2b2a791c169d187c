use std::time::Duration;

/// How a worker works.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WorkOptions {
    /// Number of threads.
    pub threads: usize,
    /// How often a running job's state is kept; never if none. Only jobs that are predicted to last two intervals or
    /// more, by their time limit, are kept at all.
    pub checkpoint_interval: Option<Duration>,
    /// How long to stay when there is nothing to do here, for jobs that may come; then what others run is left to them.
    /// Without, the end of all jobs is the end.
    pub idle_exit: Option<Duration>,
}

impl WorkOptions {
    /// A checkpoint costs milliseconds, and losing a minute's work little more.
    pub const CHECKPOINT_INTERVAL: Duration = Duration::from_mins(1);

    /// So many threads, all else as usual.
    pub fn new(threads: usize) -> Self {
        Self { threads, checkpoint_interval: Some(Self::CHECKPOINT_INTERVAL), idle_exit: None }
    }
}
