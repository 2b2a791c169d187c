//! File locks of the operating system, on files beside the database. A lock ends with the process that holds it,
//! however the process ends, so no stale locks remain. The file of the opening lock stays. It
//! says which file the database is, and which file its log is.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};

use crate::queue::error::QueueError;

/// Waits until no other process is opening the database. Others then wait until the returned file is closed.
pub(super) async fn opening_lock(database: &Path) -> Result<File, QueueError> {
    let (path, file) = open_lock(database)?;
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
    open_lock(database).is_ok()
}

fn open_lock(database: &Path) -> Result<(PathBuf, File), QueueError> {
    let mut path = database.as_os_str().to_owned();
    path.push(".lock");
    let path = PathBuf::from(path);
    match OpenOptions::new().create(true).truncate(false).read(true).write(true).open(&path) {
        Ok(file) => Ok((path, file)),
        Err(source) => Err(QueueError::File { path, source }),
    }
}
