//! The dispatcher: owns the database connection, the interrupt and the progress display.

use super::checkpoint::Kept;
use super::eta::Eta;
use super::executor::{Assignment, Executor, JobClock, Report, Request};
use super::heartbeat::Heartbeat;
use super::idle::Idle;
use super::interrupt::Interrupt;
use super::options::WorkOptions;
use super::patience::Patience;
use super::progress::{Progress, RunningJob, Snapshot};
use super::provenance;
use super::tally::Tally;
use crate::queue::{
    Claim, ClaimedJob, Counts, Exchanged, Finished, FinishedOutcome, Queue, QueueError, Scope, TakenBack,
};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;
use thiserror::Error;
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

/// How often progress is shown when nothing finishes, and other workers' jobs are looked at when there is nothing
/// else to do.
const TICK: Duration = Duration::from_millis(250);

/// What a worker left behind.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkSummary {
    /// Jobs of the scope in each state.
    pub counts: Counts,
    /// Jobs that other processes had left running when they died.
    pub taken_back: TakenBack,
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

/// Works through the pending jobs of `scope` until none is left or `interrupt` is raised.
///
/// Other processes may work on the same database, and their jobs are done here if they die. Running ones are waited for;
/// with [`WorkOptions::idle_exit`] only while somebody's signs of life are missing.
/// Interrupted jobs go back to the queue, long ones with where they are.
///
/// # Errors
/// If the database fails, or threads cannot be started.
pub async fn work(
    queue: &mut Queue,
    scope: &Scope,
    options: WorkOptions,
    interrupt: &Interrupt,
    progress: &mut impl Progress,
) -> Result<WorkSummary, WorkError> {
    let patience = Patience::new();
    // A worker among many is not lost for a server that is just being restarted.
    while let Err(error) = queue.open_jobs(scope).await {
        if interrupt.is_raised() {
            return Err(error.into());
        }
        patience.wait(error, interrupt, progress).await?;
    }
    let left = queue.counts(scope).await?;
    // No more threads than jobs to run on them, unless more may come.
    let jobs = usize::try_from(left.pending + left.running).unwrap_or(usize::MAX);
    let threads =
        if options.idle_exit.is_some() { options.threads } else { options.threads.min(jobs.max(1)) };
    let (sender, reports) = unbounded_channel();
    let executor = Executor::new(WorkOptions { threads, ..options }, &sender, interrupt)?;
    queue.register(&provenance::worker(threads)).await?;
    let taken_back = queue.take_back().await?;
    let tally = Tally::new(queue, scope).await?;
    let lease = queue.settings().lease;
    let mut dispatcher = Dispatcher {
        queue,
        scope,
        threads,
        interrupt,
        executor,
        reports,
        requests: Vec::new(),
        checkpoints: Vec::new(),
        running: BTreeMap::new(),
        timings: Vec::new(),
        heartbeat: Heartbeat::new(lease),
        idle: Idle::default(),
        idle_exit: options.idle_exit,
        is_stopping: false,
        taken_back,
        tally,
    };
    let worked = dispatcher.run(progress).await;
    // After an error too, as far as it goes: what is given back did not crash. The first error is the one to report.
    if worked.is_err() {
        let _ = dispatcher.queue.unregister().await;
    }
    worked?;
    dispatcher.end(progress).await?;
    let snapshot = dispatcher.snapshot();
    progress.stopped(&snapshot);
    let (counts, taken_back) = (snapshot.counts, dispatcher.taken_back);
    Ok(WorkSummary { counts, taken_back, interrupted: interrupt.is_raised() })
}

struct Dispatcher<'a> {
    queue: &'a mut Queue,
    scope: &'a Scope,
    threads: usize,
    interrupt: &'a Interrupt,
    executor: Executor,
    reports: UnboundedReceiver<Report>,
    /// What threads have asked for and have not been answered.
    requests: Vec<Request>,
    /// What is to be kept.
    checkpoints: Vec<Kept>,
    /// Cost and clock of every running job, by key.
    running: BTreeMap<String, (f64, Arc<JobClock>)>,
    /// (cost, seconds) of what this worker has finished.
    timings: Vec<(f64, f64)>,
    heartbeat: Heartbeat,
    idle: Idle,
    idle_exit: Option<Duration>,
    /// Whether the database knows of the interruption.
    is_stopping: bool,
    taken_back: TakenBack,
    tally: Tally,
}

