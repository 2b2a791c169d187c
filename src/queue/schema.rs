//! The tables and their versions: the files in `migrations/`, each applied once, in order.

use std::path::Path;

use sqlx::migrate::{MigrateError, Migration, MigrationType, Migrator};
use sqlx::{SqlSafeStr, SqliteConnection};

use super::QueueError;
use super::open::open_error;

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
pub(super) async fn migrate(connection: &mut SqliteConnection, path: &Path) -> Result<(), QueueError> {
    let migrator = migrator();
    let known = migrator.iter().map(|migration| migration.version).max().unwrap_or(0);
    migrator.run(connection).await.map_err(|error| match error {
        MigrateError::VersionMissing(found) if found > known => {
            QueueError::NewerDatabase { path: path.into(), found, known }
        }
        source => QueueError::Migrate { path: path.into(), source },
    })
}

fn migrator() -> Migrator {
    let migration = |version, name: &'static str, sql: &'static str| {
        Migration::new(version, name.into(), MigrationType::Simple, sql.into_sql_str(), false)
    };
    Migrator::with_migrations(vec![migration(1, "queue", include_str!("../../migrations/0001_queue.sql"))])
}
