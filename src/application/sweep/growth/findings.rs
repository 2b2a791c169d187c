//! What a study that grows has found so far.

use super::{calibrate, refine};
use crate::queue::{PlanState, PlanStatus, Queue};
use crate::report::{BranchPoint, Endpoint, Findings, JobRow, Nearest, RowState, basins};
use crate::study::{Continue, DIRECTION, Direction, KICK, Study};
use crate::sweep::database::readable_study;
use crate::sweep::error::SweepError;
use indexmap::IndexMap;
use serde_json::Value;
use std::collections::BTreeMap;

/// What a study has found, from all its `rows`; none if it does not grow, or if this version cannot read it.
///
/// # Errors
/// If the database has no such study or cannot be read.
pub async fn read_growth(
    queue: &mut Queue,
    study: &str,
    rows: &[JobRow],
) -> Result<Option<Findings>, SweepError> {
    let Some(plan) = queue.plan_status(study).await? else { return Ok(None) };
    let Some(study) = readable_study(queue, study).await? else { return Ok(None) };
    let mut found = Findings { waves: waves(rows), state: state(&study, &plan, rows), ..Findings::default() };
    let growth = study.growth();
    if let Some(settings) = &growth.refine {
        let (boundaries, curves) = (settings.boundaries.iter(), settings.curves.iter());
        found.crossings = boundaries.flat_map(|own| refine::crossings(&study, own, rows)).collect();
        found.minima = curves.flat_map(|own| refine::minima(&study, own, rows)).collect();
    }
    found.calibration = growth.calibrate.as_ref().map(|own| calibrate::found(&study, own, rows));
    match &growth.continues {
        Some(Continue { along: Some(_), .. }) => found.branches = branches(rows),
        Some(_) => found.basins = basins_of(rows),
        None => {}
    }
    Ok(Some(found))
}

/// The implausibility of a point in a study that is calibrated, and the one above which it is ruled out. `point` has the
/// values of the free parameters by their names. Returns `None` if the study is not calibrated, or if one of them is missing.
///
/// # Errors
/// As [`read_growth`].
pub async fn read_implausibility(
    queue: &mut Queue,
    study: &str,
    rows: &[JobRow],
    point: &[(String, f64)],
) -> Result<Option<(Nearest, f64)>, SweepError> {
    let Some(study) = readable_study(queue, study).await? else { return Ok(None) };
    let settings = study.growth().calibrate.as_ref();
    Ok(settings.and_then(|own| calibrate::implausibility(&study, own, rows, point)))
}

fn waves(rows: &[JobRow]) -> Vec<BTreeMap<String, u64>> {
    let mut waves: Vec<BTreeMap<String, u64>> = Vec::new();
    for row in rows.iter().filter(|row| row.wave > 0) {
        let index = row.wave as usize - 1;
        waves.resize_with(waves.len().max(index + 1), BTreeMap::new);
        *waves[index].entry(row.why.clone().unwrap_or_default()).or_default() += 1;
    }
    waves
}

fn state(study: &Study, plan: &PlanStatus, rows: &[JobRow]) -> String {
    let note = plan.note.as_deref().unwrap_or_default();
    let waves = plan.waves;
    match plan.state {
        PlanState::Complete => format!("The plan ended after wave {waves}: {note}."),
        PlanState::Failed => {
            format!("The next wave could not be planned: {note}. `tribosweep retry` tries it again.")
        }
        PlanState::Open => {
            let most = study.most_jobs().unwrap_or(0);
            let jobs = rows.len();
            let last = if waves > 0 && !note.is_empty() {
                format!("Wave {waves} asked for {note}. ")
            } else {
                String::new()
            };
            format!(
                "{last}More jobs may follow when these have ended: there are {jobs} of at most {most} jobs."
            )
        }
    }
}

/// The ends on the two ways at each point, in the order of the rows.
fn branches(rows: &[JobRow]) -> Vec<BranchPoint> {
    let mut found: IndexMap<String, BranchPoint> = IndexMap::new();
    for row in rows {
        // A measured point has no way.
        let Some(way) = own(row, DIRECTION).and_then(Value::as_str) else { continue };
        let parameters = without(row, DIRECTION);
        let point = found.entry(serde_json::to_string(&parameters).unwrap_or_default());
        let point = point.or_insert_with(|| BranchPoint { parameters, up: None, down: None });
        let end = row.record().map(Endpoint::of);
        if way == Direction::Up.name() {
            point.up = end;
        } else {
            point.down = end;
        }
    }
    let mut found: Vec<BranchPoint> = found.into_values().collect();
    found.sort_by(|a, b| {
        let numbers = |point: &BranchPoint| -> Vec<f64> {
            point.parameters.iter().map(|(_, value)| value.as_f64().unwrap_or(0.0)).collect()
        };
        numbers(a)
            .iter()
            .zip(&numbers(b))
            .map(|(a, b)| a.total_cmp(b))
            .find(|order| order.is_ne())
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    found
}

/// The states that the kicked jobs of each point ended in.
fn basins_of(rows: &[JobRow]) -> Vec<crate::report::Basin> {
    type Ends = Vec<Option<Endpoint>>;
    let mut found: IndexMap<String, (Vec<(String, Value)>, Ends)> = IndexMap::new();
    for row in rows {
        let is_kicked = own(row, KICK).and_then(Value::as_u64).is_some_and(|kick| kick > 0);
        let has_ended = matches!(row.state, RowState::Done(_) | RowState::Failed { .. });
        if !is_kicked || !has_ended {
            continue;
        }
        let parameters = without(row, KICK);
        let point = found.entry(serde_json::to_string(&parameters).unwrap_or_default());
        point.or_insert_with(|| (parameters, Vec::new())).1.push(row.record().map(Endpoint::of));
    }
    found.values().flat_map(|(parameters, ends)| basins(parameters, ends)).collect()
}

fn own<'a>(row: &'a JobRow, name: &str) -> Option<&'a Value> {
    row.parameters.get(name)
}

fn without(row: &JobRow, name: &str) -> Vec<(String, Value)> {
    row.parameters.of_grid().iter().filter(|(own, _)| own != name).cloned().collect()
}
