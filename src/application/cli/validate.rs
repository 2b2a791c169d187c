//! `tribosweep validate`: check a study file, and all else that a run needs, without running it.

use super::error::CliError;
use super::forecast;
use super::output::print;
use super::replace::{self, Replacement};
use super::report::{self, OutFolder};
use super::study_args::StudyArgs;
use super::warnings;
use super::work::Threads;
use crate::exit;
use crate::publish::value::count;
use crate::queue::Location;

/// Arguments of `validate`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    study: StudyArgs,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    replacement: Replacement,
    #[command(flatten)]
    out: OutFolder,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Checks the study, the database and the folder of the report, and prints what the jobs take. Creates nothing.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let plan = args.study.plan()?;
    let mut doubts = warnings::of_study(plan.study());
    report::check_folder(plan.name(), &args.out)?;
    let (forecast, replaced) = forecast::read(&plan, args.threads.number(), db)?;
    doubts += forecast::warn(&forecast);
    let samples = plan.study().samples().map(|samples| format!("samples {samples}"));
    let axes = plan.study().axes().map(|(parameter, values)| format!("{} {}", parameter.name, values.len()));
    let axes: Vec<String> = samples.into_iter().chain(axes).collect();
    let grid = if axes.is_empty() { String::new() } else { format!(" ({})", axes.join(" × ")) };
    print(&if args.json {
        format!("{}\n", forecast::as_json(&forecast, replaced.as_ref(), &plan))
    } else {
        let file = args.study.file.display();
        // A changed study may have another name than the file says.
        let name = if args.study.is_changed() { format!(" as {}", plan.name()) } else { String::new() };
        // Warnings are on another stream than this line.
        let doubts = if doubts > 0 { format!(", {}", count(doubts, "warning")) } else { String::new() };
        format!(
            "{file}{name}: valid, {}{grid}{doubts}\n{}{}",
            count(forecast.jobs, "job"),
            forecast::as_text(&forecast, db),
            forecast::growth(&plan)
        )
    })?;
    replace::check(&plan, &args.replacement, replaced)?;
    Ok(exit::SUCCESS)
}
