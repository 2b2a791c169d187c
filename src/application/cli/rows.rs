//! The jobs of several studies.

use super::error::CliError;
use crate::queue::Location;
use crate::report::JobRow;
use crate::sweep::{self, Purpose};

/// The names of studies, given by name or by file, and the rows of all their jobs.
pub(super) fn of_studies(studies: &[String], db: &Location) -> Result<(Vec<String>, Vec<JobRow>), CliError> {
    let names = studies.iter().map(|study| sweep::study_name(study)).collect::<Result<Vec<_>, _>>()?;
    let rows = sweep::with_queue(db, Purpose::Read, async |queue| {
        let mut all = Vec::new();
        for name in &names {
            all.extend(sweep::read_rows(queue, name).await?);
        }
        Ok::<_, CliError>(all)
    })?;
    Ok((names, rows))
}
