//! Opening the database, and studies by name or file.

use super::error::SweepError;
use super::rows::StoredParameters;
use crate::queue::{Clock, Location, Queue, QueueError, Settings};
use crate::study::Study;
use std::future::Future;
use std::path::Path;

/// Runs a future to its end on this thread, for programs without an asynchronous runtime.
///
/// # Errors
/// Those of the future, and [`SweepError::Runtime`].
///
/// # Panics
/// Inside an asynchronous runtime, which can await the future itself.
pub fn block_on<T, E: From<SweepError>>(future: impl Future<Output = Result<T, E>>) -> Result<T, E> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    runtime.map_err(SweepError::Runtime)?.block_on(future)
}

/// What a database is opened for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// To read from an existing database.
    Read,
    /// To change an existing database.
    Change,
    /// To use a database, which is created if it does not exist.
    Create,
}

/// Opens a database, runs `work` with it on this thread, and closes it, for programs without an asynchronous runtime.
/// [`with_open`] does the same with a database that is open.
///
/// # Errors
/// Those of [`open`], of `work`, and of closing.
///
/// # Panics
/// Inside an asynchronous runtime.
pub fn with_queue<T, E: From<SweepError>>(
    database: &Location,
    access: Purpose,
    work: impl AsyncFnOnce(&mut Queue) -> Result<T, E>,
) -> Result<T, E> {
    block_on(async {
        let queue = match access {
            Purpose::Read => open_to_read(database.clone()).await,
            Purpose::Change => open_to_change(database.clone()).await,
            Purpose::Create => open(database.clone()).await,
        }?;
        with_open(queue, work).await
    })
}

/// Runs `work` with a database that is open, and closes it.
///
/// # Errors
/// Those of `work` and of closing.
pub async fn with_open<T, E: From<SweepError>>(
    mut queue: Queue,
    work: impl AsyncFnOnce(&mut Queue) -> Result<T, E>,
) -> Result<T, E> {
    let result = work(&mut queue).await?;
    queue.close().await.map_err(SweepError::from)?;
    Ok(result)
}

/// Opens a database; creates it if it does not exist. The location is a path or a [`Location`].
///
/// # Errors
/// As [`Queue::open`].
pub async fn open(database: impl Into<Location>) -> Result<Queue, SweepError> {
    Ok(Queue::open(database, Clock::OfDatabase).await?)
}

/// Opens an existing database to read from it.
///
/// # Errors
/// As [`Queue::open_to_read`].
pub async fn open_to_read(database: impl Into<Location>) -> Result<Queue, SweepError> {
    Ok(Queue::open_to_read(database, Clock::OfDatabase).await?)
}

/// Opens an existing database to change it.
///
/// # Errors
/// As [`Queue::open_existing`].
pub async fn open_to_change(database: impl Into<Location>) -> Result<Queue, SweepError> {
    Ok(Queue::open_existing(database, Clock::OfDatabase, Settings::default()).await?)
}

/// The name of a study that is given as its name or as its file. What ends in `.json` is a file.
///
/// # Errors
/// If the file cannot be read or is no valid study.
pub fn study_name(study: &str) -> Result<String, SweepError> {
    Ok(match study_file(study) {
        Some(path) => Study::load(path)?.name().to_owned(),
        None => study.to_owned(),
    })
}

/// The study in a file, or the one in the database as it was submitted. What ends in `.json` is a file.
///
/// # Errors
/// If the file or the database cannot be read, the study is not valid, or the database has no study of that name.
pub async fn load_study(study: &str, database: &Location) -> Result<Study, SweepError> {
    if let Some(path) = study_file(study) {
        return Ok(Study::load(path)?);
    }
    let queue = open_to_read(database.clone()).await?;
    with_open(queue, async |queue| stored_study(queue, study).await).await
}

/// A study of the database, with the jobs that it had when it was submitted.
///
/// # Errors
/// [`QueueError::UnknownStudy`]; if the database cannot be read, or this version cannot read the study.
pub(super) async fn stored_study(queue: &mut Queue, study: &str) -> Result<Study, SweepError> {
    let document = document(queue, study).await?;
    let mut parameters = queue.pages_of_parameters(study).await?;
    let first = queue.next_page(&mut parameters).await?.and_then(|page| page.into_iter().next());
    let beta_r_s = first.as_deref().and_then(StoredParameters::beta_r_s);
    Ok(Study::parse_stored(&document, study, beta_r_s)?)
}

/// As [`stored_study`]; none if the database has no such study, or if this version cannot read it.
///
/// # Errors
/// If the database cannot be read.
pub(super) async fn readable_study(queue: &mut Queue, study: &str) -> Result<Option<Study>, SweepError> {
    match stored_study(queue, study).await {
        Ok(study) => Ok(Some(study)),
        Err(SweepError::Study(_) | SweepError::Queue(QueueError::UnknownStudy { .. })) => Ok(None),
        Err(error) => Err(error),
    }
}

/// The document of a study in the database, as it was submitted.
///
/// # Errors
/// [`QueueError::UnknownStudy`]; if the database cannot be read.
pub async fn document(queue: &mut Queue, study: &str) -> Result<String, SweepError> {
    if let Some(found) = queue.study(study).await? {
        return Ok(found.document);
    }
    let known = queue.studies().await?.into_iter().map(|study| study.name).collect();
    Err(QueueError::UnknownStudy { name: study.to_owned(), known }.into())
}

/// The path of a study that is given as its file. What ends in `.json` is a file.
pub(super) fn study_file(study: &str) -> Option<&Path> {
    let path = Path::new(study);
    path.extension().is_some_and(|extension| extension == "json").then_some(path)
}
