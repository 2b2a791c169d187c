//! `tribosweep export`: one row a job.

use super::error::CliError;
use super::output::{block_on, print, write_file};
use super::rows;
use crate::exit;
use crate::report::export;
use std::path::{Path, PathBuf};

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
pub fn run(args: &Args, db: &Path) -> Result<u8, CliError> {
    let name = rows::study_name(&args.study)?;
    let rows = block_on(async {
        let mut queue = rows::open(db).await?;
        let rows = rows::read(&mut queue, &name).await?;
        queue.close().await?;
        Ok(rows)
    })?;
    let mut content = Vec::new();
    match args.format {
        Format::Csv => export::csv(&rows, &mut content)?,
        Format::Json => export::json_lines(&rows, &mut content)?,
    }
    match &args.file {
        Some(path) => write_file(path, &content)?,
        None => print(&content)?,
    }
    Ok(exit::SUCCESS)
}
