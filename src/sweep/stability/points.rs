//! The points of a stored study of complex modes.

use super::along::rest;
use crate::queue::Queue;
use crate::report::{Along, JobRow, StabilityPoint};
use crate::solver;
use crate::study::Study;
use crate::sweep::database::document;
use crate::sweep::error::SweepError;
use crate::sweep::rows::for_each_row;
use indexmap::IndexMap;
use serde_json::Value;
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
    let stored = Study::parse_stored(&document(queue, study).await?, study)?;
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
    Some(StabilityPoint {
        parameters: row.parameters.clone(),
        on_grid,
        stability: row.record()?.stability.clone()?,
    })
}

/// The parameters that all points of a series share.
pub(super) type Series = Vec<(String, Value)>;

/// A name that no other series has.
pub(super) fn id(series: &Series) -> String {
    series.iter().map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(";")
}

/// The points of each series with their places along it, from the smallest to the largest. The series are in the order of their
/// first points. Points without a number there are in none.
pub(super) fn by_series<'a>(
    along: &Along,
    points: &'a [StabilityPoint],
) -> Vec<(Series, Vec<(f64, &'a StabilityPoint)>)> {
    type Points<'a> = Vec<(f64, &'a StabilityPoint)>;
    let mut found: IndexMap<String, (Series, Points)> = IndexMap::new();
    for point in points {
        let Some(at) = point.parameter(&along.parameter).as_f64() else { continue };
        let series = rest(along, &point.parameters);
        found.entry(id(&series)).or_insert_with(|| (series, Vec::new())).1.push((at, point));
    }
    let mut found: Vec<_> = found.into_values().collect();
    for (_, points) in &mut found {
        Along::sort(points, |point| point.on_grid);
    }
    found
}
