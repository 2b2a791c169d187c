use std::fs::OpenOptions;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use sqlx::sqlite::{SqliteConnectOptions, SqliteSynchronous};
use sqlx::{ConnectOptions, SqliteConnection};

use super::error::{classify, classify_at_open};
use super::file::{self, File};
use super::{filesystem, lock, schema};
use crate::queue::error::QueueError;
use crate::queue::settings::Settings;

/// The oldest supported `SQLite`. Earlier ones can lose data when one connection writes to the log and another one
/// makes a checkpoint at the same time.
const OLDEST_SQLITE: [u32; 3] = [3, 51, 3];

/// The size of the page cache: 64 MiB. A negative number means KiB instead of pages.
const CACHE_KIB: &str = "-65536";

/// How many pages the write-ahead log has before a checkpoint: 40 MB instead of 4 MB by default.
const LOG_PAGES: &str = "10000";

/// The size of the buffer between the database's thread and the reader: one page of rows.
const ROWS_IN_FLIGHT: usize = 1_000;

/// Opens the database at `path`. Creates it if it is missing, but not its folder.
pub(in crate::queue) async fn open(path: &Path, settings: Settings) -> Result<File, QueueError> {
    let path = resolve(path)?;
    check_path(&path)?;
    // If two processes create the file, switch it to a write-ahead log or create the tables at the same time, one of
    // them fails with "database is locked". The busy timeout does not help.
    let opening = lock::opening_lock(&path).await?;
    if file::has_log_of_another(&path, &lock::read(&opening)) {
        return Err(QueueError::LogOfAnother { path });
    }
    let mut connection = connect(&path, options(&path, settings).create_if_missing(true)).await?;
    check_library(&mut connection).await?;
    schema::check_ownership(&mut connection, &path).await?;
    use_write_ahead_log(&mut connection, &path).await?;
    schema::migrate(&mut connection, &path).await?;
    sqlx::query("PRAGMA foreign_keys = ON").execute(&mut connection).await.map_err(classify)?;
    let file = File::new(connection, &path);
    if let Some(record) = file::record(&path) {
        lock::write(&opening, &record);
    }
    drop(opening);
    Ok(file)
}

/// Opens the database at `path`, which must exist, for reading. This also works if the file and its folder are
/// read-only.
pub(in crate::queue) async fn open_to_read(path: &Path, settings: Settings) -> Result<File, QueueError> {
    check_kind(path)?;
    if is_writable(path) {
        return open(path, settings).await;
    }
    let path = resolve(path)?;
    check_path(&path)?;
    let beside = |suffix: &str| file::beside(&path, suffix).exists();
    // Without a log, no process is writing. SQLite is then told that the file is immutable, because otherwise it would
    // try to create the shared memory for a log.
    let has_log = beside("-wal");
    if has_log && !beside("-shm") {
        return Err(QueueError::UnreadableLog { path });
    }
    let mut connection = connect(&path, options(&path, settings).read_only(true).immutable(!has_log)).await?;
    check_library(&mut connection).await?;
    schema::check_ownership(&mut connection, &path).await?;
    schema::check_version(&mut connection, &path).await?;
    Ok(File::new(connection, &path))
}

fn check_path(path: &Path) -> Result<(), QueueError> {
    let folder = path.parent().unwrap_or(Path::new("/"));
    if let Some(kind) = filesystem::network_kind(folder) {
        return Err(QueueError::NetworkFileSystem { path: path.into(), kind });
    }
    check_kind(path)
}

/// Refuses what is no regular file. Opening a pipe would wait for another program.
fn check_kind(path: &Path) -> Result<(), QueueError> {
    let Ok(metadata) = path.metadata() else { return Ok(()) };
    let kind = if metadata.is_dir() { "a folder" } else { "a pipe or a device" };
    if metadata.is_file() { Ok(()) } else { Err(QueueError::NotAFile { path: path.into(), kind }) }
}

/// Checks whether a database can be created at `path`, without creating it.
pub(in crate::queue) fn check_new(path: &Path) -> Result<(), QueueError> {
    let path = resolve(path)?;
    check_path(&path)?;
    let folder = path.parent().unwrap_or(Path::new("/"));
    tempfile::tempfile_in(folder).map(drop).map_err(|source| QueueError::File { path, source })
}

/// Whether the database file and files beside it can be written.
pub(in crate::queue) fn is_writable(path: &Path) -> bool {
    let refused = |error: &std::io::Error| {
        matches!(error.kind(), ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem)
    };
    let Ok(path) = resolve(path) else { return true };
    let file = OpenOptions::new().write(true).open(&path);
    // Other errors are reported when the database is opened.
    !file.is_err_and(|error| refused(&error)) && lock::can_be_taken(&path)
}

/// The canonical path of a database that may not exist yet. Lock files are beside the database, and a symbolic link to
/// the database must lead to the same lock files.
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
        // With a write-ahead log, a power cut can lose the last transactions, but it cannot damage the database. Lost
        // results are simulated again.
        .synchronous(SqliteSynchronous::Normal)
        // An exchange changes some pages of many tables. With fewer checkpoints, a page that changes often is copied
        // from the log into the database once.
        .pragma("cache_size", CACHE_KIB)
        .pragma("wal_autocheckpoint", LOG_PAGES)
        // Statement journals in a file would take a fifth of the time of an exchange.
        .pragma("temp_store", "MEMORY")
        // A separate thread reads the rows. With a small buffer, the two threads would wake each other so often that
        // this takes more time than reading.
        .row_buffer_size(ROWS_IN_FLIGHT)
}

async fn connect(path: &Path, options: SqliteConnectOptions) -> Result<SqliteConnection, QueueError> {
    options.connect().await.map_err(|source| classify_at_open(path, source))
}

async fn check_library(connection: &mut SqliteConnection) -> Result<(), QueueError> {
    let version: String =
        sqlx::query_scalar("SELECT sqlite_version()").fetch_one(connection).await.map_err(classify)?;
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

/// The pragma returns the mode that is now in force. It reports no error if the requested mode is not possible.
async fn use_write_ahead_log(connection: &mut SqliteConnection, path: &Path) -> Result<(), QueueError> {
    let mode: String =
        sqlx::query_scalar("PRAGMA journal_mode = WAL").fetch_one(connection).await.map_err(classify)?;
    if mode.eq_ignore_ascii_case("wal") {
        Ok(())
    } else {
        Err(QueueError::NoWriteAheadLog { path: path.into(), mode })
    }
}

#[cfg(test)]
mod tests {
    use super::is_safe;

    /// Protects: versions are compared as numbers, and a version that cannot be parsed is refused.
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
