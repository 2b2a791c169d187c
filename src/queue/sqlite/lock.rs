//! Locks of the operating system on files beside the database. They end with the process that holds them,
//! however it ends, so there is nothing stale to clean up; the empty file of the opening lock stays.

use std::fs::{File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};

use crate::queue::QueueError;

/// The lock that a process of the first schema held while it ran jobs; with it, none of them does.
pub(super) struct FormerWorkerLock {
    path: PathBuf,
    _file: File,
}

impl FormerWorkerLock {
    /// Takes it.
    ///
    /// # Errors
    /// [`QueueError::OlderWorking`] if a process holds it.
    pub fn take(database: &Path) -> Result<Self, QueueError> {
        let (path, file) = open_beside(database, ".worker")?;
        match file.try_lock() {
            Ok(()) => Ok(Self { path, _file: file }),
            Err(TryLockError::WouldBlock) => Err(QueueError::OlderWorking { path: database.into() }),
            Err(TryLockError::Error(source)) => Err(QueueError::File { path, source }),
        }
    }

    /// Ends it with its file, when nobody needs it any more: no process of the first schema opens a newer database.
    pub fn remove(self) {
        // An empty file that stays is no harm.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Waits until nobody else is opening the database; others wait until the returned file is closed.
pub(super) async fn opening_lock(database: &Path) -> Result<File, QueueError> {
    let (path, file) = open_beside(database, ".lock")?;
    // Waiting on the runtime's own thread would stop the very task that is to release the lock, if two
    // tasks of one runtime open the database.
    let locked = tokio::task::spawn_blocking(move || file.lock().map(|()| file)).await;
    locked.expect("locking a file does not panic").map_err(|source| QueueError::File { path, source })
}

/// Whether a lock file can be written beside the database.
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
