//! Jobs that continue others: along a parameter, or from one point with random velocities.

use crate::report::{JobRow, RowState};
use crate::solver;
use crate::spec::Continuation;
use crate::study::{Continue, DIRECTION, Direction, Job, KICK, Study, StudyError, chains_of};
use serde_json::Value;
use std::collections::{HashMap, HashSet};

/// Why such jobs are added.
pub const PURPOSE: &str = "continuing";

/// The next jobs of each chain; nothing if all chains have ended. A chain ends at a job that failed.
pub fn next_jobs(study: &Study, continues: &Continue, rows: &[JobRow]) -> Result<Vec<Job>, StudyError> {
    match &continues.along {
        Some(along) => next_of_chains(study, continues, along, rows),
        None => Ok(kicked(continues, &study.expand(solver::VERSION)?, rows)),
    }
}

fn next_of_chains(
    study: &Study,
    continues: &Continue,
    along: &str,
    rows: &[JobRow],
) -> Result<Vec<Job>, StudyError> {
    let grid = study.points(solver::VERSION)?;
    let chains = chains_of(&grid, along);
    let by_place: HashMap<String, &JobRow> =
        rows.iter().map(|row| (place(row.parameters.of_grid()), row)).collect();
    let mut next = Vec::new();
    for direction in &continues.directions {
        for chain in &chains {
            let mut points: Vec<&Job> = chain.clone();
            if *direction == Direction::Down {
                points.reverse();
            }
            // The jobs of the chain so far, by their parameters: a chain has one job at each point.
            let row_at = |point: &&Job| {
                let own = (DIRECTION.to_owned(), Value::from(direction.name()));
                let parameters: Vec<_> = point.parameters.iter().cloned().chain([own]).collect();
                by_place.get(&place(&parameters)).copied()
            };
            let done: Vec<&JobRow> = points.iter().map_while(row_at).collect();
            let Some(parent) = done.last().filter(|row| matches!(row.state, RowState::Done(_))) else {
                continue;
            };
            let Some(point) = points.get(done.len()) else { continue };
            let continuation = Continuation {
                parent: Some(parent.job.clone()),
                kick_m_s: continues.kick_m_s(),
                kick_seed: 0,
            };
            next.push(point.continued(
                Some(continuation),
                (DIRECTION, direction.name().into()),
                solver::VERSION,
            ));
        }
    }
    Ok(next)
}

fn kicked(continues: &Continue, roots: &[Job], rows: &[JobRow]) -> Vec<Job> {
    let kick = |root: &Job, seed: u64| {
        let continuation =
            Continuation { parent: Some(root.key.clone()), kick_m_s: continues.kick_m_s(), kick_seed: seed };
        root.continued(Some(continuation), (KICK, seed.into()), solver::VERSION)
    };
    let done = rows.iter().filter(|row| matches!(row.state, RowState::Done(_)));
    let done: HashSet<&str> = done.map(|row| row.job.as_str()).collect();
    let is_done = |root: &&Job| done.contains(root.key.as_str());
    let known: HashSet<&str> = rows.iter().map(|row| row.job.as_str()).collect();
    let kicks = 1..=u64::from(continues.kicks.unwrap_or(0));
    let all = roots.iter().filter(is_done).flat_map(|root| kicks.clone().map(move |seed| kick(root, seed)));
    all.filter(|job| !known.contains(job.key.as_str())).collect()
}

/// A name of a point that no other point has.
fn place(parameters: &[(String, Value)]) -> String {
    serde_json::to_string(parameters).unwrap_or_default()
}
