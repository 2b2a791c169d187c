//! Exit codes of the `tribosweep` command; they are part of its interface.

/// The command did its work, and no job failed. Other workers may still be running jobs.
pub(crate) const SUCCESS: u8 = 0;
/// Some jobs failed; the others have results.
pub(crate) const SOME_FAILED: u8 = 1;
/// The command could not do its work, or not all of it: bad input or usage, a database or file that cannot be used, or a
/// problem that `doctor` found. Work that was done before the error is kept.
pub(crate) const ERROR: u8 = 2;
/// Jobs are left because the work was interrupted or jobs were cancelled. The same command continues an interrupted
/// sweep.
pub(crate) const WORK_LEFT: u8 = 3;
