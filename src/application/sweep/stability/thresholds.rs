//! The study of complex modes as one that grows: towards the values at which sliding becomes unstable or stable.

use super::along::ways;
use crate::queue::{Queue, Rows};
use crate::report::Along;
use crate::solver;
use crate::study::{Boundaries, Job, MAX_JOBS, MOST_WAVE_JOBS, Refine, Side};
use crate::sweep::error::SweepError;
use crate::sweep::growth::{Series, name, position, rest, series_along};
use crate::sweep::plan::{Added, Plan};
use crate::sweep::rows::for_each_row;
use serde_json::Value;
use std::collections::HashSet;

/// The share of a threshold within which it is known.
const TOLERANCE: f64 = 0.002;

/// The largest step of μ over which modes are followed.
const LARGEST_STEP: f64 = 0.05;

/// The parameter of the friction coefficient.
const MU: &str = "mu";

/// Why points are there that an earlier study of the same name had.
const EARLIER: &str = "earlier";

/// Makes a plan of modes without a run one that looks for thresholds along a way, and adds the points that the database has of this
/// study on the ways through its grid: they were computed to find thresholds, and their results must not go out of view.
///
/// # Errors
/// If the database cannot be read.
pub async fn plan_thresholds(
    mut plan: Plan,
    along: Option<&Along>,
    queue: &mut Queue,
) -> Result<Plan, SweepError> {
    if let Some(along) = along {
        let is_axis = plan.study().axes().any(|(parameter, _)| parameter.name == MU);
        let boundaries = Boundaries {
            over: along.parameter.clone(),
            between: Side::Stability,
            within: None,
            within_share: Some(TOLERANCE),
            largest_step: (along.is_mu() && is_axis).then_some(LARGEST_STEP),
        };
        let (curves, boundaries) = (None, Some(boundaries));
        plan.refine(Refine { curves, boundaries, most_jobs: MAX_JOBS, wave_jobs: MOST_WAVE_JOBS });
    }
    let stored = stored(&plan, queue).await?;
    plan.extend(&stored)?;
    Ok(plan)
}

/// The points that the database has on the ways through the grid.
async fn stored(plan: &Plan, queue: &mut Queue) -> Result<Vec<(Job, Added)>, SweepError> {
    let mut found: Vec<(Job, Added)> = Vec::new();
    if queue.study(plan.name()).await?.is_none() {
        return Ok(found);
    }
    let study = plan.study();
    let mut ways = ways(study);
    if !ways.iter().any(Along::is_mu) {
        ways.push(Along::mu());
    }
    // A study with a single μ may have had several.
    let with_mu: Vec<Job> = plan.jobs().iter().map(with_mu).collect();
    let grid = |along: &Along| if along.is_mu() { &with_mu } else { plan.jobs() };
    let ways: Vec<_> = ways.iter().map(|along| (along, series_along(grid(along), along))).collect();
    let mut known: HashSet<String> = plan.jobs().iter().map(|job| job.key.clone()).collect();
    for_each_row(queue, plan.name(), Rows::All, |_, row| {
        for (along, series) in &ways {
            let Some((_, first)) = series.first() else { continue };
            let parameters = first.points[0].1.parameters.iter();
            let own: Vec<(String, Value)> =
                parameters.map(|(name, _)| (name.clone(), row.parameter(name))).collect();
            let job =
                |series: &Series<'_, Job>| study.job_at(&series.at(position(along, &own)?)?, solver::VERSION);
            let job = series.get(&name(&rest(along, &own))).and_then(job);
            // A job of another version has another key, and is computed again.
            if let Some(job) = job.filter(|job| job.key == row.job && known.insert(row.job.clone())) {
                let why = row.why.clone().unwrap_or_else(|| EARLIER.to_owned());
                found.push((job, Added { wave: row.wave.max(1), why }));
            }
        }
        Ok(())
    })
    .await?;
    Ok(found)
}

/// The job with its μ as a parameter.
fn with_mu(job: &Job) -> Job {
    let mut job = job.clone();
    if job.parameters.iter().all(|(name, _)| name != MU) {
        job.parameters.push((MU.to_owned(), job.spec.scene.contact.mu.into()));
    }
    job
}
