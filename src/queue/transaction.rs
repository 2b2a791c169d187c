//! Transactions that write.

use super::engine::{Access, Connection};
use super::{Clock, Queue, QueueError};

impl Queue {
    /// Does `work`, which is told the time, in a transaction that nobody writes beside: all of it, or after an error
    /// nothing.
    pub(super) async fn write<T>(
        &mut self,
        work: impl AsyncFnOnce(&mut Connection, i64) -> Result<T, QueueError>,
    ) -> Result<T, QueueError> {
        transact(&mut self.connection, &self.clock, Access::Alone, work).await
    }

    /// As [`Self::write`], for what changes only what this queue's worker has in hand, or takes what nobody has: others
    /// may do the same at once.
    pub(super) async fn write_own<T>(
        &mut self,
        work: impl AsyncFnOnce(&mut Connection, i64) -> Result<T, QueueError>,
    ) -> Result<T, QueueError> {
        transact(&mut self.connection, &self.clock, Access::Shared, work).await
    }

    /// The time by the clock that this queue goes by, in milliseconds since 1970-01-01 UTC.
    ///
    /// # Errors
    /// If the database cannot be asked.
    pub async fn now_ms(&mut self) -> Result<i64, QueueError> {
        self.connection.now_ms(&self.clock).await
    }
}

/// Does `work` in a transaction.
pub(super) async fn transact<T>(
    connection: &mut Connection,
    clock: &Clock,
    access: Access,
    work: impl AsyncFnOnce(&mut Connection, i64) -> Result<T, QueueError>,
) -> Result<T, QueueError> {
    let now_ms = connection.begin(access, clock).await?;
    let worked = match work(connection, now_ms).await {
        Ok(value) => connection.commit().await.map(|()| value),
        Err(error) => Err(error),
    };
    if worked.is_err() {
        connection.roll_back().await;
    }
    worked
}
