//! The history of a node in one of several jobs that are compared.

use super::capture::{NodeStep, capture};
use super::inspection::{InspectionError, Options, nodes_of};
use super::nodes::{NodeSelector, ObservedNode};
use super::survey::{Survey, survey};
use crate::spec::JobSpec;
use std::ops::ControlFlow;

/// Number of cycles in a trace.
const CYCLES: f64 = 1.5;

/// A node's history in one of the jobs that are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// The parameter that differs between the jobs, with the value that this job has.
    pub label: String,
    /// The node.
    pub node: ObservedNode,
    /// Time \[s\] at which a cycle starts.
    pub from_s: f64,
    /// Duration \[s\] that is shown from there.
    pub duration_s: f64,
    /// The steps in that time.
    pub steps: Vec<NodeStep>,
}

impl Trace {
    /// Runs a job and keeps the history of each of the nodes over one and a half cycles, from an upward crossing of
    /// N = F. Returns one trace for each node.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn of_job(
        label: &str,
        spec: &JobSpec,
        nodes: &[NodeSelector],
        on_progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Vec<Self>, InspectionError> {
        let nodes = nodes_of(spec, nodes)?;
        let Survey { windows, .. } = survey(spec, Options::default().cycles, on_progress)?;
        // No frames, because nothing is shown of the whole pin.
        let capture = capture(spec, &windows, &nodes, 0, on_progress)?;
        let (from_s, duration_s) = (windows.shown_s[0], CYCLES * windows.period_s);
        let until_s = from_s + duration_s;
        let label = if windows.has_cycles { label.to_owned() } else { format!("{label} (no cycle)") };
        let trace = |(node, mut steps): (ObservedNode, Vec<NodeStep>)| {
            steps.retain(|step| step.time_s >= from_s && step.time_s <= until_s);
            Self { label: label.clone(), node, from_s, duration_s, steps }
        };
        Ok(nodes.into_iter().zip(capture.nodes).map(trace).collect())
    }
}
