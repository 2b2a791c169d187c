//! `tribosweep run`: submit, work and report.

use super::error::CliError;
use super::output::print;
use super::replace::Replacement;
use super::report::{self, OutFolder};
use super::study_args::StudyArgs;
use super::submit::{Priority, submit};
use super::unreadable::log_unreadable_rows;
use super::work::{Checkpoints, Retries, Threads, options, work_on};
use crate::queue::{Clock, Location, Queue, Shard};
use crate::report::tables;
use crate::sweep::{self, ReportRequest};

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    study: StudyArgs,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    checkpoints: Checkpoints,
    #[command(flatten)]
    retries: Retries,
    #[command(flatten)]
    priority: Priority,
    #[command(flatten)]
    replacement: Replacement,
    #[command(flatten)]
    out: OutFolder,
}

/// Runs the whole sweep. If it is interrupted, the report has the jobs that are done.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let plan = args.study.plan()?;
    let name = plan.name();
    report::create_folder(name, &args.out)?;
    sweep::block_on(async {
        let queue = Queue::open_with(db.clone(), Clock::OfDatabase, args.retries.settings()).await?;
        sweep::with_open(queue, async |queue| {
            submit(&plan, &args.priority, Shard::WHOLE, &args.replacement, queue).await?;
            let code = work_on(&plan, options(&args.threads, Some(&args.checkpoints)), queue).await?;
            let content = sweep::read_report(queue, &ReportRequest::of_study(name)).await?;
            print(&tables::of_results(&content.rows, &content.view, name))?;
            report::write(queue, &content, &args.out.of(name), None).await?;
            queue.ensure_place().await?;
            Ok(code.max(log_unreadable_rows(&content.rows)))
        })
        .await
    })
}
