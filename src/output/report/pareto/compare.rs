//! From rows to physical cases: the finished jobs of each, their reference and their scores.

use super::reference::{DoneJob, Reference};
use super::score::{self, Score};
use super::settings::physics_in_words;
use crate::publish::value::{self, count};
use crate::report::row::{JobNumerics, JobRow, RowState};

/// All physical cases with at least two finished jobs.
#[derive(Debug)]
pub struct Comparison<'a> {
    /// The cases, in the order of the study.
    pub cases: Vec<Case<'a>>,
    /// Cases that are left out because fewer than two of their jobs are done, in words.
    pub left_out: Vec<String>,
}

/// The jobs of one physical case.
#[derive(Debug)]
pub struct Case<'a> {
    /// The physical parameters in words.
    pub caption: String,
    /// Its finished jobs, in the order of the study.
    pub jobs: Vec<DoneJob<'a>>,
    /// The figures that they are compared with.
    pub reference: Reference,
    /// One score for each job.
    pub scores: Vec<Score>,
    /// Number of jobs that are pending, running or cancelled.
    pub waiting: usize,
    /// Number of jobs that failed.
    pub failed: usize,
}

/// There are no jobs that can be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ParetoError {
    /// Too few results.
    #[error(
        "jobs done: {done} of {jobs}; expected at least two done jobs of one physical case; \
         finish the study with `tribosweep run` first"
    )]
    TooFewDone {
        /// Jobs with a result.
        done: usize,
        /// Jobs in all.
        jobs: usize,
    },
    /// Every physical case has a single job.
    #[error(
        "no two of the done jobs ({done}) are the same physical case: expected a study that varies numerics \
         (elements, safety_factor, time_step_s, beta2, stop_early, tolerance …) at fixed physics"
    )]
    OneJobACase {
        /// Jobs with a result.
        done: usize,
    },
}

impl<'a> Case<'a> {
    /// The case of `jobs`, which are two or more. `all` are all of its rows, finished or not.
    fn new(
        jobs: Vec<DoneJob<'a>>,
        all: &[&JobRow],
        names_damping: bool,
        is_numerics: fn(&str) -> bool,
    ) -> Self {
        let physics = physics_in_words(jobs[0].row, is_numerics);
        let damping = value::rounded(jobs[0].numerics.beta_r_s);
        let reference = Reference::of(&jobs);
        let is_failed =
            |row: &&&JobRow| matches!(row.state, RowState::Failed { .. } | RowState::Unreadable { .. });
        let failed = all.iter().filter(is_failed).count();
        Self {
            caption: if names_damping { format!("{physics}, β_R = {damping} s") } else { physics },
            scores: score::scores(&jobs, &reference),
            reference,
            waiting: all.len() - jobs.len() - failed,
            failed,
            jobs,
        }
    }
}

/// Compares the finished jobs of each physical case with the finest of them.
///
/// A job that is in `rows` twice (of two studies that share it) counts once. `is_numerics` says of a parameter whether it changes how a
/// physical case is solved and not the case.
///
/// # Errors
/// If there is nothing to compare: fewer than two jobs are done, or none of them are of the same physical case.
pub fn compare(rows: &[JobRow], is_numerics: fn(&str) -> bool) -> Result<Comparison<'_>, ParetoError> {
    let mut seen = std::collections::HashSet::new();
    let rows: Vec<&JobRow> = rows.iter().filter(|row| seen.insert(row.job.as_str())).collect();
    let done = rows.iter().filter(|row| row.record().is_some()).count();
    if done < 2 {
        return Err(ParetoError::TooFewDone { done, jobs: rows.len() });
    }
    let mut comparison = Comparison { cases: Vec::new(), left_out: Vec::new() };
    for group in grouped(&rows, |numerics| numerics.case.clone()) {
        let by_damping = damping_is_physics(&group);
        let parts =
            if by_damping { grouped(&group, |numerics| numerics.beta_r_s.to_bits()) } else { vec![group] };
        for part in parts {
            let jobs: Vec<DoneJob> = part.iter().filter_map(|row| DoneJob::of(row)).collect();
            if jobs.len() < 2 {
                let (words, of) = (physics_in_words(part[0], is_numerics), count(part.len(), "job"));
                comparison.left_out.push(format!("{words}: {} of {of} done", jobs.len()));
            } else {
                comparison.cases.push(Case::new(jobs, &part, by_damping, is_numerics));
            }
        }
    }
    if comparison.cases.is_empty() { Err(ParetoError::OneJobACase { done }) } else { Ok(comparison) }
}

/// Groups in the order of their first rows.
fn grouped<'a, K: PartialEq>(rows: &[&'a JobRow], key: impl Fn(&JobNumerics) -> K) -> Vec<Vec<&'a JobRow>> {
    let mut groups: Vec<(K, Vec<&JobRow>)> = Vec::new();
    for &row in rows {
        let Some(key) = row.numerics.as_ref().map(&key) else { continue };
        match groups.iter_mut().find(|(own, _)| *own == key) {
            Some((_, group)) => group.push(row),
            None => groups.push((key, vec![row])),
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

/// Whether β_R was swept as physics: the finest mesh of the group, done or not, has several values of it.
fn damping_is_physics(group: &[&JobRow]) -> bool {
    let numerics = || group.iter().filter_map(|row| row.numerics.as_ref());
    let finest = numerics().map(|n| n.element_size_m).fold(f64::INFINITY, f64::min);
    let mut damping = numerics().filter(|n| n.element_size_m == finest).map(|n| n.beta_r_s);
    damping.next().is_some_and(|first| damping.any(|other| other != first))
}
