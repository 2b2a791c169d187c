//! `tribosweep show`: one job with its state and the provenance of its result.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::queue::{Location, StudyDocument};
use crate::sweep::{self, StoredJob};
use serde_json::{Value, json};

/// Arguments of `show`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The job's key as in the export, or its first characters.
    job: String,
}

/// Prints the job as JSON.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let job = sweep::block_on(async {
        let mut queue = sweep::open_to_read(db.clone()).await?;
        let job = sweep::find_job(&mut queue, &args.job).await?;
        queue.close().await?;
        Ok::<_, CliError>(job)
    })?;
    print(&format!("{:#}\n", as_json(&job)))?;
    Ok(exit::SUCCESS)
}

fn as_json(StoredJob { details, studies }: &StoredJob) -> Value {
    let study = |study: &StudyDocument| {
        json!({
            "name": study.name,
            "submitted_ms": study.submitted_ms,
            "document": parsed(&study.document),
        })
    };
    json!({
        "job": details.key,
        "studies": studies.iter().map(study).collect::<Vec<_>>(),
        "state": details.state.as_str(),
        "attempt": details.attempt,
        "crashes": details.crashes,
        "priority": details.priority,
        "cost": details.cost,
        "batch": details.batch,
        "note": details.note,
        "error": details.error,
        "wall_s": details.wall_s,
        "started_ms": details.started_ms,
        "finished_ms": details.finished_ms,
        "provenance": details.provenance.as_deref().map(parsed),
    })
}

/// A text as JSON, or as a string if it is not JSON.
fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|_| Value::from(text))
}
