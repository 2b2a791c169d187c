//! One physical case: its finished jobs, their reference and their scores.

use super::done::DoneJob;
use super::early::{self, EarlyStop};
use super::reference::{self, Reference};
use super::score::{self, Score};
use super::settings;
use crate::publish::value;
use crate::report::row::{JobRow, RowState};

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
    /// What stopping early changes, for each pair of jobs that differ in nothing else.
    pub early: Vec<EarlyStop>,
    /// Number of jobs that are pending, running or cancelled.
    pub waiting: usize,
    /// Number of jobs that failed.
    pub failed: usize,
}

impl<'a> Case<'a> {
    /// The case of `jobs`, which are two or more. `all` are all of its rows, finished or not.
    pub(super) fn new(
        jobs: Vec<DoneJob<'a>>,
        all: &[&JobRow],
        names_damping: bool,
        is_numerics: fn(&str) -> bool,
    ) -> Self {
        let physics = settings::physics_in_words(jobs[0].row, is_numerics);
        let damping = value::rounded(jobs[0].numerics.beta_r_s);
        let caption = if names_damping { format!("{physics}, β_R = {damping} s") } else { physics };
        let reference = reference::of(&jobs);
        let scores = score::scores(&jobs, &reference);
        let early = early::pairs(&jobs);
        let count = |test: fn(&RowState) -> bool| all.iter().filter(|row| test(&row.state)).count();
        Self {
            caption,
            reference,
            scores,
            early,
            waiting: count(|state| {
                matches!(state, RowState::Pending | RowState::Running | RowState::Cancelled)
            }),
            failed: count(|state| matches!(state, RowState::Failed { .. } | RowState::Unreadable { .. })),
            jobs,
        }
    }
}
