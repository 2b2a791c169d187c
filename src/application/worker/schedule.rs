//! When the state of a running job is stored.

use std::time::{Duration, Instant};

/// When checkpoints of one job are due, by its speed so far.
#[derive(Debug, Clone, Copy)]
pub struct CheckpointSchedule {
    /// Simulated time [s] after which the job ends at the latest.
    limit_s: f64,
    /// The first observation: when it was made, and the simulated time [s] then.
    first: Option<(Instant, f64)>,
    /// When the last checkpoint was due, or the job began.
    last: Instant,
}

impl CheckpointSchedule {
    /// The schedule of a job that simulates at most `limit_s`, and begins now.
    pub fn new(limit_s: f64) -> Self {
        Self { limit_s, first: None, last: Instant::now() }
    }

    /// Notes how far the job is.
    pub fn observe(&mut self, now: Instant, simulated_s: f64) {
        self.first.get_or_insert((now, simulated_s));
    }

    /// Whether the job is predicted to last two intervals or more, by its time limit.
    pub fn is_long(&self, now: Instant, simulated_s: f64, interval: Duration) -> bool {
        self.first.is_some_and(|(first, first_simulated_s)| {
            let wall_per_simulated =
                now.duration_since(first).as_secs_f64() / (simulated_s - first_simulated_s);
            // A job that has not advanced yet gives no finite number, and no prediction.
            wall_per_simulated.is_finite()
                && wall_per_simulated * self.limit_s >= 2.0 * interval.as_secs_f64()
        })
    }

    /// Whether a checkpoint is due. If so, the next interval begins.
    pub fn is_due(&mut self, now: Instant, simulated_s: f64, interval: Duration) -> bool {
        let is_due = now.duration_since(self.last) >= interval && self.is_long(now, simulated_s, interval);
        if is_due {
            self.last = now;
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a job that is predicted to last two intervals is stored at each interval, and a shorter one never; a
    /// job that has not advanced is not predicted.
    #[test]
    fn long_jobs_are_stored_at_each_interval() {
        let interval = Duration::from_secs(10);
        let begun = Instant::now();
        let at = |seconds: u64| begun + Duration::from_secs(seconds);
        for (limit_s, is_long) in [(1.9, false), (2.0, true), (200.0, true)] {
            let mut schedule = CheckpointSchedule { limit_s, first: None, last: begun };
            schedule.observe(begun, 0.5);
            assert!(!schedule.is_long(at(9), 0.5, interval));
            // A simulated second takes ten.
            let due: Vec<u64> =
                (1..=45).filter(|&s| schedule.is_due(at(s), 0.5 + s as f64 / 10.0, interval)).collect();
            assert_eq!(due, if is_long { vec![10, 20, 30, 40] } else { vec![] }, "limit {limit_s} s");
        }
    }
}
