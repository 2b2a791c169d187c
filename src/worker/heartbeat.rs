//! When to give a sign of life.

use std::time::{Duration, Instant};

/// A small part of a lease, so that a few missed ones cost none.
const PART_OF_LEASE: u32 = 8;

/// Says when the next heartbeat is due, by a clock that nobody sets.
#[derive(Debug)]
pub struct Heartbeat {
    interval: Duration,
    due: Instant,
}

impl Heartbeat {
    /// The first one is due an interval from now.
    pub fn new(lease: Duration) -> Self {
        let interval = lease / PART_OF_LEASE;
        Self { interval, due: Instant::now() + interval }
    }

    /// Whether it is time.
    pub fn is_due(&self) -> bool {
        Instant::now() >= self.due
    }

    /// It was given: the next interval begins. One that could not be given stays due.
    pub fn is_given(&mut self) {
        self.due = Instant::now() + self.interval;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::queue::Settings;

    /// Protects: a lease outlasts several heartbeats, with a database that is locked for as long as it may be.
    #[test]
    fn a_lease_outlasts_missed_heartbeats() {
        for lease in [Settings::default().lease, Settings::SHORTEST_LEASE, Duration::from_hours(1)] {
            let Settings { lease, busy_timeout, .. } = Settings::default().with_lease(lease);
            assert!(lease >= 4 * Heartbeat::new(lease).interval + busy_timeout);
        }
    }

    /// Protects: the first heartbeat is not due at once, and one that was not given stays due.
    #[test]
    fn what_is_due_stays_due() {
        assert!(!Heartbeat::new(Duration::from_mins(2)).is_due());
        let mut overdue = Heartbeat::new(Duration::ZERO);
        assert!(overdue.is_due() && overdue.is_due());
        overdue.interval = Duration::from_mins(1);
        overdue.is_given();
        assert!(!overdue.is_due());
    }
}
