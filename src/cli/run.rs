//! `tribosweep run`: submit, work and report.

use super::error::CliError;
use super::output::print;
use super::report::{self, OutFolder};
use super::submit::{Priority, submit};
use super::work::{Checkpoints, Retries, Threads, options, work};
use crate::queue::{Clock, Location, Queue, Scope, Shard};
use crate::report::tables::{Quantity, markdown};
use crate::sweep::{self, Plan};
use std::path::PathBuf;

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
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

/// Runs the whole sweep. If it is interrupted, the report has the jobs that are done.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let plan = Plan::load(&args.study)?;
    let name = plan.name();
    report::create_folder(name, &args.out)?;
    sweep::block_on(async {
        let mut queue = Queue::open_with(db.clone(), Clock::OfDatabase, args.retries.settings()).await?;
        submit(&plan, &args.priority, Shard::WHOLE, &mut queue).await?;
        let options = options(&args.threads, &args.checkpoints);
        let code = work(&mut queue, &Scope::Study(name.to_owned()), options).await?;
        let rows = sweep::read_rows(&mut queue, name).await?;
        print(&markdown(&rows, Quantity::MuStar))?;
        report::write(&mut queue, &rows, name, &args.out, None).await?;
        queue.close().await?;
        Ok(code)
    })
}
