//! `tribosweep export`: one row per job.

use super::error::CliError;
use super::output::{fill_file, stream};
use crate::exit;
use crate::queue::Location;
use crate::sweep::{self, ExportFormat};
use std::io::Write;
use std::path::PathBuf;

/// Arguments of `export`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file.
    study: String,
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

/// Exports the study.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = sweep::study_name(&args.study)?;
    let format = match args.format {
        Format::Csv => ExportFormat::Csv,
        Format::Json => ExportFormat::JsonLines,
    };
    let fill = |out: &mut dyn Write| {
        sweep::block_on(async {
            let mut queue = sweep::open_to_read(db.clone()).await?;
            sweep::export(&mut queue, &name, format, out).await?;
            queue.close().await?;
            Ok(())
        })
    };
    match &args.file {
        Some(path) => fill_file(path, fill)?,
        None => stream(fill)?,
    }
    Ok(exit::SUCCESS)
}
