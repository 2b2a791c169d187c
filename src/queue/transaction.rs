//! Transactions that write.
//!
//! Not those of sqlx: when a disk is full, `SQLite` has rolled a transaction back by itself, and sqlx, which has not
//! noticed, begins no other on that connection ever after.

use sqlx::SqliteConnection;

use super::{Queue, QueueError};

impl Queue {
    /// Does `work` in a transaction that takes the lock for writing at its start: all of it, or after an error nothing.
    pub(super) async fn write<T>(
        &mut self,
        work: impl AsyncFnOnce(&mut SqliteConnection) -> Result<T, QueueError>,
    ) -> Result<T, QueueError> {
        let connection = &mut self.connection;
        sqlx::query("BEGIN IMMEDIATE").execute(&mut *connection).await?;
        let worked = match work(connection).await {
            Ok(value) => {
                sqlx::query("COMMIT").execute(&mut *connection).await.map(|_| value).map_err(Into::into)
            }
            Err(error) => Err(error),
        };
        if worked.is_err() {
            // Fails where SQLite has done so already; the first error is the one to report.
            let _ = sqlx::query("ROLLBACK").execute(connection).await;
        }
        worked
    }
}
