use std::path::PathBuf;

use sqlx::error::DatabaseError;
use sqlx::sqlite::SqliteError;

use super::Location;

/// What can go wrong with the queue, with what to do about it in the text.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum QueueError {
    /// The folder of a database that is to be created does not exist.
    #[error("the folder {folder} for the database does not exist; create it, or give another database path")]
    NoFolder {
        /// The missing folder.
        folder: PathBuf,
    },

    /// There is nothing to read.
    #[error("no database at {database}; submit a study first with `tribosweep submit STUDY`")]
    NoDatabase {
        /// Where the database was looked for.
        database: Location,
    },

    /// The path holds something else.
    #[error("{path} is not a SQLite database and is left as it is; give another database path")]
    NotADatabase {
        /// The file or folder found there.
        path: PathBuf,
    },

    /// The path holds a database with other tables.
    #[error(
        "{path} is a SQLite database of another program and is left as it is; give another database path"
    )]
    ForeignDatabase {
        /// The file found there.
        path: PathBuf,
    },

    /// The database's schema has migrations this program does not know.
    #[error(
        "{database} was written by a newer tribosweep (schema {found}; this one knows up to {known}); \
         update tribosweep, or give another database path"
    )]
    NewerDatabase {
        /// The database.
        database: Location,
        /// Its schema version.
        found: i64,
        /// The newest schema version this program knows.
        known: i64,
    },

    /// The linked `SQLite` can corrupt a write-ahead log that two connections write.
    #[error(
        "SQLite {found} is linked, and versions before {oldest} can corrupt a database that two processes write; \
         build tribosweep with its bundled SQLite"
    )]
    OldSqlite {
        /// The version linked.
        found: String,
        /// The oldest version accepted.
        oldest: String,
    },

    /// The file system cannot share memory between processes the way a write-ahead log needs.
    #[error(
        "{path} lies on a network file system ({kind}), where SQLite's locks and write-ahead log cannot be relied on; \
         put the database on a local disk and copy it when the work is done"
    )]
    NetworkFileSystem {
        /// The database file.
        path: PathBuf,
        /// The file system's type.
        kind: String,
    },

    /// `SQLite` accepted the wish for a write-ahead log and did something else.
    #[error(
        "{path} cannot use a write-ahead log (SQLite stays in mode `{mode}`); put the database on a local disk"
    )]
    NoWriteAheadLog {
        /// The database file.
        path: PathBuf,
        /// The journal mode in force.
        mode: String,
    },

    /// A process of an earlier version, which knows nothing of several workers, runs jobs.
    #[error(
        "an older tribosweep is working on {path}, and its tables are to be brought up to date; \
         wait for it to end, or stop it first"
    )]
    OlderWorking {
        /// The database file.
        path: PathBuf,
    },

    /// The database cannot be brought up to date because it cannot be written.
    #[error(
        "{path} was written by an older tribosweep (schema {found}; this one needs {needed}) and cannot be written \
         here; copy it to a folder that can be written"
    )]
    OlderDatabase {
        /// The database file.
        path: PathBuf,
        /// Its schema version.
        found: i64,
        /// The version that this program reads.
        needed: i64,
    },

    /// A log that is not folded in yet needs a file of shared memory to be read.
    #[error(
        "{path} has a write-ahead log, which cannot be read where nothing can be written; copy {path} and {path}-wal \
         to a folder that can be written"
    )]
    UnreadableLog {
        /// The database file.
        path: PathBuf,
    },

    /// No study has that name.
    #[error("there is no study `{name}` in the database; {}", existing(.known))]
    UnknownStudy {
        /// The name asked for.
        name: String,
        /// The studies there are, oldest first.
        known: Vec<String>,
    },

    /// Another study has that name.
    #[error(
        "the study `{name}` is another one in the database that is written to; remove one of them (`tribosweep rm`), or \
         submit one under another name"
    )]
    OtherStudy {
        /// The name.
        name: String,
    },

    /// A job's cost cannot be ordered or summed.
    #[error("job {key} has the cost {cost}; a cost is a finite number")]
    BadCost {
        /// The job's key.
        key: String,
        /// Its cost.
        cost: f64,
    },

    /// A file beside the database (a lock) could not be used.
    #[error("cannot use {path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },

    /// The database file could not be opened.
    #[error("cannot open the database {database}: {source}")]
    Open {
        /// The database.
        database: Location,
        /// What the database said.
        source: sqlx::Error,
    },

    /// The tables could not be created or brought up to date.
    #[error("cannot bring the tables of {database} up to date: {source}")]
    Migrate {
        /// The database.
        database: Location,
        /// What the migration said.
        source: sqlx::migrate::MigrateError,
    },

    /// The server cannot be used as it is asked for.
    #[error("{database}: {reason}")]
    Server {
        /// The database.
        database: Location,
        /// What is wrong, and what would be right.
        reason: String,
    },

    /// The server could not be reached to open the database.
    #[error("{database}: no answer from the server ({reason})")]
    NoAnswer {
        /// The database.
        database: Location,
        /// What came instead of an answer.
        reason: String,
    },

    /// Somebody else holds a lock longer than the busy timeout.
    #[error(
        "the database is locked: another program holds a lock on it for longer than anything here takes. Close what \
         has it open (a database shell, a viewer, a backup); the same command then goes on, and nothing is lost"
    )]
    Locked(#[source] sqlx::Error),

    /// The server does not answer, or has ended the connection. What was sent last may have been done or not.
    #[error(
        "the database server does not answer ({0}); nothing is lost, and the same command goes on when it does"
    )]
    Unreachable(String),

    /// There is no room.
    #[error(
        "the disk of the database is full; what was stored is kept. Make room and start the same command again"
    )]
    DiskFull(#[source] sqlx::Error),

    /// The database may be read only.
    #[error(
        "the database cannot be written (its file or folder is read-only or somebody else's, or the server does not allow \
         it to this user: {0}); change that, or copy it and give the copy with --db"
    )]
    ReadOnly(#[source] sqlx::Error),

    /// The file is not what `SQLite` wrote.
    #[error(
        "the database is damaged: {0}. Look at it with `tribosweep doctor`; what can still be read comes out of \
         `sqlite3 FILE .recover`, and a backup is better"
    )]
    Damaged(#[source] sqlx::Error),

    /// Anything else the database reports.
    #[error("the database reports: {0}")]
    Database(#[source] sqlx::Error),
}

impl QueueError {
    /// Whether the same may well succeed a while later.
    pub fn is_transient(&self) -> bool {
        matches!(self, Self::Locked(_) | Self::Unreachable(_) | Self::NoAnswer { .. })
    }
}

impl From<sqlx::Error> for QueueError {
    fn from(source: sqlx::Error) -> Self {
        #[cfg(feature = "postgres")]
        let source = match super::postgres::error::known(source) {
            Ok(known) => return known,
            Err(other) => other,
        };
        match sqlite_code(&source) {
            Some(SQLITE_BUSY | SQLITE_LOCKED) => Self::Locked(source),
            Some(SQLITE_READONLY) => Self::ReadOnly(source),
            Some(SQLITE_CORRUPT | SQLITE_NOTADB) => Self::Damaged(source),
            Some(SQLITE_FULL) => Self::DiskFull(source),
            Some(SQLITE_IOERR) if extended_code(&source) == Some(SQLITE_IOERR_SHMSIZE) => {
                Self::DiskFull(source)
            }
            _ => Self::Database(source),
        }
    }
}

const SQLITE_BUSY: u32 = 5;
const SQLITE_LOCKED: u32 = 6;
const SQLITE_READONLY: u32 = 8;
const SQLITE_IOERR: u32 = 10;
/// There is no room for the shared memory, the first thing that whoever opens the database writes.
const SQLITE_IOERR_SHMSIZE: u32 = SQLITE_IOERR | (19 << 8);
const SQLITE_CORRUPT: u32 = 11;
const SQLITE_FULL: u32 = 13;
/// A file with a wrong header.
pub(super) const SQLITE_NOTADB: u32 = 26;

/// `SQLite`'s primary result code; the extended one, which sqlx gives, has the details in its upper bits.
pub(super) fn sqlite_code(error: &sqlx::Error) -> Option<u32> {
    extended_code(error).map(|extended| extended & 0xff)
}

fn extended_code(error: &sqlx::Error) -> Option<u32> {
    error.as_database_error()?.try_downcast_ref::<SqliteError>()?.code()?.parse().ok()
}

fn existing(known: &[String]) -> String {
    if known.is_empty() {
        "it has none yet: submit one with `tribosweep submit STUDY`".into()
    } else {
        format!("it has: {}", known.join(", "))
    }
}
