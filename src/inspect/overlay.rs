//! The same node in several jobs, drawn one over the other.

use super::figures;
use super::tables::{csv, history_header, history_line};
use super::trace::Trace;
use crate::publish::value::number;
use crate::publish::{Folder, PublishError};
use std::path::{Path, PathBuf};

/// Writes the figure and the CSV of one node in several jobs; returns the files. `title` names what the jobs have in
/// common.
///
/// # Errors
/// The first file that could not be written.
pub fn write_overlay(title: &str, traces: &[Trace], out_dir: &Path) -> Result<Vec<PathBuf>, PublishError> {
    let node = traces.first().map_or("", |trace| trace.node.name.as_str());
    let mut folder = Folder::create(out_dir, "overlay")?;
    let name = format!("figure8_{node}.svg");
    let svg = figures::overlay(title, traces)
        .map_err(|source| PublishError::Figure { path: folder.path_of(&name), source })?;
    folder.write_text(&name, &svg)?;
    folder.write_with(&format!("figure8_{node}.csv"), |out| {
        let mut header = vec!["job", "since_cycle_begin_s"];
        header.extend(history_header());
        let lines = traces.iter().flat_map(|trace| {
            trace.steps.iter().map(|step| {
                let since = number(step.time_s - trace.from_s);
                let mut line = vec![trace.label.clone(), since];
                line.extend(history_line(step));
                line
            })
        });
        csv(&header, lines, out)
    })?;
    // The other nodes of the same jobs are in the same folder.
    folder.finish_beside_earlier()
}
