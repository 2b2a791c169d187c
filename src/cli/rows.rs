//! The jobs of several studies.

use super::error::CliError;
use crate::queue::Location;
use crate::report::JobRow;
use crate::sweep;

/// The names of studies, given by name or by file, and the rows of all their jobs.
pub(super) fn of_studies(studies: &[String], db: &Location) -> Result<(Vec<String>, Vec<JobRow>), CliError> {
    let names = studies.iter().map(|study| sweep::study_name(study)).collect::<Result<Vec<_>, _>>()?;
    let rows = sweep::block_on(async {
        let mut queue = sweep::open_to_read(db.clone()).await?;
        let mut all = Vec::new();
        for name in &names {
            all.extend(sweep::read_rows(&mut queue, name).await?);
        }
        queue.close().await?;
        Ok::<_, CliError>(all)
    })?;
    Ok((names, rows))
}
