//! How many jobs a worker finishes per second.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// A longer window would include work that says little about the present; a shorter one would contain too few long
/// jobs.
const WINDOW: Duration = Duration::from_mins(10);

/// Counts the jobs that a worker finishes.
#[derive(Debug, Clone)]
pub(super) struct Throughput {
    finished: i64,
    /// The times at which the throughput was asked for, and the number of finished jobs at those times.
    samples: VecDeque<(Instant, i64)>,
}

impl Throughput {
    pub fn new() -> Self {
        Self { finished: 0, samples: VecDeque::from([(Instant::now(), 0)]) }
    }

    /// Adds finished jobs.
    pub fn add(&mut self, jobs: usize) {
        self.finished += i64::try_from(jobs).unwrap_or(i64::MAX);
    }

    /// All jobs that were finished.
    pub fn finished(&self) -> i64 {
        self.finished
    }

    /// Jobs per second in the last [`WINDOW`].
    pub fn jobs_per_s(&mut self) -> f64 {
        self.jobs_per_s_at(Instant::now())
    }

    fn jobs_per_s_at(&mut self, now: Instant) -> f64 {
        // The newest sample that is older than the window stays, so that the samples span the whole window.
        while self.samples.get(1).is_some_and(|&(then, _)| now.duration_since(then) >= WINDOW) {
            self.samples.pop_front();
        }
        let (since, before) = self.samples[0];
        self.samples.push_back((now, self.finished));
        let seconds = now.duration_since(since).as_secs_f64();
        if seconds > 0.0 { (self.finished - before) as f64 / seconds } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the throughput is that of the last ten minutes, from the first question on, and it falls to zero when
    /// nothing is finished for that long.
    #[test]
    fn the_throughput_is_that_of_the_window() {
        let mut throughput = Throughput::new();
        let begun = throughput.samples[0].0;
        let mut at = |minutes: u64, jobs: usize| {
            throughput.add(jobs);
            throughput.jobs_per_s_at(begun + Duration::from_mins(minutes))
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
