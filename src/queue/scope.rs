use super::engine::Connection;
use super::error::QueueError;
use super::lookup;

/// The jobs that an operation is about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Scope {
    /// All jobs in the database.
    All,
    /// The jobs of the study of that name.
    Study(String),
}

impl Scope {
    /// The study's number, or `None` for all jobs.
    pub(super) async fn study_id(&self, connection: &mut Connection) -> Result<Option<i64>, QueueError> {
        match self {
            Self::All => Ok(None),
            Self::Study(name) => lookup::require(connection, name).await.map(Some),
        }
    }
}
