//! Stops a run that diverges.

use super::energy::Energies;
use super::error::SolverError;
use super::field::Field;
use super::model::Model;
use super::state::{Drive, State};

/// Stored energy may exceed all energy put in by this factor before a run counts as diverged.
///
/// A stable run never stores more than was put in, up to the factor 1/(1 − (Δt/Δt_limit)²) by which
/// ½vMv + ½uKu of the highest mode exceeds the scheme's own energy; a diverging one passes any
/// factor within a few hundred steps.
const ENERGY_FACTOR: f64 = 1.0e4;

/// Energy [J] that is in proportion before any work was done: the pin's static compression under
/// the full load, F²h/(2EA), and its motion with the target, ½MV².
fn scene_scale_j(model: &Model, drive: &Drive) -> f64 {
    let [lx, ly, lz] = model.mesh().size_m();
    let compression = drive.force_n.powi(2) * lz / (2.0 * model.material().young_modulus_pa * lx * ly);
    let surface =
        model.slaves().iter().map(|s| s.surface_motion[0].hypot(s.surface_motion[1])).fold(0.0, f64::max);
    let mass: f64 = model.masses_kg().iter().sum();
    compression + 0.5 * mass * (surface * drive.rate).powi(2)
}

/// Checks a lane of `state` against its `energies` at the last audit.
///
/// # Errors
/// [`SolverError::Diverged`] if the energy is not finite or out of all proportion.
pub fn check<const L: usize>(
    model: &Model,
    drive: &Drive,
    state: &State<L>,
    lane: usize,
    energies: &Energies,
) -> Result<(), SolverError> {
    let stored = energies.kinetic_j + energies.elastic_j;
    let input = energies.input_j();
    // `<=` is false for NaN: a non-finite energy is caught, too.
    if stored.abs() <= ENERGY_FACTOR * (input + scene_scale_j(model, drive)) {
        return Ok(());
    }
    let what = if stored.is_finite() && input.is_finite() {
        format!("stored energy {stored:.3e} J against {input:.3e} J put in")
    } else {
        NOT_FINITE.to_owned()
    };
    Err(diverged(model, state, lane, what))
}

/// Checks that every displacement and velocity of a lane is finite, at the end of a run.
///
/// # Errors
/// [`SolverError::Diverged`] if one is not.
pub fn check_finite<const L: usize>(model: &Model, state: &State<L>, lane: usize) -> Result<(), SolverError> {
    let finite = |field: &Field<L>| field.values().skip(lane).step_by(L).all(f64::is_finite);
    if finite(&state.u) && finite(&state.p) {
        Ok(())
    } else {
        Err(diverged(model, state, lane, NOT_FINITE.to_owned()))
    }
}

const NOT_FINITE: &str = "displacements or velocities are no longer finite";

fn diverged<const L: usize>(model: &Model, state: &State<L>, lane: usize, what: String) -> SolverError {
    let node = worst_node(model, state, lane);
    let ratio = model.time_step_s() / model.time_step_limit_s();
    let cause = if ratio > 1.0 {
        format!("the time step is {ratio:.4} of the stability limit; reduce it")
    } else {
        format!(
            "the time step is {ratio:.4} of the stability limit, so the integrator is not the cause: \
             look for extreme material, load or friction values in this job"
        )
    };
    SolverError::Diverged {
        step: state.step,
        time_s: state.step as f64 * model.time_step_s(),
        node,
        position_m: model.mesh().coordinates_m(node),
        what,
        cause,
    }
}

/// The node with a non-finite velocity, or else the largest one.
fn worst_node<const L: usize>(model: &Model, state: &State<L>, lane: usize) -> usize {
    let speed_squared = |node: usize| -> f64 {
        let sum: f64 = (0..3).map(|c| state.p[(3 * node + c) * L + lane].powi(2)).sum();
        if sum.is_nan() { f64::INFINITY } else { sum }
    };
    (0..model.mesh().node_count())
        .max_by(|&a, &b| speed_squared(a).total_cmp(&speed_squared(b)).then(b.cmp(&a)))
        .unwrap_or(0)
}
