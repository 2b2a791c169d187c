use std::fs::OpenOptions;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use sqlx::sqlite::{SqliteConnectOptions, SqliteSynchronous};
use sqlx::{ConnectOptions, SqliteConnection};

use super::{filesystem, lock, schema};
use crate::queue::error::{SQLITE_NOTADB, sqlite_code};
use crate::queue::{QueueError, Settings};

/// The oldest `SQLite` that does not lose data when two connections write and checkpoint a log at once.
const OLDEST_SQLITE: [u32; 3] = [3, 51, 3];

/// 64 MiB; negative means KiB and not pages.
const CACHE_KIB: &str = "-65536";

/// 40 MB of pages, against 4 by default.
const LOG_PAGES: &str = "10000";

/// As many as are read at a time.
const ROWS_IN_FLIGHT: usize = 1_000;

/// Opens the database at `path`; creates it, but not its folder, if it is missing.
pub(in crate::queue) async fn open(path: &Path, settings: Settings) -> Result<SqliteConnection, QueueError> {
    let path = resolve(path)?;
    check_place(&path)?;
    // Creating the file, switching it to a write-ahead log and creating the tables all fail with
    // "database is locked" in one of two processes that do so at once; the busy timeout does not help.
    let opening = lock::opening_lock(&path).await?;
    let mut connection = connect(&path, options(&path, settings).create_if_missing(true)).await?;
    check_library(&mut connection).await?;
    schema::check_ownership(&mut connection, &path).await?;
    use_write_ahead_log(&mut connection, &path).await?;
    schema::migrate(&mut connection, &path).await?;
    sqlx::query("PRAGMA foreign_keys = ON").execute(&mut connection).await?;
    drop(opening);
    Ok(connection)
}

/// Opens the database at `path`, which must exist, for what only reads: also where nothing can be written.
pub(in crate::queue) async fn open_to_read(
    path: &Path,
    settings: Settings,
) -> Result<SqliteConnection, QueueError> {
    if is_writable(path) {
        return open(path, settings).await;
    }
    let path = resolve(path)?;
    check_place(&path)?;
    let beside = |suffix: &str| {
        let mut name = path.as_os_str().to_owned();
        name.push(suffix);
        Path::new(&name).exists()
    };
    // Without a log nobody is writing, and SQLite need not look for one; it could not create the shared memory
    // through which it would.
    let has_log = beside("-wal");
    if has_log && !beside("-shm") {
        return Err(QueueError::UnreadableLog { path });
    }
    let mut connection = connect(&path, options(&path, settings).read_only(true).immutable(!has_log)).await?;
    check_library(&mut connection).await?;
    schema::check_ownership(&mut connection, &path).await?;
    schema::check_version(&mut connection, &path).await?;
    Ok(connection)
}

fn check_place(path: &Path) -> Result<(), QueueError> {
    let folder = path.parent().unwrap_or(Path::new("/"));
    if let Some(kind) = filesystem::network_kind(folder) {
        return Err(QueueError::NetworkFileSystem { path: path.into(), kind });
    }
    if path.is_dir() {
        return Err(QueueError::NotADatabase { path: path.into() });
    }
    Ok(())
}

/// Whether the file can be written, and files beside it.
pub(in crate::queue) fn is_writable(path: &Path) -> bool {
    let refused = |error: &std::io::Error| {
        matches!(error.kind(), ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem)
    };
    let Ok(path) = resolve(path) else { return true };
    let file = OpenOptions::new().write(true).open(&path);
    // What is wrong otherwise is told by opening it.
    !file.is_err_and(|error| refused(&error)) && lock::can_be_taken(&path)
}

/// The one true name of a database that may not exist yet: locks are files beside the database, and a
/// symbolic link to it must lead to the same ones.
pub(in crate::queue) fn resolve(path: &Path) -> Result<PathBuf, QueueError> {
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

fn options(path: &Path, settings: Settings) -> SqliteConnectOptions {
    SqliteConnectOptions::new()
        .filename(path)
        .busy_timeout(settings.busy_timeout)
        // In a write-ahead log this can lose the last transactions in a power cut, never the database; what
        // is lost is simulated again.
        .synchronous(SqliteSynchronous::Normal)
        // A turn touches some pages of many tables; what is written to the log again and again is folded back once.
        .pragma("cache_size", CACHE_KIB)
        .pragma("wal_autocheckpoint", LOG_PAGES)
        // What a statement would need to be undone alone: written to a file, it costs a fifth of a turn.
        .pragma("temp_store", "MEMORY")
        // Rows come from a thread of their own; waking each other for every few costs more than reading them.
        .row_buffer_size(ROWS_IN_FLIGHT)
}

async fn connect(path: &Path, options: SqliteConnectOptions) -> Result<SqliteConnection, QueueError> {
    options.connect().await.map_err(|source| open_error(path, source))
}

/// Reading a file that is not a database fails wherever `SQLite` first looks at it.
pub(super) fn open_error(path: &Path, source: sqlx::Error) -> QueueError {
    if sqlite_code(&source) == Some(SQLITE_NOTADB) {
        return QueueError::NotADatabase { path: path.into() };
    }
    match QueueError::from(source) {
        QueueError::Database(source) => QueueError::Open { database: path.into(), source },
        known => known,
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
