//! Exit codes of the `tribosweep` command; part of its interface.

/// Everything asked for was done, and all jobs succeeded that do not still run elsewhere.
pub const SUCCESS: u8 = 0;
/// Some jobs failed; the others have results.
pub const SOME_FAILED: u8 = 1;
/// Bad input or usage; nothing was done.
pub const BAD_INPUT: u8 = 2;
/// Work is left over: the sweep was interrupted. The same command continues it.
pub const WORK_LEFT: u8 = 3;
