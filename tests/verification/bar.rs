//! The one-dimensional bar.
//!
//! B2 Discrete spectrum. Lumped linear elements of length h have the exact frequencies
//!    ω_n = (2c/h) sin(nπ/2N) free–free, modes cos(nπk/N); the central difference turns ω_n into
//!    sin(θ/2) = (cΔt/h) sin(nπ/2N) per step. Source: textbook dispersion relations, exact.
//! B4a Bar on a rigid wall. A bar of speed v0 hits: contact stress ρ c v0 for 2L/c, kinetic energy
//!    KE0(1−τ) and KE0(τ−1), rebound at v0 with all its energy. Source: Saint-Venant's impact solution.
//!    At cΔt/h = 1 the scheme transports waves exactly, so stress, contact time, kinetic energy and the
//!    rebound of all nodes but one hold to rounding. The forward-increment impact loses the contact
//!    node's share of the momentum, 1/(2N); below the limit its loss of energy is O(1/N).

use crate::common::{COLUMN_AREA_M2, COLUMN_HEIGHT_M, IDLE, advance, bar, normal_force_n, observed_orders};
use std::f64::consts::PI;
use tribosweep::solver::energy::EnergyLedger;
use tribosweep::solver::{Model, ModelDefinition, State, TimeStep};

const SPEED_M_S: f64 = 0.1;

fn wave_speed(model: &Model) -> f64 {
    model.material().pressure_wave_speed_m_s()
}

/// B2: cos(nπk/N) is an eigenvector of the assembled operator with exactly ω_n².
#[test]
fn discrete_spectrum_is_exact() {
    let layers = 20;
    let model = Model::new(bar(layers)).unwrap();
    let h = model.mesh().element_size_m()[2];
    for mode in 0..=layers {
        let phase = mode as f64 * PI / layers as f64;
        let omega = 2.0 * wave_speed(&model) / h * (phase / 2.0).sin();
        let mut phi = vec![0.0; 3 * model.mesh().node_count()];
        for node in 0..model.mesh().node_count() {
            phi[3 * node + 2] = (phase * model.mesh().grid_position(node)[2] as f64).cos();
        }
        let force = model.stiffness_times(&phi);
        let largest = (2.0 * wave_speed(&model) / h).powi(2);
        for node in 0..model.mesh().node_count() {
            let acceleration = force[3 * node + 2] / model.masses_kg()[node];
            let error = (acceleration - omega * omega * phi[3 * node + 2]).abs();
            assert!(error < 1e-12 * largest, "mode {mode}, node {node}: {error:e}");
        }
    }
}

/// B2: in time, each mode oscillates as cos(θn) with the central difference's own θ.
#[test]
fn central_difference_dispersion_is_exact() {
    let layers = 20;
    for fraction in [0.3, 0.7, 1.0] {
        let model =
            Model::new(ModelDefinition { time_step: TimeStep::FractionOfLimit(fraction), ..bar(layers) })
                .unwrap();
        let h = model.mesh().element_size_m()[2];
        let cfl = wave_speed(&model) * model.time_step_s() / h;
        for mode in [1, 3, 10, 19] {
            let phase = mode as f64 * PI / layers as f64;
            let theta = 2.0 * (cfl * (phase / 2.0).sin()).asin();
            let mut state = State::at_rest(&model);
            // One unit above the plane, so that contact plays no part.
            for node in 0..model.mesh().node_count() {
                let k = model.mesh().grid_position(node)[2] as f64;
                state.u[3 * node + 2] = 2.0 + (phase * k).cos();
            }
            for n in 1..=200 {
                advance(&model, &IDLE, &mut state, 1);
                let exact = 2.0 + (theta * f64::from(n)).cos();
                let error = (state.u[2] - exact).abs();
                // Rounding enters once a step and is carried along at most linearly.
                assert!(error < 1e-15 * 30.0 * f64::from(n), "mode {mode}, step {n}: {error:e}");
            }
        }
    }
}

struct Impact {
    contact_steps: usize,
    impulse_ns: f64,
    mean_speed: f64,
    energy_loss: f64,
}

fn falling(model: &Model) -> State<1> {
    let mut state = State::at_rest(model);
    for node in 0..model.mesh().node_count() {
        state.p[3 * node + 2] = -SPEED_M_S;
    }
    state
}

/// Velocity of the centre of mass.
fn mean_speed(model: &Model, state: &State<1>) -> f64 {
    let nodes = 0..model.mesh().node_count();
    nodes.map(|node| model.masses_kg()[node] * state.p[3 * node + 2]).sum::<f64>() / mass_kg()
}

fn mass_kg() -> f64 {
    2500.0 * COLUMN_AREA_M2 * COLUMN_HEIGHT_M
}

