//! An estimate of the remaining time for jobs of different costs.
//!
//! The planner gives every job a cost: steps times nodes, up to the time at which it is likely to end. A job may take less or
//! more. So the finished jobs give a mean *and a spread* of seconds per cost, and the estimate is a range. Before any job has
//! finished, the estimate is what was expected; each finished job makes the expectation count less. Jobs without a run have no cost.
//! Their time is unknown until one of them has finished. Then each is expected to take half to twice the mean of those.

use crate::queue::{Counts, Remaining};
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
    /// Number of jobs with a cost.
    pub with_cost: u64,
    /// Their total cost.
    pub cost: f64,
    /// The part of the cost that is done already.
    pub begun: f64,
    /// Number of jobs without a cost.
    pub without_cost: u64,
}

impl Left {
    /// The jobs that are pending or running, by their `counts`, their costs, and the part of the costs that is done already.
    pub fn new(counts: Counts, remaining: Remaining, begun: f64) -> Self {
        let Remaining { cost, without_cost } = remaining;
        let with_cost = (counts.pending + counts.running).saturating_sub(without_cost);
        Self { with_cost, cost, begun, without_cost }
    }
}

/// Seconds of a job without a cost, over the mean of those that have finished: the range that is expected.
const NEXT_OVER_MEAN: [f64; 2] = [0.5, 2.0];

impl Eta {
    /// Estimates the time that jobs take on `threads` threads, from the cost and the duration \[s\] of finished jobs, and from the range of
    /// seconds per cost that was expected before. Returns `None` if jobs without a cost are left and none of them has finished.
    pub fn estimate(
        finished: &[(f64, f64)],
        expected_s_per_cost: [f64; 2],
        left: Left,
        threads: usize,
    ) -> Option<Self> {
        // A second thread does not make a single job faster.
        let threads = (left.with_cost + left.without_cost).min(threads as u64).max(1) as f64;
        let mut eta = Self { low: Duration::ZERO, high: Duration::ZERO };
        if left.with_cost > 0 {
            let of_runs = finished.iter().filter(|(cost, _)| *cost > 0.0);
            let rates: Vec<f64> = of_runs.map(|(cost, wall_s)| wall_s / cost).collect();
            let amount = (left.cost - left.begun).max(0.0) / threads;
            eta.add(&rates, expected_s_per_cost, left.with_cost, amount);
        }
        if left.without_cost > 0 {
            let of_modes = finished.iter().filter(|(cost, _)| *cost == 0.0);
            let walls_s: Vec<f64> = of_modes.map(|(_, wall_s)| *wall_s).collect();
            if walls_s.is_empty() {
                return None;
            }
            let mean_s = walls_s.iter().sum::<f64>() / walls_s.len() as f64;
            let expected_s = NEXT_OVER_MEAN.map(|factor| factor * mean_s);
            eta.add(&walls_s, expected_s, left.without_cost, left.without_cost as f64 / threads);
        }
        Some(eta)
    }

    /// Adds the time for an `amount` of `jobs`, from the rates of finished ones and the range of rates that was expected.
    fn add(&mut self, rates: &[f64], [low, high]: [f64; 2], jobs: u64, amount: f64) {
        // The expectation counts like three jobs, and less with each job that has finished.
        let weight = 1.0 / (1.0 + rates.len() as f64);
        let own = rates.iter().map(|rate| (*rate, 1.0));
        let expected = [low, (low * high).sqrt(), high].map(|rate| (rate, weight));
        let all: Vec<(f64, f64)> = own.chain(expected).collect();
        let n: f64 = all.iter().map(|(_, weight)| weight).sum();
        let mean = all.iter().map(|(rate, weight)| rate * weight).sum::<f64>() / n;
        let variance =
            all.iter().map(|(rate, weight)| (rate - mean).powi(2) * weight).sum::<f64>() / (n - 1.0);
        // The standard error of the mean is σ/√n, and the mean over the remaining jobs scatters by σ/√jobs.
        let uncertainty = 2.0 * (variance * (1.0 / n + 1.0 / jobs as f64)).sqrt();
        let of_part = if rates.is_empty() {
            Self::range(low, high, amount)
        } else {
            Self::range(mean - uncertainty, mean + uncertainty, amount)
        };
        self.low += of_part.low;
        self.high += of_part.high;
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
        Left { with_cost: jobs, cost, begun: 0.0, without_cost: 0 }
    }

    fn seconds(eta: Eta) -> [f64; 2] {
        [eta.low, eta.high].map(|time| time.as_secs_f64())
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
        assert_eq!(seconds(eta(&[])), [50.0, 400.0]);
        let [low, high] = seconds(eta(&[(1.0, 0.01)]));
        assert!(low < 1.0 && high > 200.0, "{low} {high}");
        let [low, high] = seconds(eta(&[(1.0, 0.01); 300]));
        assert!(low <= 1.0 && high < 10.0, "{low} {high}");
    }

    /// Protects: of jobs without a cost nothing is said before one of them has finished, whatever others took. Then their times count,
    /// and those of others do not. Beside jobs with a cost both times add up. More threads than jobs make nothing faster.
    #[test]
    fn jobs_without_a_cost_are_known_by_each_other() {
        let modes = Left { without_cost: 10, ..left(0, 0.0) };
        let eta = |finished: &[(f64, f64)], left| Eta::estimate(finished, [0.5, 4.0], left, 2);
        assert_eq!(eta(&[], modes), None);
        assert_eq!(eta(&[(1.0, 500.0)], Left { without_cost: 10, ..left(5, 5.0) }), None);
        let [low, high] = seconds(eta(&[(0.0, 30.0), (1.0, 500.0)], modes).unwrap());
        assert!(low < 150.0 && 150.0 < high && high < 600.0, "{low} {high}");
        let many = [(0.0, 30.0); 100];
        let [low, high] = seconds(eta(&many, modes).unwrap());
        assert!(low > 140.0 && high < 160.0, "{low} {high}");
        let both = seconds(eta(&many, Left { without_cost: 10, ..left(8, 8.0) }).unwrap());
        assert_eq!(both, [low + 2.0, high + 16.0]);
        let [low, high] = seconds(eta(&many, Left { without_cost: 1, ..modes }).unwrap());
        assert!(low < 30.0 && 30.0 < high, "{low} {high}");
        assert_eq!(seconds(eta(&[], left(0, 0.0)).unwrap()), [0.0, 0.0]);
    }
}
