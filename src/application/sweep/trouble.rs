//! The jobs of a study that failed or did not become periodic.

use super::error::SweepError;
use super::rows::{for_each_row, for_each_stored};
use crate::analysis::Outcome;
use crate::queue::{Queue, Rows};
use crate::report::JobRow;
use crate::report::trouble::{Grid, MAX_LISTED, Regions, cause};

/// The jobs of a study that failed or did not become periodic.
#[derive(Debug)]
pub struct Trouble {
    /// Rows of the jobs that failed.
    pub failed: Vec<JobRow>,
    /// Number of jobs that reached their time limit without a periodic state.
    pub not_periodic: usize,
    /// Where in the grid these jobs are.
    pub regions: Regions,
}

impl Trouble {
    /// Finds these jobs. Only the parameters of the others are read: records are most of a study.
    ///
    /// # Errors
    /// If the database has no such study or cannot be read.
    pub async fn read(queue: &mut Queue, study: &str) -> Result<Self, SweepError> {
        let mut grid = Grid::default();
        let mut unreadable = None;
        for_each_stored(queue, study, |stored| match stored {
            Ok(stored) => grid.add(&stored.into_parameters()),
            Err(error) => _ = unreadable.get_or_insert(error),
        })
        .await?;
        if let Some(reason) = unreadable {
            return Err(SweepError::Unreadable { subject: study.to_owned(), what: "parameters", reason });
        }
        let (mut troubled, mut failed) = (Vec::new(), Vec::new());
        let mut note = |ordinal: u64, row: &JobRow| {
            troubled.extend(cause(row).map(|cause| (ordinal as usize, row.job.clone(), cause)));
        };
        for_each_row(queue, study, Rows::Failed, |ordinal, row| {
            note(ordinal, &row);
            failed.push(row);
            Ok(())
        })
        .await?;
        let not_periodic = Rows::Done(Outcome::NotPeriodic.name());
        for_each_row(queue, study, not_periodic, |ordinal, row| {
            note(ordinal, &row);
            Ok(())
        })
        .await?;
        let not_periodic = troubled.len() - failed.len();
        Ok(Self { failed, not_periodic, regions: grid.regions(troubled, MAX_LISTED) })
    }
}
