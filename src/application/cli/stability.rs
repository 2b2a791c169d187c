//! `tribosweep stability`: the complex modes of steady sliding over a study's grid, and the thresholds of stability.

mod shapes;

use super::error::CliError;
use super::output::{fill_file, log, print, stream};
use super::replace::Replacement;
use super::report::{self, StabilityFolder};
use super::study_args::StudyArgs;
use super::submit::{Priority, submit};
use super::work::{Threads, options, work_on};
use crate::analysis::stability::MODES;
use crate::exit;
use crate::publish::table::Format;
use crate::publish::value::significant;
use crate::queue::{Location, Shard};
use crate::report::{
    Along, MODE_NUMBER, SHAPES, STABILITY_PAGE, ShownModes, StabilityPoint, modes_table, nearest_in_words,
    thresholds_table, unknown_errors,
};
use crate::study::number_in;
use crate::sweep::Plan;
use crate::sweep::{
    self, Purpose, plan_thresholds, read_stability, ways_to_thresholds, write_stability_report,
};
use std::path::PathBuf;

/// Significant digits of modes on a terminal. Without a mesh error fewer would be known; `modes.csv` has all digits.
const DIGITS: usize = 4;

/// A smaller frequency \[Hz\] to look near is suspected to be in kilohertz.
const LEAST_NEAR_HZ: f64 = 100.0;

/// Significant digits of thresholds and of the parameters beside them.
const PLACE_DIGITS: usize = 6;

/// Arguments of `stability`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    study: StudyArgs,
    /// Write the table to this file too, as CSV.
    #[arg(long = "csv", value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Print the table as JSON, one object per line, and no thresholds.
    #[arg(long)]
    json: bool,
    /// Number of modes at each point in the table, the fastest growing first.
    #[arg(long, value_name = "N", default_value = "4", value_parser = clap::value_parser!(u8).range(1..=MODES as i64))]
    modes: u8,
    /// Show all modes that grow, and of the others those whose frequencies are nearest to this one. The 12 fastest growing modes of a
    /// point are known. Without a unit it is in Hz.
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency_hz)]
    near: Option<f64>,
    /// Write the shapes of the modes in the table for ParaView, into the folder `modes` of the report. The grid may have 50
    /// points at most.
    #[arg(long)]
    shapes: bool,
    /// Compute the points of the grid alone, and look for no thresholds.
    #[arg(long)]
    no_thresholds: bool,
    /// The parameter whose thresholds are looked for: the values at which sliding becomes unstable or stable. It varies in the
    /// grid or in samples.zip and is no count, such as a number of elements; what else is in the zip moves with it. Default: mu;
    /// if the study does not vary it, the first other such parameter, and omega_rpm only if there is no other.
    #[arg(long, value_name = "NAME", conflicts_with = "no_thresholds")]
    along: Option<String>,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    replacement: Replacement,
    #[command(flatten)]
    out: StabilityFolder,
}

/// Parses a frequency, such as `11kHz`, in Hz.
fn frequency_hz(text: &str) -> Result<f64, String> {
    let found = number_in(text, "Hz")?;
    if found > 0.0 { Ok(found) } else { Err("expected a frequency above 0, such as 11kHz".to_owned()) }
}

