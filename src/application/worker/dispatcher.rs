//! The dispatcher of a worker: it owns the database connection and the progress display.
//!
//! It takes turns: it stores the ends of jobs and claims new ones in one transaction, answers the threads' requests, and
//! waits for their reports.

use super::channel::{Assignment, JobProgress, Report, Request};
use super::checkpoint::SealedCheckpoint;
use super::eta::{Eta, Left};
use super::executor::Executor;
use super::heartbeat::Heartbeat;
use super::idle::IdleTimer;
use super::interrupt::Interrupt;
use super::options::WorkOptions;
use super::planner::Planner;
use super::progress::{Progress, RunningJob, Snapshot};
use super::retry::RetryBackoff;
use super::stall::Stall;
use super::tally::Tally;
use crate::queue::{
    Claim, ClaimedJob, Counts, Exchanged, Finished, FinishedOutcome, Queue, QueueError, Scope, TakenBack,
};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::mpsc::UnboundedReceiver;

/// Longest time without a turn: how often progress is shown when no job ends.
pub(super) const TICK: Duration = Duration::from_millis(250);

/// Turns between the database and the solver threads.
pub struct Dispatcher<'a> {
    pub(super) queue: &'a mut Queue,
    pub(super) scope: &'a Scope,
    threads: usize,
    pub(super) interrupt: &'a Interrupt,
    executor: Executor,
    reports: UnboundedReceiver<Report>,
    /// Requests of threads that have not been answered.
    requests: Vec<Request>,
    /// Ends of jobs that could not be stored before an error.
    unstored: Vec<Finished>,
    /// Checkpoints that have not been stored.
    checkpoints: Vec<SealedCheckpoint>,
    /// Cost and progress of every running job, by key.
    running: BTreeMap<String, (f64, Arc<JobProgress>)>,
    /// Cost and duration [s] of the jobs that this worker has finished.
    timings: Vec<(f64, f64)>,
    heartbeat: Heartbeat,
    idle: IdleTimer,
    stall: Stall,
    idle_exit: Option<Duration>,
    expected_s_per_cost: [f64; 2],
    pub(super) planner: Option<&'static dyn Planner>,
    /// When studies that grow were last looked for.
    pub(super) last_plan: Option<Instant>,
    /// Whether the database knows that this worker was asked to stop.
    is_stopping: bool,
    taken_back: TakenBack,
    pub(super) tally: Tally,
}

impl<'a> Dispatcher<'a> {
    /// A dispatcher of a worker that is registered.
    pub async fn new(
        queue: &'a mut Queue,
        scope: &'a Scope,
        options: WorkOptions,
        interrupt: &'a Interrupt,
        executor: Executor,
        reports: UnboundedReceiver<Report>,
    ) -> Result<Self, QueueError> {
        let taken_back = queue.take_back().await?;
        let tally = Tally::new(queue, scope).await?;
        let heartbeat = Heartbeat::new(queue.settings().lease);
        Ok(Self {
            queue,
            scope,
            threads: options.threads,
            interrupt,
            executor,
            reports,
            requests: Vec::new(),
            unstored: Vec::new(),
            checkpoints: Vec::new(),
            running: BTreeMap::new(),
            timings: Vec::new(),
            heartbeat,
            idle: IdleTimer::default(),
            stall: Stall::default(),
            idle_exit: options.idle_exit,
            expected_s_per_cost: options.expected_s_per_cost,
            planner: options.planner,
            last_plan: None,
            is_stopping: false,
            taken_back,
            tally,
        })
    }

