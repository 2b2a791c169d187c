//! The report of a study, and whether it has to be written again.

use super::database::{readable_study, stored_study};
use super::error::SweepError;
use super::growth::read_growth;
use super::request::{ReportContent, ReportRequest};
use super::rows::read_rows;
use super::stability::{name_of_modes, read_stability, way_of};
use super::{provenance, sheet};
use crate::publish::Sheet;
use crate::queue::{Counts, Queue, QueueError, Scope};
use crate::report::Along;
use crate::report::{
    JobRow, Provenance, Report, StabilityPoint, View, Written, write_compared, write_stability,
};
use crate::study::{Study, Warning};
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
    let request = ReportRequest::of_study(study);
    let view = request.view_of_study(queue, rows).await?;
    Ok(write_viewed(queue, study, &request.studies, rows, &view, None, folder, refresh_s).await?.files)
}

/// Writes the page, tables and figures of a report's content into a folder, as [`write_refreshing_report`].
///
/// # Errors
/// As [`write_report`].
pub async fn write_content(
    queue: &mut Queue,
    content: &ReportContent,
    folder: &Path,
    refresh_s: Option<u32>,
) -> Result<Written, SweepError> {
    let ReportContent { title, studies, rows, view, sensitivity, .. } = content;
    let sensitivity = sensitivity.as_ref().map(|(name, rows)| (name.as_str(), rows.as_slice()));
    write_viewed(queue, title, studies, rows, view, sensitivity, folder, refresh_s).await
}

#[expect(clippy::too_many_arguments, reason = "the parts of a report")]
async fn write_viewed(
    queue: &mut Queue,
    title: &str,
    studies: &[String],
    rows: &[JobRow],
    view: &View,
    sensitivity: Option<(&str, &[JobRow])>,
    folder: &Path,
    refresh_s: Option<u32>,
) -> Result<Written, SweepError> {
    let surroundings = Surroundings::read(queue, studies, rows).await?;
    let (stability, along) = stability(queue, studies).await?;
    let findings = match studies {
        [study] => read_growth(queue, study, rows).await?,
        _ => None,
    };
    let findings = findings.as_ref();
    let report = Report {
        title,
        rows,
        view,
        stability: &stability,
        along: &along,
        findings,
        sensitivity,
        refresh_s,
        ..surroundings.report()
    };
    Ok(write_compared(&report, folder)?)
}

/// Writes the page, tables and figures of a study of complex modes, whose `points` were read, into a folder, which is created
/// if it does not exist. Returns the paths of the files.
///
/// # Errors
/// As [`write_report`].
pub async fn write_stability_report(
    queue: &mut Queue,
    study: &str,
    points: &[StabilityPoint],
    along: &Along,
    folder: &Path,
) -> Result<Vec<PathBuf>, SweepError> {
    let rows = read_rows(queue, study).await?;
    let request = ReportRequest::of_study(study);
    let view = request.view_of_study(queue, &rows).await?;
    let surroundings = Surroundings::read(queue, &request.studies, &rows).await?;
    let report = Report { title: study, view: &view, stability: points, along, ..surroundings.report() };
    Ok(write_stability(&report, folder)?)
}

/// What a report says about its studies beside their results.
struct Surroundings {
    description: Option<String>,
    sheet: Option<Sheet>,
    provenance: Option<Provenance>,
    warnings: Vec<String>,
    remarks: Vec<String>,
    written_ms: i64,
}

impl Surroundings {
    async fn read(queue: &mut Queue, studies: &[String], rows: &[JobRow]) -> Result<Self, SweepError> {
        let provenance = provenance::read(queue, studies).await?;
        let written_ms = queue.now_ms().await?;
        let [warnings, remarks] = warnings(queue, studies).await?;
        let definitions = definitions(queue, studies).await?;
        let sheet = sheet::read(queue, studies, &definitions, rows).await?;
        Ok(Self { description: description(&definitions), sheet, provenance, warnings, remarks, written_ms })
    }

    /// A report without title and results.
    fn report(&self) -> Report<'_> {
        Report {
            description: self.description.as_deref(),
            sheet: self.sheet.as_ref(),
            provenance: self.provenance.as_ref(),
            warnings: &self.warnings,
            remarks: &self.remarks,
            written_ms: self.written_ms,
            ..Report::default()
        }
    }
}

/// Stored studies that this version can read.
async fn definitions(queue: &mut Queue, studies: &[String]) -> Result<Vec<Study>, SweepError> {
    let mut definitions = Vec::new();
    for name in studies {
        definitions.extend(readable_study(queue, name).await?);
    }
    Ok(definitions)
}

/// The complex modes of the only study, if the database has them, and what their thresholds are thresholds of.
async fn stability(
    queue: &mut Queue,
    studies: &[String],
) -> Result<(Vec<StabilityPoint>, Along), SweepError> {
    let none = || (Vec::new(), Along::mu());
    let [study] = studies else { return Ok(none()) };
    let modes = name_of_modes(study);
    // Modes of a version whose study this one cannot read are left out.
    let Some(definition) = readable_study(queue, &modes).await? else { return Ok(none()) };
    Ok((read_stability(queue, &modes).await?, way_of(&definition)))
}

/// What the studies are for, in their authors' words. With several studies, each text names its study.
fn description(definitions: &[Study]) -> Option<String> {
    let own = definitions.iter().filter_map(|study| Some((study.name(), study.description()?)));
    let texts: Vec<String> = match definitions {
        [_] => own.map(|(_, text)| text.to_owned()).collect(),
        _ => own.map(|(name, text)| format!("{name}: {text}")).collect(),
    };
    (!texts.is_empty()).then(|| texts.join(" "))
}

/// What is doubtful about the inputs of stored studies, and then what is to be said about their cost. With several studies, each
/// warning names its study.
async fn warnings(queue: &mut Queue, studies: &[String]) -> Result<[Vec<String>; 2], SweepError> {
    let mut found = [Vec::new(), Vec::new()];
    for name in studies {
        // A study may have been removed in between.
        let [doubts, remarks] = match stored_study(queue, name).await {
            Err(SweepError::Queue(QueueError::UnknownStudy { .. })) => continue,
            Ok(study) => {
                let (doubts, remarks): (Vec<Warning>, Vec<Warning>) =
                    study.warnings().into_iter().partition(Warning::is_doubt);
                [doubts, remarks].map(|part| part.iter().map(Warning::in_words).collect())
            }
            Err(SweepError::Study(error)) => {
                let text =
                    format!("this version cannot read the study, so its inputs are not checked: {error}");
                [vec![text], Vec::new()]
            }
            Err(error) => return Err(error),
        };
        let named = |warning: String| if studies.len() > 1 { format!("{name}: {warning}") } else { warning };
        for (all, own) in found.iter_mut().zip([doubts, remarks]) {
            all.extend(own.into_iter().map(named));
        }
    }
    Ok(found)
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
