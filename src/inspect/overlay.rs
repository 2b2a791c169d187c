//! The same node in several jobs.

use super::capture::NodeStep;
use super::figures;
use super::look::{Look, LookError, Observed, Options};
use super::place::ObservedNode;
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
        options: &Options,
        go_on: &mut impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Vec<Self>, LookError> {
        let look = Look::into(spec, options, go_on)?;
        let windows = &look.survey.windows;
        let (from_s, duration_s) = (windows.shown_s[0], CYCLES * windows.period_s);
        let until_s = from_s + duration_s;
        let label = if windows.cycles { label.to_owned() } else { format!("{label} (no cycle)") };
        let trace = |(observed, mut steps): (Observed, Vec<NodeStep>)| {
            steps.retain(|step| step.time_s >= from_s && step.time_s <= until_s);
            Self { label: label.clone(), node: observed.node, from_s, duration_s, steps }
        };
        Ok(look.observed.into_iter().zip(look.capture.nodes).map(trace).collect())
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
