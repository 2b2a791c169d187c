//! Runs the queue's jobs: a dispatcher that owns database, signals and progress, and an executor that
//! owns the work, with messages between them.
//!
//! ```text
//!                  claimed jobs                 a thread's crew: jobs of one batch in the
//!  Queue ◄────► dispatcher ───────────► executor ───────► lanes of analysis::batch
//!   one transaction   ▲                                        │
//!   a turn            └─── finished jobs, requests (channel) ◄─┘
//! ```
//!
//! Threads ask for jobs and say of which batch they can use more, because what can be advanced in one vector shares
//! a model. The dispatcher answers from the database; meanwhile the other lanes go on.
//!
//! The states of long jobs are kept in the database now and then, and go on from there after an interruption.
//!
//! A job starts only after its claim is committed, and nothing in the pool waits for the database. A
//! job's result depends on nothing but its specification: threads, order and companions change no bit.

mod checkpoint;
mod crew;
mod dispatcher;
mod eta;
mod executor;
mod heartbeat;
mod idle;
mod interrupt;
mod open;
mod options;
mod patience;
mod progress;
mod provenance;
mod tally;

pub use dispatcher::{WorkError, WorkSummary, work};
pub use eta::Eta;
pub use interrupt::Interrupt;
pub use open::open;
pub use options::WorkOptions;
pub use progress::{Progress, RunningJob, SilentProgress, Snapshot};
pub use provenance::program;
