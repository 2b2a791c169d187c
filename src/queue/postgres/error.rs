//! What PostgreSQL's errors mean for the queue.

use sqlx::postgres::PgDatabaseError;

use crate::queue::error::QueueError;

/// SQLSTATE codes after which the connection or the whole server is gone: an administrator ended it, it crashed, it is
/// not ready yet, or the client was silent in the middle of a transaction.
const GONE: [&str; 5] = ["57P01", "57P02", "57P03", "57P05", "25P03"];

/// The server has as many connections as it allows.
const TOO_MANY_CONNECTIONS: &str = "53300";

/// A lock timeout, a deadlock that the server resolved by ending this transaction, and a serialization conflict.
const LOCKED: [&str; 3] = ["55P03", "40P01", "40001"];

/// The statement timeout ended the statement.
const STATEMENT_TIMEOUT: &str = "57014";

const DISK_FULL: &str = "53100";

/// The user lacks the privilege, or the server is read-only.
const READ_ONLY: [&str; 2] = ["42501", "25006"];

const DAMAGED: [&str; 2] = ["XX001", "XX002"];

/// The queue's error for an error of the server, of the connection or of sqlx.
pub(super) fn classify(source: sqlx::Error) -> QueueError {
    if matches!(source, sqlx::Error::Io(_) | sqlx::Error::Protocol(_) | sqlx::Error::Tls(_)) {
        return QueueError::Unreachable(source.to_string());
    }
    let Some(error) =
        source.as_database_error().and_then(|error| error.try_downcast_ref::<PgDatabaseError>())
    else {
        return QueueError::Database(Box::new(source));
    };
    let code = error.code();
    // Class 08 contains the connection errors.
    let is_gone = GONE.contains(&code) || code.starts_with("08");
    if is_gone || code == TOO_MANY_CONNECTIONS || code == STATEMENT_TIMEOUT {
        QueueError::Unreachable(error.to_string())
    } else if LOCKED.contains(&code) {
        QueueError::Locked { source: Box::new(source), holder: None }
    } else if code == DISK_FULL {
        QueueError::DiskFull(Box::new(source))
    } else if READ_ONLY.contains(&code) {
        QueueError::ReadOnly(Box::new(source))
    } else if DAMAGED.contains(&code) {
        QueueError::Damaged(Box::new(source))
    } else {
        QueueError::Database(Box::new(source))
    }
}
