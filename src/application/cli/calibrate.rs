//! `tribosweep calibrate`: which values of free parameters measured points do not rule out.

use super::error::CliError;
use super::output::{log, print};
use super::replace::Replacement;
use super::report::{self, Bins, OutFolder};
use super::study_args::StudyArgs;
use super::submit::{Priority, submit};
use super::work::{Checkpoints, Retries, Threads, options, work_on};
use crate::publish::value::significant;
use crate::queue::{Clock, Location, Queue, Shard};
use crate::report::{Calibration as Found, Nearest};
use crate::study::{Calibration, DiscrepancyGiven, PARAMETERS, Parameter, nearest_name};
use crate::sweep::{self, CalibrationData, Plan, ReportRequest};
use serde_json::json;
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
    #[command(flatten)]
    bins: Bins,
    /// The free parameters, of those with a distribution in the study's `samples.of`; default: all of them. The others keep their
    /// values of the scene.
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    free: Vec<String>,
    /// What the model cannot explain, as shares of the measured values, such as mu_star=2% or frequency=1%; may be repeated.
    #[arg(long, value_name = "NAME=SHARE", value_parser = discrepancy)]
    discrepancy: Vec<(Of, f64)>,
    /// Largest number of points of the free parameters; a point has a job for each measured point. Default: 30 for each parameter.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    most_points: Option<u16>,
    /// Say also how implausible this point is, such as mu=0.4,young_modulus_pa=2e9: a value for each free parameter.
    #[arg(long, value_delimiter = ',', value_name = "NAME=VALUE", value_parser = named_number)]
    at: Vec<(String, f64)>,
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

fn named_number(text: &str) -> Result<(String, f64), String> {
    let expected = || "expected NAME=VALUE with a number".to_owned();
    let (name, value) = text.split_once('=').ok_or_else(expected)?;
    let name = name.trim();
    let Some(parameter) = Parameter::find(name) else {
        let meant = nearest_name(name, PARAMETERS.iter().map(|own| own.name));
        let question = meant.map_or_else(String::new, |own| format!("; did you mean `{own}`?"));
        return Err(format!("{name}: no such parameter{question}"));
    };
    let value = parameter.number(value.trim())?;
    Ok((name.to_owned(), value))
}

/// Refuses a point that has not one value for each free parameter.
fn check_point(at: &[(String, f64)], plan: &Plan) -> Result<(), CliError> {
    let free: Vec<&str> = plan.study().free_parameters().iter().map(|own| own.parameter.name).collect();
    let has_all = free.iter().all(|name| at.iter().any(|(own, _)| own == name));
    if !at.is_empty() && (!has_all || at.len() != free.len()) {
        return Err(CliError::Usage(format!("--at: expected one value for each of {}", free.join(", "))));
    }
    for own in plan.study().free_parameters().iter().filter(|own| own.has_ends()) {
        let [low, high] = [0.0, 1.0].map(|share| own.value(share).as_f64().unwrap_or(f64::NAN));
        let name = own.parameter.name;
        let is_out = |(given, value): &&(String, f64)| given == name && !(low..=high).contains(value);
        if let Some((_, value)) = at.iter().find(is_out) {
            return Err(CliError::Usage(format!(
                "--at {name}={value}: expected a value from {low} to {high}, the range of the study"
            )));
        }
    }
    Ok(())
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
    let data = args
        .data
        .as_deref()
        .map(|path| sweep::read_calibration_data(path, args.bins.number()))
        .transpose()?;
    let (points, settings) = match data {
        Some(CalibrationData { points, settings, warnings }) => {
            for sentence in warnings {
                log(format_args!("warning: {sentence}"));
            }
            (Some(points), settings)
        }
        None => (None, Vec::new()),
    };
    let share = |of: Of| args.discrepancy.iter().rev().find(|(own, _)| *own == of).map(|(_, share)| *share);
    let discrepancy = DiscrepancyGiven { mu_star: share(Of::MuStar), frequency: share(Of::Frequency) };
    let calibration = Calibration {
        free: args.free.clone(),
        data: points,
        discrepancy,
        most_points: args.most_points.map(usize::from),
    };
    let names: Vec<String> = settings.iter().map(|(name, _)| name.clone()).collect();
    let set: Vec<String> = args.study.set_names().map(str::to_owned).collect();
    let plan = args.study.plan_of_calibration(calibration, settings)?;
    if let Some(free) =
        plan.study().free_parameters().iter().find(|own| names.iter().any(|name| own.parameter.name == name))
    {
        let name = free.parameter.name;
        return Err(CliError::Usage(format!(
            "{name} is free, and the measured points have a value of it; expected the file without this column, or --free without {name}"
        )));
    }
    let name = plan.name();
    let is_set = |name: &str| set.iter().any(|own| own == name);
    if let Some(free) = plan.study().free_parameters().iter().find(|own| is_set(own.parameter.name)) {
        let name = free.parameter.name;
        return Err(CliError::Usage(format!("--set {name}: it is free; expected --free without it")));
    }
    check_point(&args.at, &plan)?;
    report::create_folder(name, &args.out)?;
    sweep::block_on(async {
        let queue = Queue::open_with(db.clone(), Clock::OfDatabase, args.retries.settings()).await?;
        sweep::with_open(queue, async |queue| {
            submit(&plan, &Priority::default(), Shard::WHOLE, &args.replacement, queue).await?;
            let code = work_on(&plan, options(&args.threads, Some(&args.checkpoints)), queue).await?;
            let content = sweep::read_report(queue, &ReportRequest::of_study(name)).await?;
            let found = sweep::read_growth(queue, name, &content.rows).await?;
            let at = match args.at.as_slice() {
                [] => None,
                point => sweep::read_implausibility(queue, name, &content.rows, point).await?,
            };
            if let Some(found) = found.as_ref().and_then(|own| own.calibration.as_ref()) {
                print(&if args.json { as_json(found, at.as_ref()) } else { as_text(found, at.as_ref()) })?;
            }
            report::write(queue, &content, &args.out.of(name), None).await?;
            queue.ensure_place().await?;
            Ok(code)
        })
        .await
    })
}

/// What was found. `at` is the implausibility of the point that was asked for, with the cutoff.
fn as_json(found: &Found, at: Option<&(Nearest, f64)>) -> String {
    let mut answer = found.as_json();
    if let Some((at, cutoff)) = at {
        let place: serde_json::Map<_, _> = at.place.iter().cloned().collect();
        answer["at"] = json!({
            "implausibility": at.implausibility,
            "ruled_out": at.implausibility > *cutoff,
            "most_against": { "of": at.of, "at": place },
        });
    }
    format!("{answer}\n")
}

fn as_text(found: &Found, at: Option<&(Nearest, f64)>) -> String {
    let of_point = at.map(|(at, cutoff)| {
        let is_out = if at.implausibility > *cutoff { "ruled out" } else { "not ruled out" };
        let limit = if at.implausibility.is_infinite() {
            String::new()
        } else {
            format!(" (cutoff {})", significant(*cutoff, 2))
        };
        format!("The point of --at is {is_out}: it {}{limit}.", at.in_words())
    });
    found.in_words().into_iter().chain(of_point).map(|sentence| sentence + "\n").collect()
}
