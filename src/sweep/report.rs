//! The report of a study, and whether it has to be written again.

use super::error::SweepError;
use super::provenance;
use crate::queue::{Counts, Queue, Scope};
use crate::report::{JobRow, Report, write};
use std::path::{Path, PathBuf};

/// Writes the page, tables and figures of a study's `rows` into a folder, which is created if it does not exist. Returns
/// the paths of the files.
///
/// # Errors
/// If the database cannot be read, or a file cannot be written.
pub async fn write_report(
    queue: &mut Queue,
    study: &str,
    rows: &[JobRow],
    folder: &Path,
) -> Result<Vec<PathBuf>, SweepError> {
    write_refreshing_report(queue, study, rows, folder, None).await
}

/// As [`write_report`]; with `refresh_s` the page reloads itself after so many seconds.
///
/// # Errors
/// As [`write_report`].
pub async fn write_refreshing_report(
    queue: &mut Queue,
    study: &str,
    rows: &[JobRow],
    folder: &Path,
    refresh_s: Option<u32>,
) -> Result<Vec<PathBuf>, SweepError> {
    let provenance = provenance::read(queue, study).await?;
    let written_ms = queue.now_ms().await?;
    let report = Report { title: study, rows, provenance: provenance.as_ref(), written_ms, refresh_s };
    Ok(write(&report, folder)?)
}

/// Changes whenever the report of a study would: reading this is much faster than reading the rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Revision {
    counts: Counts,
    starts: u64,
    submitted_ms: Option<i64>,
}

impl Revision {
    /// Reads the present revision of a study.
    ///
    /// # Errors
    /// If the database has no such study or cannot be read.
    pub async fn read(queue: &mut Queue, study: &str) -> Result<Self, SweepError> {
        Ok(Self {
            counts: queue.counts(&Scope::Study(study.to_owned())).await?,
            starts: queue.starts(study).await?,
            submitted_ms: queue.study(study).await?.map(|study| study.submitted_ms),
        })
    }

    /// Whether no job is pending or running.
    pub fn is_finished(&self) -> bool {
        self.counts.pending + self.counts.running == 0
    }
}
