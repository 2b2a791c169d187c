//! `tribosweep calibrate`: which values of free parameters measured points do not rule out.

use super::error::CliError;
use super::output::{log, print};
use super::replace::Replacement;
use super::report::{self, OutFolder};
use super::study_args::StudyArgs;
use super::submit::{Priority, submit};
use super::work::{Checkpoints, Retries, Threads, options, work_on};
use crate::queue::{Clock, Location, Queue, Shard};
use crate::study::{Calibration, Discrepancy};
use crate::sweep::{self, CalibrationData, ReportRequest};
use std::path::PathBuf;

/// Arguments of `calibrate`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    study: StudyArgs,
    /// A CSV file of measured points: omega_rpm (or another parameter), mu_star with mu_star_error, frequency_hz with frequency_error_hz,
    /// squeals. Errors are standard deviations. Default: the points in the study's `calibrate`.
    #[arg(long, value_name = "FILE")]
    data: Option<PathBuf>,
    /// The free parameters, of those with a distribution in the study's `samples.of`; default: all of them. The others keep their
    /// values of the scene.
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    free: Vec<String>,
    /// What the model cannot explain, as shares of the measured values, such as mu_star=2% or frequency=1%; may be repeated.
    #[arg(long, value_name = "NAME=SHARE", value_parser = discrepancy)]
    discrepancy: Vec<(Of, f64)>,
    /// Largest number of points of the free parameters; a point has a job for each measured point. Default: 30 for each parameter.
    #[arg(long, value_name = "N")]
    most_points: Option<usize>,
    /// Print the answer as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    checkpoints: Checkpoints,
    #[command(flatten)]
    retries: Retries,
    #[command(flatten)]
    replacement: Replacement,
    #[command(flatten)]
    out: OutFolder,
}

/// What a discrepancy is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Of {
    MuStar,
    Frequency,
}

fn discrepancy(text: &str) -> Result<(Of, f64), String> {
    let expected = || "expected mu_star=SHARE or frequency=SHARE, such as mu_star=2%".to_owned();
    let (name, share) = text.split_once('=').ok_or_else(expected)?;
    let of = match name {
        "mu_star" => Of::MuStar,
        "frequency" | "frequency_hz" => Of::Frequency,
        _ => return Err(expected()),
    };
    let (number, factor) = share.strip_suffix('%').map_or((share, 1.0), |number| (number, 0.01));
    let share = number.trim().parse::<f64>().map_err(|_| expected())? * factor;
    if (0.0..1.0).contains(&share) { Ok((of, share)) } else { Err(expected()) }
}

/// Runs the waves, and prints what they have found. If it is interrupted, this is what is known so far.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let data = args.data.as_deref().map(sweep::read_calibration_data).transpose()?;
    let (points, settings) = match data {
        Some(CalibrationData { points, settings, left_out }) => {
            left_out.iter().for_each(log);
            (Some(points), settings)
        }
        None => (None, Vec::new()),
    };
    let share = |of: Of| args.discrepancy.iter().rev().find(|(own, _)| *own == of).map(|(_, share)| *share);
    let discrepancy = (!args.discrepancy.is_empty()).then(|| Discrepancy {
        mu_star: share(Of::MuStar).unwrap_or(0.0),
        frequency: share(Of::Frequency).unwrap_or(0.0),
    });
    let calibration =
        Calibration { free: args.free.clone(), data: points, discrepancy, most_points: args.most_points };
    let plan = args.study.plan_of_calibration(calibration, settings)?;
    let name = plan.name();
    report::create_folder(name, &args.out)?;
    sweep::block_on(async {
        let queue = Queue::open_with(db.clone(), Clock::OfDatabase, args.retries.settings()).await?;
        sweep::with_open(queue, async |queue| {
            submit(&plan, &Priority::default(), Shard::WHOLE, &args.replacement, queue).await?;
            let code = work_on(&plan, options(&args.threads, Some(&args.checkpoints)), queue).await?;
            let content = sweep::read_report(queue, &ReportRequest::of_study(name)).await?;
            let found = sweep::read_growth(queue, name, &content.rows).await?;
            if let Some(found) = found.as_ref().and_then(|own| own.calibration.as_ref()) {
                print(&if args.json {
                    format!("{}\n", found.as_json())
                } else {
                    found.in_words().into_iter().map(|sentence| sentence + "\n").collect()
                })?;
            }
            report::write(queue, &content, &args.out.of(name), None).await?;
            queue.ensure_place().await?;
            Ok(code)
        })
        .await
    })
}
