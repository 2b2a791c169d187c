use super::counts::{self, Counts};
use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;

/// A study in the list of all studies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudySummary {
    /// Its name.
    pub name: String,
    /// When it was last submitted, in milliseconds since 1970-01-01 UTC.
    pub submitted_ms: i64,
    /// Its jobs by state.
    pub counts: Counts,
}

/// A study as it was submitted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyDocument {
    /// Its name.
    pub name: String,
    /// The document, unchanged.
    pub document: String,
    /// When it was last submitted, in milliseconds since 1970-01-01 UTC.
    pub submitted_ms: i64,
}

const RENAME: &str = "UPDATE studies SET name = $2, document = $3 WHERE id = $1";

impl Queue {
    /// All studies, in the order of their first submission.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn studies(&mut self) -> Result<Vec<StudySummary>, QueueError> {
        let studies: Vec<(i64, String, i64)> =
            query("SELECT id, name, submitted_ms FROM studies ORDER BY id").all(&mut self.connection).await?;
        let mut summaries = Vec::with_capacity(studies.len());
        for (id, name, submitted_ms) in studies {
            let counts = counts::of_study(&mut self.connection, id).await?;
            summaries.push(StudySummary { name, submitted_ms, counts });
        }
        Ok(summaries)
    }

    /// The study of that name, if there is one.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn study(&mut self, name: &str) -> Result<Option<StudyDocument>, QueueError> {
        let found: Option<(String, String, i64)> =
            query("SELECT name, document, submitted_ms FROM studies WHERE name = $1")
                .bind(name)
                .optional(&mut self.connection)
                .await?;
        Ok(found.map(|(name, document, submitted_ms)| StudyDocument { name, document, submitted_ms }))
    }

    /// Gives a study another name. `edit` makes its new document from the old one: a document may contain the name.
    ///
    /// A worker that runs this study only does not find it any more, and ends with [`QueueError::UnknownStudy`].
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`]; [`QueueError::NameTaken`] if a study has the new name; or if the database cannot be
    /// written. Then nothing has changed.
    pub async fn rename(
        &mut self,
        study: &str,
        name: &str,
        edit: impl Fn(&str) -> String,
    ) -> Result<(), QueueError> {
        self.write(async |connection, _| {
            let study_id = lookup::require(connection, study).await?;
            if lookup::find(connection, name).await?.is_some() {
                return Err(QueueError::NameTaken { name: name.to_owned() });
            }
            let document = query("SELECT document FROM studies WHERE id = $1").bind(study_id);
            let document: String = document.scalar(connection).await?;
            query(RENAME).bind(study_id).bind(name).bind(edit(&document)).run(connection).await?;
            Ok(())
        })
        .await
    }
}
