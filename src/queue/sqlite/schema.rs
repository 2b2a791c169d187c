//! The tables and their versions: the files in `migrations/sqlite`. Each is applied once, in order.

use std::cmp::Ordering;
use std::path::Path;

use sqlx::migrate::{MigrateError, Migration, MigrationType, Migrator};
use sqlx::{SqlSafeStr, SqliteConnection};

use super::error::{classify, classify_at_open};
use crate::queue::error::QueueError;

/// The application id in the file's header, set by the first migration: "trib" in ASCII.
const APPLICATION_ID: i64 = 0x7472_6962;

/// A database without an application id may only be used if it has no tables. The table of migrations does not count:
/// it is created before the first migration, and the program may have been stopped in between.
const OTHER_TABLES: &str = "
    SELECT COUNT(*) FROM sqlite_schema
    WHERE type = 'table' AND name <> '_sqlx_migrations' AND name NOT LIKE 'sqlite\\_%' ESCAPE '\\'";

/// Refuses a file that is not a database, or a database of another program, before anything in it is changed.
pub(super) async fn check_ownership(
    connection: &mut SqliteConnection,
    path: &Path,
) -> Result<(), QueueError> {
    let failed = |source| classify_at_open(path, source);
    let id: i64 =
        sqlx::query_scalar("PRAGMA application_id").fetch_one(&mut *connection).await.map_err(failed)?;
    if id == APPLICATION_ID {
        return Ok(());
    }
    let tables: i64 = sqlx::query_scalar(OTHER_TABLES).fetch_one(&mut *connection).await.map_err(failed)?;
    if id == 0 && tables == 0 { Ok(()) } else { Err(QueueError::ForeignDatabase { path: path.into() }) }
}

/// Brings the tables up to date. The caller must hold the opening lock: sqlx's migrator takes no lock on `SQLite`.
///
/// Foreign keys are off on return; the caller must switch them on.
pub(super) async fn migrate(connection: &mut SqliteConnection, path: &Path) -> Result<(), QueueError> {
    let migrator = migrator();
    let known = newest(&migrator);
    // A migration rebuilds tables that others refer to. The pragma has no effect inside the migration's transaction.
    sqlx::query("PRAGMA foreign_keys = OFF").execute(&mut *connection).await.map_err(classify)?;
    migrator.run(connection).await.map_err(|error| match error {
        MigrateError::VersionMissing(found) if found > known => {
            QueueError::NewerDatabase { database: path.into(), found, known }
        }
        error => QueueError::Migrate { database: path.into(), source: error.into() },
    })
}

/// Refuses a read-only database with tables of another version, which would have to be migrated first.
pub(super) async fn check_version(connection: &mut SqliteConnection, path: &Path) -> Result<(), QueueError> {
    let (found, needed) = (version(connection).await.map_err(classify)?, newest(&migrator()));
    match found.cmp(&needed) {
        Ordering::Equal => Ok(()),
        Ordering::Less => Err(QueueError::OlderDatabase { path: path.into(), found, needed }),
        Ordering::Greater => Err(QueueError::NewerDatabase { database: path.into(), found, known: needed }),
    }
}

/// The version of the tables, 0 if there are none.
async fn version(connection: &mut SqliteConnection) -> Result<i64, sqlx::Error> {
    let tables: i64 =
        sqlx::query_scalar("SELECT COUNT(*) FROM sqlite_schema WHERE name = '_sqlx_migrations'")
            .fetch_one(&mut *connection)
            .await?;
    if tables == 0 {
        return Ok(0);
    }
    let newest = sqlx::query_scalar("SELECT COALESCE(MAX(version), 0) FROM _sqlx_migrations");
    newest.fetch_one(connection).await
}

fn newest(migrator: &Migrator) -> i64 {
    migrator.iter().map(|migration| migration.version).max().unwrap_or(0)
}

fn migrator() -> Migrator {
    let migration = |version, name: &'static str, sql: &'static str| {
        Migration::new(version, name.into(), MigrationType::Simple, sql.into_sql_str(), false)
    };
    Migrator::with_migrations(vec![
        migration(1, "queue", include_str!("../migrations/sqlite/0001_queue.sql")),
        migration(2, "leases", include_str!("../migrations/sqlite/0002_leases.sql")),
        migration(3, "workers", include_str!("../migrations/sqlite/0003_workers.sql")),
        migration(4, "plans", include_str!("../migrations/sqlite/0004_plans.sql")),
        migration(5, "digests", include_str!("../migrations/sqlite/0005_digests.sql")),
    ])
}
