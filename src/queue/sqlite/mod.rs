//! A queue in a file.

mod examine;
mod filesystem;
mod lock;
mod open;
mod schema;

pub(super) use examine::examine;
pub(super) use open::{is_writable, open, open_to_read, resolve};

use sqlx::SqliteConnection;

use super::QueueError;

/// Not sqlx's transactions: when a disk is full, `SQLite` has rolled a transaction back by itself, and sqlx, which has
/// not noticed, begins no other on that connection ever after.
pub(super) async fn begin(connection: &mut SqliteConnection) -> Result<(), QueueError> {
    // One that begins by reading cannot be promoted while another writes.
    sqlx::query("BEGIN IMMEDIATE").execute(connection).await?;
    Ok(())
}

pub(super) async fn commit(connection: &mut SqliteConnection) -> Result<(), QueueError> {
    sqlx::query("COMMIT").execute(connection).await?;
    Ok(())
}

pub(super) async fn roll_back(connection: &mut SqliteConnection) {
    // Fails where SQLite has done so already; the first error is the one to report.
    let _ = sqlx::query("ROLLBACK").execute(connection).await;
}

pub(super) async fn compact(connection: &mut SqliteConnection) -> Result<(), QueueError> {
    // The new database is built in the temporary store: not in memory.
    sqlx::query("PRAGMA temp_store = FILE").execute(&mut *connection).await?;
    sqlx::query("VACUUM").execute(&mut *connection).await?;
    sqlx::query("PRAGMA temp_store = MEMORY").execute(connection).await?;
    Ok(())
}

pub(super) async fn size(connection: &mut SqliteConnection) -> Result<u64, QueueError> {
    let pages: i64 = sqlx::query_scalar("PRAGMA page_count").fetch_one(&mut *connection).await?;
    let size: i64 = sqlx::query_scalar("PRAGMA page_size").fetch_one(connection).await?;
    Ok((pages * size).unsigned_abs())
}