/// Runs an impact until well after the rebound. The bar starts `gap_steps` steps of free fall away
/// from the wall, so that it closes in the middle of a step as contacts in a run do.
fn impact(layers: usize, fraction: f64, gap_steps: f64) -> Impact {
    let model = Model::new(ModelDefinition { time_step: TimeStep::FractionOfLimit(fraction), ..bar(layers) })
        .unwrap();
    let mut state = falling(&model);
    for node in 0..model.mesh().node_count() {
        state.u[3 * node + 2] = gap_steps * SPEED_M_S * model.time_step_s();
    }
    let mut ledger = EnergyLedger::new(&model, 1);
    let steps = (3.0 * layers as f64 / fraction).ceil() as usize;
    let (mut contact_steps, mut impulse_ns) = (0, 0.0);
    for _ in 0..steps {
        ledger.before_step(&model, &state);
        advance(&model, &IDLE, &mut state, 1);
        ledger.after_step(&model, &[IDLE], &state);
        let force = normal_force_n(&state);
        contact_steps += usize::from(force > 0.0);
        impulse_ns += force * model.time_step_s();
    }
    let energies = ledger.energies(0);
    assert!(energies.relative_residual() < 1e-12, "the energy balance closes");
    Impact {
        contact_steps,
        impulse_ns,
        mean_speed: mean_speed(&model, &state),
        energy_loss: energies.contact_loss_j / energies.initial_j,
    }
}

/// B4a at cΔt/h = 1: force, contact time, kinetic energy and rebound to rounding.
#[test]
fn wall_impact_is_exact_at_unit_cfl() {
    let layers = 50;
    let model = Model::new(bar(layers)).unwrap();
    let h = model.mesh().element_size_m()[2];
    let c = wave_speed(&model);
    assert!((c * model.time_step_s() / h - 1.0).abs() < 1e-12, "the limit of a bar is cΔt/h = 1");
    let force_n = 2500.0 * c * SPEED_M_S * COLUMN_AREA_M2;
    let mut state = falling(&model);
    for n in 0..2 * layers {
        advance(&model, &IDLE, &mut state, 1);
        let error = normal_force_n(&state) / force_n - 1.0;
        assert!(error.abs() < 1e-10, "step {n}: contact force off by {error:e}");
        // p_{n+1} is the velocity between t_n and t_{n+1}: half a step before t_{n+1}.
        let tau = (n as f64 + 0.5) / layers as f64;
        let kinetic: f64 = (0..model.mesh().node_count())
            .map(|node| 0.5 * model.masses_kg()[node] * state.p[3 * node + 2].powi(2))
            .sum();
        let exact = 0.5 * mass_kg() * SPEED_M_S * SPEED_M_S * (1.0 - tau).abs();
        // The element that holds the front has one moving and one resting node: exact in between.
        assert!((kinetic - exact).abs() < 1e-10 * 0.5 * mass_kg() * SPEED_M_S.powi(2), "step {n}");
    }
    // Every node has turned to +v0 but the contact node, which forward increments leave at rest: its half
    // element is 1/(2N) of the mass, and no later step has a contact force.
    for n in 0..layers {
        advance(&model, &IDLE, &mut state, 1);
        assert!(normal_force_n(&state) < 1e-10 * force_n, "the bar has left the wall after 2L/c");
        if n == 0 {
            for node in 0..model.mesh().node_count() {
                let speed = if model.mesh().grid_position(node)[2] == 0 { 0.0 } else { SPEED_M_S };
                assert!((state.p[3 * node + 2] - speed).abs() < 1e-10 * SPEED_M_S, "node {node} rebounds");
            }
        }
        let mean = mean_speed(&model, &state) / SPEED_M_S;
        assert!((mean - (1.0 - 0.5 / layers as f64)).abs() < 1e-10, "rebound of the centre of mass: {mean}");
    }
}

/// B4a below the limit: the impulse balances the momentum to rounding; the loss of energy is that of
/// the contact node's share, O(1/N); rebound speed and contact time tend to the exact ones.
#[test]
fn wall_impact_converges_below_the_limit() {
    let layers = [25, 50, 100, 200];
    let impacts: Vec<Impact> = layers.iter().map(|&n| impact(n, 0.5, 1.5)).collect();
    for (impact, &n) in impacts.iter().zip(&layers) {
        let balance = impact.impulse_ns - mass_kg() * (impact.mean_speed + SPEED_M_S);
        assert!(balance.abs() < 1e-11 * mass_kg() * SPEED_M_S, "N = {n}: impulse balance {balance:e}");
        // The contact node holds 1/(2N) of the bar's mass; stopping it costs at most its kinetic energy
        // at each of the few times that the smeared front lets it close.
        assert!(impact.energy_loss > 0.0 && impact.energy_loss < 2.0 / n as f64, "N = {n}");
        // Two passages of N elements at cΔt/h = ½ are 4N steps; a dispersive front is smeared over O(N^⅓).
        let error = (impact.contact_steps as f64 / (4.0 * n as f64) - 1.0).abs();
        assert!(error < 2.0 * (n as f64).powf(-2.0 / 3.0), "N = {n}: contact time off by {error}");
    }
    let losses: Vec<f64> = impacts.iter().map(|impact| impact.energy_loss).collect();
    for order in observed_orders(&losses, 2.0) {
        assert!((order - 1.0).abs() < 0.25, "energy losses {losses:?} are not O(1/N): order {order}");
    }
    let rebound: Vec<f64> = impacts.iter().map(|impact| 1.0 - impact.mean_speed / SPEED_M_S).collect();
    assert!(rebound.windows(2).all(|pair| pair[1] < pair[0]), "the rebound speed tends to v0: {rebound:?}");
}
