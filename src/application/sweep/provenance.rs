//! Where a study and its results come from, for reports.

use super::error::SweepError;
use crate::queue::{ProvenanceGroup, Queue};
use crate::report::{Provenance, ResultGroup};

/// The documents of the studies and the provenance of their results; `None` if they have been removed meanwhile.
pub(super) async fn read(queue: &mut Queue, studies: &[String]) -> Result<Option<Provenance>, SweepError> {
    let (mut documents, mut submitted_ms, mut groups) = (Vec::new(), None, Vec::new());
    for study in studies {
        let Some(document) = queue.study(study).await? else { continue };
        groups.extend(queue.provenance_groups(study).await?.iter().map(report_group));
        submitted_ms = submitted_ms.max(Some(document.submitted_ms));
        documents.push(document.document);
    }
    Ok(submitted_ms.map(|submitted_ms| Provenance::grouped(documents.join("\n"), submitted_ms, groups)))
}

fn report_group(group: &ProvenanceGroup) -> ResultGroup {
    ResultGroup {
        // A provenance that cannot be read counts as unknown.
        build: group.provenance.as_deref().and_then(|text| serde_json::from_str(text).ok()),
        jobs: group.jobs,
        first_ms: group.first_finished_ms,
        last_ms: group.last_finished_ms,
    }
}
