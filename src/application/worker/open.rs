//! Opening the database for a worker, even while the server does not answer yet.

use super::interrupt::Interrupt;
use super::progress::Progress;
use super::retry::RetryBackoff;
use crate::queue::{Clock, Location, Queue, QueueError, Settings};

/// Opens the database at `location`, which must exist. Waits up to an hour for its server; `None` if `interrupt` is
/// raised meanwhile.
///
/// # Errors
/// As [`Queue::open_existing`].
pub async fn open(
    location: &Location,
    settings: Settings,
    interrupt: &Interrupt,
    progress: &mut dyn Progress,
) -> Result<Option<Queue>, QueueError> {
    let backoff = RetryBackoff::new();
    loop {
        let error = match Queue::open_existing(location.clone(), Clock::OfDatabase, settings).await {
            Ok(queue) => return Ok(Some(queue)),
            Err(error) => error,
        };
        backoff.wait(error, interrupt, progress).await?;
        if interrupt.is_raised() {
            return Ok(None);
        }
    }
}
