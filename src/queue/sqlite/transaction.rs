use super::file::File;
use crate::queue::error::QueueError;

/// Begins a transaction with the write lock: one that began by reading could not be promoted while another one writes.
///
/// sqlx's own transactions are not used: when a disk is full, `SQLite` rolls the transaction back by itself. sqlx does
/// not notice that, and it then never begins another transaction on that connection.
///
/// # Errors
/// [`QueueError::Displaced`] if the file is not at its path any more: what is written to it would be lost.
pub(in crate::queue) async fn begin(file: &mut File) -> Result<(), QueueError> {
    file.check_place()?;
    run(file, "BEGIN IMMEDIATE").await
}

pub(in crate::queue) async fn commit(file: &mut File) -> Result<(), QueueError> {
    run(file, "COMMIT").await
}

pub(in crate::queue) async fn roll_back(file: &mut File) {
    // This fails if SQLite has already rolled back. The first error is the one to report.
    let _ = run(file, "ROLLBACK").await;
}

/// Frees the space of deleted rows.
pub(in crate::queue) async fn compact(file: &mut File) -> Result<(), QueueError> {
    // VACUUM builds the new database in the temporary store, which must not be memory here.
    run(file, "PRAGMA temp_store = FILE").await?;
    run(file, "VACUUM").await?;
    run(file, "PRAGMA temp_store = MEMORY").await
}

/// The size of the database in bytes.
pub(in crate::queue) async fn size(file: &mut File) -> Result<u64, QueueError> {
    let pages = number(file, "PRAGMA page_count").await?;
    let page_bytes = number(file, "PRAGMA page_size").await?;
    Ok((pages * page_bytes).unsigned_abs())
}

async fn run(file: &mut File, statement: &'static str) -> Result<(), QueueError> {
    let done = sqlx::query(statement).execute(file.connection()).await;
    done.map(drop).map_err(|error| file.explain(error))
}

async fn number(file: &mut File, statement: &'static str) -> Result<i64, QueueError> {
    let found = sqlx::query_scalar(statement).fetch_one(file.connection()).await;
    found.map_err(|error| file.explain(error))
}
