use super::engine::{Connection, query};
use super::{Counts, Queue, QueueError, counts};

/// A study in a list.
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
}

/// The study's number in the tables.
pub(super) async fn find(connection: &mut Connection, name: &str) -> Result<Option<i64>, QueueError> {
    let id = query("SELECT id FROM studies WHERE name = $1").bind(name);
    Ok(id.optional(connection).await?.map(|(id,)| id))
}

/// As [`find`], but a missing study is an error that names those there are.
pub(super) async fn require(connection: &mut Connection, name: &str) -> Result<i64, QueueError> {
    if let Some(id) = find(connection, name).await? {
        return Ok(id);
    }
    let known = query("SELECT name FROM studies ORDER BY id").scalars(connection).await?;
    Err(QueueError::UnknownStudy { name: name.into(), known })
}
