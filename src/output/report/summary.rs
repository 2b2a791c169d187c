//! Counts of a study's jobs.

use super::row::{JobRow, RowState};
use crate::analysis::{JobRecord, Outcome};

/// The number of jobs with each status.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Summary {
    pub total: usize,
    pub periodic: usize,
    pub decayed: usize,
    pub not_periodic: usize,
    pub unstable: usize,
    pub completed: usize,
    pub failed: usize,
    pub running: usize,
    pub pending: usize,
    pub cancelled: usize,
    pub unreadable: usize,
}

impl Summary {
    pub fn of(rows: &[JobRow]) -> Self {
        // Measured points are no jobs.
        let jobs = rows.iter().filter(|row| !row.is_measured());
        let mut summary = Self { total: jobs.clone().count(), ..Self::default() };
        for row in jobs {
            *match &row.state {
                RowState::Pending => &mut summary.pending,
                RowState::Running => &mut summary.running,
                RowState::Cancelled => &mut summary.cancelled,
                RowState::Failed { .. } => &mut summary.failed,
                RowState::Unreadable { .. } => &mut summary.unreadable,
                RowState::Measured(_) => continue,
                RowState::Done(record) => match record.outcome {
                    Outcome::Periodic => &mut summary.periodic,
                    Outcome::Decayed => &mut summary.decayed,
                    Outcome::NotPeriodic => &mut summary.not_periodic,
                    Outcome::Unstable => &mut summary.unstable,
                    Outcome::Completed => &mut summary.completed,
                },
            } += 1;
        }
        summary
    }

    pub fn done(&self) -> usize {
        self.periodic + self.decayed + self.not_periodic + self.unstable + self.completed
    }

    pub fn missing(&self) -> usize {
        self.running + self.pending + self.cancelled + self.unreadable
    }

    /// The missing jobs by status, in words.
    pub fn missing_in_words(&self) -> String {
        let cancelled =
            if self.cancelled > 0 { format!(", {} cancelled", self.cancelled) } else { String::new() };
        let unreadable =
            if self.unreadable > 0 { format!(", {} unreadable", self.unreadable) } else { String::new() };
        format!("{} running, {} pending{cancelled}{unreadable}", self.running, self.pending)
    }

    /// The jobs that are done by outcome, in words.
    pub fn done_in_words(&self) -> String {
        let Self { periodic, decayed, not_periodic, unstable, completed, .. } = self;
        let without_run = if *unstable > 0 { format!(", {unstable} unstable") } else { String::new() };
        let programs = if *completed > 0 { format!(", {completed} completed") } else { String::new() };
        format!("{periodic} periodic, {decayed} decayed, {not_periodic} not periodic{without_run}{programs}")
    }
}

/// The job with the largest residual, which is the first to check if a result is in doubt.
pub(super) fn worst(rows: &[JobRow], residual: impl Fn(&JobRecord) -> f64) -> Option<(f64, &JobRow)> {
    rows.iter()
        .filter_map(|row| Some((residual(row.record()?), row)))
        .filter(|(residual, _)| residual.is_finite())
        .max_by(|a, b| a.0.total_cmp(&b.0))
}
