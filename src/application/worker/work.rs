//! Working through the jobs of a queue.

use super::dispatcher::Dispatcher;
use super::executor::Executor;
use super::interrupt::Interrupt;
use super::options::WorkOptions;
use super::progress::Progress;
use super::provenance;
use super::retry::RetryBackoff;
use crate::queue::{Counts, Queue, QueueError, Scope, TakenBack};
use std::pin::Pin;
use thiserror::Error;
use tokio::sync::mpsc::unbounded_channel;

/// What a worker has done and left.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkSummary {
    /// Jobs of the scope in each state.
    pub counts: Counts,
    /// Jobs that other processes had left running when they died.
    pub taken_back: TakenBack,
    /// Whether the worker was asked to stop.
    pub interrupted: bool,
}

/// Why a worker could not work.
#[derive(Debug, Error)]
pub enum WorkError {
    /// The queue failed.
    #[error(transparent)]
    Queue(#[from] QueueError),
    /// The operating system did not start the threads.
    #[error("cannot start the worker threads: {0}")]
    Threads(std::io::Error),
}

/// Works through the pending jobs of `scope` until none is left or `interrupt` is raised.
///
/// Other processes may work on the same database. If one of them dies, its jobs are run here. Without
/// [`WorkOptions::idle_exit`] the worker stays until the jobs that run elsewhere have ended; with it, it exits earlier.
/// Interrupted jobs go back to the queue, long ones with a checkpoint.
///
/// The future must run on a tokio runtime with timers. The jobs run on threads of their own, and their results depend on
/// nothing but their specifications.
///
/// The future is boxed, because otherwise each program that awaits it would compile the whole worker again. It stays on
/// the thread that awaits it (it is not `Send`).
///
/// # Errors
/// If the database fails, or threads cannot be started.
pub fn work<'a>(
    queue: &'a mut Queue,
    scope: &'a Scope,
    options: WorkOptions,
    interrupt: &'a Interrupt,
    progress: &'a mut dyn Progress,
) -> Pin<Box<dyn Future<Output = Result<WorkSummary, WorkError>> + 'a>> {
    Box::pin(work_through(queue, scope, options, interrupt, progress))
}

async fn work_through(
    queue: &mut Queue,
    scope: &Scope,
    options: WorkOptions,
    interrupt: &Interrupt,
    progress: &mut dyn Progress,
) -> Result<WorkSummary, WorkError> {
    let backoff = RetryBackoff::new();
    // A worker among many must survive the restart of the server.
    while let Err(error) = queue.open_jobs(scope).await {
        if interrupt.is_raised() {
            return Err(error.into());
        }
        backoff.wait(error, interrupt, progress).await?;
    }
    let left = queue.counts(scope).await?;
    // No more threads than jobs to run on them, unless new jobs may come.
    let jobs = usize::try_from(left.pending + left.running).unwrap_or(usize::MAX);
    let may_grow = options.planner.is_some() && queue.open_jobs(scope).await?.has_plans;
    let threads = if options.idle_exit.is_some() || may_grow {
        options.threads
    } else {
        options.threads.min(jobs.max(1))
    };
    let options = WorkOptions { threads, ..options };
    let (sender, reports) = unbounded_channel();
    let executor = Executor::new(options, &sender, interrupt)
        .map_err(|error| WorkError::Threads(std::io::Error::other(error)))?;
    queue.register(&provenance::worker(threads)).await?;
    let mut dispatcher = Dispatcher::new(queue, scope, options, interrupt, executor, reports).await?;
    let worked = match dispatcher.run(progress).await {
        Ok(()) => dispatcher.shut_down(progress).await,
        error => error,
    };
    // Jobs that are given back do not count as crashed. The first error is returned.
    if let Err(error) = worked {
        return Err(dispatcher.abort(error).await.into());
    }
    let snapshot = dispatcher.snapshot();
    progress.stopped(&snapshot);
    let taken_back = dispatcher.taken_back();
    Ok(WorkSummary { counts: snapshot.counts, taken_back, interrupted: interrupt.is_raised() })
}