/// Computes the modes. If it is interrupted, the tables have the points that are done.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    if let Some(near_hz) = args.near.filter(|near_hz| *near_hz < LEAST_NEAR_HZ) {
        log(format!(
            "warning: --near is {near_hz} Hz, at which hardly any pin squeals; write '{near_hz} kHz' if kilohertz are meant"
        ));
    }
    let plan = args.study.plan_of_modes()?;
    let on_grid = if args.shapes { shapes::points(&plan)? } else { Vec::new() };
    let name = plan.name().to_owned();
    report::create_folder(&name, &args.out.of_modes())?;
    let along = along(&plan, args)?;
    let shown = along.clone().unwrap_or_else(Along::mu);
    let wanted = along.as_ref().filter(|_| !args.no_thresholds);
    sweep::with_queue(db, Purpose::Create, async |queue| {
        let plan = plan_thresholds(plan, wanted, queue).await?;
        submit(&plan, &Priority::default(), Shard::WHOLE, &args.replacement, queue).await?;
        // There are no long runs whose states could be stored.
        let mut code = work_on(&plan, options(&args.threads, None), queue).await?;
        let points = read_stability(queue, &name).await?;
        let modes = ShownModes { count: args.modes.into(), near_hz: args.near };
        let on_the_grid = || points.iter().filter(|point| point.on_grid);
        let table = modes_table(on_the_grid(), modes);
        if args.near.is_some() {
            note_unknown_modes(&points);
        }
        if let Some(path) = &args.csv {
            fill_file(path, |out| Ok(table.write(Format::Csv, out)?))?;
        }
        if args.json {
            stream(|out| Ok(table.write(Format::JsonLines, out)?))?;
        } else {
            let parameters = table.names().position(|name| name == MODE_NUMBER).unwrap_or(0);
            let (table, constant) = table.rounded_from(parameters, DIGITS).without_constants();
            print(&table.text())?;
            if !constant.is_empty() {
                print(&format!("In all lines: {}.\n", constant.join(", ")))?;
            }
            let near = args.near.and_then(|near_hz| nearest_in_words(on_the_grid(), near_hz));
            for note in near.into_iter().chain(unknown_errors(on_the_grid(), modes)) {
                print(&format!("{note}\n"))?;
            }
            if wanted.is_some() && !points.is_empty() {
                let (table, notes) = thresholds_table(&points, &shown);
                let so_far = if code == exit::WORK_LEFT { " so far, not yet narrowed down" } else { "" };
                print(&format!("\nThresholds{so_far}\n{}", table.rounded(PLACE_DIGITS).text()))?;
                for note in &notes {
                    print(&format!("{note}\n"))?;
                }
            }
            if along.is_none() && !args.no_thresholds {
                log("no thresholds: no number varies alone in `grid` or with others in `samples.zip`");
            }
        }
        let folder = args.out.of_modes().of(&name);
        // Who interrupts the computation does not wait for the shapes.
        if code != exit::WORK_LEFT && !on_grid.is_empty() {
            let written = shapes::write(&on_grid, modes, args.threads.number(), &folder.join(SHAPES))?;
            code = code.max(written);
        }
        // The page comes last, because it names the shapes.
        write_stability_report(queue, &name, &points, &shown, &folder).await?;
        log(format_args!("report written to {}", folder.join(STABILITY_PAGE).display()));
        Ok(code)
    })
}

/// Says which modes may be nearer to a frequency than those that are known.
fn note_unknown_modes(points: &[StabilityPoint]) {
    let has_more = |point: &&StabilityPoint| point.on_grid && point.stability.modes.len() == MODES;
    let slowest = points.iter().filter(has_more).filter_map(|point| point.stability.modes.last());
    let largest = slowest.map(|mode| mode.growth_rate_per_s).fold(f64::NEG_INFINITY, f64::max);
    if largest.is_finite() {
        log(format_args!(
            "{MODES} modes of a point are known: those whose growth rates are below {} 1/s may be nearer to this frequency",
            significant(largest, 3)
        ));
    }
}

/// What thresholds are thresholds of; none if the study varies no number in a way that has them.
fn along(plan: &Plan, args: &Args) -> Result<Option<Along>, CliError> {
    let mut ways = ways_to_thresholds(plan.study());
    let Some(name) = &args.along else { return Ok(ways.into_iter().next()) };
    if let Some(at) = ways.iter().position(|along| along.parameter == *name) {
        return Ok(Some(ways.swap_remove(at)));
    }
    let names: Vec<&str> = ways.iter().map(|along| along.parameter.as_str()).collect();
    let names = if names.is_empty() { "it has none".to_owned() } else { names.join(", ") };
    Err(CliError::Usage(format!(
        "--along {name}: expected a parameter with two values or more in `grid`, or one of `samples.zip`; numbers of \
         elements and other counts cannot be one; in this study: {names}"
    )))
}
