//! `tribosweep report`: the page, tables and figures of one or several studies, once or whenever a study changes.

use super::error::CliError;
use super::output::{log, print};
use super::signals::raise_on_signal;
use super::unreadable::log_unreadable_rows;
use crate::exit;
use crate::queue::{Location, Queue};
use crate::report::trouble;
use crate::study::Spacing;
use crate::sweep::{
    self, MOST_BINS, MeasuredError, Purpose, ReportContent, ReportRequest, Revision, SweepError,
};
use crate::worker::Interrupt;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How many rows of a file of measured points become one.
#[derive(Debug, clap::Args)]
pub(crate) struct Bins {
    /// With --data: take the means of the rows in N bins of the parameter that varies most, such as the speed, with the standard
    /// deviation in a bin as a part of the error.
    #[arg(long, value_name = "N", requires = "data",
          value_parser = clap::value_parser!(u16).range(1..=MOST_BINS as i64))]
    bins: Option<u16>,
}

impl Bins {
    /// Their number, if there are any.
    pub(crate) fn number(&self) -> Option<usize> {
        self.bins.map(usize::from)
    }
}

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Names or files of the studies. Several are compared with each other: figures and tables show them side by side, and
    /// the first one is the reference of the differences.
    #[arg(required = true, value_name = "STUDY")]
    studies: Vec<String>,
    /// A CSV file of measured points to compare with, with the columns omega_rpm, mu_star, frequency_hz, their errors
    /// mu_star_error and frequency_error_hz, and parameters such as mu; may be repeated.
    #[arg(long = "data", value_name = "FILE")]
    data: Vec<PathBuf>,
    #[command(flatten)]
    bins: Bins,
    /// A study that varies what could explain the differences, such as a grid of moduli and friction coefficients. The verdict then says
    /// which of its parameters could bring the first study nearer, and by how much.
    #[arg(long, value_name = "STUDY")]
    sensitivity: Option<String>,
    #[command(flatten)]
    axes: Axes,
    #[command(flatten)]
    out: ComparisonFolder,
    /// Check every so many seconds whether the study has changed, and then write the report again, until no job is
    /// pending or running. Until then an open page reloads itself.
    #[arg(long, value_name = "SECONDS", num_args = 0..=1, default_missing_value = "5",
          value_parser = clap::value_parser!(u32).range(1..=86_400))]
    watch: Option<u32>,
}

/// The axes of a report.
#[derive(Debug, clap::Args)]
struct Axes {
    /// The parameter along the axis of figures and the rows of tables; default: that of the study's file, or omega_rpm.
    #[arg(long, value_name = "NAME")]
    x: Option<String>,
    /// The parameter that tells curves and columns apart, or `source`; default: that of the study's file, or mu.
    #[arg(long, value_name = "NAME")]
    by: Option<String>,
    /// Quantities with figures and tables besides the usual ones, by their names in the export, such as n_over_f_max.
    #[arg(long, value_name = "QUANTITY", num_args = 1.., value_delimiter = ',')]
    y: Vec<String>,
    /// A figure of the span of μ* over all jobs with the same values along the axis and of the curves: over the other parameters, and
    /// over the studies.
    #[arg(long)]
    span: bool,
    /// How the axis of a parameter is scaled, such as load_n=log or omega_rpm=linear; may be repeated. Default: that of the
    /// study's file, or as the values are given there.
    #[arg(long, value_name = "NAME=SCALE", value_parser = scale)]
    scale: Vec<(String, Spacing)>,
}

/// A parameter with the scale of its axis.
fn scale(text: &str) -> Result<(String, Spacing), String> {
    let (name, scale) =
        text.split_once('=').ok_or("expected a parameter and its scale, such as load_n=log")?;
    match scale {
        "log" => Ok((name.to_owned(), Spacing::Log)),
        "linear" => Ok((name.to_owned(), Spacing::Linear)),
        _ => Err(format!("{scale}: expected log or linear")),
    }
}

/// The folder of a report.
#[derive(Debug, clap::Args)]
pub(crate) struct OutFolder {
    /// Folder for the report; default: reports/STUDY.
    #[arg(long = "out", value_name = "DIR")]
    folder: Option<PathBuf>,
}

/// The folder of a report that may be a comparison.
#[derive(Debug, clap::Args)]
struct ComparisonFolder {
    /// Folder for the report; default: reports/STUDY, and reports/A-vs-B for a comparison.
    #[arg(long = "out", value_name = "DIR")]
    folder: Option<PathBuf>,
}

/// The folder of a report on stability.
#[derive(Debug, clap::Args)]
pub(crate) struct StabilityFolder {
    /// Folder for the report; default: reports/STUDY-stability.
    #[arg(long = "out", value_name = "DIR")]
    folder: Option<PathBuf>,
}

impl StabilityFolder {
    /// The folder, with the usual one of the study's modes.
    pub(crate) fn of_modes(&self) -> OutFolder {
        OutFolder { folder: self.folder.clone() }
    }
}

impl OutFolder {
    /// The folder for the study called `name`.
    pub(crate) fn of(&self, name: &str) -> PathBuf {
        self.folder.clone().unwrap_or_else(|| Path::new("reports").join(name))
    }
}

