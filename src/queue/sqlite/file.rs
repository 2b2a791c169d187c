//! An open database file, and whether it is still where it was opened.
//!
//! A file that is deleted, moved or replaced stays open: everything could be read and written as before, and nothing of it
//! would ever be seen at its path. The worst is the log beside it. Whoever opens another file at the same path would take the
//! log for the log of that file, and merge pages of one database into the other.

use std::fs;
use std::path::{Path, PathBuf};

use sqlx::sqlite::SqliteConnection;
use sqlx::{AssertSqlSafe, Connection as _};

use super::error::classify;
use super::holder;
use super::identity::Identity;
use crate::queue::error::QueueError;

/// An open database file.
#[derive(Debug)]
pub(in crate::queue) struct File {
    /// None once it is closed.
    connection: Option<SqliteConnection>,
    path: PathBuf,
    /// None where the system does not tell files apart.
    own: Option<Identity>,
    /// The files of the log, which lie beside it.
    log: Vec<(PathBuf, Identity)>,
    /// Whether it is written to although it is not at its path, to rescue what it has.
    is_being_rescued: bool,
    /// Whether what the file has is where it can be found.
    is_rescued: bool,
}

/// The files of the log.
const LOG: [&str; 2] = ["-wal", "-shm"];

/// How many names for a copy are tried.
const COPIES: u32 = 100;

impl File {
    /// The file at `path`, which `connection` has just opened.
    pub(super) fn new(connection: SqliteConnection, path: &Path) -> Self {
        let identified = |path: PathBuf| Identity::of(&path).ok().map(|identity| (path, identity));
        Self {
            connection: Some(connection),
            path: path.into(),
            own: Identity::of(path).ok(),
            log: LOG.iter().filter_map(|suffix| identified(beside(path, suffix))).collect(),
            is_being_rescued: false,
            is_rescued: false,
        }
    }

    /// The connection.
    pub fn connection(&mut self) -> &mut SqliteConnection {
        self.connection.as_mut().expect("the file is open until it is closed")
    }

    /// The queue's error for an error of a statement. A lock is reported with its holder, if that is known.
    pub fn explain(&self, error: sqlx::Error) -> QueueError {
        match classify(error) {
            QueueError::Locked { source, .. } => {
                QueueError::Locked { source, holder: holder::in_words(&self.path) }
            }
            error => error,
        }
    }

    /// Checks that the file is still at its path.
    ///
    /// # Errors
    /// [`QueueError::Displaced`].
    pub fn check_place(&self) -> Result<(), QueueError> {
        if self.is_being_rescued || !self.is_displaced() {
            return Ok(());
        }
        let is_replaced = self.path.exists();
        let how = match self.present_path() {
            Some(now) => format!("moved to {}", now.display()),
            None if is_replaced => "replaced by another file".to_owned(),
            None if cfg!(target_os = "linux") => "deleted".to_owned(),
            None => "deleted or moved".to_owned(),
        };
        Err(QueueError::Displaced { path: self.path.clone(), how, kept: String::new() })
    }

    fn is_displaced(&self) -> bool {
        self.own.is_some_and(|own| own.has_left(&self.path))
    }

    fn present_path(&self) -> Option<PathBuf> {
        self.own.and_then(|own| own.present_path())
    }

    /// Allows transactions in a displaced file, for what is to be rescued with it.
    pub fn begin_rescue(&mut self) {
        self.is_being_rescued = true;
    }

    /// Makes sure that all that is stored in a displaced file is in a file that has a path: in the file itself where it was
    /// moved to, or in a copy. Returns that path.
    ///
    /// # Errors
    /// If there is no room for a copy, or its folders cannot be written.
    pub async fn rescue(&mut self) -> Result<PathBuf, QueueError> {
        if let Some(now) = self.present_path()
            && self.merge_log().await.unwrap_or(false)
        {
            self.is_rescued = true;
            return Ok(now);
        }
        let name = self.path.file_name().unwrap_or_default().to_owned();
        let beside = self.path.parent().unwrap_or(Path::new("/")).to_owned();
        let mut copied = Err(QueueError::NoFolder { folder: beside.clone() });
        for folder in [beside, std::env::temp_dir()] {
            let Some(path) = unused(&folder, &name) else { continue };
            let copy = sqlx::query("VACUUM INTO $1").bind(path.to_string_lossy().into_owned());
            copied = copy.execute(self.connection()).await.map(|_| path.clone()).map_err(classify);
            if copied.is_ok() {
                self.is_rescued = true;
                return copied;
            }
            // What there was no room for is no database.
            let _ = fs::remove_file(path);
        }
        copied
    }

    /// Merges the log into the file; false if another process still reads it.
    async fn merge_log(&mut self) -> Result<bool, QueueError> {
        let merge = AssertSqlSafe("PRAGMA wal_checkpoint(TRUNCATE)");
        let (is_busy, ..): (i64, i64, i64) =
            sqlx::query_as(merge).fetch_one(self.connection()).await.map_err(classify)?;
        Ok(is_busy == 0)
    }

    /// Closes the file. The last process that closes it merges the log into it.
    pub async fn close(mut self) -> Result<(), QueueError> {
        if self.is_displaced() {
            self.abandon();
        }
        match self.connection.take() {
            Some(connection) => connection.close().await.map_err(classify),
            None => Ok(()),
        }
    }

    /// Leaves a displaced file without closing it: `SQLite` would delete the log at its old path, which may be that of
    /// another database by now. The system closes it with the process.
    fn abandon(&mut self) {
        std::mem::forget(self.connection.take());
        if !self.is_rescued {
            return;
        }
        // What is in the log is elsewhere. A log that stayed would be merged into another file at the same path.
        for (path, identity) in &self.log {
            if !identity.has_left(path) {
                let _ = fs::remove_file(path);
            }
        }
    }
}

impl Drop for File {
    fn drop(&mut self) {
        if self.connection.is_some() && self.is_displaced() {
            self.abandon();
        }
    }
}

/// What is written down beside a database: which file it is, and which file its log is.
///
/// With it, the log of a file that is not there any more is recognised by whoever opens another file at its path.
pub(super) fn record(path: &Path) -> Option<String> {
    let [own, log] = [path.to_owned(), beside(path, LOG[0])].map(|path| Identity::of(&path).ok());
    Some(format!("{} {}\n", own?.to_word(), log?.to_word()))
}

/// Whether the log beside the file at `path` is that of another file, as the `record` of the last opening says. Not if both
/// are copies: then they may belong together.
pub(super) fn has_log_of_another(path: &Path, record: &str) -> bool {
    let mut words = record.split_ascii_whitespace().map(Identity::from_word);
    let (Some(Some(own)), Some(Some(log))) = (words.next(), words.next()) else { return false };
    path.exists() && own.has_left(path) && !log.has_left(&beside(path, LOG[0]))
}

pub(super) fn beside(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// A path in `folder` for a copy of a database called `name`.
fn unused(folder: &Path, name: &std::ffi::OsStr) -> Option<PathBuf> {
    (1..COPIES)
        .map(|number| beside(&folder.join(name), &format!(".rescued-{number}")))
        .find(|path| !path.exists())
}
