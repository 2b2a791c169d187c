use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use sqlx::sqlite::{SqliteConnectOptions, SqliteSynchronous};
use sqlx::{ConnectOptions, SqliteConnection};

use super::{Clock, Queue, QueueError, filesystem, lock, schema};

/// Far longer than any transaction here, so that only a lock somebody forgot ends in an error.
const BUSY_TIMEOUT: Duration = Duration::from_secs(30);

/// The oldest `SQLite` that does not lose data when two connections write and checkpoint a log at once.
const OLDEST_SQLITE: [u32; 3] = [3, 51, 3];

/// `SQLite`'s result code for a file with a wrong header.
const SQLITE_NOTADB: &str = "26";

impl Queue {
    /// Opens the database at `path`; creates it, but not its folder, if it is missing.
    ///
    /// # Errors
    /// If the folder is missing, the path holds something else or a newer schema, or the file system or
    /// the `SQLite` library cannot be trusted with several writers.
    pub async fn open(path: &Path, clock: Arc<dyn Clock>) -> Result<Self, QueueError> {
        let path = resolve(path)?;
        let folder = path.parent().unwrap_or(Path::new("/"));
        if let Some(kind) = filesystem::network_kind(folder) {
            return Err(QueueError::NetworkFileSystem { path, kind });
        }
        if path.is_dir() {
            return Err(QueueError::NotADatabase { path });
        }
        // Creating the file, switching it to a write-ahead log and creating the tables all fail with
        // "database is locked" in one of two processes that do so at once; the busy timeout does not help.
        let opening = lock::opening_lock(&path).await?;
        let mut connection = connect(&path).await?;
        check_library(&mut connection).await?;
        schema::check_ownership(&mut connection, &path).await?;
        use_write_ahead_log(&mut connection, &path).await?;
        schema::migrate(&mut connection, &path).await?;
        drop(opening);
        Ok(Self { connection, clock, path })
    }

    /// Opens the database at `path`, which must exist: for what only reads.
    ///
    /// # Errors
    /// [`QueueError::NoDatabase`] if there is none, otherwise as [`Queue::open`].
    pub async fn open_existing(path: &Path, clock: Arc<dyn Clock>) -> Result<Self, QueueError> {
        if !path.exists() {
            return Err(QueueError::NoDatabase { path: path.into() });
        }
        Self::open(path, clock).await
    }
}

/// The one true name of a database that may not exist yet: locks are files beside the database, and a
/// symbolic link to it must lead to the same ones.
pub(super) fn resolve(path: &Path) -> Result<PathBuf, QueueError> {
    if let Ok(existing) = path.canonicalize() {
        return Ok(existing);
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => Ok(folder.join(name)),
        _ => Err(QueueError::NoFolder { folder: folder.into() }),
    }
}

async fn connect(path: &Path) -> Result<SqliteConnection, QueueError> {
    SqliteConnectOptions::new()
        .filename(path)
        .create_if_missing(true)
        .busy_timeout(BUSY_TIMEOUT)
        .foreign_keys(true)
        // In a write-ahead log this can lose the last transactions in a power cut, never the database; what
        // is lost is simulated again.
        .synchronous(SqliteSynchronous::Normal)
        .connect()
        .await
        .map_err(|source| open_error(path, source))
}

/// Reading a file that is not a database fails wherever `SQLite` first looks at it.
pub(super) fn open_error(path: &Path, source: sqlx::Error) -> QueueError {
    let code = source.as_database_error().and_then(sqlx::error::DatabaseError::code);
    if code.as_deref() == Some(SQLITE_NOTADB) {
        QueueError::NotADatabase { path: path.into() }
    } else {
        QueueError::Open { path: path.into(), source }
    }
}

async fn check_library(connection: &mut SqliteConnection) -> Result<(), QueueError> {
    let version: String = sqlx::query_scalar("SELECT sqlite_version()").fetch_one(connection).await?;
    if is_safe(&version) {
        Ok(())
    } else {
        let oldest = OLDEST_SQLITE.map(|part| part.to_string()).join(".");
        Err(QueueError::OldSqlite { found: version, oldest })
    }
}

fn is_safe(version: &str) -> bool {
    let parts: Vec<u32> = version.split('.').map_while(|part| part.parse().ok()).collect();
    parts.as_slice() >= OLDEST_SQLITE.as_slice()
}

/// The pragma answers with the mode now in force and reports no error if that is not the one asked for.
async fn use_write_ahead_log(connection: &mut SqliteConnection, path: &Path) -> Result<(), QueueError> {
    let mode: String = sqlx::query_scalar("PRAGMA journal_mode = WAL").fetch_one(connection).await?;
    if mode.eq_ignore_ascii_case("wal") {
        Ok(())
    } else {
        Err(QueueError::NoWriteAheadLog { path: path.into(), mode })
    }
}

#[cfg(test)]
mod tests {
    use super::is_safe;

    /// Protects: versions are compared as numbers, and one that cannot be read is not trusted.
    #[test]
    fn old_libraries_are_refused() {
        for (version, safe) in [
            ("3.51.2", false),
            ("3.51.3", true),
            ("3.52.0", true),
            ("3.100.0", true),
            ("4.0.0", true),
            ("3.9.9", false),
            ("3.51", false),
            ("unknown", false),
        ] {
            assert_eq!(is_safe(version), safe, "{version}");
        }
    }
}
