//! Jobs that failed, that did not become periodic or as exact as they ask for, that go on yielding, or that are missing: where they are in
//! the grid, and why.

use crate::analysis::{Outcome, PlasticFlow};
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
    blocks.extend(list("Accuracy not reached", rows, not_accurate));
    blocks.extend(list("Still yielding", rows, yields));
    blocks.extend(list("Missing jobs", rows, missing));
    (!blocks.is_empty()).then(|| Section::new("trouble", "Trouble", blocks))
}

/// A table of the rows for which `why` returns a reason.
fn list(heading: &str, rows: &[JobRow], why: fn(&JobRow) -> Option<Text>) -> Vec<Block> {
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
        "{}; after {} μ* = {} over {} cycles",
        trouble::cause(row)?.why,
        value::quantity(record.simulated_s, "s"),
        MU_STAR.text_with_error(record.mu_star, Some(record.mu_star_se)),
        record.cycles
    );
    Some(words.into())
}

fn not_accurate(row: &JobRow) -> Option<Text> {
    let record = row.record().filter(|record| record.accuracy_reached == Some(false))?;
    let words = match record.mesh_error() {
        Ok(_) if record.start.is_none() => "there is no coarser mesh to compare with".to_owned(),
        Ok(own) => format!(
            "the error of μ* may be {}, {} % of it",
            value::significant(own.mu_star, 2),
            value::significant(100.0 * own.mu_star / record.mu_star.abs(), 2)
        ),
        Err(why) => format!("the error of μ* is unknown: {}", why.reason()),
    };
    Some(words.into())
}

/// A job that goes on yielding.
fn yields(row: &JobRow) -> Option<Text> {
    let flow = row.record()?.plastic.filter(PlasticFlow::is_yielding)?;
    let words = format!(
        "the plastic work is {} % of the sum of it and the work of friction in the window, and the shape of the pin may go on changing; the largest plastic strain is {}",
        value::significant(100.0 * flow.share, 2),
        value::significant(flow.strain_max, 2)
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
