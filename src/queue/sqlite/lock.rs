//! File locks of the operating system, on files beside the database. A lock ends with the process that holds it,
//! however the process ends, so no stale locks remain. The file of the opening lock stays. It
//! says which file the database is, and which file its log is.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, Write};
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

/// What the last opening wrote into the lock file; empty if it cannot be read.
pub(super) fn read(mut lock: &File) -> String {
    let mut text = String::new();
    match lock.read_to_string(&mut text) {
        Ok(_) => text,
        Err(_) => String::new(),
    }
}

/// Writes into the lock file for the next opening. It is only a help, so a full disk is no error.
pub(super) fn write(mut lock: &File, text: &str) {
    let _ = lock.set_len(0).and_then(|()| lock.rewind()).and_then(|()| lock.write_all(text.as_bytes()));
}

/// Whether a lock file can be created beside the database.
pub(super) fn can_be_taken(database: &Path) -> bool {
    open_beside(database, ".lock").is_ok()
}

fn open_beside(database: &Path, suffix: &str) -> Result<(PathBuf, File), QueueError> {
    let mut path = database.as_os_str().to_owned();
    path.push(suffix);
    let path = PathBuf::from(path);
    match OpenOptions::new().create(true).truncate(false).read(true).write(true).open(&path) {
        Ok(file) => Ok((path, file)),
        Err(source) => Err(QueueError::File { path, source }),
    }
}
