//! `tribosweep submit`: plan a study's jobs.

use super::error::CliError;
use super::output::{block_on, tell};
use super::planning::Plan;
use crate::exit;
use crate::queue::{Clock, Location, Queue, Shard};
use std::path::PathBuf;

/// Arguments of `submit`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study file.
    study: PathBuf,
    #[command(flatten)]
    priority: Priority,
    /// Submit only part I of N equal ones (1/4, 2/4 …), for databases that share a study; `merge` brings them together.
    #[arg(long, value_name = "I/N", value_parser = parse_shard)]
    shard: Option<Shard>,
}

fn parse_shard(text: &str) -> Result<Shard, String> {
    let number = |text: &str| text.parse::<u64>().ok();
    let parts = text.split_once('/').and_then(|(index, of)| Some((number(index)?, number(of)?)));
    match parts {
        Some((index, of)) if 1 <= index && index <= of && u32::try_from(of).is_ok() => {
            Ok(Shard { index: index - 1, of })
        }
        _ => Err("expected I/N with I from 1 to N, such as 1/4".to_owned()),
    }
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
        submit(&plan, &args.priority, args.shard.unwrap_or(Shard::WHOLE), &mut queue).await?;
        queue.close().await?;
        Ok(exit::SUCCESS)
    })
}

/// Submits a study that was read before the database was opened: a bad one leaves no database behind.
pub async fn submit(
    plan: &Plan,
    priority: &Priority,
    shard: Shard,
    queue: &mut Queue,
) -> Result<(), CliError> {
    let submitted = queue.submit_shard(&plan.for_queue(priority.value.map(i64::from))?, shard).await?;
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
