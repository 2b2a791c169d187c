//! An estimate of the remaining time for jobs of different costs.
//!
//! The planner gives every job a relative cost: what it takes if it runs to its time limit. A job may take less,
//! because it ends when its limit cycle is found. So the finished jobs give a mean *and a spread* of seconds per
//! cost, and the estimate is a range.

use crate::units::duration_text;
use std::fmt;
use std::time::Duration;

/// A range for the remaining time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eta {
    /// Optimistic end of the range.
    pub low: Duration,
    /// Pessimistic end of the range.
    pub high: Duration,
}

impl Eta {
    /// Estimates the time that `remaining_jobs` with the total cost `remaining_cost` take on `threads` threads, from the
    /// cost and the duration \[s\] of finished jobs. `None` if fewer than three jobs have finished.
    pub fn estimate(
        finished: &[(f64, f64)],
        remaining_cost: f64,
        remaining_jobs: u64,
        threads: usize,
    ) -> Option<Self> {
        let rates: Vec<f64> =
            finished.iter().filter(|(cost, _)| *cost > 0.0).map(|(cost, wall_s)| wall_s / cost).collect();
        if rates.len() < 3 {
            return None;
        }
        let n = rates.len() as f64;
        let mean = rates.iter().sum::<f64>() / n;
        let variance = rates.iter().map(|rate| (rate - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let jobs = remaining_jobs.max(1) as f64;
        // The standard error of the mean is σ/√n, and the mean over the remaining jobs scatters by σ/√jobs.
        let uncertainty = 2.0 * (variance * (1.0 / n + 1.0 / jobs)).sqrt();
        let seconds = |rate: f64| {
            let wall_s = (rate.max(0.0) * remaining_cost / threads as f64).min(1.0e9);
            Duration::from_secs_f64(wall_s)
        };
        Some(Self { low: seconds(mean - uncertainty), high: seconds(mean + uncertainty) })
    }
}

impl fmt::Display for Eta {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = [self.low, self.high].map(|time| duration_text(time.as_secs_f64(), 0));
        if low == high { write!(f, "about {low}") } else { write!(f, "{low} to {high}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: equal jobs give a sharp estimate, and threads share the work.
    #[test]
    fn equal_jobs_give_a_single_time() {
        let finished = [(10.0, 2.0); 5];
        let eta = Eta::estimate(&finished, 400.0, 40, 2).unwrap();
        assert_eq!((eta.low, eta.high), (Duration::from_secs(40), Duration::from_secs(40)));
        assert_eq!(eta.to_string(), "about 40 s");
    }

    /// Protects: jobs of unequal rates give a range around the mean that narrows as more jobs finish.
    #[test]
    fn unequal_jobs_give_a_range() {
        let few = [(1.0, 1.0), (1.0, 3.0), (1.0, 2.0)];
        let many = few.repeat(20);
        let width = |finished: &[(f64, f64)]| {
            let eta = Eta::estimate(finished, 100.0, 100, 1).unwrap();
            assert!(eta.low < Duration::from_secs(200) && eta.high > Duration::from_secs(200));
            eta.high - eta.low
        };
        assert!(width(&many) < width(&few));
    }

    /// Protects: two finished jobs give no estimate.
    #[test]
    fn two_jobs_give_no_estimate() {
        assert_eq!(Eta::estimate(&[(1.0, 1.0), (1.0, 1.0)], 10.0, 10, 1), None);
    }
}
