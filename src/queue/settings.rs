use std::time::Duration;

/// What may differ from one use of a queue to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// How long to wait for a lock that another process holds.
    pub busy_timeout: Duration,
    /// How long a claimed job stays its owner's without a sign of life, where nothing better is known.
    pub lease: Duration,
    /// A job whose process died so many times in a row is not tried again.
    pub crash_limit: u32,
}

impl Settings {
    /// A shorter one would leave no time for a database that is busy.
    pub const SHORTEST_LEASE: Duration = Duration::from_secs(5);

    /// With another lease. Who waits for a lock waits for no more than a part of it, so that the lease lasts.
    #[must_use]
    pub fn with_lease(self, lease: Duration) -> Self {
        Self { lease, busy_timeout: (lease / 4).min(Self::default().busy_timeout), ..self }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            // Far longer than any transaction here, so that only a lock somebody forgot ends in an error.
            busy_timeout: Duration::from_secs(30),
            // Several heartbeats, so that a slow disk costs none.
            lease: Duration::from_mins(2),
            crash_limit: 3,
        }
    }
}
