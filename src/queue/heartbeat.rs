use super::{Queue, QueueError};

const EXTEND: &str = "UPDATE jobs SET lease_until_ms = ?2 WHERE owner = ?1 AND state = 'running'";

const ALIVE: &str = "UPDATE workers SET heartbeat_ms = ?2 WHERE id = ?1";

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
        let owner = self.registration().id;
        let now_ms = self.clock.now_ms();
        let until_ms = self.lease_until(now_ms);
        self.write(async |connection| {
            sqlx::query(ALIVE).bind(owner).bind(now_ms).execute(&mut *connection).await?;
            let extended = sqlx::query(EXTEND).bind(owner).bind(until_ms).execute(connection).await?;
            Ok(extended.rows_affected())
        })
        .await
    }

    /// The end of a lease that begins now.
    pub(super) fn lease_until(&self, now_ms: i64) -> i64 {
        now_ms.saturating_add(i64::try_from(self.settings.lease.as_millis()).unwrap_or(i64::MAX))
    }
}
