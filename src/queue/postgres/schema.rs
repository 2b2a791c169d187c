//! The tables and their versions: the files in `migrations/postgres`. Each is applied once, in order.

use sqlx::migrate::{MigrateError, Migration, MigrationType, Migrator};
use sqlx::{PgConnection, SqlSafeStr};

use super::error::classify;
use crate::queue::error::QueueError;
use crate::queue::location::Location;

/// The schema that contains the tables, so that other programs can use the same database.
pub(super) const NAME: &str = "tribosweep";

/// The key of the advisory lock that a process holds while it creates or migrates tables.
const MIGRATION_LOCK: i64 = 0x7472_6962_0000_0002;

/// Whether there are tables.
pub(super) async fn has_tables(connection: &mut PgConnection) -> Result<bool, sqlx::Error> {
    let exists = "SELECT to_regclass($1) IS NOT NULL";
    sqlx::query_scalar(exists).bind(format!("{NAME}._sqlx_migrations")).fetch_one(connection).await
}

/// Brings the tables up to date, if they are not.
pub(super) async fn migrate(connection: &mut PgConnection, location: &Location) -> Result<(), QueueError> {
    let migrator = migrator();
    let known = migrator.iter().map(|migration| migration.version).max().unwrap_or(0);
    if version(connection).await.map_err(classify)? == known {
        return Ok(());
    }
    let lock = sqlx::query("SELECT pg_advisory_lock($1)").bind(MIGRATION_LOCK);
    lock.execute(&mut *connection).await.map_err(classify)?;
    let migrated = apply(connection, &migrator, location, known).await;
    let unlock = sqlx::query("SELECT pg_advisory_unlock($1)").bind(MIGRATION_LOCK);
    unlock.execute(connection).await.map_err(classify)?;
    migrated
}

async fn apply(
    connection: &mut PgConnection,
    migrator: &Migrator,
    location: &Location,
    known: i64,
) -> Result<(), QueueError> {
    let create = sqlx::AssertSqlSafe(format!("CREATE SCHEMA IF NOT EXISTS {NAME}"));
    sqlx::raw_sql(create).execute(&mut *connection).await.map_err(classify)?;
    migrator.run(connection).await.map_err(|error| match error {
        MigrateError::VersionMissing(found) if found > known => {
            QueueError::NewerDatabase { database: location.clone(), found, known }
        }
        error => QueueError::Migrate { database: location.clone(), source: error.into() },
    })
}

/// The version of the tables, 0 if there are none.
async fn version(connection: &mut PgConnection) -> Result<i64, sqlx::Error> {
    if !has_tables(connection).await? {
        return Ok(0);
    }
    let newest = sqlx::query_scalar("SELECT COALESCE(MAX(version), 0) FROM _sqlx_migrations");
    newest.fetch_one(connection).await
}

fn migrator() -> Migrator {
    let migration = |version, name: &'static str, sql: &'static str| {
        Migration::new(version, name.into(), MigrationType::Simple, sql.into_sql_str(), false)
    };
    Migrator::with_migrations(vec![
        migration(1, "queue", include_str!("../migrations/postgres/0001_queue.sql")),
        migration(2, "plans", include_str!("../migrations/postgres/0002_plans.sql")),
        migration(3, "digests", include_str!("../migrations/postgres/0003_digests.sql")),
    ])
}
