//! The same node in several jobs, drawn one over the other.

use super::capture::NodeStep;
use super::trace::Trace;
use super::{figures, tables};
use crate::publish::table::Column;
#[cfg(feature = "cli")]
use crate::publish::table::FileColumns;
use crate::publish::{Folder, PublishError};
use std::path::{Path, PathBuf};

/// A step of a job: what the job is called, the time \[s\] since a cycle began, and the node.
type Line = (String, f64, NodeStep);

fn columns() -> Vec<Column<Line>> {
    let own = [
        Column::new("job", "", "what the job is called", |(label, ..): &Line| label.as_str().into()),
        Column::new(
            "since_cycle_begin_s",
            "s",
            "time since the beginning of the cycle",
            |(_, since_s, _)| (*since_s).into(),
        ),
    ];
    let history = tables::history().into_iter().map(|column| column.within(|(.., step): &Line| step));
    own.into_iter().chain(history).collect()
}

/// The columns of all files of inspections, for the page of columns.
#[cfg(feature = "cli")]
pub fn columns_of_files() -> Vec<FileColumns> {
    let own = FileColumns::new(
        &["figure8_NODE.csv"],
        "A line is a step of a node in one of several jobs.",
        &columns(),
    );
    tables::described().into_iter().chain([own]).collect()
}

/// Writes the figure and the CSV of one node in several jobs; returns the files. `title` names what the jobs have in
/// common.
///
/// # Errors
/// The first file that could not be written.
pub fn write_overlay(title: &str, traces: &[Trace], out_dir: &Path) -> Result<Vec<PathBuf>, PublishError> {
    let node = traces.first().map_or("", |trace| trace.node.name.as_str());
    let mut folder = Folder::create(out_dir, "overlay")?;
    let chart = figures::overlay(title, traces);
    folder.write_text(&format!("figure8_{node}.svg"), &chart.svg(&chart.title))?;
    let lines = traces.iter().flat_map(|trace| {
        let line = |step: &NodeStep| (trace.label.clone(), step.time_s - trace.from_s, *step);
        trace.steps.iter().map(line)
    });
    folder.write_lines(&format!("figure8_{node}.csv"), &columns(), lines)?;
    // The other nodes of the same jobs are in the same folder.
    folder.finish_beside_earlier()
}
