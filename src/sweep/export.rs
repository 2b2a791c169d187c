//! One row per job, for other programs.

use super::error::SweepError;
use super::rows::{for_each_row, further_names};
use crate::queue::{Queue, Rows};
use crate::report::export::Export;
use std::io::Write;

/// The format of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ExportFormat {
    /// Comma-separated values with a header.
    #[default]
    Csv,
    /// One JSON object per line.
    JsonLines,
}

/// Writes one row per job of a study to `out`. The study is read twice, first for the names of its parameters, so that
/// its rows need not be held in memory.
///
/// # Errors
/// If the database has no such study or cannot be read, and [`SweepError::Output`] if `out` fails.
pub async fn export(
    queue: &mut Queue,
    study: &str,
    format: ExportFormat,
    out: &mut dyn Write,
) -> Result<(), SweepError> {
    let further = further_names(queue, study).await?;
    let mut export = match format {
        ExportFormat::Csv => Export::csv(further, out).map_err(SweepError::Output)?,
        ExportFormat::JsonLines => Export::json_lines(further, out),
    };
    for_each_row(queue, study, Rows::All, |_, row| export.write(&row).map_err(SweepError::Output)).await?;
    export.finish().map_err(SweepError::Output)
}
