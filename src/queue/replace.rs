//! What a submission may do to the study that has its name, and what it does.

use serde::Serialize;

/// Whether a submission may replace the study that has its name. The decision is made in the transaction that replaces it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Replace {
    /// Only if the new study has every job of the old one that is done, so that no result goes out of view.
    #[default]
    KeepingResults,
    /// As `KeepingResults`, and also if the old study has this document: its user has agreed that results of that study go
    /// out of view. Another process may have replaced that study in the meantime.
    Document(String),
    /// Always.
    Always,
}

impl Replace {
    /// Whether the study may be replaced in this way.
    pub(super) fn permits(&self, replaced: &Replaced) -> bool {
        match self {
            Self::KeepingResults => replaced.dropped_done == 0,
            Self::Document(document) => replaced.dropped_done == 0 || replaced.document == *document,
            Self::Always => true,
        }
    }
}

/// The study that has the name: [`OldColumns`].
pub(super) const OLD: &str = "
    SELECT s.id, s.document, (SELECT COUNT(DISTINCT m.job_id) FROM study_jobs AS m WHERE m.study_id = s.id),
           (SELECT m.parameters FROM study_jobs AS m WHERE m.study_id = s.id ORDER BY m.ordinal LIMIT 1)
    FROM studies AS s WHERE s.name = $1";

/// Number, document, number of jobs, and the parameters of the first row.
pub(super) type OldColumns = (i64, String, i64, Option<String>);

/// A study that is replaced by another one of its name, or would be. A job that several rows point to counts once.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Replaced {
    /// The document of the old study.
    #[serde(skip)]
    pub document: String,
    /// The parameters of its first row, if it has one.
    #[serde(skip)]
    pub parameters: Option<String>,
    /// Jobs that both studies have.
    pub kept: u64,
    /// Jobs that only the new study has.
    pub new: u64,
    /// Jobs that only the old study has. They and their results stay in the database.
    pub dropped: u64,
    /// Those of the dropped jobs that are done.
    pub dropped_done: u64,
    /// Pending jobs that become cancelled because no study requests them any more.
    pub cancelled: u64,
}
