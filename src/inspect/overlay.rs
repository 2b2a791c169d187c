//! The same node in several jobs.

use super::capture::{NodeStep, capture};
use super::figures;
use super::look::{LookError, Options, nodes_of};
use super::place::{ObservedNode, Place};
use super::survey::{Survey, survey};
use super::tables::{csv, history_header, history_line};
use crate::publish::value::number;
use crate::publish::{Folder, PublishError};
use crate::spec::JobSpec;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// So many cycles are laid over each other.
const CYCLES: f64 = 1.5;

/// A node's history in one of the jobs.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// What tells the job from the others.
    pub label: String,
    /// The node.
    pub node: ObservedNode,
    /// Where a cycle begins [s].
    pub from_s: f64,
    /// What is shown from there [s].
    pub duration_s: f64,
    /// The steps.
    pub steps: Vec<NodeStep>,
}

impl Trace {
    /// Runs a job and keeps the histories of the nodes over one and a half cycles from where N rises through F, one for
    /// each node.
    ///
    /// # Errors
    /// [`LookError`].
    pub fn of_job(
        label: &str,
        spec: &JobSpec,
        places: &[Place],
        go_on: &mut impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Vec<Self>, LookError> {
        let nodes = nodes_of(spec, places)?;
        let Survey { windows, .. } = survey(spec, Options::default().cycles, go_on)?;
        // No frames: nothing is shown of the pin.
        let capture = capture(spec, &windows, &nodes, 0, go_on)?;
        let (from_s, duration_s) = (windows.shown_s[0], CYCLES * windows.period_s);
        let until_s = from_s + duration_s;
        let label = if windows.cycles { label.to_owned() } else { format!("{label} (no cycle)") };
        let trace = |(node, mut steps): (ObservedNode, Vec<NodeStep>)| {
            steps.retain(|step| step.time_s >= from_s && step.time_s <= until_s);
            Self { label: label.clone(), node, from_s, duration_s, steps }
        };
        Ok(nodes.into_iter().zip(capture.nodes).map(trace).collect())
    }
}

/// Writes the figure of one node and its numbers; returns the files. `title` is what the jobs have in common.
///
/// # Errors
/// The first file that could not be written.
pub fn write_overlay(title: &str, traces: &[Trace], out_dir: &Path) -> Result<Vec<PathBuf>, PublishError> {
    let node = traces.first().map_or("", |trace| trace.node.name.as_str());
    let mut folder = Folder::create(out_dir)?;
    let name = format!("figure8_{node}.svg");
    let svg = figures::overlay(title, traces)
        .map_err(|source| PublishError::Figure { path: folder.path_of(&name), source })?;
    folder.text(&name, &svg)?;
    folder.with(&format!("figure8_{node}.csv"), |out| {
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
    Ok(folder.written)
}
