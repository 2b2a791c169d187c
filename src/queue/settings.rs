use std::time::Duration;

/// The settings of a queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// How long to wait for a lock that another process holds.
    pub busy_timeout: Duration,
    /// How long a claimed job belongs to its owner without a heartbeat, if the owner's process is not visible.
    pub lease: Duration,
    /// A job fails after this many attempts in succession whose process died.
    pub crash_limit: u32,
}

impl Settings {
    /// The shortest useful lease. A shorter one would leave no time to wait for a busy database.
    pub const SHORTEST_LEASE: Duration = Duration::from_secs(5);

    /// These settings with another lease. The busy timeout is at most a quarter of the lease, so that a worker that
    /// waits for a lock does not lose its jobs.
    #[must_use]
    pub fn with_lease(self, lease: Duration) -> Self {
        Self { lease, busy_timeout: (lease / 4).min(Self::default().busy_timeout), ..self }
    }

    pub(super) fn lease_ms(self) -> i64 {
        i64::try_from(self.lease.as_millis()).unwrap_or(i64::MAX)
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            // Far longer than any transaction here, so that only a lock that somebody forgot ends in an error.
            busy_timeout: Duration::from_secs(30),
            // Several heartbeats fit into a lease, so that a slow disk does not end it.
            lease: Duration::from_mins(2),
            crash_limit: 3,
        }
    }
}
