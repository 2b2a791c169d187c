//! `tribosweep status`: the progress of the studies.

use super::DEFAULT_DB;
use super::error::CliError;
use super::output::{self, print};
use super::{outlook, workers};
use crate::exit;
use crate::publish::table::listed;
use crate::publish::value::count;
use crate::queue::{Counts, Location, Queue, Scope, StudySummary};
use crate::report::overview::overview;
use crate::report::trouble::sentences;
use crate::report::{JobRow, RowState};
use crate::sweep::{self, Outlook, Purpose, Trouble};
use serde_json::{Value, json};
use std::fmt::Write;

/// The overview has a letter for each job of a study with at most so many: reading the records of more takes too long.
const LARGEST_OVERVIEW: u64 = 2_000;

/// Arguments of `status`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file; default: all studies.
    study: Option<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Shows the state of one or all studies.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = args.study.as_deref().map(sweep::study_name).transpose()?;
    let text = sweep::with_queue(db, Purpose::Read, async |queue| {
        let text = match &name {
            Some(name) => one_study(queue, name, args.json, db).await,
            None => all_studies(queue, args.json).await,
        }?;
        Ok::<_, CliError>(text)
    })?;
    print(&output::coloured(output::fitted(text)))?;
    Ok(exit::SUCCESS)
}

async fn all_studies(queue: &mut Queue, as_json: bool) -> Result<String, CliError> {
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
    let line = |study: &StudySummary| [study.name.clone(), counts_text(study.counts)];
    let mut text = listed(0, &studies.iter().map(line).collect::<Vec<_>>(), None);
    text.push_str(&workers::as_text(&queue.workers().await?, output::width()));
    Ok(text)
}

async fn one_study(queue: &mut Queue, name: &str, as_json: bool, db: &Location) -> Result<String, CliError> {
    let trouble = Trouble::read(queue, name).await?;
    let counts = queue.counts(&Scope::Study(name.to_owned())).await?;
    let outlook = Outlook::read(queue, name, counts).await?;
    let workers = queue.workers().await?;
    let plan = queue.plan_status(name).await?;
    if as_json {
        let mut json = study_json(name, counts, outlook.as_ref(), &trouble);
        if let Some(plan) = plan {
            let rows = sweep::read_rows(queue, name).await?;
            json["waves"] =
                sweep::read_growth(queue, name, &rows).await?.map(|found| found.waves_json()).into();
            json["plan"] = plan.state.name().into();
        }
        json["workers"] = json!(workers);
        return Ok(format!("{json}\n"));
    }
    let Trouble { not_periodic, regions, .. } = trouble;
    let mut text = format!("{name}: {}\n", counts_text(counts));
    if let Some(outlook) = &outlook {
        text.push_str(&outlook::as_text(outlook, output::width()));
    }
    text.push_str(&workers::as_text(&workers, output::width()));
    let rows = if counts.total() <= LARGEST_OVERVIEW || plan.is_some() {
        sweep::read_rows(queue, name).await?
    } else {
        Vec::new()
    };
    if counts.total() <= LARGEST_OVERVIEW {
        text.push_str(&overview(&rows, output::width()));
    }
    if let Some(findings) = sweep::read_growth(queue, name, &rows).await? {
        text.push_str(&findings.as_text());
    }
    if not_periodic > 0 {
        let jobs = count(not_periodic, "done job");
        let _ = writeln!(text, "{jobs} reached the time limit without becoming periodic");
    }
    for line in sentences(&regions) {
        let _ = writeln!(text, "{line}");
    }
    if counts.pending + counts.running > 0 {
        let _ = writeln!(text, "continue with `tribosweep{} work`", option_of(db));
    }
    if counts.cancelled > 0 {
        let option = option_of(db);
        let _ = writeln!(text, "make cancelled jobs pending again with `tribosweep{option} retry {name}`");
    }
    Ok(text)
}

/// The option with which another command takes the same database; empty if it does without.
fn option_of(db: &Location) -> String {
    let usual = std::env::var("TRIBOSWEEP_DB").unwrap_or_else(|_| DEFAULT_DB.to_owned());
    if *db == Location::parse(usual.into()) {
        return String::new();
    }
    let name = db.to_string();
    format!(" --db {}", shlex::try_quote(&name).unwrap_or(std::borrow::Cow::Borrowed(&name)))
}

fn study_json(name: &str, counts: Counts, outlook: Option<&Outlook>, trouble: &Trouble) -> Value {
    let failures: Vec<Value> = trouble
        .failed
        .iter()
        .map(|row| {
            let error = if let RowState::Failed { error } = &row.state { error.as_str() } else { "" };
            json!({ "job": row.job, "parameters": parameters(row), "error": error })
        })
        .collect();
    json!({
        "study": name,
        "jobs": counts_json(counts),
        "outlook": outlook.map(outlook::as_json),
        "not_periodic": trouble.not_periodic,
        "failures": failures,
        "regions": trouble.regions.largest,
    })
}

fn parameters(row: &JobRow) -> String {
    let list: Vec<String> =
        row.parameters.of_grid().iter().map(|(name, value)| format!("{name} = {value}")).collect();
    list.join(", ")
}

fn counts_text(counts: Counts) -> String {
    let cancelled =
        if counts.cancelled > 0 { format!(", {} cancelled", counts.cancelled) } else { String::new() };
    format!(
        "{}: {} done, {} failed, {} running, {} pending{cancelled}",
        count(counts.total(), "job"),
        counts.done,
        counts.failed,
        counts.running,
        counts.pending
    )
}

fn counts_json(counts: Counts) -> Value {
    let mut json = json!(counts);
    json["total"] = counts.total().into();
    json
}
