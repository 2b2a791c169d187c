//! What the server's errors mean for the queue.

use sqlx::postgres::PgDatabaseError;

use crate::queue::QueueError;

/// Codes (SQLSTATE) after which the connection, or all of the server, is gone: ended by an administrator, by a crash, not
/// ready yet, or because a client was silent in the middle of a transaction.
const GONE: [&str; 5] = ["57P01", "57P02", "57P03", "57P05", "25P03"];

/// There are as many connections as the server allows.
const TOO_MANY: &str = "53300";

/// A lock that was not to be had in time, a deadlock that was resolved at our cost, and a conflict.
const LOCKED: [&str; 3] = ["55P03", "40P01", "40001"];

/// A statement took longer than it may.
const TOO_LONG: &str = "57014";

const DISK_FULL: &str = "53100";

/// No right to do it, a server that only reads.
const READ_ONLY: [&str; 2] = ["42501", "25006"];

const DAMAGED: [&str; 2] = ["XX001", "XX002"];

/// The error if it is the server's or the connection's; otherwise as it came.
pub(in crate::queue) fn known(source: sqlx::Error) -> Result<QueueError, sqlx::Error> {
    if matches!(source, sqlx::Error::Io(_) | sqlx::Error::Protocol(_) | sqlx::Error::Tls(_)) {
        return Ok(QueueError::Unreachable(source.to_string()));
    }
    let Some(error) =
        source.as_database_error().and_then(|error| error.try_downcast_ref::<PgDatabaseError>())
    else {
        return Err(source);
    };
    let code = error.code();
    // Class 08 are the errors of connections.
    Ok(if GONE.contains(&code) || code == TOO_MANY || code == TOO_LONG || code.starts_with("08") {
        QueueError::Unreachable(error.to_string())
    } else if LOCKED.contains(&code) {
        QueueError::Locked(source)
    } else if code == DISK_FULL {
        QueueError::DiskFull(source)
    } else if READ_ONLY.contains(&code) {
        QueueError::ReadOnly(source)
    } else if DAMAGED.contains(&code) {
        QueueError::Damaged(source)
    } else {
        QueueError::Database(source)
    })
}
