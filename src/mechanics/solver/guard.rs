//! Stops a run that diverges.

use super::drive::Drive;
use super::energy::Energies;
use super::error::SolverError;
use super::field::{Field, FieldOf};
use super::interface::solve::RunNumber;
use super::interface::solve::sweeps::{MAX_SWEEPS, TOLERANCE};
use super::model::Model;
use super::state::StateOf;

/// A run counts as diverged if its stored energy exceeds the energy put in by more than this factor.
///
/// The balance of [`energy`](super::energy) is exact, or nearly so with large strains. So no run stores more energy than was put in, unless
/// contact or damping add energy. This happens when the highest mode alternates at the stability limit. The factor 2 leaves
/// room for rounding and for single steps.
const STORED_FACTOR: f64 = 2.0;

/// The same factor for the sum of the magnitudes of the elastic and the kinetic energy.
///
/// Above the limit the scheme still conserves its own energy, in which the kinetic part of an alternating mode is
/// negative. Both parts then grow without bound while their sum stays constant. Below the limit the magnitudes
/// exceed the sum by at most 1/(1 − (Δt/Δt_limit)²), which is 50 at 0.99 of the limit. They reach this only if all
/// the energy is in the highest mode. Beyond twice that, the result is mesh noise.
const MAGNITUDE_FACTOR: f64 = 100.0;

/// Checks a lane of `state` with its `energies` at the last audit.
///
/// # Errors
/// [`SolverError::Diverged`] if the energy is not finite or exceeds one of the two factors above.
pub fn check<const L: usize, R: RunNumber>(
    model: &Model,
    drive: &Drive,
    state: &StateOf<L, R>,
    lane: usize,
    energies: &Energies,
) -> Result<(), SolverError> {
    let stored = energies.kinetic_j + energies.elastic_j;
    let magnitude = energies.kinetic_j.abs() + energies.elastic_j.abs();
    let input = energies.input_j();
    // The energy put in can be zero, so the energy of a static compression is added. Motion with the target needs
    // no allowance: the work of the drive contains its energy.
    let scale = input + model.pin().compression_energy_j(drive.force_n);
    // `<=` is false for NaN, so an energy that is not finite fails as well.
    if stored <= STORED_FACTOR * scale && magnitude <= MAGNITUDE_FACTOR * scale && scale.is_finite() {
        return Ok(());
    }
    if let Some(error) = inverted(model, state, lane) {
        return Err(error);
    }
    let what = if magnitude.is_finite() && scale.is_finite() {
        format!(
            "stored energy {stored:.3e} J (kinetic {:.3e} J, elastic {:.3e} J) against {input:.3e} J put in",
            energies.kinetic_j, energies.elastic_j
        )
    } else {
        NOT_FINITE.to_owned()
    };
    Err(diverged(model, state, lane, what))
}

/// The first check of the stability limit of a pin whose deformation changes it. Later ones follow after as many steps again, up to
/// [`STEPS_PER_CHECK`]. A check costs some 70 steps.
const FIRST_CHECK: u64 = 32;

/// Most steps between two such checks.
const STEPS_PER_CHECK: u64 = 8192;

/// Share of the stability limit of the deformed pin that the safety factor of an error message leaves.
const ADVISED_SHARE: f64 = 0.9;

/// Checks the stability limit of the deformed pin in a lane, in some steps of a run with large strains.
///
/// # Errors
/// [`SolverError::StepOutgrown`] if it is below the time step.
pub fn check_step<const L: usize, R: RunNumber>(
    model: &Model,
    state: &StateOf<L, R>,
    lane: usize,
) -> Result<(), SolverError> {
    let steps = state.steps_done(lane);
    let is_early = steps.is_power_of_two() && (FIRST_CHECK..STEPS_PER_CHECK).contains(&steps);
    let is_due = is_early || steps.is_multiple_of(STEPS_PER_CHECK);
    if !is_due || model.pin().operator().law().is_none() {
        return Ok(());
    }
    let history = state.history.of_lane(lane);
    let Some(limit_s) = model.deformed_limit_s(&displacements(model, state, lane, 0.0), &history) else {
        return Ok(());
    };
    let time_step_s = model.time_step_s();
    if time_step_s <= limit_s {
        return Ok(());
    }
    let advised_s = ADVISED_SHARE * limit_s;
    Err(SolverError::StepOutgrown {
        time_s: steps as f64 * time_step_s,
        limit_s,
        time_step_s,
        advised_s,
        safety_factor: advised_s / model.time_step_limit_s(),
    })
}

