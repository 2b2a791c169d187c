//! How fast a worker is.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// What was longer ago says little of now; what is shorter says little of long jobs.
const WINDOW: Duration = Duration::from_mins(10);

/// Counts what a worker finishes.
#[derive(Debug, Clone)]
pub(super) struct Pace {
    finished: i64,
    /// When it was asked for, and what had been finished then.
    asked: VecDeque<(Instant, i64)>,
}

impl Pace {
    pub fn new() -> Self {
        Self { finished: 0, asked: VecDeque::from([(Instant::now(), 0)]) }
    }

    /// So many more jobs are finished.
    pub fn count(&mut self, jobs: usize) {
        self.finished += i64::try_from(jobs).unwrap_or(i64::MAX);
    }

    /// All jobs that were finished.
    pub fn finished(&self) -> i64 {
        self.finished
    }

    /// Jobs a second, lately.
    pub fn jobs_per_s(&mut self) -> f64 {
        self.jobs_per_s_at(Instant::now())
    }

    fn jobs_per_s_at(&mut self, now: Instant) -> f64 {
        // One that is older than the window stays, so that the window is full.
        while self.asked.get(1).is_some_and(|&(then, _)| now.duration_since(then) >= WINDOW) {
            self.asked.pop_front();
        }
        let (since, before) = self.asked[0];
        self.asked.push_back((now, self.finished));
        let seconds = now.duration_since(since).as_secs_f64();
        if seconds > 0.0 { (self.finished - before) as f64 / seconds } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the pace is that of the last minutes, from the first question on, and falls to nothing when nothing is
    /// finished for that long.
    #[test]
    fn the_pace_is_the_latest() {
        let mut pace = Pace::new();
        let begun = pace.asked[0].0;
        let mut at = |minutes: u64, jobs: usize| {
            pace.count(jobs);
            pace.jobs_per_s_at(begun + Duration::from_mins(minutes))
        };
        assert_eq!(at(1, 60), 1.0);
        assert_eq!(at(2, 180), 2.0);
        for minute in 3..=12 {
            at(minute, 30);
        }
        assert_eq!(at(13, 30), 0.5);
        for minute in 14..=22 {
            assert!(at(minute, 0) > 0.0);
        }
        assert_eq!(at(23, 0), 0.0);
    }
}
