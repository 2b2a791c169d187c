//! `tribosweep status`: how far the studies are.

use super::error::CliError;
use super::output::{block_on, print};
use super::rows;
use crate::analysis::Outcome;
use crate::exit;
use crate::queue::{Counts, Queue};
use crate::report::{Row, RowState};
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

async fn one(queue: &mut Queue, name: &str, as_json: bool) -> Result<String, CliError> {
    let rows = rows::read(queue, name).await?;
    let counts = queue.counts(&crate::queue::Scope::Study(name.to_owned())).await?;
    let not_periodic =
        rows.iter().filter(|row| row.record().is_some_and(|r| r.outcome == Outcome::NotPeriodic)).count();
    let failures: Vec<(&Row, &str)> = rows
        .iter()
        .filter_map(|row| match &row.state {
            RowState::Failed { error } => Some((row, error.as_str())),
            _ => None,
        })
        .collect();
    if as_json {
        let failed: Vec<Value> = failures
            .iter()
            .map(|(row, error)| json!({ "job": row.job, "parameters": parameters(row), "error": error }))
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
    for (row, error) in failures.iter().take(LISTED) {
        let _ = writeln!(text, "failed: {} ({}): {error}", row.job, parameters(row));
    }
    if failures.len() > LISTED {
        let _ = writeln!(text, "… and {} more failures", failures.len() - LISTED);
    }
    if counts.pending + counts.running > 0 {
        text.push_str("continue with `tribosweep work`\n");
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
