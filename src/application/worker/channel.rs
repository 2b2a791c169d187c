//! What a solver thread and the dispatcher tell each other.

use super::checkpoint::SealedCheckpoint;
use super::interrupt::Interrupt;
use super::options::JobKey;
use crate::analysis::{Ending, Structures};
use crate::queue::{ClaimedJob, Finished, FinishedOutcome};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvError};
use std::sync::{Arc, OnceLock};
use std::time::Duration;
use tokio::sync::mpsc::UnboundedSender;

/// How far a running job is; shared by its thread and the dispatcher.
#[derive(Debug, Default)]
pub struct JobProgress {
    simulated_ns: AtomicU64,
    /// When the job is likely to end, known from its beginning.
    ending: OnceLock<Ending>,
    /// Whether a checkpoint is on its way to the database. There is one at a time: a database that is locked for an
    /// hour must not fill the memory.
    checkpoint_in_flight: AtomicBool,
}

impl JobProgress {
    /// Simulated time [s].
    pub fn simulated_s(&self) -> f64 {
        self.simulated_ns.load(Ordering::Relaxed) as f64 * 1e-9
    }

    /// Sets the simulated time [s].
    pub fn set_simulated_s(&self, simulated_s: f64) {
        self.simulated_ns.store((simulated_s * 1e9) as u64, Ordering::Relaxed);
    }

    /// Notes when the job is likely to end.
    pub fn set_ending(&self, ending: Ending) {
        let _ = self.ending.set(ending);
    }

    /// The simulated time [s] at which it ends at the latest; `None` before it has begun, and for modes, which simulate nothing.
    pub fn limit_s(&self) -> Option<f64> {
        self.ending.get().filter(|ending| ending.has_run).map(|ending| ending.limit_s)
    }

    /// The share of its work that is likely to be left, from 0 to 1.
    pub fn share_left(&self) -> f64 {
        self.ending.get().map_or(1.0, |ending| ending.share_left(self.simulated_s()))
    }

    /// Marks a checkpoint as on its way; false if another one still is.
    pub fn begin_checkpoint(&self) -> bool {
        !self.checkpoint_in_flight.swap(true, Ordering::Relaxed)
    }

    /// The checkpoint on its way has been stored or given up.
    pub fn end_checkpoint(&self) {
        self.checkpoint_in_flight.store(false, Ordering::Relaxed);
    }
}

/// What a thread tells the dispatcher.
#[derive(Debug)]
pub enum Report {
    /// A job ended.
    Finished(Finished),
    /// A checkpoint of a running job.
    Checkpoint(SealedCheckpoint),
    /// The thread can take jobs.
    Request(Request),
}

/// A thread's request for jobs.
///
/// Batch requests are answered immediately, possibly with no job. A request for any job is answered when there is one.
#[derive(Debug, Clone)]
pub struct Request {
    /// The thread that asks.
    pub thread: usize,
    /// The batch whose jobs it can use; `None` for jobs of any batch.
    pub batch: Option<String>,
    /// Largest number of jobs.
    pub limit: usize,
}

/// A job for a thread.
#[derive(Debug)]
pub struct Assignment {
    /// The job.
    pub job: ClaimedJob,
    /// Where the thread shows how far the job is.
    pub progress: Arc<JobProgress>,
}

/// A thread's end of the connection with the dispatcher.
pub struct WorkerChannel {
    /// The thread's number.
    pub thread: usize,
    /// Answers to the thread's requests.
    pub replies: Receiver<Vec<Assignment>>,
    /// What the thread tells the dispatcher.
    pub reports: UnboundedSender<Report>,
    /// Whether the worker is asked to stop.
    pub interrupt: Interrupt,
    /// How often the state of a running job is stored; `None` if never.
    pub checkpoint_interval: Option<Duration>,
    /// The key that a job must have; `None` if it is not checked.
    pub job_key: Option<JobKey>,
    /// The structures of models, which all threads of the worker share.
    pub structures: Structures,
}

impl WorkerChannel {
    /// Asks for up to `limit` jobs of a batch, or of any batch.
    pub fn request(&self, batch: Option<String>, limit: usize) {
        self.report(Report::Request(Request { thread: self.thread, batch, limit }));
    }

    /// Waits for the answer to a request. An error means that the dispatcher has ended.
    pub fn wait_for_reply(&self) -> Result<Vec<Assignment>, RecvError> {
        self.replies.recv()
    }

    /// The answer to a request, if it is there.
    pub fn poll_reply(&self) -> Option<Vec<Assignment>> {
        self.replies.try_recv().ok()
    }

    /// Reports the end of a job that took `wall_s` seconds of the thread's time.
    pub fn finish(&self, job: &ClaimedJob, outcome: FinishedOutcome, wall_s: f64) {
        let (key, attempt) = (job.key.clone(), job.attempt);
        self.report(Report::Finished(Finished { key, attempt, outcome, wall_s }));
    }

    /// Sends a report.
    pub fn report(&self, report: Report) {
        // The dispatcher outlives its jobs. If it is gone, the process is ending, and its claims end with it.
        let _ = self.reports.send(report);
    }
}
