//! `tribosweep status`: how far the studies are.

use super::error::CliError;
use super::outlook::{self, Outlook};
use super::output::{self, block_on, print};
use super::planning::RowParameters;
use super::{rows, workers};
use crate::analysis::Outcome;
use crate::exit;
use crate::queue::{Counts, Location, Queue, Rows, Scope};
use crate::report::overview::overview;
use crate::report::trouble::{Grid, MAX_LISTED, Region, Regions, cause, sentences};
use crate::report::{JobRow, RowState};
use serde_json::{Value, json};
use std::fmt::Write;

/// Studies with more jobs are told in numbers alone: reading their records takes longer than looking at them is worth.
const SHOWN: u64 = 2_000;

/// Arguments of `status`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study's name or file; all studies when left out.
    study: Option<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Shows the state of one or all studies.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
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
    print(&output::coloured(text))?;
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
    let mut text = studies.iter().fold(String::new(), |mut text, study| {
        let _ = writeln!(text, "{:width$}  {}", study.name, counts_text(study.counts));
        text
    });
    text.push_str(&workers::in_words(&queue.workers().await?, output::width()));
    Ok(text)
}

/// The rows of a study that are in trouble. Of all others only the parameters are read: records are most of a study.
struct Trouble {
    failed: Vec<JobRow>,
    not_periodic: usize,
    regions: Regions,
}

async fn find(queue: &mut Queue, name: &str) -> Result<Trouble, CliError> {
    let mut grid = Grid::default();
    let mut unreadable = None;
    let read = queue.each_parameters(name, |text| match serde_json::from_str::<RowParameters>(text) {
        Ok(row) => grid.add(row.omega_rpm, row.mu, &row.grid),
        Err(error) => _ = unreadable.get_or_insert(error),
    });
    read.await?;
    if let Some(error) = unreadable {
        return Err(CliError::Unreadable(format!(
            "the parameters of {name} were written by another version of tribosweep ({error}); submit the study to a \
             new database"
        )));
    }
    let (mut troubled, mut failed) = (Vec::new(), Vec::new());
    let mut note = |place: u64, row: &JobRow| {
        troubled.extend(cause(row).map(|cause| (place as usize, row.job.clone(), cause)));
    };
    rows::each(queue, name, Rows::Failed, |place, row| {
        note(place, &row);
        failed.push(row);
        Ok(())
    })
    .await?;
    let not_periodic = Rows::Done(Outcome::NotPeriodic.name());
    rows::each(queue, name, not_periodic, |place, row| {
        note(place, &row);
        Ok(())
    })
    .await?;
    let not_periodic = troubled.len() - failed.len();
    Ok(Trouble { failed, not_periodic, regions: grid.regions(troubled, MAX_LISTED) })
}

async fn one(queue: &mut Queue, name: &str, as_json: bool) -> Result<String, CliError> {
    let trouble = find(queue, name).await?;
    let counts = queue.counts(&Scope::Study(name.to_owned())).await?;
    let outlook = outlook::read(queue, name, counts).await?;
    let workers = queue.workers().await?;
    if as_json {
        let mut found = one_json(name, counts, outlook.as_ref(), &trouble);
        found["workers"] = workers::as_json(&workers);
        return Ok(format!("{found}\n"));
    }
    let Trouble { not_periodic, regions, .. } = trouble;
    let mut text = format!("{name}: {}\n", counts_text(counts));
    if let Some(outlook) = &outlook {
        text.push_str(&outlook.in_words(output::width()));
    }
    text.push_str(&workers::in_words(&workers, output::width()));
    if counts.total() <= SHOWN {
        text.push_str(&overview(&rows::read(queue, name).await?, output::width()));
    }
    if not_periodic > 0 {
        let _ = writeln!(text, "{not_periodic} done jobs reached their time limit without becoming periodic");
    }
    for line in sentences(&regions) {
        let _ = writeln!(text, "{line}");
    }
    if counts.pending + counts.running > 0 {
        text.push_str("continue with `tribosweep work`\n");
    }
    if counts.cancelled > 0 {
        let _ = writeln!(text, "bring cancelled jobs back with `tribosweep retry {name}`");
    }
    Ok(text)
}

fn one_json(name: &str, counts: Counts, outlook: Option<&Outlook>, trouble: &Trouble) -> Value {
    let failures: Vec<Value> = trouble
        .failed
        .iter()
        .map(|row| {
            let error = if let RowState::Failed { error } = &row.state { error.as_str() } else { "" };
            json!({ "job": row.job, "parameters": parameters(row), "error": error })
        })
        .collect();
    let regions = trouble.regions.largest.iter();
    let regions: Vec<Value> = regions
        .map(|Region { jobs, of, place, cause, example }| {
            json!({
                "what": cause.what, "jobs": jobs, "of": of, "place": place, "why": cause.why, "example": example
            })
        })
        .collect();
    json!({
        "study": name,
        "jobs": counts_json(counts),
        "outlook": outlook.map(Outlook::json),
        "not_periodic": trouble.not_periodic,
        "failures": failures,
        "regions": regions,
    })
}

fn parameters(row: &JobRow) -> String {
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
