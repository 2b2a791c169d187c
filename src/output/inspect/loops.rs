//! Hysteresis loops: friction over slip and over displacement, and the energies that belong to them.
//!
//! Over a step a node moves by Δ_n relative to the disk and by du_n in space. The solver's energy balance takes the
//! forces at both ends of such an increment with the weights 1 − γ and γ (γ = β₂). The energies here have the same
//! weights, so the friction energies of all nodes add up to the solver's own to rounding. With γ = ½ they are areas by
//! the trapezoidal rule: the area under friction over slip, and the area inside friction over displacement.

use super::capture::{Capture, FaceStep};
use super::inspection::Inspection;
use crate::analysis::sample::{NodeSample, Sample};
use crate::solver::interface::ContactState;
use serde::Serialize;

/// Energies \[J\] of the friction forces over one cycle, at one node or at the whole contact face.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct LoopEnergies {
    /// Dissipated by friction: the area under friction over slip.
    pub friction_j: f64,
    /// Work of friction on the pin: the area inside friction over displacement. Damping and impacts use it up.
    pub into_pin_j: f64,
    /// Work of the disk's motion. On a rigid disk it is the sum of the two others and of what is lost when nodes begin to
    /// stick.
    pub drive_j: f64,
}

/// The energies of an inspection's loops over one cycle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoopSummary {
    /// The observed nodes, averaged over the cycles that are shown.
    pub nodes: Vec<LoopEnergies>,
    /// The whole contact face over the cycle in which it is recorded.
    pub face: LoopEnergies,
    /// A check against the solver's energy balance; none if the cycle has fewer than two audits of it.
    pub audited: Option<AuditedFriction>,
}

/// Friction energy between the first and the last audit of the energy balance in a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AuditedFriction {
    /// The times \[s\] of the two audits.
    pub from_to_s: [f64; 2],
    /// From the energy balance \[J\].
    pub balance_j: f64,
    /// From the loops of all nodes \[J\].
    pub loops_j: f64,
}

/// A point of a loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopPoint {
    /// t_n \[s\].
    pub time_s: f64,
    /// Displacement \[m\] of the disk relative to the node in y since the cycle began. A node that sticks does not change it.
    pub slip_m: f64,
    /// Displacement in y \[m\]; none at the first step, because it is known from the second one on.
    pub y_m: Option<f64>,
    /// Friction force on the pin in y \[N\].
    pub friction_n: f64,
    /// Contact state; none for the whole face.
    pub state: Option<ContactState>,
    /// Tangential force T at the clamp \[N\]; for the whole face only.
    pub clamp_n: Option<f64>,
}

fn dot([fx, fy, _]: [f64; 3], [x, y]: [f64; 2]) -> f64 {
    fx * x + fy * y
}

/// Energy dissipated by friction over the increment of the step `now`. A force does it only if its node slips: at a node
/// that sticks the balance counts the work as contact loss.
fn friction_j(now: &NodeSample, next: &NodeSample, gamma: f64) -> f64 {
    let work = |at: &NodeSample| {
        if at.state == ContactState::Slip { -dot(at.force_n, now.slip_m) } else { 0.0 }
    };
    (1.0 - gamma) * work(now) + gamma * work(next)
}

/// Energies of a node over consecutive steps, which are taken for a closed loop: the first step follows the last one.
/// `velocity_m_s` is that of the target in x and y.
fn closed_loop(steps: &[NodeSample], velocity_m_s: [f64; 2], time_step_s: f64, gamma: f64) -> LoopEnergies {
    let n = steps.len();
    let mut energies = LoopEnergies::default();
    for (at, now) in steps.iter().enumerate() {
        let (before, next) = (&steps[(at + n - 1) % n], &steps[(at + 1) % n]);
        let moved_m = [0, 1].map(|c| now.u_m[c] - before.u_m[c]);
        energies.friction_j += friction_j(now, next, gamma);
        energies.into_pin_j += (1.0 - gamma) * dot(now.force_n, moved_m) + gamma * dot(next.force_n, moved_m);
        energies.drive_j += dot(now.force_n, velocity_m_s) * time_step_s;
    }
    energies
}

impl LoopEnergies {
    fn over(self, cycles: f64) -> Self {
        let Self { friction_j, into_pin_j, drive_j } = self;
        Self { friction_j: friction_j / cycles, into_pin_j: into_pin_j / cycles, drive_j: drive_j / cycles }
    }
}

/// The steps of one node of the contact face.
fn of_slave(face: &[FaceStep], slave: usize) -> Vec<NodeSample> {
    face.iter().map(|step| step.nodes[slave]).collect()
}

/// The energies of all loops.
pub fn summary(inspection: &Inspection) -> LoopSummary {
    let Inspection { capture, survey, observed, .. } = inspection;
    let (model, dt) = (&capture.model, survey.record.time_step_s);
    let gamma = model.scheme().beta2;
    let rate = inspection.disk_rate();
    let velocity_m_s = |slave: usize| model.slaves()[slave].surface_motion.map(|motion| motion * rate);
    let nodes = observed.iter().zip(&capture.nodes).map(|(observed, steps)| {
        let steps: Vec<NodeSample> = steps.iter().map(|step| step.node).collect();
        let cycles = survey.windows.cycle_count as f64;
        closed_loop(&steps, velocity_m_s(observed.node.slave), dt, gamma).over(cycles)
    });
    let mut face = LoopEnergies::default();
    for slave in 0..model.slaves().len() {
        let own = closed_loop(&of_slave(&capture.face, slave), velocity_m_s(slave), dt, gamma);
        face.friction_j += own.friction_j;
        face.into_pin_j += own.into_pin_j;
        face.drive_j += own.drive_j;
    }
    LoopSummary { nodes: nodes.collect(), face, audited: audited(capture, gamma) }
}

