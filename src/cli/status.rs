//! `tribosweep status`: how far the studies are.

use super::error::CliError;
use super::output::{block_on, print};
use super::rows;
use crate::analysis::Outcome;
use crate::exit;
use crate::queue::{Counts, Queue, Scope};
use crate::report::Row;
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

/// What a study's rows tell besides their number.
struct Findings {
    not_periodic: u64,
    failures: Vec<Failure>,
}

/// A failed row, with its parameters in words and the reason.
struct Failure {
    job: String,
    parameters: String,
    error: String,
}

/// Counts in the database: of all that records hold, a word of each is of interest here. A record that cannot be read is
/// the report's to complain about.
async fn find(queue: &mut Queue, name: &str) -> Result<Findings, CliError> {
    let outcomes = queue.recorded(name, "$.outcome").await?;
    let not_periodic = outcomes.into_iter().filter(|(outcome, _)| outcome == Outcome::NotPeriodic.name());
    let not_periodic = not_periodic.map(|(_, rows)| rows).sum();
    let failures = queue.failed_rows(name).await?.into_iter().map(|row| {
        let parameters = parameters(&rows::convert(name, &row)?);
        Ok(Failure { parameters, job: row.key, error: row.error.unwrap_or_default() })
    });
    Ok(Findings { not_periodic, failures: failures.collect::<Result<_, CliError>>()? })
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
