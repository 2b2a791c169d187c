//! A finished job of a comparison.

use crate::analysis::JobRecord;
use crate::report::row::{JobNumerics, JobRow};

/// A finished job with everything that the comparison needs.
#[derive(Debug, Clone, Copy)]
pub struct DoneJob<'a> {
    /// Its row.
    pub row: &'a JobRow,
    /// Its numerics.
    pub numerics: &'a JobNumerics,
    /// Its record.
    pub record: &'a JobRecord,
}

impl<'a> DoneJob<'a> {
    /// The job of a row, if it is done and its numerics are known.
    pub(super) fn of(row: &'a JobRow) -> Option<Self> {
        Some(Self { row, numerics: row.numerics.as_ref()?, record: row.record()? })
    }

    /// Nodes × time steps done: a cost that is the same on every machine.
    pub fn node_steps(&self) -> f64 {
        self.numerics.nodes as f64 * self.record.steps as f64
    }
}
