use std::error::Error;
use std::path::PathBuf;

use super::location::Location;
use super::replace::Replaced;

/// The error of the database library beneath. The library itself is no part of the queue's interface.
type Source = Box<dyn Error + Send + Sync>;

/// What can go wrong with the queue. The messages say what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum QueueError {
    /// The folder of a database that is to be created does not exist.
    #[error("the folder {folder} for the database does not exist; create it, or give another database path")]
    NoFolder {
        /// The missing folder.
        folder: PathBuf,
    },

    /// There is no database to read.
    #[error(
        "no database at {database}: `tribosweep run STUDY` makes one, and `--db` names one in another place"
    )]
    NoDatabase {
        /// Where the database was looked for.
        database: Location,
    },

    /// The path contains something else than a database.
    #[error("{path} is not a SQLite database and is left as it is; give another database path")]
    NotADatabase {
        /// The file or folder found there.
        path: PathBuf,
    },

    /// The path is that of something else than a file.
    #[error("{path} is {kind} and no database; give the path of a file")]
    NotAFile {
        /// The path as given.
        path: PathBuf,
        /// What is there.
        kind: &'static str,
    },

    /// The path contains a database of another program.
    #[error(
        "{path} is a SQLite database of another program and is left as it is; give another database path"
    )]
    ForeignDatabase {
        /// The file found there.
        path: PathBuf,
    },

    /// The database's schema has migrations that this program does not know.
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

    /// The linked `SQLite` can corrupt a write-ahead log that two connections write to.
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

    /// The database is on a network file system, which cannot provide the shared memory of a write-ahead log.
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

    /// `SQLite` cannot use a write-ahead log.
    #[error(
        "{path} cannot use a write-ahead log (SQLite stays in mode `{mode}`); put the database on a local disk"
    )]
    NoWriteAheadLog {
        /// The database file.
        path: PathBuf,
        /// The journal mode in force.
        mode: String,
    },

    /// The tables have to be migrated, and the database is read-only.
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

    /// The database is read-only and has a write-ahead log. `SQLite` would have to create a shared-memory file to read
    /// it.
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
        /// The existing studies, oldest first.
        known: Vec<String>,
    },

    /// A different study has that name.
    #[error(
        "the study `{name}` is another one in the database that is written to; remove one of them (`tribosweep rm`), or \
         submit one under another name"
    )]
    OtherStudy {
        /// The name.
        name: String,
    },

    /// A study of that name exists, and replacing it would take results from it.
    #[error(
        "the database has another study `{name}`, and replacing it would take results from it ({}; they stay stored); allow \
         that with --replace, or give this study another \"name\" (--name NAME)",
        .replaced.dropped_done
    )]
    ResultsWouldBeDropped {
        /// The name.
        name: String,
        /// The study that exists, against the new one.
        replaced: Box<Replaced>,
    },

    /// A study has the name already.
    #[error(
        "there is a study `{name}` already; give another name, or remove that study with `tribosweep rm {name}`"
    )]
    NameTaken {
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

    /// A lock file beside the database could not be used.
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
        source: Source,
    },

    /// The tables could not be created or brought up to date.
    #[error("cannot bring the tables of {database} up to date: {source}")]
    Migrate {
        /// The database.
        database: Location,
        /// What the migration said.
        source: Source,
    },

    /// The server cannot be used in the way that the URL demands.
    #[error("{database}: {reason}")]
    Server {
        /// The database.
        database: Location,
        /// What is wrong, and what to do.
        reason: String,
    },

    /// The server could not be reached when the database was opened.
    #[error("{database}: no answer from the server ({reason})")]
    NoAnswer {
        /// The database.
        database: Location,
        /// What happened instead of an answer.
        reason: String,
    },

    /// Another process holds a lock for longer than the busy timeout.
    #[error("the database is locked: {}; the same command then continues, and nothing is lost", lock(.holder.as_deref()))]
    Locked {
        /// What the database said.
        source: Source,
        /// The process that holds the lock and what to do about it, if that is known.
        holder: Option<String>,
    },

    /// The file is not any more where it was opened.
    #[error("the database {path} was {how} while this process worked on it{kept}")]
    Displaced {
        /// Where it was.
        path: PathBuf,
        /// What happened to it, in words.
        how: String,
        /// What became of the results, in words.
        kept: String,
    },

    /// Beside the database lies the log of another file, which was at this path before.
    #[error(
        "{path} is another file than the one that was here before, and {path}-wal is the log of that one: its last results \
         are in it, and it would destroy this file. End the processes that work on the former file. If {path}-wal is still \
         there then, move {path}-wal and {path}-shm away, or to the former file if you still have it"
    )]
    LogOfAnother {
        /// The database file.
        path: PathBuf,
    },

    /// A row of the database is none that this program writes.
    #[error(
        "the database was changed by hand or is damaged: {0}. `tribosweep doctor --deep` lists what is wrong; take a backup, or \
         submit the study to a new database"
    )]
    Inconsistent(String),

    /// The server does not answer, or it has ended the connection. It is unknown whether the last transaction was
    /// committed.
    #[error(
        "the database server does not answer ({0}); nothing is lost, and the same command continues when it does"
    )]
    Unreachable(String),

    /// The disk is full.
    #[error(
        "the disk of the database is full; everything stored so far is kept. Make room and start the same command again"
    )]
    DiskFull(#[source] Source),

    /// The database cannot be written.
    #[error(
        "the database cannot be written (its file or folder is read-only or belongs to another user, or the server does not \
         allow this user to write: {0}); change that, or copy the database and give the copy with --db"
    )]
    ReadOnly(#[source] Source),

    /// The file is damaged.
    #[error(
        "the database is damaged: {0}. Look at it with `tribosweep doctor`; what can still be read comes out of \
         `sqlite3 FILE .recover`, and a backup is better"
    )]
    Damaged(#[source] Source),

    /// Any other error of the database.
    #[error("the database reports: {0}")]
    Database(#[source] Source),
}

impl QueueError {
    /// Whether the same operation may succeed later.
    pub fn is_transient(&self) -> bool {
        matches!(self, Self::Locked { .. } | Self::Unreachable(_) | Self::NoAnswer { .. })
    }
}

fn lock(holder: Option<&str>) -> String {
    holder.map_or_else(
        || {
            "another program holds a lock on it for longer than any operation here takes. Close the program that has it open \
             (a database shell, a viewer, a backup)"
                .to_owned()
        },
        |holder| format!("{holder} holds a lock on it for longer than any operation here takes"),
    )
}

fn existing(known: &[String]) -> String {
    if known.is_empty() {
        "it has none yet: submit one with `tribosweep submit STUDY`".into()
    } else {
        format!("it has: {}", known.join(", "))
    }
}
