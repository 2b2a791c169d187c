//! The points of a stored study of complex modes.

use crate::queue::Queue;
use crate::report::{JobRow, StabilityPoint};
use crate::solver;
use crate::sweep::database::stored_study;
use crate::sweep::error::SweepError;
use crate::sweep::rows::for_each_row;
use std::collections::HashSet;

/// The name of the study of the complex modes of the study called `name`.
pub fn name_of_modes(name: &str) -> String {
    format!("{name}-stability")
}

/// Reads the points of a study of complex modes that are done, in the order of its jobs: those of the grid come first.
///
/// # Errors
/// If the database has no such study or cannot be read, or this version cannot read the study.
pub async fn read_stability(queue: &mut Queue, study: &str) -> Result<Vec<StabilityPoint>, SweepError> {
    let stored = stored_study(queue, study).await?;
    let on_grid: HashSet<String> = stored.expand(solver::VERSION)?.into_iter().map(|job| job.key).collect();
    let mut points = Vec::new();
    for_each_row(queue, study, crate::queue::Rows::All, |_, row| {
        points.extend(point(&row, on_grid.contains(&row.job)));
        Ok(())
    })
    .await?;
    Ok(points)
}

fn point(row: &JobRow, on_grid: bool) -> Option<StabilityPoint> {
    let record = row.record()?;
    Some(StabilityPoint {
        parameters: row.parameters.clone(),
        on_grid,
        stands_alone: record.why_modes_stand_alone(),
        stability: record.stability.clone()?,
    })
}
