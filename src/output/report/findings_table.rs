//! A table of what a study that grows has found.

use crate::publish::table::Table;

/// A table of findings.
pub(super) struct FindingsTable {
    pub heading: &'static str,
    pub meaning: &'static str,
    pub table: Table,
}
