//! `tribosweep submit`: plan a study's jobs.

use super::error::CliError;
use super::output::{block_on, tell};
use super::planning::Plan;
use crate::exit;
use crate::queue::{Clock, Location, Queue};
use std::path::PathBuf;

/// Arguments of `submit`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study file.
    study: PathBuf,
    #[command(flatten)]
    priority: Priority,
}

/// Which jobs go first.
#[derive(Debug, clap::Args)]
pub struct Priority {
    /// Jobs of a higher priority go first, whatever study they belong to; default: 0, or what they have.
    #[arg(long = "priority", value_name = "N", allow_negative_numbers = true)]
    value: Option<i32>,
}

/// Plans the study.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let plan = Plan::load(&args.study)?;
    block_on(async {
        let mut queue = Queue::open(db.clone(), Clock::OfDatabase).await?;
        submit(&plan, &args.priority, &mut queue).await?;
        queue.close().await?;
        Ok(exit::SUCCESS)
    })
}

/// Submits a study that was read before the database was opened: a bad one leaves no database behind.
pub async fn submit(plan: &Plan, priority: &Priority, queue: &mut Queue) -> Result<(), CliError> {
    let submitted = queue.submit(&plan.for_queue(priority.value.map(i64::from))?).await?;
    tell(format_args!(
        "{}: {} jobs, {} new, {} already done{}{}",
        plan.study.name(),
        submitted.jobs,
        submitted.added,
        submitted.already_done,
        if submitted.already_failed > 0 {
            format!(", {} failed before", submitted.already_failed)
        } else {
            String::new()
        },
        if submitted.cancelled > 0 {
            format!(", {} of the replaced study cancelled", submitted.cancelled)
        } else {
            String::new()
        }
    ));
    Ok(())
}
