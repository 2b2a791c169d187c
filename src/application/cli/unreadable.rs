//! Jobs whose stored result cannot be read: they are named and left out.

use super::output::log;
use crate::exit;
use crate::publish::value::count;
use crate::report::JobRow;
use crate::sweep::Unreadable;

/// Logs the jobs that were left out, if there are any. Returns the exit code.
pub(crate) fn log_unreadable(unreadable: &Unreadable) -> u8 {
    if unreadable.count == 0 {
        return exit::SUCCESS;
    }
    let jobs = count(unreadable.count, "job");
    log(format_args!("warning: {jobs} left out, whose stored results cannot be read:"));
    for line in &unreadable.jobs {
        log(format_args!("  {line}"));
    }
    log(
        "`tribosweep retry STUDY --unreadable` makes them pending again; `tribosweep doctor --deep` reads all of the database",
    );
    exit::SOME_FAILED
}

/// As [`log_unreadable`], for the rows of a report.
pub(crate) fn log_unreadable_rows(rows: &[JobRow]) -> u8 {
    let mut unreadable = Unreadable::default();
    for row in rows {
        unreadable.note(row);
    }
    log_unreadable(&unreadable)
}
