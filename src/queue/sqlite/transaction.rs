use sqlx::SqliteConnection;

use super::error::classify;
use crate::queue::error::QueueError;

/// Begins a transaction with the write lock: one that began by reading could not be promoted while another one writes.
///
/// sqlx's own transactions are not used: when a disk is full, `SQLite` rolls the transaction back by itself. sqlx does
/// not notice that, and it then never begins another transaction on that connection.
pub(in crate::queue) async fn begin(connection: &mut SqliteConnection) -> Result<(), QueueError> {
    run(connection, "BEGIN IMMEDIATE").await
}

pub(in crate::queue) async fn commit(connection: &mut SqliteConnection) -> Result<(), QueueError> {
    run(connection, "COMMIT").await
}

pub(in crate::queue) async fn roll_back(connection: &mut SqliteConnection) {
    // This fails if SQLite has already rolled back. The first error is the one to report.
    let _ = run(connection, "ROLLBACK").await;
}

/// Frees the space of deleted rows.
pub(in crate::queue) async fn compact(connection: &mut SqliteConnection) -> Result<(), QueueError> {
    // VACUUM builds the new database in the temporary store, which must not be memory here.
    run(connection, "PRAGMA temp_store = FILE").await?;
    run(connection, "VACUUM").await?;
    run(connection, "PRAGMA temp_store = MEMORY").await
}

/// The size of the database in bytes.
pub(in crate::queue) async fn size(connection: &mut SqliteConnection) -> Result<u64, QueueError> {
    let pages = number(connection, "PRAGMA page_count").await?;
    let page_bytes = number(connection, "PRAGMA page_size").await?;
    Ok((pages * page_bytes).unsigned_abs())
}

async fn run(connection: &mut SqliteConnection, statement: &'static str) -> Result<(), QueueError> {
    sqlx::query(statement).execute(connection).await.map(drop).map_err(classify)
}

async fn number(connection: &mut SqliteConnection, statement: &'static str) -> Result<i64, QueueError> {
    sqlx::query_scalar(statement).fetch_one(connection).await.map_err(classify)
}
