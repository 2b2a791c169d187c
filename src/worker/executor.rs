//! Threads that advance claimed jobs, and their two-way traffic with the dispatcher.
//!
//! A thread without work asks for a job. With it begins a [`Crew`]: the jobs of one batch, which fills its lanes
//! with others of the batch and asks for more whenever one ends.

use super::checkpoint::Kept;
use super::crew::Crew;
use super::interrupt::Interrupt;
use super::options::WorkOptions;
use crate::queue::{ClaimedJob, Finished};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;
use tokio::sync::mpsc::UnboundedSender;

/// How far a running job is.
#[derive(Debug, Default)]
pub struct JobClock {
    simulated_ns: AtomicU64,
    /// Whether a checkpoint is on its way to the database. There is one at a time: a database that is locked for an
    /// hour must not fill the memory.
    keeping: AtomicBool,
}

impl JobClock {
    /// Simulated time [s].
    pub fn simulated_s(&self) -> f64 {
        self.simulated_ns.load(Ordering::Relaxed) as f64 * 1e-9
    }

    /// A checkpoint has arrived, or is lost.
    pub(super) fn end_keeping(&self) {
        self.keeping.store(false, Ordering::Relaxed);
    }

    /// Whether a checkpoint may be sent; if so, it is on its way.
    pub(super) fn begin_keeping(&self) -> bool {
        !self.keeping.swap(true, Ordering::Relaxed)
    }

    pub(super) fn set(&self, simulated_s: f64) {
        self.simulated_ns.store((simulated_s * 1e9) as u64, Ordering::Relaxed);
    }
}

/// What a thread tells the dispatcher.
#[derive(Debug)]
pub enum Report {
    /// A job ended.
    Finished(Finished),
    /// Where a job is.
    Checkpoint(Kept),
    /// The thread can take jobs.
    Wants(Request),
}

/// What a thread asks for. A request for jobs of a batch is answered at once, if only with none; one for any job
/// when there is one.
#[derive(Debug, Clone)]
pub struct Request {
    /// Who asks.
    pub thread: usize,
    /// Of which batch; any if none.
    pub batch: Option<String>,
    /// At most so many jobs.
    pub limit: usize,
}

/// A job for a thread.
#[derive(Debug)]
pub struct Assignment {
    /// The job.
    pub job: ClaimedJob,
    /// Where its progress is shown.
    pub clock: Arc<JobClock>,
}

/// The threads and the ways to them.
pub struct Executor {
    // Dropped first: the threads end when their mailboxes close.
    mailboxes: Vec<Sender<Vec<Assignment>>>,
    _pool: rayon::ThreadPool,
}

/// A thread's side of the traffic.
pub(super) struct Desk {
    pub thread: usize,
    pub mailbox: Receiver<Vec<Assignment>>,
    pub reports: UnboundedSender<Report>,
    pub interrupt: Interrupt,
    pub checkpoint_interval: Option<Duration>,
}

impl Executor {
    /// Threads that send their reports to `reports`.
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub fn new(
        options: WorkOptions,
        reports: &UnboundedSender<Report>,
        interrupt: &Interrupt,
    ) -> Result<Self, rayon::ThreadPoolBuildError> {
        let WorkOptions { threads, checkpoint_interval, .. } = options;
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("solver-{i}"))
            .build()?;
        let mailboxes = (0..threads).map(|thread| {
            let (sender, mailbox) = channel();
            let desk = Desk {
                thread,
                mailbox,
                reports: reports.clone(),
                interrupt: interrupt.clone(),
                checkpoint_interval,
            };
            pool.spawn(move || desk.work());
            sender
        });
        Ok(Self { mailboxes: mailboxes.collect(), _pool: pool })
    }

    /// Answers a thread's request.
    pub fn answer(&self, thread: usize, jobs: Vec<Assignment>) {
        // A thread lives as long as its mailbox is open.
        let _ = self.mailboxes[thread].send(jobs);
    }
}

impl Desk {
    fn work(self) {
        loop {
            self.ask(None, 1);
            let Ok(jobs) = self.mailbox.recv() else { return };
            let mut waiting = jobs;
            // A crew gives back what belongs to another one.
            while let Some(first) = waiting.pop() {
                waiting.extend(Crew::run(&self, first));
            }
        }
    }

    pub fn ask(&self, batch: Option<String>, limit: usize) {
        self.report(Report::Wants(Request { thread: self.thread, batch, limit }));
    }

    pub fn report(&self, report: Report) {
        // The dispatcher outlives its jobs; if it is gone, the process is ending and so is the claim.
        let _ = self.reports.send(report);
    }
}
