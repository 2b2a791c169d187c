//! The effect of stopping early: pairs of jobs that differ in nothing else.

use super::done::DoneJob;
use super::reference::{self, FIGURES, FREQUENCY};
use crate::report::row::JobNumerics;

/// A job that stopped early, compared with the same job that ran to its time limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EarlyStop {
    /// Index of the job that stopped early among the case's jobs.
    pub early: usize,
    /// Index of the job that ran to its limit.
    pub whole: usize,
    /// Relative change of μ* by stopping early.
    pub mu_star_change: f64,
    /// Smallest relative change that can be distinguished from 0: √(se² + se²) over μ*.
    pub mu_star_resolution: f64,
    /// Relative change of the frequency.
    pub frequency_change: Option<f64>,
    /// Largest absolute change of the three shares.
    pub shares_change: f64,
    /// Share of the steps that are saved.
    pub steps_saved: f64,
    /// Share of the solver time that is saved.
    pub wall_saved: Option<f64>,
}

/// All pairs, in the order of the jobs that stop early. A whole run is compared with jobs of any tolerance, because it
/// does not depend on the tolerance.
pub(super) fn pairs(jobs: &[DoneJob]) -> Vec<EarlyStop> {
    let alike = |early: &JobNumerics, whole: &JobNumerics| {
        let as_whole = JobNumerics {
            stop_early: false,
            limit_s: whole.limit_s,
            average_last_fraction: whole.average_last_fraction,
            cycles: whole.cycles,
            tolerance: whole.tolerance,
            drift_tolerance: whole.drift_tolerance,
            ..early.clone()
        };
        // A time step that is given is not among the numerics: the caller compares those of the records.
        !whole.stop_early && as_whole == *whole
    };
    let same_step = |a: &DoneJob, b: &DoneJob| a.record.time_step_s == b.record.time_step_s;
    (0..jobs.len())
        .filter(|&early| jobs[early].numerics.stop_early)
        .filter_map(|early| {
            // If there are several whole runs, the longest one is taken.
            let whole = (0..jobs.len())
                .filter(|&i| {
                    alike(jobs[early].numerics, jobs[i].numerics) && same_step(&jobs[early], &jobs[i])
                })
                .max_by(|&a, &b| jobs[a].numerics.limit_s.total_cmp(&jobs[b].numerics.limit_s))?;
            Some(pair(jobs, early, whole))
        })
        .collect()
}

fn pair(jobs: &[DoneJob], early: usize, whole: usize) -> EarlyStop {
    let (a, b) = (&jobs[early], &jobs[whole]);
    let (found, expected) = (reference::figures(a), reference::figures(b));
    let change = |figure: usize| Some(found[figure]? - expected[figure]?);
    let mu_star = b.record.mu_star;
    EarlyStop {
        early,
        whole,
        mu_star_change: a.record.mu_star / mu_star - 1.0,
        mu_star_resolution: a.record.mu_star_se.hypot(b.record.mu_star_se) / mu_star.abs(),
        frequency_change: change(FREQUENCY).zip(expected[FREQUENCY]).map(|(change, f)| change / f),
        shares_change: (FREQUENCY + 1..FIGURES).filter_map(change).map(f64::abs).fold(0.0, f64::max),
        steps_saved: 1.0 - a.record.steps as f64 / b.record.steps as f64,
        wall_saved: a.row.wall_s.zip(b.row.wall_s).map(|(early, whole)| 1.0 - early / whole),
    }
}
