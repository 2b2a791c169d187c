//! When the next heartbeat is due.

use std::time::{Duration, Instant};

/// Heartbeats per lease: the lease outlasts a few missed ones.
const PER_LEASE: u32 = 8;

/// Says when the next heartbeat is due, by the monotonic clock.
#[derive(Debug)]
pub struct Heartbeat {
    interval: Duration,
    due: Instant,
}

impl Heartbeat {
    /// The first one is due an interval from now.
    pub fn new(lease: Duration) -> Self {
        let interval = lease / PER_LEASE;
        Self { interval, due: Instant::now() + interval }
    }

    /// Whether a heartbeat is due.
    pub fn is_due(&self) -> bool {
        Instant::now() >= self.due
    }

    /// Begins the next interval. Without this call a heartbeat stays due.
    pub fn mark_sent(&mut self) {
        self.due = Instant::now() + self.interval;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::queue::Settings;

    /// Protects: a lease outlasts several heartbeats, even while the database is locked for the busy timeout.
    #[test]
    fn a_lease_outlasts_missed_heartbeats() {
        for lease in [Settings::default().lease, Settings::SHORTEST_LEASE, Duration::from_hours(1)] {
            let Settings { lease, busy_timeout, .. } = Settings::default().with_lease(lease);
            assert!(lease >= 4 * Heartbeat::new(lease).interval + busy_timeout);
        }
    }

    /// Protects: the first heartbeat is not due at once, and one that was not sent stays due.
    #[test]
    fn unsent_heartbeats_stay_due() {
        assert!(!Heartbeat::new(Duration::from_mins(2)).is_due());
        let mut overdue = Heartbeat::new(Duration::ZERO);
        assert!(overdue.is_due() && overdue.is_due());
        overdue.interval = Duration::from_mins(1);
        overdue.mark_sent();
        assert!(!overdue.is_due());
    }
}
