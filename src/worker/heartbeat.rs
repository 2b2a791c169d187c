//! When to give a sign of life.

use std::time::{Duration, Instant};

/// A small part of a lease, so that a few missed ones cost none.
const INTERVAL: Duration = Duration::from_secs(15);

/// Says when the next heartbeat is due, by a clock that nobody sets.
#[derive(Debug)]
pub struct Heartbeat {
    last: Instant,
}

impl Heartbeat {
    /// The first one is due an interval from now.
    pub fn new() -> Self {
        Self { last: Instant::now() }
    }

    /// Whether it is time; if so, the next interval begins.
    pub fn is_due(&mut self) -> bool {
        let is_due = self.last.elapsed() >= INTERVAL;
        if is_due {
            self.last = Instant::now();
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::queue::Settings;

    /// Protects: a lease outlasts several heartbeats, with a database that is locked for as long as it may be.
    #[test]
    fn a_lease_outlasts_missed_heartbeats() {
        let Settings { lease, busy_timeout, .. } = Settings::default();
        assert!(lease >= 4 * INTERVAL + busy_timeout);
    }

    /// Protects: the first heartbeat is not due at once.
    #[test]
    fn the_first_one_is_not_due() {
        assert!(!Heartbeat::new().is_due());
    }
}
