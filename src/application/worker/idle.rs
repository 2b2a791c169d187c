//! How long there has been no job, and when to look for jobs again.

use std::time::{Duration, Instant};

/// Shortest time between two polls.
const SHORTEST_PAUSE: Duration = Duration::from_millis(250);

/// Longest time between two polls. It is not shorter because hundreds of idle workers must not keep a server busy.
const LONGEST_PAUSE: Duration = Duration::from_secs(5);

/// In between, the pause is the idle time so far divided by this.
const PAUSE_DIVISOR: u32 = 8;

/// A worker's idle time and its next poll.
#[derive(Debug, Default)]
pub struct IdleTimer {
    since: Option<Instant>,
    next_poll: Option<Instant>,
}

impl IdleTimer {
    /// The worker has a job again.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Called while the worker has no job: whether to look for jobs now. If so, the next pause begins.
    pub fn is_poll_due(&mut self) -> bool {
        self.is_poll_due_at(Instant::now())
    }

    /// How long the worker has been idle.
    pub fn elapsed(&self) -> Duration {
        self.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    fn is_poll_due_at(&mut self, now: Instant) -> bool {
        let since = *self.since.get_or_insert(now);
        let is_due = self.next_poll.is_none_or(|next| now >= next);
        if is_due {
            let pause = now.duration_since(since) / PAUSE_DIVISOR;
            self.next_poll = Some(now + pause.clamp(SHORTEST_PAUSE, LONGEST_PAUSE));
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a worker that has just become idle polls often, and one that has been idle for an hour every few
    /// seconds.
    #[test]
    fn polls_become_rarer() {
        let begun = Instant::now();
        let polls = |idle: &mut IdleTimer, from_s: u64, to_s: u64| {
            let ticks = (4 * from_s..4 * to_s).map(|tick| begun + Duration::from_millis(250 * tick));
            ticks.filter(|&now| idle.is_poll_due_at(now)).count()
        };
        let mut idle = IdleTimer::default();
        assert_eq!(polls(&mut idle, 0, 2), 8);
        polls(&mut idle, 2, 3600);
        assert_eq!(polls(&mut idle, 3600, 3700), 20);
        idle.reset();
        assert!(idle.is_poll_due_at(begun + Duration::from_hours(2)));
    }
}
