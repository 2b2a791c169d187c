//! `tribosweep submit`: plan the jobs of a study and store them.

use super::error::CliError;
use super::output::log;
use crate::exit;
use crate::queue::{Location, Queue, Shard};
use crate::sweep::{self, Plan};
use std::path::PathBuf;

/// Arguments of `submit`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study file.
    study: PathBuf,
    #[command(flatten)]
    priority: Priority,
    /// Submit only shard I of N equal ones (1/4, 2/4 …), for a study that is split between several databases; `merge`
    /// combines them.
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

/// The order of jobs.
#[derive(Debug, clap::Args)]
pub(crate) struct Priority {
    /// Run jobs of a higher priority before others, of whatever study. The default is 0; jobs that exist keep theirs.
    #[arg(long = "priority", value_name = "N", allow_negative_numbers = true)]
    value: Option<i32>,
}

/// Submits the study.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    // The study is read before the database is opened: an invalid study creates no database.
    let plan = Plan::load(&args.study)?;
    sweep::block_on(async {
        let mut queue = sweep::open(db.clone()).await?;
        submit(&plan, &args.priority, args.shard.unwrap_or(Shard::WHOLE), &mut queue).await?;
        queue.close().await?;
        Ok(exit::SUCCESS)
    })
}

/// Submits a study and logs what has changed.
pub(crate) async fn submit(
    plan: &Plan,
    priority: &Priority,
    shard: Shard,
    queue: &mut Queue,
) -> Result<(), CliError> {
    let submitted = plan.submit_shard(queue, shard, priority.value.map(i64::from)).await?;
    log(format_args!(
        "{}: {} jobs, {} new, {} already done{}{}",
        plan.name(),
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
