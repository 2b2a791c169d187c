//! How fast jobs are advanced: as fast as the finished jobs of the database, or as ordinary machines do it.

use super::super::error::SweepError;
use crate::queue::{Queue, Scope};
use serde::Serialize;

/// The time of a thread per node and step, while all threads are busy, as a range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Speed {
    /// The fast end \[ns\].
    pub fast_ns: f64,
    /// The slow end \[ns\].
    pub slow_ns: f64,
    /// Number of finished jobs whose times give the range; 0 if it is the typical one.
    #[serde(rename = "finished_jobs")]
    pub jobs: usize,
}

/// Fewer finished jobs say little about others: single jobs end much earlier or later than expected.
const LEAST_JOBS: usize = 10;

/// The load of a machine changes its speed from day to day by this factor, however many jobs have finished.
const LOAD: f64 = 1.2;

impl Speed {
    /// What ordinary machines reach.
    pub const TYPICAL: Self = Self { fast_ns: 3.0, slow_ns: 12.0, jobs: 0 };

    /// The speed of the finished jobs in a database.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn read(queue: &mut Queue) -> Result<Self, SweepError> {
        Ok(Self::of(&queue.timings(&Scope::All).await?))
    }

    /// The speed of finished jobs with these costs, in node-steps, and times \[s\]. A few jobs give the typical one.
    fn of(finished: &[(f64, f64)]) -> Self {
        let known = || finished.iter().filter(|(cost, wall_s)| *cost > 0.0 && *wall_s > 0.0);
        let jobs = known().count();
        if jobs < LEAST_JOBS {
            return Self::TYPICAL;
        }
        let (cost, wall_s) =
            known().fold((0.0, 0.0), |(costs, walls), (cost, wall_s)| (costs + cost, walls + wall_s));
        let mean = wall_s / cost;
        let variance: f64 = known().map(|(cost, wall_s)| (wall_s - mean * cost).powi(2)).sum();
        // Twice the standard error of a ratio of two sums.
        let width = (2.0 * variance.sqrt() / wall_s).exp().max(LOAD);
        Self { fast_ns: mean * 1e9 / width, slow_ns: mean * 1e9 * width, jobs }
    }

    /// The speed in the middle of the range \[ns\].
    pub fn middle_ns(&self) -> f64 {
        (self.fast_ns * self.slow_ns).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: equal jobs give their speed, within what the load of a machine changes; unequal ones give a wider range
    /// around the mean; and a few jobs, or jobs without a cost, change nothing.
    #[test]
    fn finished_jobs_give_a_speed() {
        let equal = Speed::of(&[(1e9, 5.0); 20]);
        assert!((equal.middle_ns() - 5.0).abs() < 1e-9 && equal.jobs == 20, "{equal:?}");
        assert!((equal.slow_ns / equal.fast_ns - LOAD * LOAD).abs() < 1e-9, "{equal:?}");
        let unequal = Speed::of(&[(1e9, 2.0), (1e9, 8.0)].repeat(10));
        assert!((unequal.middle_ns() - 5.0).abs() < 1e-9, "{unequal:?}");
        assert!(unequal.slow_ns / unequal.fast_ns > 1.5, "{unequal:?}");
        assert_eq!(Speed::of(&[(1e9, 5.0); LEAST_JOBS - 1]), Speed::TYPICAL);
        assert_eq!(Speed::of(&[(0.0, 5.0); 50]), Speed::TYPICAL);
    }
}
