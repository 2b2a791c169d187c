//! The jobs of one batch on one thread.

use super::checkpoint::{self, Kept, Pace};
use super::executor::{Assignment, Desk, Report};
use crate::analysis::batch::Batch;
use crate::analysis::{JobError, JobRecord};
use crate::queue::{Finished, FinishedOutcome};
use crate::spec::JobSpec;
use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Requests that follow one another faster than this are made ahead of need.
const SHORT: Duration = Duration::from_millis(50);

/// Jobs that are advanced together, and those that wait for a lane.
pub(super) struct Crew<'a> {
    desk: &'a Desk,
    batch: Batch,
    name: String,
    waiting: VecDeque<Assignment>,
    running: BTreeMap<u64, Member>,
    tickets: u64,
    /// Whether a request for more has not been answered yet.
    asked: bool,
    /// When a request was made last …
    asked_at: Instant,
    /// … and the jobs that have ended since.
    ended: usize,
    /// Jobs of another model: their batch's name was wrong.
    strangers: Vec<Assignment>,
}

/// A job in a lane.
struct Member {
    assignment: Assignment,
    /// Its share of the thread's time [s]: jobs that are advanced together share it equally.
    share_s: f64,
    pace: Pace,
}

impl<'a> Crew<'a> {
    /// Runs a job and whatever else of its batch there is; returns jobs that belong to others.
    pub fn run(desk: &'a Desk, first: Assignment) -> Vec<Assignment> {
        let prepared = catch_unwind(|| prepare(&first)).unwrap_or_else(|panic| Err(internal_error(&*panic)));
        let batch = match prepared {
            Ok(batch) => batch,
            Err(outcome) => {
                finish(desk, &first, outcome, 0.0);
                return Vec::new();
            }
        };
        let mut crew = Self {
            desk,
            batch,
            name: first.job.batch.clone(),
            waiting: VecDeque::from([first]),
            running: BTreeMap::new(),
            tickets: 0,
            asked: false,
            asked_at: Instant::now(),
            ended: 1,
            strangers: Vec::new(),
        };
        if !crew.work() {
            crew.blame();
        }
        crew.strangers
    }

    /// Advances jobs until none is left; false if the solver panicked.
    fn work(&mut self) -> bool {
        loop {
            if self.desk.interrupt.is_raised() {
                self.release();
                return true;
            }
            // A panic is a bug, but it must not take the sweep with it.
            let heard = catch_unwind(AssertUnwindSafe(|| {
                self.hear();
                self.fill();
            }));
            if heard.is_err() {
                return false;
            }
            self.ask();
            if self.running.is_empty() {
                if self.asked {
                    continue;
                }
                return true;
            }
            let begun = Instant::now();
            let Ok(ended) = catch_unwind(AssertUnwindSafe(|| self.batch.advance())) else { return false };
            let share_s = begun.elapsed().as_secs_f64() / self.running.len() as f64;
            for member in self.running.values_mut() {
                member.share_s += share_s;
            }
            for job in ended {
                self.end(job.ticket, outcome(job.result));
            }
            self.look();
        }
    }

    /// Shows how far the jobs are, and keeps those that it is time to keep.
    fn look(&mut self) {
        let now = Instant::now();
        for (ticket, simulated_s) in self.batch.simulated() {
            let Some(member) = self.running.get_mut(&ticket) else { continue };
            member.assignment.clock.set(simulated_s);
            member.pace.look(now, simulated_s);
            if let Some(interval) = self.desk.checkpoint_interval
                && member.pace.is_due(now, simulated_s, interval)
                && member.assignment.clock.begin_keeping()
            {
                keep(self.desk, &self.batch, ticket, member);
            }
        }
    }

    /// Begins waiting jobs in free lanes.
    fn fill(&mut self) {
        while self.batch.jobs() < self.batch.widest() {
            let Some(mut assignment) = self.waiting.pop_front() else { return };
            let spec = match parse(&assignment) {
                Ok(spec) => spec,
                Err(outcome) => {
                    finish(self.desk, &assignment, outcome, 0.0);
                    continue;
                }
            };
            if !self.batch.takes(&spec) {
                self.strangers.push(assignment);
                continue;
            }
            self.tickets += 1;
            let kept = assignment.job.checkpoint.take();
            let pace = Pace::new(spec.run.limit_s);
            // Before it begins: whatever happens, somebody has to answer for it.
            self.running.insert(self.tickets, Member { assignment, share_s: 0.0, pace });
            if self.resume(kept.as_deref(), &spec) {
                continue;
            }
            if let Err(error) = self.batch.begin(self.tickets, spec) {
                self.end(self.tickets, outcome(Err(error)));
            }
        }
    }

    /// Goes on with the newest member where an earlier attempt left off; whether there is such a place.
    fn resume(&mut self, kept: Option<&[u8]>, spec: &JobSpec) -> bool {
        let Some(member) = self.running.get_mut(&self.tickets) else { return false };
        let Some((spent_s, place)) = kept.and_then(|kept| checkpoint::open(&member.assignment.job, kept))
        else {
            return false;
        };
        let is_resumed = self.batch.resume(self.tickets, spec.clone(), place).is_ok();
        if is_resumed {
            member.share_s = spent_s;
        }
        is_resumed
    }