/// Writes the report and prints the path of its page.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let studies = args.studies.iter().map(|study| sweep::study_name(study)).collect::<Result<_, _>>()?;
    let Axes { x, by, y, span, scale } = &args.axes;
    let request = ReportRequest {
        studies,
        data: args.data.clone(),
        bins: args.bins.number(),
        sensitivity: args.sensitivity.as_deref().map(sweep::study_name).transpose()?,
        x: x.clone(),
        by: by.clone(),
        y: y.clone(),
        span: *span,
        scale: scale.clone(),
    };
    if args.sensitivity.is_some() && request.studies.len() + request.data.len() < 2 {
        let message = "--sensitivity: expected something to compare with: --data FILE, or a second study";
        return Err(CliError::Usage(message.to_owned()));
    }
    // Who mistypes a file's name wants to hear of it, whatever is in the database.
    for path in &args.data {
        let unreadable = |reason| MeasuredError::Read { file: path.display().to_string(), reason };
        fs::metadata(path).map_err(|reason| SweepError::from(unreadable(reason)))?;
    }
    let folder = OutFolder { folder: args.out.folder.clone() }.of(&request.folder_name());
    sweep::with_queue(db, Purpose::Read, async |queue| {
        let code;
        if let Some(interval_s) = args.watch {
            code = watch(queue, &request, &folder, interval_s).await?;
        } else {
            code = read_and_write(queue, &request, &folder, None).await?;
            print_page(&folder)?;
        }
        Ok(code)
    })
}

fn print_page(folder: &Path) -> Result<(), CliError> {
    print(&format!("{}\n", folder.join("report.html").display()))
}

async fn read_and_write(
    queue: &mut Queue,
    request: &ReportRequest,
    folder: &Path,
    refresh_s: Option<u32>,
) -> Result<u8, CliError> {
    let content = sweep::read_report(queue, request).await?;
    write(queue, &content, folder, refresh_s).await?;
    Ok(log_unreadable_rows(&content.rows))
}

/// Writes a report and logs where it is.
pub(crate) async fn write(
    queue: &mut Queue,
    content: &ReportContent,
    folder: &Path,
    refresh_s: Option<u32>,
) -> Result<(), CliError> {
    for sentence in &content.warnings {
        log(format_args!("warning: {sentence}"));
    }
    let written = sweep::write_content(queue, content, folder, refresh_s).await?;
    for sentence in &written.verdicts {
        log(sentence);
    }
    for sentence in &written.unmatched {
        log(format_args!("warning: {sentence}"));
    }
    if let [head, lines @ ..] = &written.contradictions[..] {
        log(format_args!("warning: {head}"));
        for line in lines {
            log(format_args!("  {line}"));
        }
    }
    for sentence in trouble::warnings(&content.rows) {
        log(format_args!("warning: {sentence}"));
    }
    log(format_args!("report written to {}", folder.display()));
    Ok(())
}

/// The longest time between a signal and the reaction to it.
const TICK: Duration = Duration::from_millis(100);

/// Writes the report whenever a study has changed, until all studies are finished or a signal asks to stop.
async fn watch(
    queue: &mut Queue,
    request: &ReportRequest,
    folder: &Path,
    interval_s: u32,
) -> Result<u8, CliError> {
    let interrupt = Interrupt::default();
    let listener =
        tokio::spawn(raise_on_signal(interrupt.clone(), "the report will not be updated any more"));
    let mut last: Option<Vec<Revision>> = None;
    let mut code = exit::SUCCESS;
    loop {
        // The revision is read before the rows: a change in between leads to another report.
        let mut revision = Vec::new();
        for study in &request.studies {
            revision.push(Revision::read(queue, study).await?);
        }
        let is_last = revision.iter().all(Revision::is_finished) || interrupt.is_raised();
        if is_last || last.as_ref() != Some(&revision) {
            code = read_and_write(queue, request, folder, Some(interval_s).filter(|_| !is_last)).await?;
        }
        if last.is_none() {
            print_page(folder)?;
        }
        if is_last {
            break;
        }
        last = Some(revision);
        // Only this wait ends early: a future of the queue must not be dropped before it is complete.
        let mut left = Duration::from_secs(interval_s.into());
        while !left.is_zero() && !interrupt.is_raised() {
            tokio::time::sleep(left.min(TICK)).await;
            left = left.saturating_sub(TICK);
        }
    }
    listener.abort();
    Ok(code)
}

/// Checks whether the folder of a report can be created and written to, and creates nothing.
pub(crate) fn check_folder(name: &str, out: &OutFolder) -> Result<(), CliError> {
    let folder = out.of(name);
    // The nearest folder that exists; a relative path begins in the current one.
    let existing = folder.ancestors().find(|path| path.symlink_metadata().is_ok()).unwrap_or(Path::new("."));
    tempfile::tempfile_in(existing).map(drop).map_err(|source| CliError::file(&folder, source))
}

/// Creates the folder of a report, so that an error is noticed before the work.
pub(crate) fn create_folder(name: &str, out: &OutFolder) -> Result<(), CliError> {
    let folder = out.of(name);
    std::fs::create_dir_all(&folder).map_err(|source| CliError::file(&folder, source))
}
