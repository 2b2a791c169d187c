//! Another name for a study.

use super::error::SweepError;
use crate::queue::Queue;
use crate::study::{refused_name, renamed};

/// Gives a study in the database another name. If its document contains the name, it contains the new one afterwards.
/// Files and folders stay as they are.
///
/// # Errors
/// [`SweepError::BadName`]; if the database has no such study, has a study with the new name, or cannot be written. Then
/// nothing has changed.
pub async fn rename(queue: &mut Queue, study: &str, name: &str) -> Result<(), SweepError> {
    if let Some(reason) = refused_name(name) {
        return Err(SweepError::BadName { name: name.to_owned(), reason });
    }
    Ok(queue.rename(study, name, |document| renamed(document, name)).await?)
}