    /// Takes turns with the database until there is nothing more to do.
    pub async fn run(&mut self, progress: &mut dyn Progress) -> Result<(), QueueError> {
        let mut done = Vec::new();
        loop {
            self.store_checkpoints(progress).await;
            let requests = self.take_answerable_requests();
            let exchanged = match self.exchange(&done, &requests, progress).await {
                Ok(exchanged) => exchanged,
                Err(error) => {
                    self.unstored = done;
                    return Err(error);
                }
            };
            self.record_ends(&done, &exchanged.refused, progress);
            done.clear();
            for (request, jobs) in requests.into_iter().zip(exchanged.claimed) {
                self.answer(request, jobs);
            }
            self.plan_waves(progress).await?;
            self.tally.refresh(self.queue, self.scope).await?;
            progress.update(&self.snapshot());
            loop {
                if self.running.is_empty() && self.is_finished(progress).await? {
                    return Ok(());
                }
                // Never wrap a database future in a timeout: dropping it would hold the lock.
                match tokio::time::timeout(TICK, self.reports.recv()).await {
                    Ok(Some(report)) => self.accept(report, &mut done),
                    Ok(None) => unreachable!("the threads hold senders"),
                    Err(_) => self.tick(progress).await?,
                }
                while let Ok(report) = self.reports.try_recv() {
                    self.accept(report, &mut done);
                }
                if !done.is_empty() || !self.checkpoints.is_empty() || self.has_answerable_request() {
                    break;
                }
            }
        }
    }

    /// Leaves the database as far as it answers; what fails is ignored.
    async fn unregister(&mut self) {
        let _ = self.queue.unregister().await;
    }

    /// After an error that ends the worker: leaves the database as far as it answers. If the database was deleted, moved or
    /// replaced, all results are put where they can be found; the error says where.
    pub async fn abort(&mut self, error: QueueError) -> QueueError {
        if !matches!(error, QueueError::Displaced { .. }) {
            self.unregister().await;
            return error;
        }
        let mut ended = std::mem::take(&mut self.unstored);
        while let Ok(report) = self.reports.try_recv() {
            self.accept(report, &mut ended);
        }
        self.queue.rescue(&ended, error).await
    }

    /// Unregisters the worker and counts the jobs for the last time.
    pub async fn shut_down(&mut self, progress: &mut dyn Progress) -> Result<(), QueueError> {
        let backoff = RetryBackoff::new();
        loop {
            let left = match self.queue.unregister().await {
                Ok(()) => self.tally.query(self.queue, self.scope).await,
                error => error,
            };
            match left {
                // What was counted is there, and not only in memory.
                Ok(()) => return self.queue.ensure_place().await,
                Err(error) => backoff.wait(error, self.interrupt, progress).await?,
            }
        }
    }

    /// Whether the worker is to stop, given that no job runs here.
    async fn is_finished(&mut self, progress: &mut dyn Progress) -> Result<bool, QueueError> {
        if self.interrupt.is_raised() {
            return Ok(true);
        }
        if self.tally.counts.pending > 0 {
            self.note_unclaimed().await?;
            return Ok(false);
        }
        if !self.idle.is_poll_due() {
            return Ok(false);
        }
        let backoff = RetryBackoff::new();
        loop {
            match self.poll_for_jobs(progress).await {
                Ok(is_finished) => return Ok(is_finished),
                Err(_) if self.interrupt.is_raised() => return Ok(true),
                Err(error) => backoff.wait(error, self.interrupt, progress).await?,
            }
        }
    }

    /// Looks for new jobs and for jobs of dead workers; returns whether there is nothing more to wait for.
    async fn poll_for_jobs(&mut self, progress: &mut dyn Progress) -> Result<bool, QueueError> {
        self.take_back().await?;
        self.last_plan = None;
        let has_planned = self.plan_waves(progress).await?;
        // The tally may be older than the changes by other workers.
        let open = self.queue.open_jobs(self.scope).await?;
        if open.has_pending || open.has_running && self.tally.counts.running == 0 {
            self.note_unclaimed().await?;
        } else {
            self.stall.reset();
        }
        if open.has_pending || has_planned {
            self.tally.invalidate();
            return Ok(false);
        }
        if open.has_running {
            for advice in self.queue.stopped_workers().await? {
                progress.waiting(&advice);
            }
        }
        // A wave that another worker plans will have jobs for this one, too.
        let may_grow = open.has_plans && self.planner.is_some();
        let Some(limit) = self.idle_exit else { return Ok(!open.has_running && !may_grow) };
        // Exits even if other workers are still running jobs, unless one of them has missed a heartbeat: its jobs may
        // come back.
        Ok(self.idle.elapsed() >= limit && !(open.has_running && self.queue.has_missing_workers().await?))
    }

