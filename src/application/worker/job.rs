//! A job on its thread: its payload is parsed once, and its end becomes an outcome for the queue.

use super::channel::{Assignment, WorkerChannel};
use super::options::JobKey;
use crate::analysis::continuation::{PinMotion, from_bytes, to_bytes};
use crate::analysis::{Ending, JobError, JobRecord};
use crate::queue::{ClaimedJob, FinishedOutcome};
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
        match read(&assignment.job, channel.job_key) {
            Ok(spec) => {
                assignment.progress.set_ending(Ending::of(&spec));
                let parent = assignment.job.parent_state.take().and_then(|bytes| from_bytes(&bytes));
                Some(Self { assignment, spec, parent })
            }
            Err(error) => {
                channel.finish(&assignment.job, FinishedOutcome::Failed { error }, 0.0);
                None
            }
        }
    }
}

/// The specification of a job, if it is the one that the job's key was made of and what the job begins with is intact.
fn read(job: &ClaimedJob, job_key: Option<JobKey>) -> Result<JobSpec, String> {
    let spec = serde_json::from_str(&job.payload).map_err(|error| {
        format!("unreadable job: {error}; submit the study again, then `tribosweep retry` it")
    })?;
    if job_key.is_some_and(|job_key| job_key(&spec) != job.key) {
        return Err("the specification that is stored for this job does not have the job's key: it was changed, or another \
                    version of the solver planned the job; submit the study again, then `tribosweep retry` it"
            .to_owned());
    }
    if job.parent_is_damaged {
        let parent = job.parent.as_deref().unwrap_or_default();
        return Err(format!(
            "the stored motion in which job {parent} ended is damaged, and this job begins with it; run that job again with \
             `tribosweep retry STUDY --unreadable` and `tribosweep work`, then `tribosweep retry` this one"
        ));
    }
    Ok(spec)
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
        Err(JobError::Interrupted) => FinishedOutcome::Released,
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
