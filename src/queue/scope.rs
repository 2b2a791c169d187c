use super::engine::Connection;
use super::{QueueError, studies};

/// Which jobs an operation is about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Scope {
    /// All jobs in the database.
    All,
    /// The jobs of the study of that name.
    Study(String),
}

impl Scope {
    /// The study's number, for statements that take none as "all".
    pub(super) async fn study_id(&self, connection: &mut Connection) -> Result<Option<i64>, QueueError> {
        match self {
            Self::All => Ok(None),
            Self::Study(name) => studies::require(connection, name).await.map(Some),
        }
    }
}
