//! `tribosweep status`: how far the studies are.

use super::error::CliError;
use super::output::{block_on, print};
use super::rows;
use crate::analysis::Outcome;
use crate::exit;
use crate::queue::{Counts, JobState, Queue, Scope};
use crate::report::Row;
use serde::Deserialize;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;

/// Arguments of `status`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study's name or file; all studies when left out.
    study: Option<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// So many failures are listed; the rest is counted.
const LISTED: usize = 10;

/// Shows the state of one or all studies.
pub fn run(args: &Args, db: &Path) -> Result<u8, CliError> {
    let name = args.study.as_deref().map(rows::study_name).transpose()?;
    let text = block_on(async {
        let mut queue = rows::open(db).await?;
        let text = match &name {
            Some(name) => one(&mut queue, name, args.json).await,
            None => all(&mut queue, args.json).await,
        }?;
        queue.close().await?;
        Ok(text)
    })?;
    print(&text)?;
    Ok(exit::SUCCESS)
}

async fn all(queue: &mut Queue, as_json: bool) -> Result<String, CliError> {
    let studies = queue.studies().await?;
    if as_json {
        let list: Vec<Value> = studies
            .iter()
            .map(|study| json!({ "study": study.name, "jobs": counts_json(study.counts) }))
            .collect();
        return Ok(format!("{}\n", Value::from(list)));
    }
    if studies.is_empty() {
        return Ok("no studies yet; submit one with `tribosweep submit STUDY`\n".to_owned());
    }
    let width = studies.iter().map(|study| study.name.chars().count()).max().unwrap_or(0);
    Ok(studies.iter().fold(String::new(), |mut text, study| {
        let _ = writeln!(text, "{:width$}  {}", study.name, counts_text(study.counts));
        text
    }))
}

/// What of a record is counted here: reading all of it takes several times as long.
#[derive(Deserialize)]
struct Ended {
    outcome: Outcome,
}

/// What a study's rows tell besides their number.
#[derive(Default)]
struct Findings {
    not_periodic: usize,
    /// Failed rows, with their parameters in words and the reason.
    failures: Vec<Failure>,
}

struct Failure {
    job: String,
    parameters: String,
    error: String,
}

async fn find(queue: &mut Queue, name: &str) -> Result<Findings, CliError> {
    let mut findings = Findings::default();
    let mut unreadable = None;
    let read = queue.each_row(name, |row| match row.state {
        JobState::Failed => match rows::convert(name, &row) {
            Ok(read) => findings.failures.push(Failure {
                parameters: parameters(&read),
                job: row.key,
                error: row.error.unwrap_or_default(),
            }),
            Err(error) => {
                unreadable.get_or_insert(error);
            }
        },
        JobState::Done => {
            // A record that cannot be read is the report's to complain about.
            let ended = row.record.as_deref().map(serde_json::from_str::<Ended>);
            let is_periodic = !matches!(ended, Some(Ok(Ended { outcome: Outcome::NotPeriodic })));
            findings.not_periodic += usize::from(!is_periodic);
        }
        _ => {}
    });
    read.await?;
    unreadable.map_or(Ok(findings), Err)
}

async fn one(queue: &mut Queue, name: &str, as_json: bool) -> Result<String, CliError> {
    let Findings { not_periodic, failures } = find(queue, name).await?;
    let counts = queue.counts(&Scope::Study(name.to_owned())).await?;
    if as_json {
        let failed: Vec<Value> = failures
            .iter()
            .map(|Failure { job, parameters, error }| json!({ "job": job, "parameters": parameters, "error": error }))
            .collect();
        return Ok(format!(
            "{}\n",
            json!({ "study": name, "jobs": counts_json(counts), "not_periodic": not_periodic, "failures": failed })
        ));
    }
    let mut text = format!("{name}: {}\n", counts_text(counts));
    if not_periodic > 0 {
        let _ = writeln!(text, "{not_periodic} done jobs reached their time limit without becoming periodic");
    }
    for Failure { job, parameters, error } in failures.iter().take(LISTED) {
        let _ = writeln!(text, "failed: {job} ({parameters}): {error}");
    }
    if failures.len() > LISTED {
        let _ = writeln!(text, "… and {} more failures", failures.len() - LISTED);
    }
    if counts.pending + counts.running > 0 {
        text.push_str("continue with `tribosweep work`\n");
    }
    if counts.cancelled > 0 {
        let _ = writeln!(text, "bring cancelled jobs back with `tribosweep retry {name}`");
    }
    Ok(text)
}

fn parameters(row: &Row) -> String {
    let list: Vec<String> = row.parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    list.join(", ")
}

fn counts_text(counts: Counts) -> String {
    let cancelled =
        if counts.cancelled > 0 { format!(", {} cancelled", counts.cancelled) } else { String::new() };
    format!(
        "{} jobs: {} done, {} failed, {} running, {} pending{cancelled}",
        counts.total(),
        counts.done,
        counts.failed,
        counts.running,
        counts.pending
    )
}

fn counts_json(counts: Counts) -> Value {
    json!({
        "total": counts.total(),
        "done": counts.done,
        "failed": counts.failed,
        "running": counts.running,
        "pending": counts.pending,
        "cancelled": counts.cancelled,
    })
}
