//! A queue of jobs in a `SQLite` file or in a PostgreSQL database. Payloads, parameters and records are opaque strings:
//! nothing here depends on what the jobs compute.
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
//! * A **job** is identified by its key. Submitting a key that already exists adds no job. Studies therefore share
//!   jobs, and a repeated submission costs no simulation.
//! * A **study** is identified by its name. It is a document and an ordered list of rows. Each row is a set of
//!   parameters and points to a job; two rows may point to the same job.
//! * A **worker** is a process that runs jobs; there may be several. A worker owns the jobs that it has claimed until
//!   it finishes them or is gone (`take_back` defines when a worker is gone).
//! * An **attempt** is one start of a job. A finish names its attempt, and it counts only if the same worker is still
//!   running that attempt. A worker that lost a job therefore cannot overwrite later results.
//! * A study may **grow**: when its jobs have ended, a worker plans its next wave from their results (`plans`).
//! * Jobs of one **batch** can be run together. A claim takes jobs of one batch only.
//!
//! # Rules
//! * Each operation is written once, for both databases. `engine` contains the differences between them; a statement
//!   that the databases do not share is written in two dialects, side by side.
//! * Every write happens in a transaction that takes its lock at the start. The lock is exclusive, or it is shared with
//!   transactions that change only their own worker's jobs or claim jobs that nobody has (`Access`). On `SQLite` every
//!   lock is exclusive. `SQLite` cannot promote a transaction that began by reading while another one writes: it fails
//!   at once with "database is locked", whatever the busy timeout is. On PostgreSQL, transactions with shared locks
//!   never wait for each other.
//! * A transaction awaits nothing but the database. Never drop a future of this module before it is ready (no
//!   `select!`, no timeout around it): the transaction would keep its lock and block every other process.
//! * Reads are single statements. A reader that holds a transaction open prevents checkpoints of the write-ahead log
//!   and the removal of old row versions.
//!
//! [`Queue`] is defined in `handle`, and each operation adds its methods in a file of its own. The files import from
//! each other directly and never in a circle. This file only declares and re-exports.

mod absorb;
mod access;
mod bulk;
mod cancel;
mod checkpoint;
mod claim;
mod clock;
mod counts;
mod deep;
mod details;
mod digest;
mod doctor;
mod engine;
mod error;
mod exchange;
mod finding;
mod finish;
mod garbage;
mod handle;
mod heartbeat;
mod known;
mod location;
mod lookup;
mod open;
mod open_jobs;
mod owner;
mod pages;
mod plan_rows;
mod plans;
#[cfg(feature = "postgres")]
mod postgres;
mod preview;
mod process;
mod provenance;
mod register;
mod remove;
mod replace;
mod rescue;
mod retry;
mod rows;
mod scope;
mod settings;
mod sqlite;
mod state;
mod studies;
mod submit;
mod take_back;
mod throughput;
mod transaction;
mod unsigned;
mod worker;
mod workers;

pub use absorb::Absorbed;
pub use cancel::Cancelled;
pub use claim::{Claim, ClaimedJob};
pub use clock::Clock;
pub use counts::{Counts, Remaining};
pub use deep::{StoredPayload, StoredResult, StoredState};
pub use details::JobDetails;
pub use digest::Integrity;
pub use doctor::examine;
pub use error::QueueError;
pub use exchange::Exchanged;
pub use finding::Finding;
pub use finish::{Finished, FinishedOutcome};
pub use garbage::Garbage;
pub use handle::Queue;
pub use location::{Location, Server};
pub use open_jobs::OpenJobs;
pub use pages::Pages;
pub use plans::{PlanClaim, PlanState, PlanStatus, Planned};
pub use provenance::ProvenanceGroup;
pub use remove::Removed;
pub use replace::{Replace, Replaced};
pub use retry::{Retried, Retry};
pub use rows::{Rows, StudyRow};
pub use scope::Scope;
pub use settings::Settings;
pub use state::JobState;
pub use studies::{StudyDocument, StudySummary};
pub use submit::{NewJob, NewStudy, Shard, Submitted};
pub use take_back::TakenBack;
pub use worker::Worker;
pub use workers::{ActiveWorkers, WorkerPresence, WorkerStatus};
