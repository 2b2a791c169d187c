use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;

const RENAME: &str = "UPDATE studies SET name = $2, document = $3 WHERE id = $1";

impl Queue {
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
