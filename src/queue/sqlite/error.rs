//! What `SQLite`'s errors mean for the queue.

use std::path::Path;

use sqlx::error::DatabaseError;
use sqlx::sqlite::SqliteError;

use crate::queue::error::QueueError;

const BUSY: u32 = 5;
const LOCKED: u32 = 6;
const READONLY: u32 = 8;
const IOERR: u32 = 10;
/// There is no room for the shared memory, which is the first thing that an opening connection writes.
const IOERR_SHMSIZE: u32 = IOERR | (19 << 8);
const CORRUPT: u32 = 11;
const FULL: u32 = 13;
/// The file has a wrong header.
const NOTADB: u32 = 26;

/// The queue's error for an error of `SQLite` or of sqlx.
pub(super) fn classify(source: sqlx::Error) -> QueueError {
    let extended = extended_code(&source);
    // This program writes no such values: a text that is no UTF-8, a word where a number is.
    let is_unreadable = matches!(source, sqlx::Error::ColumnDecode { .. });
    let source = Box::new(source);
    if is_unreadable {
        return QueueError::Damaged(source);
    }
    match extended.map(primary_code) {
        Some(BUSY | LOCKED) => QueueError::Locked { source, holder: None },
        Some(READONLY) => QueueError::ReadOnly(source),
        Some(CORRUPT | NOTADB) => QueueError::Damaged(source),
        Some(FULL) => QueueError::DiskFull(source),
        Some(IOERR) if extended == Some(IOERR_SHMSIZE) => QueueError::DiskFull(source),
        _ => QueueError::Database(source),
    }
}

/// The queue's error for an error while the file at `path` is opened.
///
/// If the file is not a database, `SQLite` reports that at its first read, which may be any of the first statements.
pub(super) fn classify_at_open(path: &Path, source: sqlx::Error) -> QueueError {
    if extended_code(&source).map(primary_code) == Some(NOTADB) {
        return QueueError::NotADatabase { path: path.into() };
    }
    match classify(source) {
        QueueError::Database(source) => QueueError::Open { database: path.into(), source },
        known => known,
    }
}

/// sqlx gives `SQLite`'s extended result code: the primary code is in the lower 8 bits, the details above.
fn primary_code(extended: u32) -> u32 {
    extended & 0xff
}

fn extended_code(error: &sqlx::Error) -> Option<u32> {
    error.as_database_error()?.try_downcast_ref::<SqliteError>()?.code()?.parse().ok()
}
