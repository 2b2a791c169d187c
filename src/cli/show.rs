//! `tribosweep show`: all that is known of a job, and what its result was made with.

use super::error::CliError;
use super::output::{block_on, print};
use super::rows;
use crate::exit;
use crate::queue::{JobDetails, Location, StudyDocument};
use serde_json::{Value, json};

/// Arguments of `show`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The job's key, as in the export, or the first characters of it.
    job: String,
}

/// Prints the job as JSON.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let (jobs, studies) = block_on(async {
        let mut queue = rows::open(db).await?;
        // Two are enough to know that there are several.
        let jobs = queue.jobs(&args.job, 2).await?;
        let mut studies = Vec::new();
        for name in jobs.first().map_or(&[][..], |job| &job.studies) {
            // It may have been removed in between.
            studies.extend(queue.study(name).await?);
        }
        queue.close().await?;
        Ok((jobs, studies))
    })?;
    let job = match jobs.as_slice() {
        [job] => job,
        // A key may be the beginning of another.
        [job, _] if job.key == args.job => job,
        [] => {
            let job = &args.job;
            return Err(CliError::Plan(format!(
                "no job's key begins with `{job}`; `tribosweep export` lists keys"
            )));
        }
        [one, other, ..] => {
            return Err(CliError::Plan(format!(
                "several jobs begin with `{}`: {}, {}, …; give more of the key",
                args.job, one.key, other.key
            )));
        }
    };
    print(&format!("{:#}\n", describe(job, &studies)))?;
    Ok(exit::SUCCESS)
}

fn describe(job: &JobDetails, studies: &[StudyDocument]) -> Value {
    let study = |study: &StudyDocument| json!({ "name": study.name, "submitted_ms": study.submitted_ms, "document": as_json(&study.document) });
    json!({
        "job": job.key,
        "studies": studies.iter().map(study).collect::<Vec<_>>(),
        "state": job.state.as_str(),
        "attempt": job.attempt,
        "crashes": job.crashes,
        "priority": job.priority,
        "cost": job.cost,
        "batch": job.batch,
        "note": job.note,
        "error": job.error,
        "wall_s": job.wall_s,
        "started_ms": job.started_ms,
        "finished_ms": job.finished_ms,
        "provenance": job.provenance.as_deref().map(as_json),
    })
}

/// What is not JSON, or what another version wrote in another form, is shown as it is.
fn as_json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|_| Value::from(text))
}
