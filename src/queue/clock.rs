use std::fmt;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

/// The clock for timestamps and leases.
#[derive(Clone, Default)]
pub enum Clock {
    /// The database's clock: the server's, which is the same for all its clients, or for a file this machine's.
    #[default]
    OfDatabase,
    /// A function that returns milliseconds since 1970-01-01 UTC, so that tests control the time.
    Given(Arc<dyn Fn() -> i64 + Send + Sync>),
}

impl fmt::Debug for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OfDatabase => "OfDatabase",
            Self::Given(_) => "Given",
        })
    }
}

/// This machine's time, in milliseconds since 1970-01-01 UTC.
pub(super) fn machine_ms() -> i64 {
    // A clock that is set before 1970 does not stop a sweep: no result depends on these times.
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_millis() as i64)
}
