//! Running the jobs of a study without a display.

use super::error::SweepError;
use super::growth::PLANNER;
use crate::queue::{Queue, Scope};
use crate::spec::JobSpec;
use crate::worker::{self, Interrupt, SilentProgress, WorkOptions, WorkSummary};
use crate::{solver, study};

/// The key of a job under this version of the solver, for [`WorkOptions`].
pub fn job_key(spec: &JobSpec) -> String {
    study::job_key(spec, solver::VERSION)
}

/// Runs the pending jobs of a study until none is left. [`worker::work`] does the same with a request to stop and a
/// progress display.
///
/// # Errors
/// If the database has no such study or fails, or the threads cannot be started. A job that fails is no error: it is
/// counted in the summary.
pub async fn work(queue: &mut Queue, study: &str, options: WorkOptions) -> Result<WorkSummary, SweepError> {
    let scope = Scope::Study(study.to_owned());
    Ok(worker::work(
        queue,
        &scope,
        options.growing(PLANNER).checking(job_key),
        &Interrupt::default(),
        &mut SilentProgress,
    )
    .await?)
}
