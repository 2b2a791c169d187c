//! Runs above the true stability limit. The guard must detect their divergence in time.

use crate::stress::modes::{self, Mode};
use crate::stress::scenes::{IDLE, in_the_air, lifted, pin};
use crate::stress::summary;
use serde_json::{Value, json};
use tribosweep_mechanics::analysis;
use tribosweep_mechanics::solver::energy::{Energies, EnergyLedger};
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, SolverError, State, guard, step};
use tribosweep_mechanics::spec::{Clamp, ClampSide, JobSpec};

/// Steps between two checks by the guard, as in a job.
const INTERVAL: u64 = 16;

const FRACTION: f64 = 1.02;

const ELEMENTS: [usize; 3] = [2, 3, 2];

/// β₂ and the damping ½β_Rω of the highest mode.
fn integrators() -> impl Iterator<Item = (f64, f64)> {
    [0.5, 0.75, 1.0].into_iter().flat_map(|beta2| [0.0, 0.01, 1.0].map(|damping| (beta2, damping)))
}

/// Runs with the guard as a job does. Returns the step at which the guard stopped the run, the node and the
/// message.
#[expect(clippy::large_types_passed_by_value, reason = "a test makes one, whose size does not matter")]
fn guarded(model: &Model, drive: Drive, mut state: State<1>, steps: u64) -> Option<(u64, usize, String)> {
    let mut ledger = EnergyLedger::new(model, INTERVAL);
    for n in 0..steps {
        ledger.before_step(model, &state);
        step(model, &[drive], &mut state);
        ledger.after_step(model, &[drive], &state);
        if ledger.audits(n)
            && let Err(error) = guard::check(model, &drive, &state, 0, ledger.energies(0))
        {
            let message = error.to_string();
            let SolverError::Diverged { step, node, .. } = error else { panic!("{message}") };
            return Some((step, node, message));
        }
    }
    None
}

/// The step at which the guard must stop a single mode. The two-term recursion of the mode (`solver::scheme`)
/// replaces the block, and the energies of `solver::energy` replace the ledger.
fn predicted(model: &Model, mode: &Mode, speed_m_s: f64) -> u64 {
    let (dt, gamma, beta_r) = (model.time_step_s(), model.scheme().beta2, model.scheme().beta_r_s);
    let (omega2, mass) = (mode.omega * mode.omega, mode.mass_kg);
    let nowhere = State::<1>::at_rest(model);
    let (mut u, mut p, mut initial_j) = (0.0, speed_m_s, 0.0);
    for n in 0..1_000_000_u64 {
        let a = -omega2 * (u + beta_r * p);
        let v = if n == 0 { p } else { p + gamma * dt * a };
        let kinetic_j = 0.5 * mass * (v * v - 0.5 * gamma * dt * dt * a * a);
        let elastic_j = 0.5 * mass * omega2 * u * u;
        if n == 0 {
            initial_j = kinetic_j + elastic_j;
        }
        let energies = Energies { kinetic_j, elastic_j, initial_j, ..Energies::default() };
        if n % INTERVAL == 0 && guard::check(model, &IDLE, &nowhere, 0, &energies).is_err() {
            return n + 1;
        }
        let (u_factor, p_factor) = if n == 0 { (0.5, 1.0 - gamma) } else { (0.5 + gamma, 1.0) };
        u += dt * p + u_factor * dt * dt * a;
        p += p_factor * dt * a;
    }
    panic!("the mode does not grow: β₂ = {gamma}, β_R = {beta_r}");
}

fn definition(beta2: f64, damping: f64, closed: bool) -> (ModelDefinition, Mode) {
    let undamped = ModelDefinition { beta2, ..pin(ELEMENTS) };
    let mode = modes::highest(&undamped, closed);
    (ModelDefinition { beta_r_s: 2.0 * damping / mode.omega, ..undamped }, mode)
}

