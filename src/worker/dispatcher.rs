//! The dispatcher: owns the database connection, the interrupt and the progress display.

use super::eta::Eta;
use super::executor::{Executor, JobClock};
use super::interrupt::Interrupt;
use super::progress::{Progress, RunningJob, Snapshot};
use crate::queue::{Claim, Counts, Finished, FinishedOutcome, Queue, QueueError, Scope, WorkerLock};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;
use thiserror::Error;
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

/// How often progress is shown when nothing finishes.
const TICK: Duration = Duration::from_millis(250);

/// What a worker left behind.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkSummary {
    /// Jobs of the scope in each state.
    pub counts: Counts,
    /// Jobs that an earlier, interrupted process had left running.
    pub taken_back: u64,
    /// Whether it was asked to stop.
    pub interrupted: bool,
}

/// Why a worker could not work.
#[derive(Debug, Error)]
pub enum WorkError {
    /// The queue.
    #[error(transparent)]
    Queue(#[from] QueueError),
    /// The threads.
    #[error("cannot start the worker threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Works through the pending jobs of `scope` on `threads` until none is left or `interrupt` is raised.
///
/// Interrupted jobs go back to the queue.
///
/// # Errors
/// If another process works on this database, the database fails, or threads cannot be started.
pub async fn work(
    queue: &mut Queue,
    scope: &Scope,
    threads: usize,
    interrupt: &Interrupt,
    progress: &mut impl Progress,
) -> Result<WorkSummary, WorkError> {
    let lock = WorkerLock::acquire(queue.path())?;
    let taken_back = queue.take_back(&lock).await?;
    // No more threads than jobs to run on them.
    let pending = usize::try_from(queue.counts(scope).await?.pending).unwrap_or(usize::MAX);
    let threads = threads.min(pending.max(1));
    let (results, finished) = unbounded_channel();
    let executor = Executor::new(threads, results, interrupt.clone())?;
    let mut dispatcher = Dispatcher {
        queue,
        scope,
        threads,
        interrupt,
        executor,
        finished,
        running: BTreeMap::new(),
        timings: Vec::new(),
    };
    dispatcher.run(progress).await?;
    let snapshot = dispatcher.snapshot().await?;
    progress.stopped(&snapshot);
    Ok(WorkSummary { counts: snapshot.counts, taken_back, interrupted: interrupt.is_raised() })
}

struct Dispatcher<'a> {
    queue: &'a mut Queue,
    scope: &'a Scope,
    threads: usize,
    interrupt: &'a Interrupt,
    executor: Executor,
    finished: UnboundedReceiver<Finished>,
    /// Cost and clock of every running job, by key.
    running: BTreeMap<String, (f64, Arc<JobClock>)>,
    /// (cost, seconds) of what this worker has finished.
    timings: Vec<(f64, f64)>,
}

impl Dispatcher<'_> {
    async fn run(&mut self, progress: &mut impl Progress) -> Result<(), QueueError> {
        let mut done = Vec::new();
        loop {
            let limit = if self.interrupt.is_raised() { 0 } else { self.threads - self.running.len() };
            let claim = Claim { scope: self.scope.clone(), limit };
            let exchanged = self.queue.exchange(&done, &claim).await?;
            done.clear();
            for job in exchanged.claimed {
                let (key, cost) = (job.key.clone(), job.cost);
                self.running.insert(key, (cost, self.executor.start(job)));
            }
            if self.running.is_empty() {
                return Ok(());
            }
            progress.update(&self.snapshot().await?);
            while done.is_empty() {
                // Only the channel is awaited under the timeout; the database never is.
                match tokio::time::timeout(TICK, self.finished.recv()).await {
                    Ok(Some(job)) => done.push(job),
                    Ok(None) => unreachable!("the executor holds a sender"),
                    Err(_) => progress.update(&self.snapshot().await?),
                }
            }
            while let Ok(job) = self.finished.try_recv() {
                done.push(job);
            }
            for job in &done {
                let cost = self.running.remove(&job.key).map_or(0.0, |(cost, _)| cost);
                match &job.outcome {
                    FinishedOutcome::Done { .. } => self.timings.push((cost, job.wall_s)),
                    FinishedOutcome::Failed { error } => progress.failed(&job.key, error),
                    FinishedOutcome::Released => {}
                }
            }
        }
    }

    async fn snapshot(&mut self) -> Result<Snapshot, QueueError> {
        let counts = self.queue.counts(self.scope).await?;
        let remaining_cost = self.queue.remaining_cost(self.scope).await?;
        let eta = Eta::estimate(&self.timings, remaining_cost, counts.pending + counts.running, self.threads);
        let running = self
            .running
            .iter()
            .map(|(key, (_, clock))| RunningJob { key: key.clone(), simulated_s: clock.simulated_s() })
            .collect();
        Ok(Snapshot { counts, running, eta })
    }
}
