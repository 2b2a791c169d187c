//! Jobs that failed, that did not become periodic, whose results should be doubted, or that are missing: where they are in the grid, and why.

use crate::analysis::Outcome;
use crate::publish::page::{Block, Grid, Section, Text};
use crate::publish::value;
use crate::report::layout::parameters_in_words;
use crate::report::row::{JobRow, RowState};
use crate::report::scalar::MU_STAR;
use crate::report::tooltip::short_key;
use crate::report::trouble;

/// Returns `None` if there is no such job.
pub(super) fn section(rows: &[JobRow]) -> Option<Section> {
    let regions = trouble::sentences(&trouble::regions(rows));
    let mut blocks = Vec::new();
    if !regions.is_empty() {
        blocks.push(Block::text("Neighbouring jobs of the grid with the same cause form a region:"));
        blocks.push(Block::list(regions));
    }
    blocks.extend(list("Failed jobs", rows, failed));
    blocks.extend(list("Not periodic", rows, not_periodic));
    for doubt in &trouble::DOUBTS {
        blocks.extend(list(doubt.heading, rows, |row| (doubt.why)(row).map(Text::from)));
    }
    blocks.extend(list("Missing jobs", rows, missing));
    (!blocks.is_empty()).then(|| Section::new("trouble", "Trouble", blocks))
}

/// A table of the rows for which `why` returns a reason.
fn list(heading: &str, rows: &[JobRow], why: impl Fn(&JobRow) -> Option<Text>) -> Vec<Block> {
    let count = rows.iter().filter(|row| why(row).is_some()).count();
    if count == 0 {
        return Vec::new();
    }
    let line = |row: &JobRow| {
        Some(vec![Text::from(parameters_in_words(row)), why(row)?, Text::code(short_key(row))])
    };
    let lines = rows.iter().filter_map(line);
    let grid = Grid::of(&["parameters", "why", "job"], lines, "jobs.csv").with_words();
    vec![Block::Heading(format!("{heading} ({count})")), Block::Table(grid)]
}

fn failed(row: &JobRow) -> Option<Text> {
    match &row.state {
        RowState::Failed { error } => Some(error.into()),
        _ => None,
    }
}

fn not_periodic(row: &JobRow) -> Option<Text> {
    let record = row.record().filter(|record| record.outcome == Outcome::NotPeriodic)?;
    let words = format!(
        "{}; after {} the mean over {} cycles is μ* = {}, whose error is not known",
        trouble::cause(row)?.why,
        value::quantity(record.simulated_s, "s"),
        record.cycles,
        MU_STAR.text(record.mu_star)
    );
    Some(words.into())
}

fn missing(row: &JobRow) -> Option<Text> {
    match &row.state {
        RowState::Pending | RowState::Running | RowState::Cancelled => Some(row.status().into()),
        RowState::Unreadable { reason } => Some(format!("{}: {reason}", row.status()).into()),
        _ => None,
    }
}
