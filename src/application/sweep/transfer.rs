//! Studies with their results from some databases to another.

use super::database::{open, open_to_read, with_open};
use super::error::SweepError;
use crate::queue::{Absorbed, Location, Queue, Scope};

/// What one database contributed.
#[derive(Debug, Clone)]
pub struct Transfer {
    /// The database that was read.
    pub source: Location,
    /// What the target took from it.
    pub absorbed: Absorbed,
}

/// Takes over `study`, or all studies without one, with their results from the `sources` into the `target`, which is
/// created if it does not exist.
///
/// # Errors
/// [`SweepError::SameDatabase`] if the target is a source too; if a source does not exist or does not have the study;
/// if a database cannot be read or written.
pub async fn transfer(
    sources: &[Location],
    target: &Location,
    study: Option<&str>,
) -> Result<Vec<Transfer>, SweepError> {
    if let Some(same) = sources.iter().find(|source| is_same(source, target)) {
        return Err(SweepError::SameDatabase(same.clone()));
    }
    // All sources are opened before anything is written: an error in a name leaves the target as it was.
    let scope = study.map_or(Scope::All, |name| Scope::Study(name.to_owned()));
    let mut opened = Vec::new();
    for source in sources {
        let mut source = open_to_read(source.clone()).await?;
        source.counts(&scope).await?;
        opened.push(source);
    }
    with_open(open(target.clone()).await?, async |target| {
        let mut transfers = Vec::new();
        for source in opened {
            let absorb = async |source: &mut Queue| {
                let absorbed = target.absorb(source, study).await?;
                Ok::<_, SweepError>(Transfer { source: source.location().clone(), absorbed })
            };
            transfers.push(with_open(source, absorb).await?);
        }
        Ok(transfers)
    })
    .await
}

/// Whether two locations are one database; several paths may lead to a file.
fn is_same(source: &Location, target: &Location) -> bool {
    match (source.path().map(std::fs::canonicalize), target.path().map(std::fs::canonicalize)) {
        (Some(Ok(source)), Some(Ok(target))) => source == target,
        _ => source == target,
    }
}
