//! The second of the two runs, which is the same to the last bit. It records everything in the time that is shown.

use super::low_pass::zero_phase_low_pass;
use super::nodes::ObservedNode;
use super::survey::TimeWindows;
use crate::analysis::sample::{NodeSample, Sample};
use crate::analysis::{self, JobError, JobObserver, JobRecord, Moment};
use crate::solver::Model;
use crate::solver::energy::Energies;
use crate::spec::JobSpec;
use std::collections::VecDeque;
use std::ops::ControlFlow;

/// Largest number of steps whose totals are recorded: the last ones.
pub(super) const MAX_TOTALS: usize = 1 << 20;

/// What the second run recorded.
#[derive(Debug, Clone)]
pub struct Capture {
    /// The record, which is that of the first run.
    pub record: JobRecord,
    /// The model of the job.
    pub model: Model,
    /// The gain of the low-pass filter that the job applies to stresses, 1 − exp(−Δt/τ).
    pub stress_gain: f64,
    /// Totals of every step from [`TimeWindows::totals_from_s`] on, or of the last million.
    pub totals: Vec<Sample>,
    /// For every observed node, its steps in [`TimeWindows::shown_s`].
    pub nodes: Vec<Vec<NodeStep>>,
    /// The contact face at every step of [`TimeWindows::cycle_s`].
    pub face: Vec<FaceStep>,
    /// The energies at every audit of that cycle.
    pub audits: Vec<Audit>,
    /// The pin at equally spaced times of that cycle.
    pub frames: Vec<Frame>,
}

/// The energies at an audit of the energy balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Audit {
    /// t_n \[s\].
    pub time_s: f64,
    /// Energies \[J\] at t_n.
    pub energies: Energies,
}

/// One observed node during one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeStep {
    /// t_n \[s\].
    pub time_s: f64,
    /// Displacement, velocity, force and state.
    pub node: NodeSample,
    /// Contact stress \[Pa\]: friction in x and y, and normal stress, after a zero-phase low-pass filter.
    pub stress_pa: [f64; 3],
}

/// All contact nodes during one step.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceStep {
    /// t_n \[s\].
    pub time_s: f64,
    /// The slave nodes in their order.
    pub nodes: Vec<NodeSample>,
}

/// The pin at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// t_n \[s\].
    pub time_s: f64,
    /// Displacements \[m\] after the step, in the order node → component.
    pub u_m: Vec<f64>,
    /// Velocities [m/s] over the step, in the same order.
    pub velocity_m_s: Vec<f64>,
    /// Stress \[Pa\] at the nodes.
    pub stress_pa: Vec<[f64; 6]>,
    /// Plastic strain at the nodes; none if no material yields.
    pub plastic_strain: Option<Vec<f64>>,
    /// The contact face during the step.
    pub face: Vec<NodeSample>,
}

