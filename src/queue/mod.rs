//! Jobs in a database: a file of `SQLite`'s, or PostgreSQL. Payloads, parameters and records are opaque strings;
//! nothing here knows mechanics.
//!
//! ```text
//!            submit            exchange: claim             exchange: finish
//!  NewStudy ───────► pending ──────────────────► running ──────────────────► done | failed
//!                    ▲  ▲ │    attempt += 1         │                               │
//!                    │  │ │ cancel, remove          │                               │
//!                    │  │ └──────────► cancelled    │                               │
//!                    │  └──────────────────┘        │                               │
//!                    │     submit, retry            │                             retry
//!                    └──────────────────────────────┴───────────────────────────────┘
//!         Released and Unstarted (interruption), take_back (the process died; too often: failed)
//! ```
//!
//! * A **job** is identified by its key. Submitting a key that is there already adds nothing, so studies share
//!   jobs and a repeated submission costs no simulation.
//! * A **study** is identified by its name. It is a document and an ordered list of rows, each a set of
//!   parameters that points to a job; two rows may point to the same one.
//! * A **worker** is a process that runs jobs; there may be several. What it claims is its own, until it ends or is
//!   gone (`take_back` says when that is).
//! * An **attempt** is one start of a job. Finishing names the attempt and counts only if the same worker is still
//!   running that very attempt: whoever lost a job cannot overwrite what came after.
//! * Jobs of one **batch** can be run together; a claim takes jobs of one batch only.
//!
//! # Rules
//! * What is done is written once, for both databases; `engine` has what is different between them, and a statement that
//!   they do not have in common comes in two dialects, side by side.
//! * Whatever is written is written in a transaction that begins with its lock: alone, or beside others that change
//!   only what their own worker has in hand or what nobody has (`engine::Access`). On `SQLite` all are alone, and a
//!   transaction that begins by reading cannot be promoted while another writes: it fails at once with "database is
//!   locked", whatever the busy timeout. On PostgreSQL those that are not alone never wait for each other.
//! * Inside a transaction nothing but the database is awaited, and no future of this module is to be dropped
//!   half-way (no `select!`, no timeout around it): the lock it holds stops every other process.
//! * Reads are single statements. A transaction held open by a reader keeps the write-ahead log from being
//!   folded back into the database, and old rows from being cleared away.

mod absorb;
mod bulk;
mod cancel;
mod checkpoint;
mod claim;
mod clock;
mod counts;
mod details;
mod doctor;
mod engine;
mod error;
mod exchange;
mod finish;
mod garbage;
mod heartbeat;
mod location;
mod made;
mod open;
mod open_jobs;
mod owner;
mod pace;
#[cfg(feature = "postgres")]
mod postgres;
mod process;
mod remaining;
mod remove;
mod retry;
mod rows;
mod scope;
mod settings;
mod sqlite;
mod starts;
mod state;
mod studies;
mod submit;
mod take_back;
mod timings;
mod transaction;
mod worker;
mod workers;

pub use absorb::Absorbed;
pub use cancel::Cancelled;
pub use claim::{Claim, ClaimedJob};
pub use clock::Clock;
pub use counts::Counts;
pub use details::JobDetails;
pub use doctor::{Finding, examine};
pub use error::QueueError;
pub use exchange::Exchanged;
pub use finish::{Finished, FinishedOutcome};
pub use garbage::Garbage;
pub use location::{Location, Server};
pub use made::MadeWith;
pub use open_jobs::OpenJobs;
pub use remove::Removed;
pub use retry::{Retried, Retry};
pub use rows::{Rows, StudyRow};
pub use scope::Scope;
pub use settings::Settings;
pub use state::JobState;
pub use studies::{StudyDocument, StudySummary};
pub use submit::{NewJob, NewStudy, Shard, Submitted};
pub use take_back::TakenBack;
pub use worker::Worker;
pub use workers::{Alive, WorkerPresence, WorkerStatus};

use engine::Connection;

/// One connection to the database of studies and jobs.
#[derive(Debug)]
pub struct Queue {
    connection: Connection,
    clock: Clock,
    location: Location,
    settings: Settings,
    /// The worker that owns what is claimed here.
    registration: Option<worker::Registration>,
}

impl Queue {
    /// Where the database is.
    pub fn location(&self) -> &Location {
        &self.location
    }

    /// What it was opened with.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Closes the connection and waits for it, so that the last one out folds the write-ahead log back in.
    ///
    /// Dropping the queue loses nothing, but may leave the log's files beside the database.
    ///
    /// # Errors
    /// If the database cannot be closed, e.g. on a full disk.
    pub async fn close(self) -> Result<(), QueueError> {
        self.connection.close().await
    }
}
