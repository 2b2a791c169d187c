//! Where in the grid jobs fail or do not become periodic, and why; and which results should be doubted.
//!
//! Jobs that are in trouble for the same cause and that are neighbours in the grid form a region. A region is described
//! by the ranges of its parameters, and by how many of the jobs within these ranges are in trouble.

mod cause;
mod doubt;
mod grid;

pub use cause::{Cause, cause};
pub(super) use doubt::in_words as doubts_in_words;
pub use doubt::{DOUBTS, Doubt, warnings};
pub use grid::{Grid, Region, Regions};

use super::row::JobRow;
use crate::publish::value;
use std::fmt::Write;

/// Largest number of regions that are described one by one.
pub const MAX_LISTED: usize = 12;

/// The regions of a study.
pub fn regions(rows: &[JobRow]) -> Regions {
    let mut grid = Grid::default();
    let jobs: Vec<&JobRow> = rows.iter().filter(|row| !row.is_measured()).collect();
    for row in &jobs {
        grid.add(&row.parameters);
    }
    let troubled = jobs.iter().enumerate();
    grid.regions(troubled.filter_map(|(index, row)| Some((index, row.job.clone(), cause(row)?))), MAX_LISTED)
}

/// One sentence for each region that is described, and one for the others.
pub fn sentences(regions: &Regions) -> Vec<String> {
    let mut sentences: Vec<String> = regions.largest.iter().map(sentence).collect();
    if regions.omitted > 0 {
        sentences.push(format!(
            "and {} in {}",
            value::count(regions.jobs_in_omitted, "more job"),
            value::count(regions.omitted, "smaller region")
        ));
    }
    sentences
}

/// A region in a sentence of one line.
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
    let _ = write!(text, ": {}", cause.why.split_whitespace().collect::<Vec<_>>().join(" "));
    if *jobs > 1 {
        let _ = write!(text, " (job {example}, for example)");
    } else {
        let _ = write!(text, " (job {example})");
    }
    text
}