impl Dispatcher<'_> {
    async fn run(&mut self, progress: &mut impl Progress) -> Result<(), QueueError> {
        let mut done = Vec::new();
        loop {
            self.keep_checkpoints(progress).await;
            let asked = self.answerable();
            let exchanged = self.exchange(&done, &asked, progress).await?;
            self.settle(&done, &exchanged.refused, progress);
            done.clear();
            for (request, jobs) in asked.into_iter().zip(exchanged.claimed) {
                self.answer(request, jobs);
            }
            self.tally.refresh(self.queue, self.scope).await?;
            progress.update(&self.snapshot());
            loop {
                if self.running.is_empty() && self.is_over(progress).await? {
                    return Ok(());
                }
                // Only the channel is awaited under the timeout; the database never is.
                match tokio::time::timeout(TICK, self.reports.recv()).await {
                    Ok(Some(report)) => self.take(report, &mut done),
                    Ok(None) => unreachable!("the threads hold senders"),
                    Err(_) => self.tick(progress).await?,
                }
                while let Ok(report) = self.reports.try_recv() {
                    self.take(report, &mut done);
                }
                if !done.is_empty() || !self.checkpoints.is_empty() || !self.is_quiet() {
                    break;
                }
            }
        }
    }

    /// Ends the worker in order.
    async fn end(&mut self, progress: &mut impl Progress) -> Result<(), QueueError> {
        let patience = Patience::new();
        loop {
            let ended = match self.queue.unregister().await {
                Ok(()) => self.tally.ask(self.queue, self.scope).await,
                error => error,
            };
            match ended {
                Ok(()) => return Ok(()),
                Err(error) => patience.wait(error, self.interrupt, progress).await?,
            }
        }
    }

    /// Whether there is nothing to do but stop.
    async fn is_over(&mut self, progress: &mut impl Progress) -> Result<bool, QueueError> {
        if self.interrupt.is_raised() {
            return Ok(true);
        }
        if self.tally.counts.pending > 0 || !self.idle.is_due() {
            return Ok(false);
        }
        let patience = Patience::new();
        loop {
            match self.look().await {
                Ok(is_over) => return Ok(is_over),
                Err(_) if self.interrupt.is_raised() => return Ok(true),
                Err(error) => patience.wait(error, self.interrupt, progress).await?,
            }
        }
    }

    /// Looks for what is new and for what died elsewhere; returns whether there is nothing more to wait for.
    async fn look(&mut self) -> Result<bool, QueueError> {
        self.take_back().await?;
        // What is counted here may be older than what others do.
        let open = self.queue.open_jobs(self.scope).await?;
        if open.has_pending {
            self.tally.is_outdated();
            return Ok(false);
        }
        let Some(limit) = self.idle_exit else { return Ok(!open.has_running) };
        // Who was told how long to stay does not wait for what runs elsewhere, unless it may be about to come back.
        Ok(self.idle.lasts() >= limit && !(open.has_running && self.queue.has_missing_workers().await?))
    }

    fn take(&mut self, report: Report, done: &mut Vec<Finished>) {
        match report {
            Report::Finished(job) => done.push(job),
            Report::Checkpoint(kept) => self.checkpoints.push(kept),
            Report::Wants(request) => self.requests.push(request),
        }
    }

    /// Whether no request can be answered: none is about a batch, and no job is there for the others.
    fn is_quiet(&self) -> bool {
        let has_jobs = self.tally.counts.pending > 0 && !self.interrupt.is_raised();
        self.requests.iter().all(|request| request.batch.is_none() && !has_jobs)
    }

    /// The requests to answer now; none of them gets more than a fair share of what is left.
    fn answerable(&mut self) -> Vec<Request> {
        let pending = usize::try_from(self.tally.counts.pending).unwrap_or(usize::MAX);
        let share = pending.div_ceil(self.threads).max(1);
        let is_open = !self.interrupt.is_raised();
        let (mut now, later): (Vec<_>, Vec<_>) = std::mem::take(&mut self.requests)
            .into_iter()
            .partition(|request| request.batch.is_some() || (is_open && pending > 0));
        for request in &mut now {
            request.limit = request.limit.min(share);
        }
        self.requests = later;
        now
    }

    /// Hands a thread its jobs. A thread that asked for any job and gets none keeps its request.
    fn answer(&mut self, request: Request, jobs: Vec<ClaimedJob>) {
        if jobs.is_empty() && request.batch.is_none() {
            // Others were faster. Until the next count there is nothing to ask for.
            self.tally.counts.pending = 0;
            self.requests.push(request);
            return;
        }
        if !jobs.is_empty() {
            self.idle.end();
        }
        self.tally.claimed(jobs.len() as u64);
        let assignments = jobs.into_iter().map(|job| {
            let clock = Arc::new(JobClock::default());
            self.running.insert(job.key.clone(), (job.cost, Arc::clone(&clock)));
            Assignment { job, clock }
        });
        let assignments = assignments.collect();
        self.executor.answer(request.thread, assignments);
    }

    /// Keeps where long jobs are. Before their ends: what is released takes its last checkpoint with it.
    ///
    /// A checkpoint is a help and not a result: where it cannot be kept, the work goes on, and the one before is there.
    async fn keep_checkpoints(&mut self, progress: &mut impl Progress) {
        let mut is_refused = false;
        let patience = Patience::new();
        for Kept { key, attempt, bytes } in std::mem::take(&mut self.checkpoints) {
            while !is_refused {
                match self.queue.save_checkpoint(&key, attempt, &bytes).await {
                    Ok(_) => break,
                    Err(error) => {
                        // No other one comes for what is released now.
                        let is_last = self.interrupt.is_raised();
                        if !is_last {
                            progress.waiting(&format!("the state of running jobs cannot be kept: {error}"));
                        }
                        is_refused =
                            !is_last || patience.wait(error, self.interrupt, progress).await.is_err();
                    }
                }
            }
            if let Some((_, clock)) = self.running.get(&key) {
                clock.end_keeping();
            }
        }
    }

    /// Stores what is done and claims what is asked for. While the database is locked, running jobs go on.
    async fn exchange(
        &mut self,
        done: &[Finished],
        asked: &[Request],
        progress: &mut impl Progress,
    ) -> Result<Exchanged, QueueError> {
        let patience = Patience::new();
        loop {
            let is_open = !self.interrupt.is_raised();
            let claims: Vec<_> = asked
                .iter()
                .map(|request| Claim {
                    scope: self.scope.clone(),
                    limit: if is_open { request.limit } else { 0 },
                    batch: request.batch.clone(),
                })
                .collect();
            let exchanged = match self.keep_alive().await {
                Ok(()) => self.queue.exchange(done, &claims).await,
                // Who cannot give a sign of life may have been forgotten, and must not claim.
                Err(error) => Err(error),
            };
            match exchanged {
                // After an interruption, too: what is finished is not to be thrown away.
                Ok(exchanged) => return Ok(exchanged),
                Err(error @ QueueError::Locked(_)) => progress.waiting(&error.to_string()),
                Err(error) => patience.wait(error, self.interrupt, progress).await?,
            }
        }
    }

    /// What a quarter of a second without news brings.
    async fn tick(&mut self, progress: &mut impl Progress) -> Result<(), QueueError> {
        match self.keep_alive().await {
            // A lease outlasts several heartbeats.
            Err(error) if error.is_transient() => {}
            kept => kept?,
        }
        self.tally.refresh(self.queue, self.scope).await?;
        progress.update(&self.snapshot());
        Ok(())
    }

    /// Extends the leases of what runs here and takes back what runs nowhere.
    async fn keep_alive(&mut self) -> Result<(), QueueError> {
        if self.interrupt.is_raised() && !self.is_stopping {
            // If it is ended at once now, that is no crash. Where it cannot be said, it is taken for one.
            self.is_stopping = self.queue.mark_stopping().await.is_ok();
        }
        if !self.heartbeat.is_due() {
            return Ok(());
        }
        self.queue.heartbeat().await?;
        self.heartbeat.is_given();
        match self.take_back().await {
            // Next time.
            Err(error) if error.is_transient() => Ok(()),
            taken => taken,
        }
    }

    async fn take_back(&mut self) -> Result<(), QueueError> {
        let taken = self.queue.take_back().await?;
        self.taken_back.pending += taken.pending;
        self.taken_back.failed += taken.failed;
        Ok(())
    }

    fn settle(&mut self, done: &[Finished], refused: &[String], progress: &mut impl Progress) {
        for job in done {
            let cost = self.running.remove(&job.key).map_or(0.0, |(cost, _)| cost);
            if refused.contains(&job.key) {
                // Another worker has it, and counts it.
                continue;
            }
            self.tally.ended(&job.outcome, cost);
            match &job.outcome {
                FinishedOutcome::Done { .. } => self.timings.push((cost, job.wall_s)),
                FinishedOutcome::Failed { error } => progress.failed(&job.key, error),
                FinishedOutcome::Released | FinishedOutcome::Unstarted => {}
            }
        }
    }

    fn snapshot(&self) -> Snapshot {
        let Tally { counts, remaining_cost, .. } = self.tally;
        let eta = Eta::estimate(&self.timings, remaining_cost, counts.pending + counts.running, self.threads);
        let running = self
            .running
            .iter()
            .map(|(key, (_, clock))| RunningJob { key: key.clone(), simulated_s: clock.simulated_s() })
            .collect();
        Snapshot { counts, running, eta }
    }
}
