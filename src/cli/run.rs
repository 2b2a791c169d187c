//! `tribosweep run`: submit, work and report.

use super::error::CliError;
use super::output::{block_on, print};
use super::planning::Plan;
use super::report::{self, OutFolder};
use super::rows;
use super::submit::{Priority, submit};
use super::work::{Checkpoints, Retries, Threads, options, work};
use crate::queue::{Clock, Location, Queue, Scope, Shard};
use crate::report::tables::{Quantity, markdown};
use std::path::PathBuf;

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study file.
    study: PathBuf,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    checkpoints: Checkpoints,
    #[command(flatten)]
    retries: Retries,
    #[command(flatten)]
    priority: Priority,
    #[command(flatten)]
    out: OutFolder,
}

/// Runs the whole sweep; an interrupted one reports what it has.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let plan = Plan::load(&args.study)?;
    let name = plan.study.name();
    report::prepare(name, &args.out)?;
    block_on(async {
        let mut queue = Queue::open_with(db.clone(), Clock::OfDatabase, args.retries.settings()).await?;
        submit(&plan, &args.priority, Shard::WHOLE, &mut queue).await?;
        let options = options(&args.threads, &args.checkpoints);
        let code = work(&mut queue, &Scope::Study(name.to_owned()), options).await?;
        let rows = rows::read(&mut queue, name).await?;
        print(&markdown(&rows, Quantity::MuStar))?;
        report::write_rows(&mut queue, &rows, name, &args.out, None).await?;
        queue.close().await?;
        Ok(code)
    })
}
