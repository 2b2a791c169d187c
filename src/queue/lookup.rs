//! The numbers that studies have in the tables.

use super::engine::{Connection, query};
use super::error::QueueError;

/// The study's number, if there is a study of that name.
pub(super) async fn find(connection: &mut Connection, name: &str) -> Result<Option<i64>, QueueError> {
    let id = query("SELECT id FROM studies WHERE name = $1").bind(name);
    Ok(id.optional(connection).await?.map(|(id,)| id))
}

/// The study's number. A missing study is an error that lists the existing studies.
pub(super) async fn require(connection: &mut Connection, name: &str) -> Result<i64, QueueError> {
    if let Some(id) = find(connection, name).await? {
        return Ok(id);
    }
    let known = query("SELECT name FROM studies ORDER BY id").scalars(connection).await?;
    Err(QueueError::UnknownStudy { name: name.into(), known })
}
