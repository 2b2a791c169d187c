//! The inspection of a job: both runs, and what their data show.

use super::capture::{Capture, FaceStep, capture};
use super::grid::FaceGrid;
use super::nodes::{NodeSelector, ObservedNode};
use super::phases::{Instants, Phase, phases};
use super::spectrum::Spectrum;
use super::survey::{FEWEST_CYCLES, Survey, survey};
use crate::analysis::{JobError, on_final_mesh};
use crate::solver::Model;
use crate::solver::body::pin::PinMesh;
use crate::spec::{JobSpec, StabilityMethod};
use crate::units::rad_per_s_from_rpm;
use std::ops::ControlFlow;

/// What to record of a job.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The nodes whose histories are recorded.
    pub nodes: Vec<NodeSelector>,
    /// Number of cycles that are shown, at least [`Options::FEWEST_CYCLES`].
    pub cycles: usize,
    /// Number of times in a cycle at which the whole pin is recorded, at least [`Options::FEWEST_FRAMES`].
    pub frames: usize,
}

impl Options {
    /// With fewer cycles, the cycle of a node cannot be found.
    pub const FEWEST_CYCLES: usize = FEWEST_CYCLES;
    /// Snapshots are taken from the frames. With fewer frames they would be too far from the instants that they are for.
    pub const FEWEST_FRAMES: usize = 16;
}

impl Default for Options {
    fn default() -> Self {
        Self { nodes: NodeSelector::DEFAULT.to_vec(), cycles: 4, frames: 48 }
    }
}

/// A job cannot be inspected.
#[derive(Debug, thiserror::Error)]
pub enum InspectionError {
    /// A node does not exist.
    #[error("{0}")]
    Node(String),
    /// The job has no record.
    #[error(transparent)]
    Job(#[from] JobError),
}

/// One job in detail.
#[derive(Debug, Clone)]
pub struct Inspection {
    /// The job.
    pub spec: JobSpec,
    /// The first run.
    pub survey: Survey,
    /// The second run.
    pub capture: Capture,
    /// The observed nodes, in the order of [`Capture::nodes`].
    pub observed: Vec<NodeFindings>,
    /// The spectrum of the total normal force over [`Capture::totals`].
    pub spectrum: Spectrum,
}

/// What the history of an observed node shows.
#[derive(Debug, Clone)]
pub struct NodeFindings {
    /// The node.
    pub node: ObservedNode,
    /// Velocity [m/s] of the undeformed target under it, in y.
    pub target_velocity_m_s: f64,
    /// Its contact phases in the time that is shown.
    pub phases: Vec<Phase>,
    /// The instants of a cycle.
    pub instants: Option<Instants>,
}

impl Inspection {
    /// Runs the job twice, and evaluates what the second run recorded.
    ///
    /// `on_progress` gets the simulated time \[s\] of the current run, and can end the run.
    ///
    /// # Errors
    /// [`InspectionError`].
    pub fn run(
        spec: &JobSpec,
        options: &Options,
        on_progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Self, InspectionError> {
        let spec = &on_final_mesh(spec, on_progress)?;
        let nodes = nodes_of(spec, &options.nodes)?;
        // What happens in a run is shown. The eigenvalues of a job may change when it ends.
        let mut simulated = spec.clone();
        if spec.stability == StabilityMethod::Modes {
            simulated.stability = StabilityMethod::Simulate;
        }
        let survey = survey(&simulated, options.cycles.max(Options::FEWEST_CYCLES), on_progress)?;
        let windows = &survey.windows;
        let capture =
            capture(&simulated, windows, &nodes, options.frames.max(Options::FEWEST_FRAMES), on_progress)?;
        let rate = rad_per_s_from_rpm(spec.scene.disk.omega_rpm);
        let observed = nodes
            .into_iter()
            .zip(&capture.nodes)
            .map(|(node, steps)| {
                let end_s = windows.shown_s[1];
                let phases = phases(steps.iter().map(|step| (step.time_s, step.node.state)), end_s);
                let stress: Vec<_> = steps.iter().map(|step| (step.time_s, step.stress_pa[2])).collect();
                let instants = Instants::find(&phases, &stress, windows.shown_s[0], windows.period_s);
                let target_velocity_m_s = rate * capture.model.slaves()[node.slave].surface_motion[1];
                NodeFindings { node, target_velocity_m_s, phases, instants }
            })
            .collect();
        let normal: Vec<f64> = capture.totals.iter().map(|sample| sample.normal_n).collect();
        let spectrum = Spectrum::of(&normal, survey.record.time_step_s);
        Ok(Self { spec: spec.clone(), survey, capture, observed, spectrum })
    }

    /// The rate of the disk \[rad/s\].
    pub(super) fn disk_rate(&self) -> f64 {
        rad_per_s_from_rpm(self.spec.scene.disk.omega_rpm)
    }

    /// The mesh of the pin.
    pub fn mesh(&self) -> &PinMesh {
        self.capture.model.mesh()
    }

    /// Lines of nodes on the contact face.
    pub(super) fn face_grid(&self) -> FaceGrid {
        FaceGrid::new(self.mesh())
    }
}

/// The nodes that are selected, after a check of the job.
pub fn nodes_of(spec: &JobSpec, nodes: &[NodeSelector]) -> Result<Vec<ObservedNode>, InspectionError> {
    spec.check().map_err(JobError::from)?;
    let mesh = Model::mesh_of(&spec.scene).map_err(JobError::from)?;
    nodes
        .iter()
        .map(|selector| selector.resolve(&mesh))
        .collect::<Result<_, _>>()
        .map_err(InspectionError::Node)
}

/// A node's trajectory over the cycle in the y–z plane: y, z displacements [m].
pub fn node_loop(face: &[FaceStep], slave: usize) -> Vec<(f64, f64)> {
    face.iter()
        .map(|step| {
            let [_, y, z] = step.nodes[slave].u_m;
            (y, z)
        })
        .collect()
}

/// Area [m²] inside a closed loop: positive if it is counter-clockwise, seen with y to the right and z upwards.
pub fn loop_area_m2(path: &[(f64, f64)]) -> f64 {
    let next = path.iter().cycle().skip(1);
    path.iter().zip(next).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the area of a counter-clockwise loop is positive, and it does not depend on the position of the loop.
    #[test]
    fn loops_have_a_sense() {
        let circle = |sense: f64| -> Vec<(f64, f64)> {
            (0..400)
                .map(|k| {
                    let angle = sense * f64::from(k) * std::f64::consts::TAU / 400.0;
                    (3.0 + 2.0 * angle.cos(), -1.0 + 2.0 * angle.sin())
                })
                .collect()
        };
        // A polygon of n corners in a circle of radius 2.
        let exact = 0.5 * 400.0 * 4.0 * (std::f64::consts::TAU / 400.0).sin();
        for sense in [1.0, -1.0] {
            assert!((loop_area_m2(&circle(sense)) - sense * exact).abs() < 1e-11);
        }
    }
}
