//! The estimated cost of a job, to order jobs and to estimate the remaining time.

use crate::spec::{DiskKind, JobSpec, elasticity};

/// Cost of a node of an elastic disk relative to a node of the pin: its rows of K are general ones, and it takes about
/// two stages per step.
const DISK_NODE: f64 = 8.0;

/// Nodes × time steps up to the time limit.
///
/// The step is `safety_factor` × h / `c_p` with the shortest element edge h and the speed `c_p` of
/// pressure waves. A run that stops early costs less, and damping shortens the step: the cost serves
/// comparisons between jobs, it is no prediction.
pub(super) fn node_steps(spec: &JobSpec) -> f64 {
    let pin = &spec.scene.pin;
    let nodes: f64 = pin.elements.iter().map(|&n| n as f64 + 1.0).product();
    let wave_speed =
        elasticity::pressure_wave_speed_m_s(pin.young_modulus_pa, pin.poisson_ratio, pin.density_kg_m3);
    let edges = pin.size_m.iter().zip(pin.elements).map(|(size, n)| size / n as f64);
    let shortest = edges.fold(f64::INFINITY, f64::min);
    let step = spec.numerics.time_step_s.unwrap_or(spec.numerics.safety_factor * shortest / wave_speed);
    let nodes = match spec.scene.disk.kind {
        DiskKind::Rigid => nodes,
        DiskKind::Elastic => {
            nodes + DISK_NODE * spec.scene.disk.ring.estimated_nodes(pin, spec.scene.disk.track_radius_m)
        }
    };
    nodes * (spec.run.limit_s / step).ceil().max(1.0)
}
