//! Where a study and its results come from, for reports.

use super::error::CliError;
use crate::queue::{ProvenanceGroup, Queue};
use crate::report::{Made, Maker, Origin};
use serde::Deserialize;

/// What a worker tells of itself, as far as a reader cares. Another version may have told less.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Told {
    version: String,
    commit: String,
    host: String,
    cpu: Option<String>,
    architecture: String,
    system: String,
    vectors: String,
    threads: u64,
}

/// The study's document and what its results were made with; nothing if the study has been removed meanwhile.
pub async fn read(queue: &mut Queue, study: &str) -> Result<Option<Origin>, CliError> {
    let Some(document) = queue.study(study).await? else { return Ok(None) };
    let made = queue.provenance_groups(study).await?;
    Ok(Some(Origin::grouped(document.document, document.submitted_ms, made.iter().map(convert))))
}

fn convert(made: &ProvenanceGroup) -> Made {
    // What cannot be read is not known.
    let told: Option<Told> = made.provenance.as_deref().and_then(|text| serde_json::from_str(text).ok());
    let with = told.map(|told| Maker {
        version: told.version,
        commit: told.commit,
        host: told.host,
        cpu: told.cpu,
        platform: [told.architecture, told.system].join(" "),
        vectors: told.vectors,
        threads: told.threads,
    });
    Made { with, jobs: made.jobs, first_ms: made.first_finished_ms, last_ms: made.last_finished_ms }
}
