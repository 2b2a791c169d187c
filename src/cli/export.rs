//! `tribosweep export`: one row a job.

use super::error::CliError;
use super::output::{block_on, fill_file, stream};
use super::rows;
use crate::exit;
use crate::queue::{Location, Rows};
use crate::report::export::Export;
use std::io::Write;
use std::path::PathBuf;

/// Arguments of `export`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study's name or file.
    study: String,
    /// Write to this file instead of standard output.
    #[arg(long = "csv", value_name = "FILE")]
    file: Option<PathBuf>,
    /// How rows are written.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// How rows are written.
#[derive(Debug, Clone, Copy, Default, clap::ValueEnum)]
enum Format {
    /// Comma-separated values with a header.
    #[default]
    Csv,
    /// One JSON object a line.
    Json,
}

/// Exports the study.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = rows::study_name(&args.study)?;
    let fill = |out: &mut dyn Write| block_on(write(&name, args.format, db, out));
    match &args.file {
        Some(path) => fill_file(path, fill)?,
        None => stream(fill)?,
    }
    Ok(exit::SUCCESS)
}

/// Reads the study twice, first for the names of its parameters, so as not to hold its rows.
async fn write(study: &str, format: Format, db: &Location, out: &mut dyn Write) -> Result<(), CliError> {
    let mut queue = rows::open(db).await?;
    let further = rows::further_names(&mut queue, study).await?;
    let mut export = match format {
        Format::Csv => Export::csv(further, out)?,
        Format::Json => Export::json_lines(further, out),
    };
    rows::each(&mut queue, study, Rows::All, |_, row| Ok(export.write(&row)?)).await?;
    export.finish()?;
    queue.close().await?;
    Ok(())
}
