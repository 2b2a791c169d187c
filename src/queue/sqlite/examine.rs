//! Checks of a database file.

use sqlx::SqliteConnection;

use super::error::classify;
use crate::queue::error::QueueError;
use crate::queue::finding::Finding;

const SYNCHRONOUS: [&str; 4] = ["off", "normal", "full", "extra"];

/// Checks the library, the file and the references between tables.
pub(in crate::queue) async fn examine(
    connection: &mut SqliteConnection,
    findings: &mut Vec<Finding>,
) -> Result<(), QueueError> {
    let version: String = scalar(connection, "SELECT sqlite_version()").await?;
    findings.push(Finding::good("SQLite", version));
    findings.push(Finding::good("file system", "local, or not known to be a network file system"));
    let mode: String = scalar(connection, "PRAGMA journal_mode").await?;
    // A database that cannot be written is opened as if it had no log, so any mode is acceptable.
    findings.push(Finding::good("journal", mode));
    let level: i64 = scalar(connection, "PRAGMA synchronous").await?;
    let level = usize::try_from(level).ok().and_then(|level| SYNCHRONOUS.get(level));
    findings.push(Finding::good("synchronous", *level.unwrap_or(&"unknown")));

    let damage = integrity(connection).await?;
    let advice = "; copy what can be read with `sqlite3 FILE .recover`, or take a backup";
    let text = if damage.is_empty() { "ok".to_owned() } else { damage.join("; ") + advice };
    findings.push(Finding::judged("integrity", text, damage.is_empty()));

    let orphans: i64 = scalar(connection, "SELECT COUNT(*) FROM pragma_foreign_key_check").await?;
    let text = if orphans == 0 {
        "ok".to_owned()
    } else {
        format!("{orphans} rows refer to rows that do not exist")
    };
    findings.push(Finding::judged("references", text, orphans == 0));
    Ok(())
}

/// What `SQLite` finds wrong with the file: the first few problems, which suffice to show what it is.
pub(in crate::queue) async fn integrity(
    connection: &mut SqliteConnection,
) -> Result<Vec<String>, QueueError> {
    let mut damage: Vec<String> =
        sqlx::query_scalar("PRAGMA integrity_check(5)").fetch_all(connection).await.map_err(classify)?;
    if damage == ["ok"] {
        damage.clear();
    }
    Ok(damage)
}

async fn scalar<T>(connection: &mut SqliteConnection, statement: &'static str) -> Result<T, QueueError>
where
    T: Send + Unpin + for<'r> sqlx::Decode<'r, sqlx::Sqlite> + sqlx::Type<sqlx::Sqlite>,
{
    sqlx::query_scalar(statement).fetch_one(connection).await.map_err(classify)
}
