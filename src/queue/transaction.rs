//! Transactions that write.

use super::access::Access;
use super::clock::Clock;
use super::engine::Connection;
use super::error::QueueError;
use super::handle::Queue;
use super::owner::Owner;

impl Queue {
    /// Runs `work` in an exclusive transaction, with the time in milliseconds since 1970-01-01 UTC. After an error, the
    /// transaction is rolled back.
    pub(super) async fn write<T>(
        &mut self,
        work: impl AsyncFnOnce(&mut Connection, i64) -> Result<T, QueueError>,
    ) -> Result<T, QueueError> {
        let worked = transact(&mut self.connection, &self.clock, Access::Exclusive, work).await;
        self.naming_holder(worked).await
    }

    /// As [`Self::write`], in a shared transaction: `work` may change only jobs of this queue's worker, and claim jobs
    /// that nobody has.
    pub(super) async fn write_shared<T>(
        &mut self,
        work: impl AsyncFnOnce(&mut Connection, i64) -> Result<T, QueueError>,
    ) -> Result<T, QueueError> {
        let worked = transact(&mut self.connection, &self.clock, Access::Shared, work).await;
        self.naming_holder(worked).await
    }

    /// What was done under a lock. If another process holds that lock and it is not known which one, it is probably a worker
    /// of this database that is stopped. Nothing else holds it for long.
    pub(super) async fn naming_holder<T>(&mut self, worked: Result<T, QueueError>) -> Result<T, QueueError> {
        match worked {
            Err(QueueError::Locked { source, holder: None }) => {
                let owners = self.owners().await.unwrap_or_default();
                let holder = owners.iter().find(|owner| owner.is_stopped()).map(|Owner { pid, .. }| {
                    format!(
                        "process {pid}, a worker of this database that is stopped (continue it with `kill -CONT {pid}` or end \
                         it with `kill -KILL {pid}`), probably"
                    )
                });
                Err(QueueError::Locked { source, holder })
            }
            worked => worked,
        }
    }

    /// The time of this queue's clock, in milliseconds since 1970-01-01 UTC.
    ///
    /// # Errors
    /// If the database cannot be asked.
    pub async fn now_ms(&mut self) -> Result<i64, QueueError> {
        self.connection.now_ms(&self.clock).await
    }
}

/// Runs `work` in a transaction.
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