/// The friction energy of the face between two audits: of the increments that begin at the first one and end at the last
/// one.
fn audited(capture: &Capture, gamma: f64) -> Option<AuditedFriction> {
    let [first, .., last] = capture.audits.as_slice() else { return None };
    let from = capture.face.iter().position(|step| step.time_s >= first.time_s)?;
    let to = capture.face.iter().position(|step| step.time_s >= last.time_s)?;
    let pairs = capture.face[from..=to].windows(2);
    let loops_j = pairs
        .flat_map(|pair| pair[0].nodes.iter().zip(&pair[1].nodes))
        .map(|(now, next)| friction_j(now, next, gamma))
        .sum();
    let balance_j = last.energies.friction_j - first.energies.friction_j;
    Some(AuditedFriction { from_to_s: [first.time_s, last.time_s], balance_j, loops_j })
}

/// The loop of an observed node over the cycles that are shown. The slip begins at zero in every cycle.
pub fn of_node(inspection: &Inspection, number: usize) -> Vec<LoopPoint> {
    let steps = &inspection.capture.nodes[number];
    let starts_s = cycle_starts_s(inspection);
    let mut points: Vec<LoopPoint> = Vec::with_capacity(steps.len());
    let (mut slip_m, mut started, mut y_m) = (0.0, 0, None);
    for step in steps {
        let now = starts_s.partition_point(|start_s| *start_s <= step.time_s);
        if now != started {
            (slip_m, started) = (0.0, now);
        }
        points.push(LoopPoint {
            time_s: step.time_s,
            slip_m,
            y_m,
            friction_n: step.node.force_n[1],
            state: Some(step.node.state),
            clamp_n: None,
        });
        slip_m -= step.node.slip_m[1];
        y_m = Some(step.node.u_m[1]);
    }
    points
}

/// The starts [s] of the cycles that are shown.
fn cycle_starts_s(inspection: &Inspection) -> Vec<f64> {
    let survey = &inspection.survey;
    if !survey.windows.has_cycles {
        return Vec::new();
    }
    let shown = survey.passages_s.iter().map(|[start_s, _]| *start_s);
    shown
        .filter(|start_s| *start_s >= survey.windows.shown_s[0])
        .step_by(survey.record.crossings_per_cycle)
        .collect()
}

/// The loop of the whole contact face over the recorded cycle: the sum of the friction forces over the mean slip and the
/// mean displacement of the nodes, weighted with their areas.
pub fn of_face(inspection: &Inspection) -> Vec<LoopPoint> {
    let capture = &inspection.capture;
    let slaves = capture.model.slaves();
    let area_m2: f64 = slaves.iter().map(|slave| slave.area_m2).sum();
    let mean = |step: &FaceStep, value: fn(&NodeSample) -> f64| {
        let weighted = step.nodes.iter().zip(slaves).map(|(node, slave)| slave.area_m2 * value(node));
        weighted.sum::<f64>() / area_m2
    };
    let (mut slip_m, mut y_m) = (0.0, None);
    let mut totals = capture.totals.iter();
    let mut points = Vec::with_capacity(capture.face.len());
    for step in &capture.face {
        let total: Option<&Sample> = totals.find(|total| total.time_s >= step.time_s);
        points.push(LoopPoint {
            time_s: step.time_s,
            slip_m,
            y_m,
            friction_n: step.nodes.iter().map(|node| node.force_n[1]).sum(),
            state: None,
            clamp_n: total.map(|total| total.clamp_tangential_n),
        });
        slip_m -= mean(step, |node| node.slip_m[1]);
        y_m = Some(mean(step, |node| node.u_m[1]));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a node that sticks for half of a cycle and slips back for the other half has the energies of a rectangle
    /// on paper: friction f s, nothing into the pin beyond what the disk gave.
    #[test]
    fn energies_are_areas() {
        let (steps, force_n, velocity_m_s, dt) = (400, 2.0, 0.5, 1e-6);
        let half = steps / 2;
        let moved = velocity_m_s * dt;
        let mut y_m = 0.0;
        let cycle: Vec<NodeSample> = (0..steps)
            .map(|at| {
                let sticks = at < half;
                // The node moves with the disk, and then back with the same speed.
                y_m += if sticks { moved } else { -moved };
                NodeSample {
                    u_m: [0.0, y_m, 0.0],
                    slip_m: [0.0, if sticks { 0.0 } else { -2.0 * moved }],
                    force_n: [0.0, if sticks { 0.5 * force_n } else { force_n }, 3.0],
                    state: if sticks { ContactState::Stick } else { ContactState::Slip },
                    ..NodeSample::default()
                }
            })
            .collect();
        let found = closed_loop(&cycle, [0.0, velocity_m_s], dt, 0.5);
        let (slipped_m, reach_m) = (2.0 * moved * half as f64, moved * half as f64);
        // The last increment of the slip ends at a step that sticks. Half of its work is contact loss.
        let lost_j = 0.5 * 2.0 * moved * force_n;
        let exact = [force_n * slipped_m - lost_j, 0.5 * force_n * reach_m - force_n * reach_m];
        // Where the force changes, the trapezoid has the mean of two forces: two corners of a quarter of a step each.
        let corner_j = force_n * moved;
        assert!((found.friction_j - exact[0]).abs() < 1e-12 * exact[0], "{found:?}");
        assert!((found.into_pin_j - exact[1]).abs() <= corner_j, "{found:?} {exact:?}");
        let exact_drive_j = 1.5 * force_n * velocity_m_s * dt * half as f64;
        assert!((found.drive_j - exact_drive_j).abs() < 1e-12 * exact_drive_j, "{found:?}");
    }
}