/// Protects: at 1.02 of the true limit (not of the program's bound, which is a few percent lower), a free pin
/// in its highest mode is stopped at the very audit that the amplification matrix predicts, for every β₂ and
/// damping. The undamped pin is stopped, too, although the scheme conserves its energy while it diverges.
#[test]
fn a_free_pin_is_stopped_when_it_must_be() {
    let mut lines = Vec::new();
    for (beta2, damping) in integrators() {
        let (free, mode) = definition(beta2, damping, false);
        let model = modes::at_fraction(&in_the_air(free), &mode, FRACTION).unwrap();
        // The pin starts undeformed with a velocity, so that its whole energy is there for the comparison.
        // Its amplitude of v/ω = 1 nm may grow a thousandfold before the pin reaches the plane.
        let speed_m_s = 1.0e-9 * mode.omega;
        let predicted = predicted(&model, &mode, speed_m_s);
        assert!(predicted > 1, "nothing has grown yet: β₂ = {beta2}, {damping}");
        let state = lifted(&model, 1.0e-6, speed_m_s, &mode.shape);
        let found = guarded(&model, IDLE, state, 10 * predicted);
        let (step, node, message) = found.unwrap_or_else(|| panic!("β₂ = {beta2}, {damping}: not stopped"));
        assert!(
            step.abs_diff(predicted) <= INTERVAL,
            "β₂ = {beta2}, {damping}: {step}, predicted {predicted}"
        );
        assert!(model.time_step_s() > model.time_step_limit_s(), "the program's limit is a bound");
        assert!(message.contains("of the stability limit; reduce it"), "{message}");
        lines.push(line("in the air", beta2, damping, &model, &mode, Some(predicted), step, node));
    }
    summary::write("beyond", &lines);
}

/// Protects: a pin that is pressed on the disk and dragged is stopped as well. Its step is 1.02 of the limit
/// for a base that is held in z as a whole (with an open base the limit is lower). The highest mode begins at
/// least with the rounding of the deformation under the load, so it needs at most ln(10⁴/ε²)/(2 ln λ) steps
/// from there.
#[test]
fn a_pressed_pin_is_stopped() {
    let mut lines = Vec::new();
    for (beta2, damping) in integrators() {
        let (closed, mode) = definition(beta2, damping, true);
        let model = modes::at_fraction(&closed, &mode, FRACTION).unwrap();
        let growth = modes::growth_per_step(mode.omega, &model);
        // Pressure waves cross the pin twice while the load increases.
        let ramp_s = 2.0 * model.mesh().size_m()[2] / model.pin().material().pressure_wave_speed_m_s();
        let drive = Drive { law: Law::coulomb(0.4), rate: 0.733, force_n: 30.0, ramp_s };
        let rounding = (1.0e4 / f64::EPSILON.powi(2)).ln() / (2.0 * growth.ln());
        let most = (ramp_s / model.time_step_s() + rounding).ceil() as u64 + INTERVAL;
        let found = guarded(&model, drive, State::at_rest(&model), 10 * most);
        let (step, node, message) = found.unwrap_or_else(|| panic!("β₂ = {beta2}, {damping}: not stopped"));
        assert!(step <= most, "β₂ = {beta2}, {damping}: step {step}, at most {most}");
        assert!(message.contains("of the stability limit; reduce it"), "{message}");
        lines.push(line("pressed", beta2, damping, &model, &mode, Some(most), step, node));
    }
    summary::write("beyond", &lines);
}

