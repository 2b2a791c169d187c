//! `tribosweep submit`: plan the jobs of a study and store them.

use super::error::CliError;
use super::forecast;
use super::output::{log, print};
use super::replace::{self, Replacement};
use super::study_args::StudyArgs;
use super::warnings;
use crate::exit;
use crate::publish::value;
use crate::queue::{Location, Queue, Shard};
use crate::sweep::{self, Plan, Purpose, Submission};

/// Arguments of `submit`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    study: StudyArgs,
    #[command(flatten)]
    priority: Priority,
    /// Submit only shard I of N equal ones (1/4, 2/4 …), for a study that is split between several databases; `merge`
    /// combines them.
    #[arg(long, value_name = "I/N", value_parser = parse_shard)]
    shard: Option<Shard>,
    #[command(flatten)]
    replacement: Replacement,
    /// Submit nothing, and say what the jobs take: nodes, time step, memory, disk, time on this machine.
    #[arg(long, conflicts_with = "shard")]
    dry_run: bool,
    /// With --dry-run: print JSON.
    #[arg(long, requires = "dry_run")]
    json: bool,
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
#[derive(Debug, Default, clap::Args)]
pub(crate) struct Priority {
    /// Run jobs of a higher priority before others, of whatever study. The default is 0; jobs that exist keep theirs.
    #[arg(long = "priority", value_name = "N", allow_negative_numbers = true)]
    value: Option<i32>,
}

/// Submits the study.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    // The study is read before the database is opened: an invalid study creates no database.
    let plan = args.study.plan()?;
    if args.dry_run {
        return dry_run(&plan, args, db);
    }
    sweep::with_queue(db, Purpose::Create, async |queue| {
        let shard = args.shard.unwrap_or(Shard::WHOLE);
        submit(&plan, &args.priority, shard, &args.replacement, queue).await?;
        Ok(exit::SUCCESS)
    })
}

/// Prints what the jobs of a study take. Changes nothing.
fn dry_run(plan: &Plan, args: &Args, db: &Location) -> Result<u8, CliError> {
    warnings::of_study(plan.study());
    let (forecast, replaced) = forecast::read(plan, sweep::available_threads(), db)?;
    forecast::warn(&forecast);
    let name = plan.name();
    print(&if args.json {
        format!("{}\n", forecast::as_json(&forecast, replaced.as_ref(), plan))
    } else {
        let jobs = value::count(forecast.jobs, "job");
        format!(
            "{name}: {jobs}, nothing was submitted\n{}{}",
            forecast::as_text(&forecast, db),
            forecast::growth(plan)
        )
    })?;
    replace::check(plan, &args.replacement, replaced)?;
    Ok(exit::SUCCESS)
}

/// Submits a study and logs what has changed.
pub(crate) async fn submit(
    plan: &Plan,
    priority: &Priority,
    shard: Shard,
    replacement: &Replacement,
    queue: &mut Queue,
) -> Result<(), CliError> {
    warnings::of_study(plan.study());
    let submission =
        Submission { shard, priority: priority.value.map(i64::from), replace: replacement.policy() };
    let submitted = replace::submit(plan, submission, queue).await?;
    let failed = match submitted.already_failed {
        0 => String::new(),
        failed => format!(", {failed} failed before"),
    };
    log(format_args!(
        "{}: {}, {} new, {} already done{failed}",
        plan.name(),
        value::count(submitted.jobs, "job"),
        submitted.added,
        submitted.already_done,
    ));
    Ok(())
}
