//! What a worker asks when a wave of a study is due.

use super::{chains, refine};
use crate::publish::value::count;
use crate::queue::{PlanClaim, Planned, StudyRow};
use crate::report::JobRow;
use crate::solver;
use crate::study::{Job, Study};
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
    let study = Study::parse_stored(&claim.document, &claim.study)?;
    let rows: Vec<JobRow> =
        rows.par_iter().map(|row| report_row(&claim.study, row)).collect::<Result<_, _>>()?;
    let growth = study.growth();
    if let Some(continues) = &growth.continues {
        let jobs = chains::next_jobs(&study, continues, &rows)?;
        if jobs.is_empty() {
            let missing = study.most_jobs().unwrap_or(0).saturating_sub(rows.len());
            let stopped = if missing == 0 {
                String::new()
            } else {
                format!("; {} missing, because jobs before them failed", count(missing as u64, "job"))
            };
            return Ok(Planned::Complete { note: format!("all chains have ended{stopped}") });
        }
        let note = format!("{} that continue others", count(jobs.len() as u64, "job"));
        let whys = vec!["continues its neighbour".to_owned(); jobs.len()];
        return wave(claim, &jobs, whys, note);
    }
    let Some(settings) = &growth.refine else {
        return Ok(Planned::Complete { note: "the study does not grow".to_owned() });
    };
    let wanted = refine::wanted(settings, &rows);
    if wanted.is_empty() {
        return Ok(Planned::Complete { note: "everything is known as well as it is asked for".to_owned() });
    }
    let mut known: HashSet<String> = rows.iter().map(|row| row.job.clone()).collect();
    let most = settings.wave_jobs.min(settings.most_jobs.saturating_sub(rows.len()));
    let (mut jobs, mut whys, mut purposes) = (Vec::new(), Vec::new(), BTreeMap::<&str, u64>::new());
    for point in &wanted {
        if jobs.len() == most {
            break;
        }
        // What a limit forbids is not asked for, and neither is what is there.
        let Some(job) = study.job_at(&point.parameters, solver::VERSION) else { continue };
        if known.insert(job.key.clone()) {
            *purposes.entry(point.purpose).or_default() += 1;
            whys.push(point.purpose.to_owned());
            jobs.push(job);
        }
    }
    if jobs.is_empty() {
        let why = if most == 0 {
            format!("the budget of {} is used up", count(settings.most_jobs as u64, "job"))
        } else {
            "no further point is possible".to_owned()
        };
        let still = count(wanted.len() as u64, "further point");
        return Ok(Planned::Complete { note: format!("{why}; {still} would be needed") });
    }
    let words: Vec<String> = purposes.iter().map(|(purpose, jobs)| format!("{purpose}: {jobs}")).collect();
    wave(claim, &jobs, whys, words.join(", "))
}

fn wave(claim: &PlanClaim, jobs: &[Job], whys: Vec<String>, note: String) -> Result<Planned, SweepError> {
    let jobs = added_jobs(&claim.study, jobs, &Added { wave: claim.wave, whys })?;
    if jobs.is_empty() {
        return Ok(Planned::Complete { note: "the solver refuses every further point".to_owned() });
    }
    Ok(Planned::Wave { jobs, note })
}
