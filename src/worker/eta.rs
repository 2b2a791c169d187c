//! An estimate of the remaining time for jobs of different costs.
//!
//! The planner gives every job a cost: steps times nodes, up to the time at which it is likely to end. A job may take less or
//! more. So the finished jobs give a mean *and a spread* of seconds per cost, and the estimate is a range. Before any job has
//! finished, the estimate is what was expected; each finished job makes the expectation count less.

use crate::units::{as_seconds, duration_text};
use serde::Serialize;
use std::fmt;
use std::time::Duration;

/// A range for the remaining time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Eta {
    /// Optimistic end of the range.
    #[serde(serialize_with = "as_seconds")]
    pub low: Duration,
    /// Pessimistic end of the range.
    #[serde(serialize_with = "as_seconds")]
    pub high: Duration,
}

impl Eta {
    /// Estimates the time that `remaining_jobs` with the total cost `remaining_cost` take on `threads` threads, from the
    /// cost and the duration \[s\] of finished jobs, and from the range of seconds per cost that was expected before.
    pub fn estimate(
        finished: &[(f64, f64)],
        expected_s_per_cost: [f64; 2],
        remaining_cost: f64,
        remaining_jobs: u64,
        threads: usize,
    ) -> Self {
        let mut rates: Vec<(f64, f64)> = finished
            .iter()
            .filter(|(cost, _)| *cost > 0.0)
            .map(|(cost, wall_s)| (wall_s / cost, 1.0))
            .collect();
        let [low, high] = expected_s_per_cost;
        if rates.is_empty() {
            return Self::range(low, high, remaining_cost / threads as f64);
        }
        // The expectation counts like three jobs, and less with each job that has finished.
        let weight = 1.0 / (1.0 + rates.len() as f64);
        rates.extend([low, (low * high).sqrt(), high].map(|rate| (rate, weight)));
        let n: f64 = rates.iter().map(|(_, weight)| weight).sum();
        let mean = rates.iter().map(|(rate, weight)| rate * weight).sum::<f64>() / n;
        let variance =
            rates.iter().map(|(rate, weight)| (rate - mean).powi(2) * weight).sum::<f64>() / (n - 1.0);
        let jobs = remaining_jobs.max(1) as f64;
        // The standard error of the mean is σ/√n, and the mean over the remaining jobs scatters by σ/√jobs.
        let uncertainty = 2.0 * (variance * (1.0 / n + 1.0 / jobs)).sqrt();
        Self::range(mean - uncertainty, mean + uncertainty, remaining_cost / threads as f64)
    }

    fn range(low_s: f64, high_s: f64, cost: f64) -> Self {
        let [low, high] =
            [low_s, high_s].map(|rate| Duration::from_secs_f64((rate.max(0.0) * cost).clamp(0.0, 1.0e9)));
        Self { low, high }
    }
}

/// Seconds of a thread per cost of a job that a machine of today takes, as a range.
pub const TYPICAL_S_PER_COST: [f64; 2] = [1.5e-9, 2.0e-8];

impl fmt::Display for Eta {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = [self.low, self.high].map(|time| duration_text(time.as_secs_f64(), 0));
        if low == high { write!(f, "about {low}") } else { write!(f, "{low} to {high}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: equal jobs as expected give a sharp estimate, and threads share the work.
    #[test]
    fn equal_jobs_give_a_single_time() {
        let finished = [(10.0, 2.0); 5];
        let eta = Eta::estimate(&finished, [0.2, 0.2], 400.0, 40, 2);
        assert_eq!((eta.low.as_millis(), eta.high.as_millis()), (40_000, 40_000));
        assert_eq!(Eta { high: eta.low, ..eta }.to_string(), "about 40 s");
    }

    /// Protects: jobs of unequal rates give a range around the mean that narrows as more jobs finish.
    #[test]
    fn unequal_jobs_give_a_range() {
        let few = [(1.0, 1.0), (1.0, 3.0), (1.0, 2.0)];
        let many = few.repeat(20);
        let width = |finished: &[(f64, f64)]| {
            let eta = Eta::estimate(finished, [1.0, 4.0], 100.0, 100, 1);
            assert!(eta.low < Duration::from_secs(200) && eta.high > Duration::from_secs(200));
            eta.high - eta.low
        };
        assert!(width(&many) < width(&few));
    }

    /// Protects: before a job has finished the estimate is the expected range, and a wrong expectation is forgotten as jobs
    /// finish.
    #[test]
    fn an_expectation_counts_until_jobs_have_finished() {
        let eta = |finished: &[(f64, f64)]| Eta::estimate(finished, [0.5, 4.0], 100.0, 1000, 1);
        let seconds = |eta: Eta| [eta.low, eta.high].map(|time| time.as_secs_f64());
        assert_eq!(seconds(eta(&[])), [50.0, 400.0]);
        let [low, high] = seconds(eta(&[(1.0, 0.01)]));
        assert!(low < 1.0 && high > 200.0, "{low} {high}");
        let [low, high] = seconds(eta(&[(1.0, 0.01); 300]));
        assert!(low <= 1.0 && high < 10.0, "{low} {high}");
    }
}
