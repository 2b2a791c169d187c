use std::path::PathBuf;

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
    #[error("no database at {path}; submit a study first with `tribosweep submit STUDY`")]
    NoDatabase {
        /// Where the database was looked for.
        path: PathBuf,
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
        "{path} was written by a newer tribosweep (schema {found}; this one knows up to {known}); \
         update tribosweep, or give another database path"
    )]
    NewerDatabase {
        /// The database file.
        path: PathBuf,
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

    /// Another process holds the worker lock.
    #[error(
        "another `tribosweep work` or `tribosweep run` is working on {path}; wait for it to end, or stop it first"
    )]
    AlreadyWorking {
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
    #[error("cannot open the database {path}: {source}")]
    Open {
        /// The database file.
        path: PathBuf,
        /// What `SQLite` said.
        source: sqlx::Error,
    },

    /// The tables could not be created or brought up to date.
    #[error("cannot bring the tables of {path} up to date: {source}")]
    Migrate {
        /// The database file.
        path: PathBuf,
        /// What the migration said.
        source: sqlx::migrate::MigrateError,
    },

    /// Anything else `SQLite` reports: full disk, damaged file, a lock that another program keeps.
    #[error("the database reports: {0}")]
    Database(#[from] sqlx::Error),
}

fn existing(known: &[String]) -> String {
    if known.is_empty() {
        "it has none yet: submit one with `tribosweep submit STUDY`".into()
    } else {
        format!("it has: {}", known.join(", "))
    }
}
