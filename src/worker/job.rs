//! A job on its thread: its payload is parsed once, and its end becomes an outcome for the queue.

use super::channel::{Assignment, WorkerChannel};
use crate::analysis::continuation::{PinMotion, from_bytes, to_bytes};
use crate::analysis::{Ending, JobError, JobRecord};
use crate::queue::FinishedOutcome;
use crate::spec::JobSpec;
use std::any::Any;

/// An assignment whose payload has been parsed.
#[derive(Debug)]
pub struct ParsedJob {
    /// The job as it was claimed.
    pub assignment: Assignment,
    /// Its payload.
    pub spec: JobSpec,
    /// The last motion of the job that it continues.
    pub parent: Option<PinMotion>,
}

impl ParsedJob {
    /// Parses the payload. If it is no job, reports that the job failed.
    pub fn parse(mut assignment: Assignment, channel: &WorkerChannel) -> Option<Self> {
        match serde_json::from_str(&assignment.job.payload) {
            Ok(spec) => {
                assignment.progress.set_ending(Ending::of(&spec));
                let parent = assignment.job.parent_state.take().and_then(|bytes| from_bytes(&bytes));
                Some(Self { assignment, spec, parent })
            }
            Err(error) => {
                let failure = FinishedOutcome::Failed { error: format!("unreadable job: {error}") };
                channel.finish(&assignment.job, failure, 0.0);
                None
            }
        }
    }
}

/// The end of a run as an outcome for the queue.
///
/// `spec` says whether the last motion is kept for jobs that continue this one.
pub fn outcome(
    spec: &JobSpec,
    result: Result<JobRecord, JobError>,
    motion: Option<&PinMotion>,
) -> FinishedOutcome {
    match result {
        Ok(record) => match serde_json::to_string(&record) {
            Ok(text) => FinishedOutcome::Done {
                record: text,
                label: record.outcome.name().to_owned(),
                final_state: motion.filter(|_| spec.continuation.is_some()).map(to_bytes),
            },
            Err(error) => FinishedOutcome::Failed { error: format!("unwritable record: {error}") },
        },
        Err(error) => FinishedOutcome::Failed { error: error.to_string() },
    }
}

/// The outcome of a job whose run panicked.
pub fn panic_outcome(panic: &(dyn Any + Send)) -> FinishedOutcome {
    let message = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("no message");
    FinishedOutcome::Failed { error: format!("internal error (please report it): {message}") }
}