/// Protects: the guard stops no stable run. The same states at 0.99 of the true limit continue, although the
/// magnitudes of their energies are up to 50 times the energy itself.
#[test]
fn below_the_limit_nothing_is_stopped() {
    for (beta2, damping) in integrators() {
        let (free, mode) = definition(beta2, damping, false);
        let model = modes::at_fraction(&in_the_air(free.clone()), &mode, 0.99).unwrap();
        let state = lifted(&model, 1.0e-6, 1.0e-9 * mode.omega, &mode.shape);
        assert_eq!(guarded(&model, IDLE, state, 20_000), None, "β₂ = {beta2}, {damping}, in the air");
        let model = modes::at_fraction(&free, &mode, 0.99).unwrap();
        let drive = Drive { law: Law::coulomb(0.4), rate: 0.733, force_n: 30.0, ramp_s: 1.0e-4 };
        let state = State::at_rest(&model);
        assert_eq!(guarded(&model, drive, state, 20_000), None, "β₂ = {beta2}, {damping}, pressed");
    }
}

/// Protects: a run at exactly the limit is stopped, and its message says to stay below it. With one element
/// the bound is exact. The highest mode alternates there, and friction feeds it until more energy is stored
/// than was put in. At 0.99 of the limit the run has a result.
#[test]
fn the_limit_itself_is_told() {
    let mut spec = JobSpec::default();
    let pin = &mut spec.scene.pin;
    (pin.size_m, pin.elements, pin.poisson_ratio) = ([0.01, 0.01, 0.01], [1, 1, 1], 0.499);
    spec.scene.contact.mu = 2.0;
    spec.scene.clamp = Clamp { side: ClampSide::TrailingEnd, width_m: 0.0 };
    spec.scene.load.ramp_s = 0.0;
    (spec.numerics.beta_r_s, spec.numerics.safety_factor) = (0.0, 1.0);
    spec.run.stop_early = false;
    let Err(error) = analysis::solve(&spec, &mut analysis::Unobserved) else {
        panic!("a result at the limit")
    };
    let message = error.to_string();
    assert!(
        message.contains("1.000000 of the stability limit") && message.contains("take at most 0.99"),
        "{message}"
    );
    spec.numerics.safety_factor = 0.99;
    analysis::solve(&spec, &mut analysis::Unobserved).unwrap_or_else(|error| panic!("{error}"));
}

#[allow(clippy::too_many_arguments)]
fn line(
    scene: &str,
    beta2: f64,
    damping: f64,
    model: &Model,
    mode: &Mode,
    predicted: Option<u64>,
    step: u64,
    node: usize,
) -> Value {
    json!({
        "scene": scene,
        "beta2": beta2,
        "damping": damping,
        "of_bound": model.time_step_s() / model.time_step_limit_s(),
        "growth": modes::growth_per_step(mode.omega, model),
        "predicted": predicted,
        "step": step,
        "node": node,
    })
}

/// Protects: the guard names the worst node of its own lane, and both of its factors work.
#[test]
fn the_guard_tells_the_node_and_keeps_both_factors() {
    let model = Model::new(pin([6, 8, 5])).expect("a legal scene");
    let drive = Drive { law: Law::coulomb(0.4), rate: 0.733, force_n: 0.0, ramp_s: 0.0 };
    for (speed, node) in [(1.0, 17), (f64::NAN, 42), (f64::INFINITY, 5)] {
        let mut state = State::<2>::at_rest(&model);
        state.p[2 * (3 * node + 1) + 1] = speed;
        // The other lane has a worse node elsewhere.
        state.p[2 * 3 * 60] = 1.0e9;
        let energies = Energies { kinetic_j: f64::NAN, ..Energies::default() };
        match guard::check(&model, &drive, &state, 1, &energies) {
            Err(SolverError::Diverged { node: told, .. }) => assert_eq!(told, node),
            other => panic!("not stopped: {other:?}"),
        }
    }
    let state = State::<1>::at_rest(&model);
    let stops = |kinetic_j, elastic_j| {
        let energies = Energies { kinetic_j, elastic_j, drive_work_j: 1.0, ..Energies::default() };
        guard::check(&model, &drive, &state, 0, &energies).is_err()
    };
    assert!(!stops(0.9, 1.0) && stops(1.1, 1.0), "stored: twice what was put in");
    assert!(!stops(-49.0, 50.0) && stops(-51.0, 50.0), "magnitudes: a hundred times");
}
