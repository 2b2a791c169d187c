/// Which other transactions may write at the same time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Access {
    /// None: this transaction may change jobs of any worker. (On `SQLite` every writing transaction is exclusive.)
    Exclusive,
    /// Other shared ones: this transaction claims jobs that nobody has, or changes only its own worker's jobs.
    Shared,
}
