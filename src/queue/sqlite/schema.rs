//! The tables and their versions: the files in `migrations/sqlite`, each applied once, in order.

use std::cmp::Ordering;
use std::path::Path;

use sqlx::migrate::{MigrateError, Migration, MigrationType, Migrator};
use sqlx::{SqlSafeStr, SqliteConnection};

use super::lock::FormerWorkerLock;
use super::open::open_error;
use crate::queue::QueueError;

/// Set by the first migration: "trib" in ASCII.
const APPLICATION_ID: i64 = 0x7472_6962;

/// Without an owner's mark, only a database without tables may become ours. The table of migrations is not
/// counted: it is created before the first migration, and the program may have been stopped in between.
const OTHER_TABLES: &str = "
    SELECT COUNT(*) FROM sqlite_schema
    WHERE type = 'table' AND name <> '_sqlx_migrations' AND name NOT LIKE 'sqlite\\_%' ESCAPE '\\'";

/// Refuses a file that is no database, or another program's, before anything in it is changed.
pub(super) async fn check_ownership(
    connection: &mut SqliteConnection,
    path: &Path,
) -> Result<(), QueueError> {
    let failed = |source| open_error(path, source);
    let id: i64 =
        sqlx::query_scalar("PRAGMA application_id").fetch_one(&mut *connection).await.map_err(failed)?;
    if id == APPLICATION_ID {
        return Ok(());
    }
    let tables: i64 = sqlx::query_scalar(OTHER_TABLES).fetch_one(&mut *connection).await.map_err(failed)?;
    if id == 0 && tables == 0 { Ok(()) } else { Err(QueueError::ForeignDatabase { path: path.into() }) }
}

/// Brings the tables up to date. The caller holds the opening lock: the migrator takes none on `SQLite`.
///
/// Foreign keys are off on return, and to be switched on.
pub(super) async fn migrate(connection: &mut SqliteConnection, path: &Path) -> Result<(), QueueError> {
    let migrator = migrator();
    let known = newest(&migrator);
    // Tables are rebuilt under those that refer to them; the pragma does nothing inside a migration's transaction.
    sqlx::query("PRAGMA foreign_keys = OFF").execute(&mut *connection).await?;
    let former = if version(connection).await? == 1 { Some(FormerWorkerLock::take(path)?) } else { None };
    migrator.run(connection).await.map_err(|error| match error {
        MigrateError::VersionMissing(found) if found > known => {
            QueueError::NewerDatabase { database: path.into(), found, known }
        }
        source => QueueError::Migrate { database: path.into(), source },
    })?;
    if let Some(former) = former {
        former.remove();
    }
    Ok(())
}

/// Refuses tables that this program does not read as they are, where they cannot be changed.
pub(super) async fn check_version(connection: &mut SqliteConnection, path: &Path) -> Result<(), QueueError> {
    let (found, needed) = (version(connection).await?, newest(&migrator()));
    match found.cmp(&needed) {
        Ordering::Equal => Ok(()),
        Ordering::Less => Err(QueueError::OlderDatabase { path: path.into(), found, needed }),
        Ordering::Greater => Err(QueueError::NewerDatabase { database: path.into(), found, known: needed }),
    }
}

/// The version of the tables, 0 if there are none.
async fn version(connection: &mut SqliteConnection) -> Result<i64, QueueError> {
    let tables: i64 =
        sqlx::query_scalar("SELECT COUNT(*) FROM sqlite_schema WHERE name = '_sqlx_migrations'")
            .fetch_one(&mut *connection)
            .await?;
    if tables == 0 {
        return Ok(0);
    }
    let newest = sqlx::query_scalar("SELECT COALESCE(MAX(version), 0) FROM _sqlx_migrations");
    Ok(newest.fetch_one(connection).await?)
}

fn newest(migrator: &Migrator) -> i64 {
    migrator.iter().map(|migration| migration.version).max().unwrap_or(0)
}

fn migrator() -> Migrator {
    let migration = |version, name: &'static str, sql: &'static str| {
        Migration::new(version, name.into(), MigrationType::Simple, sql.into_sql_str(), false)
    };
    Migrator::with_migrations(vec![
        migration(1, "queue", include_str!("../../../migrations/sqlite/0001_queue.sql")),
        migration(2, "leases", include_str!("../../../migrations/sqlite/0002_leases.sql")),
        migration(3, "workers", include_str!("../../../migrations/sqlite/0003_workers.sql")),
    ])
}
