//! Exit codes of the `tribosweep` command; they are part of its interface.

use std::fmt::Write;

/// The command did its work, and no job failed. Other workers may still be running jobs.
pub(crate) const SUCCESS: u8 = 0;
/// Some jobs failed, or stored results cannot be read; the others have results.
pub(crate) const SOME_FAILED: u8 = 1;
/// The command could not do its work, or not all of it. Work that was done before the error is kept.
pub(crate) const ERROR: u8 = 2;
/// Jobs are left. The same command continues an interrupted sweep.
pub(crate) const WORK_LEFT: u8 = 3;

/// What the codes mean, as the help says it.
const MEANINGS: [(u8, &str); 4] = [
    (SUCCESS, "All jobs succeeded, or the command did its work. Other workers may still run jobs."),
    (SOME_FAILED, "Some jobs failed, or stored results cannot be read; the others have results."),
    (ERROR, "Error: bad input, usage or environment, such as a damaged database or a full disk."),
    (WORK_LEFT, "Jobs are left: interrupted, cancelled meanwhile, or held by a stopped process."),
];

/// The text about exit codes at the end of the help.
pub(crate) fn help() -> String {
    MEANINGS.iter().fold("Exit codes:".to_owned(), |mut text, (code, meaning)| {
        let _ = write!(text, "\n  {code}  {meaning}");
        text
    })
}
