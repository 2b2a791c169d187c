//! An estimate of the remaining time for jobs of different costs.
//!
//! The planner gives every job a cost: steps times nodes, up to the time at which it is likely to end. A job may take less or
//! more. So the finished jobs give a mean *and a spread* of seconds per cost, and the estimate is a range. Before any job has
//! finished, the estimate is what was expected; each finished job makes the expectation count less. Jobs without a run have no cost:
//! nothing is expected of them before one has finished, and then half to twice its time.

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

/// The jobs that are left.
#[derive(Debug, Clone, Copy)]
pub struct Left {
    /// Number of jobs.
    pub jobs: u64,
    /// Their total cost; 0 if none of them has a run.
    pub cost: f64,
    /// The part of the cost that is done already.
    pub begun: f64,
}

/// Seconds of the next job without a cost, over the mean of those that have finished.
const UNKNOWN_JOB: [f64; 2] = [0.5, 2.0];

impl Eta {
    /// Estimates the time that jobs take on `threads` threads, from the cost and the duration \[s\] of finished jobs, and from the range of
    /// seconds per cost that was expected before. Returns `None` if nothing is known of jobs without a cost. Beside others they
    /// do not count.
    pub fn estimate(
        finished: &[(f64, f64)],
        expected_s_per_cost: [f64; 2],
        left: Left,
        threads: usize,
    ) -> Option<Self> {
        let has_cost = left.cost > 0.0;
        let alike = finished.iter().filter(|(cost, _)| (*cost > 0.0) == has_cost);
        let mut rates: Vec<(f64, f64)> =
            alike.map(|(cost, wall_s)| (if has_cost { wall_s / cost } else { *wall_s }, 1.0)).collect();
        if left.jobs == 0 {
            return Some(Self::range(0.0, 0.0, 0.0));
        }
        let ([low, high], amount) = if has_cost {
            (expected_s_per_cost, (left.cost - left.begun).max(0.0))
        } else if rates.is_empty() {
            return None;
        } else {
            let mean_s = rates.iter().map(|(wall_s, _)| wall_s).sum::<f64>() / rates.len() as f64;
            (UNKNOWN_JOB.map(|factor| factor * mean_s), left.jobs as f64)
        };
        let amount = amount / threads as f64;
        if rates.is_empty() {
            return Some(Self::range(low, high, amount));
        }
        // The expectation counts like three jobs, and less with each job that has finished.
        let weight = 1.0 / (1.0 + rates.len() as f64);
        rates.extend([low, (low * high).sqrt(), high].map(|rate| (rate, weight)));
        let n: f64 = rates.iter().map(|(_, weight)| weight).sum();
        let mean = rates.iter().map(|(rate, weight)| rate * weight).sum::<f64>() / n;
        let variance =
            rates.iter().map(|(rate, weight)| (rate - mean).powi(2) * weight).sum::<f64>() / (n - 1.0);
        // The standard error of the mean is σ/√n, and the mean over the remaining jobs scatters by σ/√jobs.
        let uncertainty = 2.0 * (variance * (1.0 / n + 1.0 / left.jobs as f64)).sqrt();
        Some(Self::range(mean - uncertainty, mean + uncertainty, amount))
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

    fn left(jobs: u64, cost: f64) -> Left {
        Left { jobs, cost, begun: 0.0 }
    }

    /// Protects: equal jobs as expected give a sharp estimate, and threads share the work.
    #[test]
    fn equal_jobs_give_a_single_time() {
        let finished = [(10.0, 2.0); 5];
        let eta = Eta::estimate(&finished, [0.2, 0.2], left(40, 400.0), 2).unwrap();
        assert_eq!((eta.low.as_millis(), eta.high.as_millis()), (40_000, 40_000));
        assert_eq!(Eta { high: eta.low, ..eta }.to_string(), "about 40 s");
    }

    /// Protects: jobs of unequal rates give a range around the mean that narrows as more jobs finish.
    #[test]
    fn unequal_jobs_give_a_range() {
        let few = [(1.0, 1.0), (1.0, 3.0), (1.0, 2.0)];
        let many = few.repeat(20);
        let width = |finished: &[(f64, f64)]| {
            let eta = Eta::estimate(finished, [1.0, 4.0], left(100, 100.0), 1).unwrap();
            assert!(eta.low < Duration::from_secs(200) && eta.high > Duration::from_secs(200));
            eta.high - eta.low
        };
        assert!(width(&many) < width(&few));
    }

    /// Protects: before a job has finished the estimate is the expected range, and a wrong expectation is forgotten as jobs
    /// finish.
    #[test]
    fn an_expectation_counts_until_jobs_have_finished() {
        let eta =
            |finished: &[(f64, f64)]| Eta::estimate(finished, [0.5, 4.0], left(1000, 100.0), 1).unwrap();
        let seconds = |eta: Eta| [eta.low, eta.high].map(|time| time.as_secs_f64());
        assert_eq!(seconds(eta(&[])), [50.0, 400.0]);
        let [low, high] = seconds(eta(&[(1.0, 0.01)]));
        assert!(low < 1.0 && high > 200.0, "{low} {high}");
        let [low, high] = seconds(eta(&[(1.0, 0.01); 300]));
        assert!(low <= 1.0 && high < 10.0, "{low} {high}");
    }

    /// Protects: of jobs without a cost nothing is said before one of them has finished, whatever others took. Then their times count,
    /// and those of others do not.
    #[test]
    fn jobs_without_a_cost_are_known_by_each_other() {
        let eta = |finished: &[(f64, f64)]| Eta::estimate(finished, [0.5, 4.0], left(10, 0.0), 2);
        assert_eq!(eta(&[]), None);
        assert_eq!(eta(&[(1.0, 500.0)]), None);
        let seconds = |eta: Eta| [eta.low, eta.high].map(|time| time.as_secs_f64());
        let [low, high] = seconds(eta(&[(0.0, 30.0), (1.0, 500.0)]).unwrap());
        assert!(low < 150.0 && 150.0 < high && high < 600.0, "{low} {high}");
        let [low, high] = seconds(eta(&[(0.0, 30.0); 100]).unwrap());
        assert!(low > 140.0 && high < 160.0, "{low} {high}");
        assert_eq!(seconds(Eta::estimate(&[], [0.5, 4.0], left(0, 0.0), 2).unwrap()), [0.0, 0.0]);
        // A run that has begun is no job without a cost.
        let begun = Left { begun: 5.0, ..left(1, 5.0) };
        assert_eq!(seconds(Eta::estimate(&[], [0.5, 4.0], begun, 2).unwrap()), [0.0, 0.0]);
    }
}
