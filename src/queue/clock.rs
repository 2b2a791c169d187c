use std::fmt;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

/// Whose time is written beside what happens, and by which leases end.
#[derive(Clone, Default)]
pub enum Clock {
    /// The database's: that of its server, the same for all who use it, or for a file that of this machine.
    #[default]
    OfDatabase,
    /// Milliseconds since 1970-01-01 UTC from elsewhere, so that tests own the time.
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
    // A clock set before 1970 is no reason to stop a sweep: no result depends on these times.
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_millis() as i64)
}
