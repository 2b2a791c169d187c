//! How long there has been nothing to do, and when to look again.

use std::time::{Duration, Instant};

/// Looked at first after so long …
const SOONEST: Duration = Duration::from_millis(250);

/// … and never later than this: hundreds of workers that wait must not keep a server busy.
const LATEST: Duration = Duration::from_secs(5);

/// The part of the time waited so far after which it is looked again.
const PART: u32 = 8;

/// Nothing to do.
#[derive(Debug, Default)]
pub struct Idle {
    since: Option<Instant>,
    look: Option<Instant>,
}

impl Idle {
    /// There is something to do.
    pub fn end(&mut self) {
        *self = Self::default();
    }

    /// There is nothing to do; whether it is time to look for more.
    pub fn is_due(&mut self) -> bool {
        self.is_due_at(Instant::now())
    }

    /// How long there has been nothing to do.
    pub fn lasts(&self) -> Duration {
        self.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    fn is_due_at(&mut self, now: Instant) -> bool {
        let since = *self.since.get_or_insert(now);
        let is_due = self.look.is_none_or(|look| now >= look);
        if is_due {
            self.look = Some(now + (now.duration_since(since) / PART).clamp(SOONEST, LATEST));
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: what comes soon is found soon, and who waits for an hour looks every few seconds.
    #[test]
    fn looks_become_rarer() {
        let begun = Instant::now();
        let looks = |idle: &mut Idle, from_s: u64, to_s: u64| {
            let ticks = (4 * from_s..4 * to_s).map(|tick| begun + Duration::from_millis(250 * tick));
            ticks.filter(|&now| idle.is_due_at(now)).count()
        };
        let mut idle = Idle::default();
        assert_eq!(looks(&mut idle, 0, 2), 8);
        looks(&mut idle, 2, 3600);
        assert_eq!(looks(&mut idle, 3600, 3700), 20);
        idle.end();
        assert!(idle.is_due_at(begun + Duration::from_hours(2)));
    }
}
