use super::engine::query;
use super::{Queue, QueueError};

const EXTEND: &str = "UPDATE jobs SET lease_until_ms = $2 WHERE owner = $1 AND state = 'running'";

/// One that was silent for so long that it was taken for dead is not.
const ALIVE: &str =
    "UPDATE workers SET heartbeat_ms = $2, finished = $3, jobs_per_s = $4, ended_ms = NULL WHERE id = $1";

impl Queue {
    /// A sign of life: extends the leases of all that the registered worker runs, and returns how many there are.
    ///
    /// Fewer than the worker believes to run means that some were taken back: their finishes will be refused.
    ///
    /// # Errors
    /// If the database cannot be written.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn heartbeat(&mut self) -> Result<u64, QueueError> {
        let lease_ms = self.lease_ms();
        let registration = self.registration_mut();
        let (owner, finished) = (registration.id, registration.pace.finished());
        let jobs_per_s = registration.pace.jobs_per_s();
        // Each on its own, and beside everybody: behind somebody who has the tables alone for longer than a lease, all
        // would seem to be dead.
        let now_ms = self.now_ms().await?;
        let alive = query(ALIVE).bind(owner).bind(now_ms).bind(finished).bind(Some(jobs_per_s));
        if alive.run(&mut self.connection).await? == 0 {
            self.register_again().await?;
            return Ok(0);
        }
        let extended = query(EXTEND).bind(owner).bind(now_ms.saturating_add(lease_ms));
        extended.run(&mut self.connection).await
    }

    /// How long a lease is.
    pub(super) fn lease_ms(&self) -> i64 {
        i64::try_from(self.settings.lease.as_millis()).unwrap_or(i64::MAX)
    }
}