/// Runs the job again and records `nodes`, the contact face and, at `frames` times, the whole pin.
///
/// # Errors
/// Those of [`analysis::solve`].
///
/// # Panics
/// If the run has no step, which no job can be short enough for.
pub fn capture(
    spec: &JobSpec,
    windows: &TimeWindows,
    nodes: &[ObservedNode],
    frames: usize,
    on_progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Capture, JobError> {
    let mut recorder = Recorder {
        windows,
        nodes,
        frame_times_s: frame_times_s(windows, frames),
        model: None,
        gain: 0.0,
        totals: VecDeque::new(),
        histories: vec![Vec::new(); nodes.len()],
        face: Vec::new(),
        energies: Energies::default(),
        audits: Vec::new(),
        frames: Vec::new(),
        on_progress,
    };
    let record = analysis::solve(spec, &mut recorder)?;
    let model = recorder.model.expect("a run has a step");
    let histories = nodes.iter().zip(recorder.histories);
    let history = |(node, steps): (&ObservedNode, Vec<(f64, NodeSample)>)| {
        node_steps(steps, model.slaves()[node.slave].area_m2, recorder.gain)
    };
    Ok(Capture {
        record,
        stress_gain: recorder.gain,
        totals: recorder.totals.into(),
        nodes: histories.map(history).collect(),
        model,
        face: recorder.face,
        audits: recorder.audits,
        frames: recorder.frames,
    })
}

/// Adds the stresses to the history of a node.
fn node_steps(steps: Vec<(f64, NodeSample)>, area_m2: f64, gain: f64) -> Vec<NodeStep> {
    let [x, y, n] = [0, 1, 2].map(|c| {
        let raw: Vec<f64> = steps.iter().map(|(_, node)| node.force_n[c] / area_m2).collect();
        zero_phase_low_pass(&raw, gain)
    });
    let steps = steps.into_iter().enumerate();
    steps.map(|(i, (time_s, node))| NodeStep { time_s, node, stress_pa: [x[i], y[i], n[i]] }).collect()
}

/// The times of the frames [s], latest first.
fn frame_times_s(windows: &TimeWindows, frames: usize) -> Vec<f64> {
    let [start_s, end_s] = windows.cycle_s;
    (0..frames).rev().map(|k| start_s + (end_s - start_s) * k as f64 / frames as f64).collect()
}

struct Recorder<'a> {
    windows: &'a TimeWindows,
    nodes: &'a [ObservedNode],
    frame_times_s: Vec<f64>,
    model: Option<Model>,
    gain: f64,
    totals: VecDeque<Sample>,
    histories: Vec<Vec<(f64, NodeSample)>>,
    face: Vec<FaceStep>,
    /// The energies at the last audit.
    energies: Energies,
    audits: Vec<Audit>,
    frames: Vec<Frame>,
    on_progress: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl JobObserver for Recorder<'_> {
    fn needs_run(&self) -> bool {
        true
    }

    fn step(&mut self, moment: &Moment<'_>) {
        let time_s = moment.sample.time_s;
        let within = |[start_s, end_s]: [f64; 2]| time_s >= start_s && time_s < end_s;
        if self.model.is_none() {
            self.model = Some(moment.model.clone());
            self.gain = moment.nodes.stress_gain();
        }
        let is_audit = *moment.energies != self.energies;
        self.energies = *moment.energies;
        if time_s >= self.windows.totals_from_s {
            if self.totals.len() == MAX_TOTALS {
                self.totals.pop_front();
            }
            self.totals.push_back(*moment.sample);
        }
        if within(self.windows.shown_s) {
            for (observed, history) in self.nodes.iter().zip(&mut self.histories) {
                let slave = observed.slave;
                let node = moment.nodes.slave(slave);
                history.push((time_s, node));
            }
        }
        if !within(self.windows.cycle_s) {
            return;
        }
        self.face.push(FaceStep { time_s, nodes: face_of(moment) });
        if is_audit {
            self.audits.push(Audit { time_s, energies: self.energies });
        }
        let due = |next_s: &mut f64| time_s >= *next_s;
        if self.frame_times_s.pop_if(due).is_some() {
            // A cycle may have fewer steps than frames.
            while self.frame_times_s.pop_if(due).is_some() {}
            let (pin, u_m, history) = (moment.model.pin(), moment.nodes.u_m(), moment.nodes.history());
            self.frames.push(Frame {
                time_s,
                stress_pa: pin.nodal_stress_pa(&u_m, &history),
                plastic_strain: pin.nodal_plastic_strain(&history),
                u_m,
                velocity_m_s: moment.nodes.velocity_m_s(),
                face: face_of(moment),
            });
        }
    }

    fn progress(&mut self, simulated_s: f64) -> ControlFlow<()> {
        (self.on_progress)(simulated_s)
    }
}

fn face_of(moment: &Moment<'_>) -> Vec<NodeSample> {
    (0..moment.model.slaves().len()).map(|slave| moment.nodes.slave(slave)).collect()
}