    /// Asks for more jobs after one has ended, if there is a lane for them.
    fn ask(&mut self) {
        let free = self.batch.widest() - self.batch.jobs();
        if !self.asked && self.ended > 0 && free > 0 && self.waiting.is_empty() {
            // Short jobs need not wait for the database, long ones are not to wait here while others are idle.
            let is_busy = self.asked_at.elapsed() < SHORT;
            let ahead = if is_busy { (self.ended - 1).min(self.batch.widest()) } else { 0 };
            self.desk.ask(Some(self.name.clone()), free + ahead);
            (self.asked, self.asked_at, self.ended) = (true, Instant::now(), 0);
        }
    }

    /// Takes the answer to a request, and waits for it when there is nothing else to do.
    fn hear(&mut self) {
        if !self.asked {
            return;
        }
        let answer = if self.running.is_empty() {
            // A closed mailbox is an answer, too: there is no more to come.
            self.desk.mailbox.recv().unwrap_or_default()
        } else {
            match self.desk.mailbox.try_recv() {
                Ok(jobs) => jobs,
                Err(_) => return,
            }
        };
        self.asked = false;
        if answer.is_empty() {
            self.batch.narrow();
        }
        self.waiting.extend(answer);
    }

    fn end(&mut self, ticket: u64, outcome: FinishedOutcome) {
        let Some(member) = self.running.remove(&ticket) else { return };
        self.ended += 1;
        finish(self.desk, &member.assignment, outcome, member.share_s);
    }

    /// Gives everything back, long jobs with where they are.
    fn release(&mut self) {
        if let Some(interval) = self.desk.checkpoint_interval {
            let now = Instant::now();
            for (ticket, simulated_s) in self.batch.simulated() {
                if let Some(member) = self.running.get(&ticket)
                    && member.pace.is_long(now, simulated_s, interval)
                {
                    keep(self.desk, &self.batch, ticket, member);
                }
            }
        }
        for member in std::mem::take(&mut self.running).into_values() {
            finish(self.desk, &member.assignment, FinishedOutcome::Released, member.share_s);
        }
        let answer = if self.asked { self.desk.mailbox.recv().unwrap_or_default() } else { Vec::new() };
        self.asked = false;
        for assignment in self.waiting.drain(..).chain(answer).chain(self.strangers.drain(..)) {
            finish(self.desk, &assignment, FinishedOutcome::Unstarted, 0.0);
        }
    }

    /// After a panic: runs the jobs one by one, so that only the one that panics by itself fails.
    fn blame(&mut self) {
        for member in std::mem::take(&mut self.running).into_values() {
            let begun = Instant::now();
            let alone = catch_unwind(AssertUnwindSafe(|| alone(&member.assignment, self.desk)));
            let outcome = alone.unwrap_or_else(|panic| internal_error(&*panic));
            let share_s = member.share_s + begun.elapsed().as_secs_f64();
            finish(self.desk, &member.assignment, outcome, share_s);
        }
        if self.asked {
            self.strangers.extend(self.desk.mailbox.recv().unwrap_or_default());
        }
        self.strangers.extend(self.waiting.drain(..));
    }
}

/// Sends where a job is to the database.
fn keep(desk: &Desk, batch: &Batch, ticket: u64, member: &Member) {
    if let Some(place) = batch.checkpoint(ticket) {
        let job = &member.assignment.job;
        let bytes = checkpoint::seal(job, member.share_s, &place);
        desk.report(Report::Checkpoint(Kept { key: job.key.clone(), attempt: job.attempt, bytes }));
    }
}

/// Solves one job without companions.
fn alone(assignment: &Assignment, desk: &Desk) -> FinishedOutcome {
    let (mut batch, spec) = match prepare(assignment).and_then(|batch| Ok((batch, parse(assignment)?))) {
        Ok(prepared) => prepared,
        Err(outcome) => return outcome,
    };
    if let Err(error) = batch.begin(0, spec) {
        return outcome(Err(error));
    }
    loop {
        if let Some(ended) = batch.advance().pop() {
            return outcome(ended.result);
        }
        for (_, simulated_s) in batch.simulated() {
            assignment.clock.set(simulated_s);
        }
        if desk.interrupt.is_raised() {
            return FinishedOutcome::Released;
        }
    }
}

fn internal_error(panic: &(dyn std::any::Any + Send)) -> FinishedOutcome {
    let message = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("no message");
    FinishedOutcome::Failed { error: format!("internal error (please report it): {message}") }
}

fn parse(assignment: &Assignment) -> Result<JobSpec, FinishedOutcome> {
    serde_json::from_str(&assignment.job.payload)
        .map_err(|error| FinishedOutcome::Failed { error: format!("unreadable job: {error}") })
}

fn prepare(assignment: &Assignment) -> Result<Batch, FinishedOutcome> {
    Batch::new(&parse(assignment)?).map_err(|error| outcome(Err(error)))
}

fn outcome(result: Result<JobRecord, JobError>) -> FinishedOutcome {
    match result {
        Ok(record) => match serde_json::to_string(&record) {
            Ok(text) => FinishedOutcome::Done { record: text, label: record.outcome.name().to_owned() },
            Err(error) => FinishedOutcome::Failed { error: format!("unwritable record: {error}") },
        },
        Err(error) => FinishedOutcome::Failed { error: error.to_string() },
    }
}

fn finish(desk: &Desk, assignment: &Assignment, outcome: FinishedOutcome, wall_s: f64) {
    let (key, attempt) = (assignment.job.key.clone(), assignment.job.attempt);
    desk.report(Report::Finished(Finished { key, attempt, outcome, wall_s }));
}
