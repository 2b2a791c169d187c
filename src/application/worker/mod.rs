//! Runs the jobs of a queue: a dispatcher owns the database and the progress display, solver threads own the work, and
//! they exchange messages.
//!
//! ```text
//!                  claimed jobs                  a batch runner per thread: jobs of one batch in
//!  Queue ◄────► dispatcher ───────────► executor ───────► the lanes of analysis::batch
//!   one transaction   ▲                                        │
//!   per turn          └──── ended jobs, requests (channel) ◄───┘
//! ```
//!
//! Jobs that are advanced in one vector share a model. So threads request jobs of the batch that they are running. The
//! dispatcher answers from the database, and meanwhile the other lanes go on.
//!
//! The states of long jobs are stored in the database at intervals. After an interruption they are resumed from there.
//!
//! A job starts only after its claim is committed, and no solver thread waits for the database while it has jobs. The
//! result of a job depends on nothing but its specification: threads, order and companions change no bit of it.

mod batch_runner;
mod channel;
mod checkpoint;
mod dispatcher;
mod eta;
mod executor;
mod heartbeat;
mod idle;
mod interrupt;
mod isolate;
mod job;
mod open;
mod options;
mod planner;
mod progress;
mod provenance;
mod retry;
mod schedule;
mod stall;
mod tally;
mod waves;
mod work;

pub use eta::{Eta, Left};
pub use interrupt::Interrupt;
pub use open::open;
pub use options::{JobKey, WorkOptions};
pub use planner::Planner;
pub use progress::{Progress, RunningJob, SilentProgress, Snapshot};
pub use provenance::program;
pub use work::{WorkError, WorkSummary, work};
