//! File locks of the operating system, on files beside the database. A lock ends with the process that holds it,
//! however the process ends, so no stale locks remain. The empty file of the opening lock stays.

use std::fs::{File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};

use crate::queue::error::QueueError;

/// The lock that a process with the first schema held while it ran jobs. Whoever holds it knows that no such process
/// runs.
pub(super) struct FormerWorkerLock {
    path: PathBuf,
    _file: File,
}

impl FormerWorkerLock {
    /// Takes the lock without waiting.
    ///
    /// # Errors
    /// [`QueueError::OlderWorking`] if another process holds the lock.
    pub fn take(database: &Path) -> Result<Self, QueueError> {
        let (path, file) = open_beside(database, ".worker")?;
        match file.try_lock() {
            Ok(()) => Ok(Self { path, _file: file }),
            Err(TryLockError::WouldBlock) => Err(QueueError::OlderWorking { path: database.into() }),
            Err(TryLockError::Error(source)) => Err(QueueError::File { path, source }),
        }
    }

    /// Deletes the lock file after the migration: no process with the first schema opens a newer database.
    pub fn remove(self) {
        // A remaining empty file does no harm.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Waits until no other process is opening the database. Others then wait until the returned file is closed.
pub(super) async fn opening_lock(database: &Path) -> Result<File, QueueError> {
    let (path, file) = open_beside(database, ".lock")?;
    // If two tasks of one single-threaded runtime open the database, waiting on the runtime's thread would block the
    // task that holds the lock.
    let locked = tokio::task::spawn_blocking(move || file.lock().map(|()| file)).await;
    locked.expect("locking a file does not panic").map_err(|source| QueueError::File { path, source })
}

/// Whether a lock file can be created beside the database.
pub(super) fn can_be_taken(database: &Path) -> bool {
    open_beside(database, ".lock").is_ok()
}

fn open_beside(database: &Path, suffix: &str) -> Result<(PathBuf, File), QueueError> {
    let mut path = database.as_os_str().to_owned();
    path.push(suffix);
    let path = PathBuf::from(path);
    match OpenOptions::new().create(true).truncate(false).write(true).open(&path) {
        Ok(file) => Ok((path, file)),
        Err(source) => Err(QueueError::File { path, source }),
    }
}
