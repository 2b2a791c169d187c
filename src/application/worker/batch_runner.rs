//! Runs the jobs of one batch on one thread.

use super::channel::{Assignment, Report, WorkerChannel};
use super::checkpoint;
use super::isolate::isolate_panic;
use super::job::{ParsedJob, outcome, panic_outcome};
use super::schedule::CheckpointSchedule;
use crate::analysis::batch::{Batch, Begun};
use crate::analysis::continuation::PinMotion;
use crate::analysis::{JobError, JobRecord};
use crate::queue::FinishedOutcome;
use crate::spec::JobSpec;
use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Jobs are prefetched when requests come closer than this.
const PREFETCH_BELOW: Duration = Duration::from_millis(50);

/// The jobs that are advanced together, and those that wait for a lane.
pub struct BatchRunner<'a> {
    channel: &'a WorkerChannel,
    batch: Batch,
    /// The batch's name in requests.
    name: String,
    waiting: VecDeque<ParsedJob>,
    running: BTreeMap<u64, RunningJob>,
    last_ticket: u64,
    /// Whether a request has not been answered yet.
    has_open_request: bool,
    last_request: Instant,
    ended_since_request: usize,
    /// Whether the eigenvalues decided the last job that began.
    was_decided: bool,
    /// Jobs of another model that came under this batch's name.
    mismatched: Vec<ParsedJob>,
}

/// A job in a lane.
struct RunningJob {
    job: ParsedJob,
    /// Its part of the thread's time [s]. Jobs that are advanced together share the time equally.
    share_s: f64,
    schedule: CheckpointSchedule,
}

impl<'a> BatchRunner<'a> {
    /// Runs `first` and all other jobs of its batch that the dispatcher sends. Returns the jobs that cannot be advanced
    /// with this batch.
    pub fn run(channel: &'a WorkerChannel, first: ParsedJob) -> Vec<ParsedJob> {
        let failure = match catch_unwind(AssertUnwindSafe(|| {
            Batch::sharing(&first.spec, channel.structures.clone())
        })) {
            Ok(Ok(batch)) => return Self::new(channel, batch, first).run_to_end(),
            Ok(Err(error)) => outcome(&first.spec, Err(error), None),
            Err(panic) => panic_outcome(&*panic),
        };
        channel.finish(&first.assignment.job, failure, 0.0);
        Vec::new()
    }

    fn new(channel: &'a WorkerChannel, batch: Batch, first: ParsedJob) -> Self {
        Self {
            channel,
            batch,
            name: first.assignment.job.batch.clone(),
            waiting: VecDeque::from([first]),
            running: BTreeMap::new(),
            last_ticket: 0,
            has_open_request: false,
            last_request: Instant::now(),
            // So that the first request is made at once.
            ended_since_request: 1,
            was_decided: false,
            mismatched: Vec::new(),
        }
    }

    fn run_to_end(mut self) -> Vec<ParsedJob> {
        // A panic is a bug, but it must not end the sweep.
        if catch_unwind(AssertUnwindSafe(|| self.advance_all())).is_err() {
            self.run_one_by_one();
        }
        self.mismatched
    }

    /// Advances jobs until none is left, or gives them back after an interruption.
    fn advance_all(&mut self) {
        loop {
            if self.channel.interrupt.is_raised() {
                return self.release();
            }
            self.take_reply();
            self.fill_lanes();
            self.request_more();
            if self.running.is_empty() {
                if self.has_open_request || !self.waiting.is_empty() {
                    continue;
                }
                return;
            }
            let begun = Instant::now();
            let ended = self.batch.advance();
            let share_s = begun.elapsed().as_secs_f64() / self.running.len() as f64;
            for running in self.running.values_mut() {
                running.share_s += share_s;
            }
            for job in ended {
                self.end(job.ticket, job.result, job.motion.as_ref());
            }
            self.show_progress();
        }
    }

    /// Takes the answer to a request, and waits for it when there is nothing else to do.
    fn take_reply(&mut self) {
        if !self.has_open_request {
            return;
        }
        let reply = if self.running.is_empty() {
            // If the dispatcher has ended, no job comes any more.
            self.channel.wait_for_reply().unwrap_or_default()
        } else {
            match self.channel.poll_reply() {
                Some(reply) => reply,
                None => return,
            }
        };
        self.has_open_request = false;
        if reply.is_empty() {
            self.batch.narrow();
        }
        self.wait_for_lanes(reply);
    }

    fn wait_for_lanes(&mut self, assignments: Vec<Assignment>) {
        let jobs =
            assignments.into_iter().filter_map(|assignment| ParsedJob::parse(assignment, self.channel));
        self.waiting.extend(jobs);
    }

    /// Begins waiting jobs in free lanes.
    fn fill_lanes(&mut self) {
        // Eigenvalues may take a second or more, so that an interruption must not wait for all jobs.
        while self.batch.jobs() < self.batch.widest() && !self.channel.interrupt.is_raised() {
            let Some(mut job) = self.waiting.pop_front() else { return };
            if !self.batch.takes(&job.spec) {
                self.mismatched.push(job);
                continue;
            }
            let checkpoint = job.assignment.job.checkpoint.take();
            let (spec, parent) = (job.spec.clone(), job.parent.clone());
            let schedule = CheckpointSchedule::new(spec.run.limit_s);
            self.last_ticket += 1;
            // Registered before it begins: if it panics, its end must be reported all the same.
            self.running.insert(self.last_ticket, RunningJob { job, share_s: 0.0, schedule });
            if checkpoint.is_some_and(|sealed| self.resume(&sealed)) {
                continue;
            }
            self.begin(spec, parent);
        }
    }