    /// A look found jobs that this worker, which runs none, has not claimed.
    ///
    /// # Errors
    /// If nobody else runs a job either, and this has been so for too long.
    async fn note_unclaimed(&mut self) -> Result<(), QueueError> {
        if self.tally.counts.running == 0 && !self.stall.is_over_limit() {
            return Ok(());
        }
        // The tally may be old.
        self.tally.query(self.queue, self.scope).await?;
        let open = self.queue.open_jobs(self.scope).await?;
        let Counts { pending, running, .. } = self.tally.counts;
        let is_stuck =
            if pending > 0 { self.stall.has_tried() } else { open.has_pending || open.has_running };
        if running == 0 && is_stuck {
            return Err(self.queue.contradiction().await?);
        }
        self.stall.reset();
        Ok(())
    }

    fn accept(&mut self, report: Report, done: &mut Vec<Finished>) {
        match report {
            Report::Finished(job) => done.push(job),
            Report::Checkpoint(checkpoint) => self.checkpoints.push(checkpoint),
            Report::Request(request) => self.requests.push(request),
        }
    }

    /// Whether a request can be answered now. Batch requests are answered immediately, possibly with no job; a request
    /// for any job waits until there is one.
    fn is_answerable(&self, request: &Request) -> bool {
        request.batch.is_some() || (self.tally.counts.pending > 0 && !self.interrupt.is_raised())
    }

    fn has_answerable_request(&self) -> bool {
        self.requests.iter().any(|request| self.is_answerable(request))
    }

