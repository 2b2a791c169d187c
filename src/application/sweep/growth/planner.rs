//! What a worker asks when a wave of a study is due.

use super::refine::Wanted;
use super::{calibrate, chains, refine};
use crate::publish::value::count;
use crate::queue::{NewJob, PlanClaim, Planned, StudyRow};
use crate::report::JobRow;
use crate::solver;
use crate::study::{Continue, Growth, Job, Study};
use crate::sweep::error::SweepError;
use crate::sweep::plan::{Added, added_jobs};
use crate::sweep::rows::report_row;
use crate::worker::Planner;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use std::collections::{BTreeMap, HashSet};

/// Plans the waves of studies that grow.
#[derive(Debug)]
struct GrowthPlanner;

/// The planner of this program, for [`WorkOptions`](crate::worker::WorkOptions).
pub static PLANNER: &dyn Planner = &GrowthPlanner;

impl Planner for GrowthPlanner {
    fn plan(&self, claim: &PlanClaim, rows: &[StudyRow]) -> Planned {
        plan(claim, rows).unwrap_or_else(|error| Planned::Failed { error: error.to_string() })
    }
}

fn plan(claim: &PlanClaim, rows: &[StudyRow]) -> Result<Planned, SweepError> {
    let rows: Vec<JobRow> =
        rows.par_iter().map(|row| report_row(&claim.study, row)).collect::<Result<_, _>>()?;
    // A wave is a function of all results: without one of them it would be another wave.
    if let Some((job, reason)) = rows.iter().find_map(|row| Some((&row.job, row.unreadable()?))) {
        let error = format!(
            "job {job}: {reason}; `tribosweep retry {} --unreadable` runs it again, and then the study goes on",
            claim.study
        );
        return Ok(Planned::Failed { error });
    }
    let beta_r_s = rows.first().and_then(|row| Some(row.numerics.as_ref()?.beta_r_s));
    let study = Study::parse_stored(&claim.document, &claim.study, beta_r_s)?;
    let growth = study.growth();
    let added = |why: &str| Added { wave: claim.wave, why: why.to_owned() };
    // Results of two versions, or of two dampings, do not belong to one curve.
    let own: HashSet<String> = study.expand(solver::VERSION)?.into_iter().map(|job| job.key).collect();
    if rows.iter().any(|row| row.wave == 0 && !own.contains(&row.job)) {
        let error =
            "its jobs are those of another version of the solver or of its defaults; submit the study again"
                .to_owned();
        return Ok(Planned::Failed { error });
    }
    if let Some(continues) = &growth.continues {
        return plan_chains(claim, &study, continues, &rows);
    }
    let (wanted, most, most_jobs) = match growth {
        Growth { calibrate: Some(settings), .. } => match calibrate::next(&study, settings, &rows) {
            calibrate::Next::Ended(note) => return Ok(Planned::Complete { note }),
            calibrate::Next::Points(points) => {
                let wanted: Vec<Wanted> = points
                    .into_iter()
                    .map(|parameters| Wanted { urgency: 1.0, parameters, purpose: calibrate::PURPOSE })
                    .collect();
                let most = wanted.len();
                (wanted, most, study.most_jobs().unwrap_or(0))
            }
        },
        Growth { refine: Some(settings), .. } => {
            let (wanted, given_up) = refine::wanted(&study, settings, &rows);
            if wanted.is_empty() {
                let note = match given_up {
                    0 => "all tolerances of the study are met".to_owned(),
                    given_up => {
                        let intervals = count(given_up as u64, "interval");
                        format!(
                            "the rest is known; {intervals} given up, because several jobs inside have no value"
                        )
                    }
                };
                return Ok(Planned::Complete { note });
            }
            let most = settings.wave_jobs.min(settings.most_jobs.saturating_sub(rows.len()));
            (wanted, most, settings.most_jobs)
        }
        Growth { .. } => return Ok(Planned::Complete { note: "the study does not grow".to_owned() }),
    };
    let mut known: HashSet<String> = rows.iter().map(|row| row.job.clone()).collect();
    let mut left = wanted.iter();
    let mut jobs: Vec<NewJob> = Vec::new();
    let mut purposes = BTreeMap::<String, u64>::new();
    // What a limit or the solver refuses makes room for the next point.
    while jobs.len() < most {
        let new =
            |point: &Wanted| Some((study.job_at(&point.parameters, solver::VERSION)?, added(point.purpose)));
        let part: Vec<(Job, Added)> = left
            .by_ref()
            .filter_map(new)
            .filter(|(job, _)| known.insert(job.key.clone()))
            .take(most - jobs.len())
            .collect();
        if part.is_empty() {
            break;
        }
        for (job, purpose) in added_jobs(&claim.study, &part)? {
            *purposes.entry(purpose.to_owned()).or_default() += 1;
            jobs.push(job);
        }
    }
    if jobs.is_empty() {
        let why = if most == 0 {
            format!("the budget of {} is used up", count(most_jobs as u64, "job"))
        } else {
            "no further point is possible".to_owned()
        };
        let still = count(wanted.len() as u64, "further point");
        return Ok(Planned::Complete { note: format!("{why}; {still} would be needed") });
    }
    let words: Vec<String> = purposes.iter().map(|(purpose, jobs)| format!("{purpose}: {jobs}")).collect();
    Ok(Planned::Wave { jobs, note: words.join(", ") })
}

/// The next jobs of chains and kicks.
fn plan_chains(
    claim: &PlanClaim,
    study: &Study,
    continues: &Continue,
    rows: &[JobRow],
) -> Result<Planned, SweepError> {
    let jobs = chains::next_jobs(study, continues, rows)?;
    if jobs.is_empty() {
        let missing = study.most_jobs().unwrap_or(0).saturating_sub(rows.len());
        let stopped = if missing == 0 {
            String::new()
        } else {
            format!("; {} missing, because jobs before them failed", count(missing as u64, "job"))
        };
        return Ok(Planned::Complete { note: format!("all chains have ended{stopped}") });
    }
    let note = format!("{}: {}", chains::PURPOSE, jobs.len());
    let jobs: Vec<(Job, Added)> = jobs
        .into_iter()
        .map(|job| (job, Added { wave: claim.wave, why: chains::PURPOSE.to_owned() }))
        .collect();
    let jobs: Vec<NewJob> = added_jobs(&claim.study, &jobs)?.into_iter().map(|(job, _)| job).collect();
    if jobs.is_empty() {
        return Ok(Planned::Complete { note: "the solver refuses every further job".to_owned() });
    }
    Ok(Planned::Wave { jobs, note })
}