    /// Begins the newest job. It ends at once if it is refused, or if the eigenvalues decide it.
    fn begin(&mut self, spec: JobSpec, parent: Option<PinMotion>) {
        let begun = Instant::now();
        let result = self.batch.begin_after(self.last_ticket, spec, parent);
        if let Some(running) = self.running.get_mut(&self.last_ticket) {
            running.share_s = begun.elapsed().as_secs_f64();
        }
        self.was_decided = matches!(result, Ok(Begun::Decided(_)));
        match result {
            Ok(Begun::Runs) => {}
            Ok(Begun::Decided(record)) => self.end(self.last_ticket, Ok(*record), None),
            Err(error) => self.end(self.last_ticket, Err(error), None),
        }
    }

    /// Resumes the newest job from a checkpoint of an earlier attempt; false if the checkpoint is not usable.
    fn resume(&mut self, sealed: &[u8]) -> bool {
        let Some(running) = self.running.get_mut(&self.last_ticket) else { return false };
        let ParsedJob { assignment, spec, parent: _ } = &running.job;
        let Some((spent_s, state)) = checkpoint::open(&assignment.job, sealed) else { return false };
        let is_resumed = self.batch.resume(self.last_ticket, spec.clone(), state).is_ok();
        if is_resumed {
            running.share_s = spent_s;
        }
        is_resumed
    }

    /// Requests more jobs after one has ended, if there is a free lane.
    fn request_more(&mut self) {
        let free = self.batch.widest() - self.batch.jobs();
        if !self.has_open_request && self.ended_since_request > 0 && free > 0 && self.waiting.is_empty() {
            // Prefetched short jobs need not wait for the database. Long jobs are not prefetched: they would wait here
            // while other threads are idle.
            let is_frequent = self.last_request.elapsed() < PREFETCH_BELOW;
            let prefetched =
                if is_frequent { (self.ended_since_request - 1).min(self.batch.widest()) } else { 0 };
            // Jobs without a run follow one after the other: other threads may take them.
            let wanted = if self.was_decided { 1 } else { free };
            self.channel.request(Some(self.name.clone()), wanted + prefetched);
            self.has_open_request = true;
            self.last_request = Instant::now();
            self.ended_since_request = 0;
        }
    }

    /// Shows how far the jobs are, and sends the checkpoints that are due.
    fn show_progress(&mut self) {
        let now = Instant::now();
        for (ticket, simulated_s) in self.batch.simulated() {
            let Some(running) = self.running.get_mut(&ticket) else { continue };
            let progress = &running.job.assignment.progress;
            progress.set_simulated_s(simulated_s);
            running.schedule.observe(now, simulated_s);
            if let Some(interval) = self.channel.checkpoint_interval
                && running.schedule.is_due(now, simulated_s, interval)
                && progress.begin_checkpoint()
            {
                send_checkpoint(self.channel, &self.batch, ticket, running);
            }
        }
    }

    fn end(&mut self, ticket: u64, result: Result<JobRecord, JobError>, motion: Option<&PinMotion>) {
        let Some(running) = self.running.remove(&ticket) else { return };
        let outcome = outcome(&running.job.spec, result, motion);
        self.ended_since_request += 1;
        self.channel.finish(&running.job.assignment.job, outcome, running.share_s);
    }

    /// Gives all jobs back, long ones with a checkpoint.
    fn release(&mut self) {
        if let Some(interval) = self.channel.checkpoint_interval {
            let now = Instant::now();
            for (ticket, simulated_s) in self.batch.simulated() {
                if let Some(running) = self.running.get(&ticket)
                    && running.schedule.is_long(now, simulated_s, interval)
                {
                    send_checkpoint(self.channel, &self.batch, ticket, running);
                }
            }
        }
        for running in std::mem::take(&mut self.running).into_values() {
            self.channel.finish(&running.job.assignment.job, FinishedOutcome::Released, running.share_s);
        }
        let unstarted = self.waiting.drain(..).chain(self.mismatched.drain(..)).map(|job| job.assignment);
        for assignment in unstarted.chain(wait_for_open_request(self.channel, &mut self.has_open_request)) {
            self.channel.finish(&assignment.job, FinishedOutcome::Unstarted, 0.0);
        }
    }

    /// Runs the jobs one by one after a panic, so that only the job that panics by itself fails.
    fn run_one_by_one(&mut self) {
        for running in std::mem::take(&mut self.running).into_values() {
            let begun = Instant::now();
            let outcome = isolate_panic(&running.job, self.channel);
            let share_s = running.share_s + begun.elapsed().as_secs_f64();
            self.channel.finish(&running.job.assignment.job, outcome, share_s);
        }
        let reply = wait_for_open_request(self.channel, &mut self.has_open_request);
        self.wait_for_lanes(reply);
        self.mismatched.extend(self.waiting.drain(..));
    }
}

/// The answer to a request that is still open; no jobs if there is none.
fn wait_for_open_request(channel: &WorkerChannel, has_open_request: &mut bool) -> Vec<Assignment> {
    if std::mem::take(has_open_request) { channel.wait_for_reply().unwrap_or_default() } else { Vec::new() }
}

/// Sends the state of a running job to the dispatcher, which stores it.
fn send_checkpoint(channel: &WorkerChannel, batch: &Batch, ticket: u64, running: &RunningJob) {
    if let Some(state) = batch.checkpoint(ticket) {
        let sealed = checkpoint::seal(&running.job.assignment.job, running.share_s, &state);
        channel.report(Report::Checkpoint(sealed));
    }
}
