//! Where in the grid jobs fail or do not become periodic, and why.
//!
//! Jobs in trouble for the same cause that are neighbours in the grid are one region, which is told by the values that
//! its parameters take, with how many of the jobs there are in it.

mod cause;
mod grid;

pub use cause::{Cause, cause};
pub use grid::{Grid, Region, Regions};

use super::row::JobRow;
use std::fmt::Write;

/// So many regions are told one by one.
pub const LISTED: usize = 12;

/// The regions of a study's rows.
pub fn regions(rows: &[JobRow]) -> Regions {
    let mut grid = Grid::default();
    for row in rows {
        grid.add(row.omega_rpm, row.mu, &row.parameters);
    }
    let troubled = rows.iter().enumerate();
    grid.regions(troubled.filter_map(|(place, row)| Some((place, row.job.clone(), cause(row)?))), LISTED)
}

/// All regions in sentences.
pub fn sentences(regions: &Regions) -> Vec<String> {
    let mut sentences: Vec<String> = regions.largest.iter().map(sentence).collect();
    if regions.more > 0 {
        sentences.push(format!("and {} more jobs in {} smaller regions", regions.jobs_in_more, regions.more));
    }
    sentences
}

/// A region in a sentence.
fn sentence(region: &Region) -> String {
    let Region { jobs, of, place, cause, example } = region;
    let mut text = format!("{}: {jobs}", cause.what);
    if jobs != of {
        let _ = write!(text, " of {of}");
    }
    text += if *of == 1 { " job" } else { " jobs" };
    if !place.is_empty() {
        let _ = write!(text, " at {place}");
    }
    // On one line.
    let _ = write!(text, ": {}", cause.why.split_whitespace().collect::<Vec<_>>().join(" "));
    if *jobs > 1 {
        let _ = write!(text, " (job {example}, for example)");
    } else {
        let _ = write!(text, " (job {example})");
    }
    text
}
