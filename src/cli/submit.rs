//! `tribosweep submit`: plan a study's jobs.

use super::error::CliError;
use super::output::{block_on, tell};
use super::planning::Plan;
use crate::exit;
use crate::queue::{Queue, SystemClock};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Arguments of `submit`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study file.
    study: PathBuf,
}

/// Plans the study.
pub fn run(args: &Args, db: &Path) -> Result<u8, CliError> {
    let plan = Plan::load(&args.study)?;
    block_on(async {
        let mut queue = Queue::open(db, Arc::new(SystemClock)).await?;
        submit(&plan, &mut queue).await?;
        queue.close().await?;
        Ok(exit::SUCCESS)
    })
}

/// Submits a study that was read before the database was opened: a bad one leaves no database behind.
pub async fn submit(plan: &Plan, queue: &mut Queue) -> Result<(), CliError> {
    let submitted = queue.submit(&plan.for_queue()?).await?;
    tell(format_args!(
        "{}: {} jobs, {} new, {} already done{}",
        plan.study.name(),
        submitted.jobs,
        submitted.added,
        submitted.already_done,
        if submitted.already_failed > 0 {
            format!(", {} failed before", submitted.already_failed)
        } else {
            String::new()
        }
    ));
    Ok(())
}
