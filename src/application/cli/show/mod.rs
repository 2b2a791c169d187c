//! `tribosweep show`: one job with its inputs, its result and the provenance of the result.

pub(crate) mod text;

use super::error::CliError;
use super::output::{print, terminal_width};
use crate::exit;
use crate::publish::value::utc_iso;
use crate::queue::Location;
use crate::study::{inputs, json_value};
use crate::sweep::{self, Purpose, StoredJob, StudyOfJob};
use crate::units::printable_lines;
use serde_json::{Map, Value, json};

/// Arguments of `show`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The job's key as in the export, or its first characters.
    job: String,
    /// Print JSON: the job as it was submitted, its inputs by name, its record, and all that is known of its run.
    #[arg(long)]
    json: bool,
}

/// Prints the job.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let job = sweep::with_queue(db, Purpose::Read, async |queue| {
        Ok::<_, CliError>(sweep::find_job(queue, &args.job).await?)
    })?;
    let text =
        if args.json { format!("{:#}\n", as_json(&job)) } else { text::of_job(&job, terminal_width()) };
    // Errors, notes and names may be those of a stranger's database.
    print(printable_lines(&text).as_ref())?;
    Ok(exit::SUCCESS)
}

fn as_json(job: &StoredJob) -> Value {
    let StoredJob { details, studies } = job;
    let study = |StudyOfJob { study, parameters }: &StudyOfJob| {
        json!({
            "name": study.name,
            "submitted_ms": study.submitted_ms,
            "submitted": utc_iso(study.submitted_ms),
            "parameters": parameters.iter().cloned().collect::<Map<_, _>>(),
            "document": json_value(&study.document, &study.name)
                .unwrap_or_else(|_| Value::from(study.document.as_str())),
        })
    };
    let inputs = job.spec().ok().map(|spec| {
        let values =
            inputs(&spec).into_iter().map(|input| (input.parameter.column().to_owned(), input.value));
        values.collect::<Map<_, _>>()
    });
    // A damaged record is not shown: its figures look like any others.
    let unreadable = job.row().ok().and_then(|row| row.unreadable().map(str::to_owned));
    let mut json = json!(details);
    json["studies"] = studies.iter().map(study).collect();
    json["started"] = details.started_ms.map(utc_iso).into();
    json["finished"] = details.finished_ms.map(utc_iso).into();
    json["provenance"] = details.provenance.as_deref().map(parsed).into();
    json["inputs"] = inputs.into();
    json["spec"] = parsed(&details.payload);
    json["record"] = details.record.as_deref().filter(|_| unreadable.is_none()).map(parsed).into();
    json["unreadable"] = unreadable.into();
    json
}

/// A text as JSON, or as a string if it is not JSON.
fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|_| Value::from(text))
}
