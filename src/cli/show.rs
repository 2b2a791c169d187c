//! `tribosweep show`: all that is known of a job, and what its result was made with.

use super::error::CliError;
use super::output::{block_on, print};
use super::rows;
use crate::exit;
use crate::queue::JobDetails;
use serde_json::{Value, json};
use std::path::Path;

/// Arguments of `show`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The job's key, as in the export, or the first characters of it.
    job: String,
}

/// Prints the job as JSON.
pub fn run(args: &Args, db: &Path) -> Result<u8, CliError> {
    let jobs = block_on(async {
        let mut queue = rows::open(db).await?;
        // Two are enough to know that there are several.
        let jobs = queue.jobs(&args.job, 2).await?;
        queue.close().await?;
        Ok(jobs)
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
    print(&format!("{:#}\n", describe(job)))?;
    Ok(exit::SUCCESS)
}

fn describe(job: &JobDetails) -> Value {
    // What another version wrote in another form is shown as it is.
    let provenance = job
        .provenance
        .as_ref()
        .map(|text| serde_json::from_str::<Value>(text).unwrap_or_else(|_| Value::from(text.as_str())));
    json!({
        "job": job.key,
        "studies": job.studies,
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
        "provenance": provenance,
    })
}
