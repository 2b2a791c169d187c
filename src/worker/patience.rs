//! Waiting for a database that cannot be reached.

use super::progress::Progress;
use crate::queue::QueueError;
use std::time::{Duration, Instant};

/// How long it is waited for …
const LIMIT: Duration = Duration::from_hours(1);

/// … and how long between two attempts.
const PAUSE: Duration = Duration::from_secs(1);

/// What is left of the time that something may take.
#[derive(Debug, Clone, Copy)]
pub struct Patience(Instant);

impl Patience {
    /// All of it.
    pub fn new() -> Self {
        Self(Instant::now())
    }

    /// Returns after a while, so that the same is tried again.
    ///
    /// # Errors
    /// The error, if waiting does not help or has lasted for an hour.
    pub async fn wait(&self, error: QueueError, progress: &mut impl Progress) -> Result<(), QueueError> {
        if !error.is_transient() || self.0.elapsed() >= LIMIT {
            return Err(error);
        }
        progress.waiting(&error.to_string());
        tokio::time::sleep(PAUSE).await;
        Ok(())
    }
}