/// The displacements of a lane, and u + β_R p with `ahead_s` = β_R.
fn displacements<const L: usize, R: RunNumber>(
    model: &Model,
    state: &StateOf<L, R>,
    lane: usize,
    ahead_s: f64,
) -> Field<1> {
    let of_lane = |field: &FieldOf<L, R>| field.values().skip(lane).step_by(L).collect::<Vec<f64>>();
    let moved = of_lane(&state.u).into_iter().zip(of_lane(&state.p)).map(|(u, p)| u + ahead_s * p);
    Field::from_values(model.mesh().layout(), &moved.collect::<Vec<f64>>())
}

fn inverted<const L: usize, R: RunNumber>(
    model: &Model,
    state: &StateOf<L, R>,
    lane: usize,
) -> Option<SolverError> {
    // Damping has the forces of u + β_R p, which may be inverted before u is.
    let element = [0.0, model.scheme().beta_r_s]
        .into_iter()
        .find_map(|ahead_s| model.pin().inverted_element(&displacements(model, state, lane, ahead_s)))?;
    let step = state.steps_done(lane);
    Some(SolverError::Inverted { element, step, time_s: step as f64 * model.time_step_s() })
}

/// Checks at the end of a run that every displacement and velocity of a lane is finite.
///
/// # Errors
/// [`SolverError::Diverged`] if one of them is not.
pub fn check_finite<const L: usize, R: RunNumber>(
    model: &Model,
    state: &StateOf<L, R>,
    lane: usize,
) -> Result<(), SolverError> {
    let finite = |field: &FieldOf<L, R>| field.values().skip(lane).step_by(L).all(f64::is_finite);
    if finite(&state.u) && finite(&state.p) && state.target.is_finite(lane) {
        Ok(())
    } else {
        Err(diverged(model, state, lane, NOT_FINITE.to_owned()))
    }
}

/// Checks that all contact solves of a lane on an elastic disk have converged.
///
/// # Errors
/// [`SolverError::ContactNotSolved`] if one has not.
pub fn check_contact<const L: usize, R: RunNumber>(
    model: &Model,
    state: &StateOf<L, R>,
    lane: usize,
) -> Result<(), SolverError> {
    let Some(solves) = state.target.solves_of(lane) else { return Ok(()) };
    if solves.failed_step == 0.0 {
        return Ok(());
    }
    Err(SolverError::ContactNotSolved {
        step: solves.failed_step as u64,
        time_s: solves.failed_step * model.time_step_s(),
        sweeps: MAX_SWEEPS,
        residual: solves.residual,
        tolerance: TOLERANCE,
    })
}

/// Above this fraction of the stability limit the time step itself is the likely cause of a divergence.
const AT_THE_LIMIT: f64 = 0.99;

const NOT_FINITE: &str = "displacements or velocities are no longer finite";

fn diverged<const L: usize, R: RunNumber>(
    model: &Model,
    state: &StateOf<L, R>,
    lane: usize,
    what: String,
) -> SolverError {
    let node = worst_node(model, state, lane);
    let ratio = model.time_step_s() / model.time_step_limit_s();
    // The limit itself is allowed; the tolerance covers the rounding of its computation.
    let cause = if ratio > 1.0 + 1.0e-12 {
        format!("the time step is {ratio:.4} of the stability limit; reduce it")
    } else if ratio > AT_THE_LIMIT {
        format!(
            "the time step is {ratio:.6} of the stability limit, where the highest mode alternates undamped and \
             contact can feed it; take at most {AT_THE_LIMIT} of it"
        )
    } else if model.pin().operator().law().is_some() {
        format!(
            "the time step is {ratio:.4} of the stability limit of the undeformed pin: large strains lower it, so give a smaller \
             time step, or look for extreme material, load or friction values in this job"
        )
    } else {
        format!(
            "the time step is {ratio:.4} of the stability limit, so the integrator is not the cause: \
             look for extreme material, load or friction values in this job"
        )
    };
    SolverError::Diverged {
        step: state.steps_done(lane),
        time_s: state.steps_done(lane) as f64 * model.time_step_s(),
        node,
        position_m: model.mesh().coordinates_m(node),
        what,
        cause,
    }
}

/// The node with a velocity that is not finite; if there is none, the node with the largest speed.
fn worst_node<const L: usize, R: RunNumber>(model: &Model, state: &StateOf<L, R>, lane: usize) -> usize {
    let speed_squared = |node: usize| -> f64 {
        let sum: f64 = (0..3).map(|c| state.p[(3 * node + c) * L + lane].to_f64().powi(2)).sum();
        if sum.is_nan() { f64::INFINITY } else { sum }
    };
    (0..model.mesh().node_count())
        .max_by(|&a, &b| speed_squared(a).total_cmp(&speed_squared(b)).then(b.cmp(&a)))
        .unwrap_or(0)
}
