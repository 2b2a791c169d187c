//! Opening the database for a worker among many, some of which start while the server does not answer.

use super::interrupt::Interrupt;
use super::patience::Patience;
use super::progress::Progress;
use crate::queue::{Clock, Location, Queue, QueueError, Settings};

/// Opens the database at `location`, which must exist, and waits for its server for as long as an hour; `None` if
/// `interrupt` was raised meanwhile.
///
/// # Errors
/// As [`Queue::open_existing`].
pub async fn open(
    location: &Location,
    settings: Settings,
    interrupt: &Interrupt,
    progress: &mut impl Progress,
) -> Result<Option<Queue>, QueueError> {
    let patience = Patience::new();
    loop {
        let error = match Queue::open_existing(location.clone(), Clock::OfDatabase, settings).await {
            Ok(queue) => return Ok(Some(queue)),
            Err(error) => error,
        };
        patience.wait(error, interrupt, progress).await?;
        if interrupt.is_raised() {
            return Ok(None);
        }
    }
}
