//! `tribosweep export`: one row per job.

use super::error::CliError;
use super::output::{fill_file, stream};
use super::unreadable::log_unreadable;
use crate::publish::table;
use crate::queue::{Location, Queue};
use crate::sweep::{self, ExportColumns, Purpose, Unreadable};
use std::io::Write;
use std::path::PathBuf;

/// Arguments of `export`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Names or files of the studies; default: all studies of the database. The column `study` tells them apart.
    #[arg(value_name = "STUDY")]
    studies: Vec<String>,
    /// Every input as a column of its own, the defaults too, and the whole record: see `columns --all`.
    #[arg(long)]
    all: bool,
    /// One row for each window of the jobs whose speed or load changes in time, instead of one for each job.
    #[arg(long, conflicts_with_all = ["all", "format"])]
    windows: bool,
    /// Write to this file instead of standard output.
    #[arg(long = "csv", value_name = "FILE")]
    file: Option<PathBuf>,
    /// The format of the rows.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// The format of the rows.
#[derive(Debug, Clone, Copy, Default, clap::ValueEnum)]
enum Format {
    /// Comma-separated values with a header.
    #[default]
    Csv,
    /// One JSON object per line.
    Json,
}

/// Exports the studies.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let mut given: Vec<String> = Vec::new();
    for study in &args.studies {
        let name = sweep::study_name(study)?;
        // A study that is given twice would count twice.
        if !given.contains(&name) {
            given.push(name);
        }
    }
    let columns = if args.all { ExportColumns::All } else { ExportColumns::Plain };
    let format = match args.format {
        Format::Csv => table::Format::Csv,
        Format::Json => table::Format::JsonLines,
    };
    let mut unreadable = Unreadable::default();
    let fill = |out: &mut dyn Write| {
        sweep::with_queue(db, Purpose::Read, async |queue| {
            let studies = if given.is_empty() { every_study(queue).await? } else { given.clone() };
            unreadable = if args.windows {
                sweep::export_windows(queue, &studies, out).await?
            } else {
                sweep::export(queue, &studies, columns, format, out).await?
            };
            Ok(())
        })
    };
    match &args.file {
        Some(path) => fill_file(path, fill)?,
        None => stream(fill)?,
    }
    Ok(log_unreadable(&unreadable))
}

async fn every_study(queue: &mut Queue) -> Result<Vec<String>, CliError> {
    Ok(queue.studies().await?.into_iter().map(|study| study.name).collect())
}
