//! Runs the queue's jobs: a dispatcher that owns database, signals and progress, and an executor that
//! owns the work, with messages between them.
//!
//! ```text
//!                 claimed jobs                    spawn
//!  Queue ◄────► dispatcher ───────────► executor ───────► rayon threads: analysis::solve
//!   one transaction   ▲                                        │
//!   a turn            └──────── finished jobs (channel) ◄──────┘
//! ```
//!
//! A job starts only after its claim is committed, and nothing in the pool waits for the database. A
//! job's result depends on nothing but its specification: threads, order and companions change no bit.

mod dispatcher;
mod eta;
mod executor;
mod heartbeat;
mod interrupt;
mod progress;
mod provenance;
mod tally;

pub use dispatcher::{WorkError, WorkSummary, work};
pub use eta::Eta;
pub use interrupt::Interrupt;
pub use progress::{Progress, RunningJob, SilentProgress, Snapshot};
