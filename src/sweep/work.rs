//! Running the jobs of a study without a display.

use super::error::SweepError;
use super::growth::PLANNER;
use crate::queue::{Queue, Scope};
use crate::worker::{self, Interrupt, SilentProgress, WorkOptions, WorkSummary};

/// Runs the pending jobs of a study until none is left. [`worker::work`] does the same with a request to stop and a
/// progress display.
///
/// # Errors
/// If the database has no such study or fails, or the threads cannot be started. A job that fails is no error: it is
/// counted in the summary.
pub async fn work(queue: &mut Queue, study: &str, options: WorkOptions) -> Result<WorkSummary, SweepError> {
    let scope = Scope::Study(study.to_owned());
    Ok(worker::work(queue, &scope, options.growing(PLANNER), &Interrupt::default(), &mut SilentProgress)
        .await?)
}
