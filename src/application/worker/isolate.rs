//! Runs one job without companions, to find the job that panics.

use super::channel::WorkerChannel;
use super::job::{ParsedJob, outcome, panic_outcome};
use crate::analysis::batch::{Batch, Begun};
use crate::queue::FinishedOutcome;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs a job by itself. If it panics again, it is the one at fault, and its outcome says so.
pub fn isolate_panic(job: &ParsedJob, channel: &WorkerChannel) -> FinishedOutcome {
    catch_unwind(AssertUnwindSafe(|| solve_alone(job, channel)))
        .unwrap_or_else(|panic| panic_outcome(&*panic))
}

fn solve_alone(job: &ParsedJob, channel: &WorkerChannel) -> FinishedOutcome {
    let started = Batch::sharing(&job.spec, channel.structures.clone()).and_then(|mut batch| {
        let begun = batch.begin_after(0, job.spec.clone(), job.parent.clone())?;
        Ok((batch, begun))
    });
    let mut batch = match started {
        Ok((batch, Begun::Runs)) => batch,
        Ok((_, Begun::Decided(record))) => return outcome(&job.spec, Ok(*record), None),
        Err(error) => return outcome(&job.spec, Err(error), None),
    };
    loop {
        if let Some(ended) = batch.advance().pop() {
            return outcome(&job.spec, ended.result, ended.motion.as_ref());
        }
        for (_, simulated_s) in batch.simulated() {
            job.assignment.progress.set_simulated_s(simulated_s);
        }
        if channel.interrupt.is_raised() {
            return FinishedOutcome::Released;
        }
    }
}
