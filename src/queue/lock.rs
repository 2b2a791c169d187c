//! Locks of the operating system on files beside the database. They end with the process that holds them,
//! however it ends, so there is nothing stale to clean up; the empty files stay.

use std::fs::{File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};

use super::QueueError;
use super::open::resolve;

/// The right to run the jobs of a database, held by one process at a time.
#[derive(Debug)]
pub struct WorkerLock {
    database: PathBuf,
    // Held for its lock, which ends when the file is closed.
    _file: File,
}

impl WorkerLock {
    /// Takes the lock of the database at `path`, without waiting.
    ///
    /// # Errors
    /// [`QueueError::AlreadyWorking`] if another process holds it.
    pub fn acquire(path: &Path) -> Result<Self, QueueError> {
        let database = resolve(path)?;
        let (lock_path, file) = open_beside(&database, ".worker")?;
        match file.try_lock() {
            Ok(()) => Ok(Self { database, _file: file }),
            Err(TryLockError::WouldBlock) => Err(QueueError::AlreadyWorking { path: database }),
            Err(TryLockError::Error(source)) => Err(QueueError::File { path: lock_path, source }),
        }
    }

    /// The database whose jobs may be run.
    pub(super) fn database(&self) -> &Path {
        &self.database
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

fn open_beside(database: &Path, suffix: &str) -> Result<(PathBuf, File), QueueError> {
    let mut path = database.as_os_str().to_owned();
    path.push(suffix);
    let path = PathBuf::from(path);
    match OpenOptions::new().create(true).truncate(false).write(true).open(&path) {
        Ok(file) => Ok((path, file)),
        Err(source) => Err(QueueError::File { path, source }),
    }
}