    /// Removes the requests to answer now. None of them asks for more than a fair share of the pending jobs.
    fn take_answerable_requests(&mut self) -> Vec<Request> {
        let pending = usize::try_from(self.tally.counts.pending).unwrap_or(usize::MAX);
        let share = pending.div_ceil(self.threads).max(1);
        let (mut now, later): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.requests).into_iter().partition(|request| self.is_answerable(request));
        for request in &mut now {
            request.limit = request.limit.min(share);
        }
        self.requests = later;
        now
    }

    /// Sends a thread its jobs. A request for any job stays open if there is none.
    fn answer(&mut self, request: Request, jobs: Vec<ClaimedJob>) {
        if jobs.is_empty() && request.batch.is_none() {
            // Other workers were faster. No job is claimed until the database has been queried again.
            self.tally.counts.pending = 0;
            self.stall.note_empty_claim();
            self.requests.push(request);
            return;
        }
        if !jobs.is_empty() {
            self.idle.reset();
            self.stall.reset();
        }
        self.tally.add_claimed(jobs.len() as u64);
        let assignments = jobs.into_iter().map(|job| {
            let progress = Arc::new(JobProgress::default());
            self.running.insert(job.key.clone(), (job.cost, Arc::clone(&progress)));
            Assignment { job, progress }
        });
        let assignments = assignments.collect();
        self.executor.reply(request.thread, assignments);
    }

    /// Stores the checkpoints. This comes before the ends of jobs, so that a released job has its last checkpoint.
    ///
    /// If a checkpoint cannot be stored, the work goes on: the previous one is still there.
    async fn store_checkpoints(&mut self, progress: &mut dyn Progress) {
        let mut is_refused = false;
        let backoff = RetryBackoff::new();
        for SealedCheckpoint { key, attempt, bytes } in std::mem::take(&mut self.checkpoints) {
            while !is_refused {
                match self.queue.save_checkpoint(&key, attempt, &bytes).await {
                    Ok(_) => break,
                    Err(error) => {
                        // The jobs are being released, and no later checkpoint will replace this one.
                        let is_last = self.interrupt.is_raised();
                        if !is_last {
                            progress.waiting(&format!("the state of running jobs cannot be stored: {error}"));
                        }
                        is_refused = !is_last || backoff.wait(error, self.interrupt, progress).await.is_err();
                    }
                }
            }
            if let Some((_, progress)) = self.running.get(&key) {
                progress.end_checkpoint();
            }
        }
    }

    /// Stores the ends of jobs and claims the requested ones. While the database is locked, running jobs go on.
    async fn exchange(
        &mut self,
        done: &[Finished],
        requests: &[Request],
        progress: &mut dyn Progress,
    ) -> Result<Exchanged, QueueError> {
        let backoff = RetryBackoff::new();
        loop {
            let is_open = !self.interrupt.is_raised();
            let claims: Vec<_> = requests
                .iter()
                .map(|request| Claim {
                    scope: self.scope.clone(),
                    limit: if is_open { request.limit } else { 0 },
                    batch: request.batch.clone(),
                })
                .collect();
            let exchanged = match self.keep_alive().await {
                Ok(()) => self.queue.exchange(done, &claims).await,
                // A worker that cannot send a heartbeat may count as dead, and must not claim.
                Err(error) => Err(error),
            };
            match exchanged {
                Ok(exchanged) => return Ok(exchanged),
                // Also after an interruption: finished work must not be lost.
                Err(error @ QueueError::Locked { .. }) => progress.waiting(&error.to_string()),
                Err(error) => backoff.wait(error, self.interrupt, progress).await?,
            }
        }
    }

    /// What is to do after [`TICK`] without a report.
    async fn tick(&mut self, progress: &mut dyn Progress) -> Result<(), QueueError> {
        match self.keep_alive().await {
            // A lease outlasts several heartbeats.
            Err(error) if error.is_transient() => {}
            kept_alive => kept_alive?,
        }
        // A worker without jobs looks for waves when it looks for jobs, which becomes rarer.
        if !self.running.is_empty() {
            self.plan_waves(progress).await?;
        }
        self.tally.refresh(self.queue, self.scope).await?;
        progress.update(&self.snapshot());
        Ok(())
    }

    /// Sends a heartbeat if one is due, which extends the leases of the jobs that run here, and takes back the jobs of
    /// dead workers.
    pub(super) async fn keep_alive(&mut self) -> Result<(), QueueError> {
        if self.interrupt.is_raised() && !self.is_stopping {
            // From now on a sudden end of this process is no crash. If the database does not learn it, it is one.
            self.is_stopping = self.queue.mark_stopping().await.is_ok();
        }
        if !self.heartbeat.is_due() {
            return Ok(());
        }
        self.queue.heartbeat().await?;
        self.heartbeat.mark_sent();
        match self.take_back().await {
            // The next heartbeat tries again.
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

    /// Counts the ends that were stored. `refused` has the keys of jobs that belong to another worker by now.
    fn record_ends(&mut self, done: &[Finished], refused: &[String], progress: &mut dyn Progress) {
        for job in done {
            let cost = self.running.remove(&job.key).map_or(0.0, |(cost, _)| cost);
            if refused.contains(&job.key) {
                // The other worker counts it.
                continue;
            }
            self.tally.add_ended(&job.outcome, cost);
            match &job.outcome {
                FinishedOutcome::Done { .. } => self.timings.push((cost, job.wall_s)),
                FinishedOutcome::Failed { error } => progress.failed(&job.key, error),
                FinishedOutcome::Released | FinishedOutcome::Unstarted => {}
            }
        }
    }

    /// Jobs of dead workers that were taken back.
    pub fn taken_back(&self) -> TakenBack {
        self.taken_back
    }

    /// The state of the jobs now.
    pub fn snapshot(&self) -> Snapshot {
        let Tally { counts, remaining, .. } = self.tally;
        let begun: f64 =
            self.running.values().map(|(cost, progress)| cost * (1.0 - progress.share_left())).sum();
        let left = Left::new(counts, remaining, begun);
        let eta = Eta::estimate(&self.timings, self.expected_s_per_cost, left, self.threads);
        let running = self
            .running
            .iter()
            .map(|(key, (_, progress))| RunningJob {
                key: key.clone(),
                simulated_s: progress.simulated_s(),
                limit_s: progress.limit_s(),
            })
            .collect();
        Snapshot { counts, running, eta }
    }
}
