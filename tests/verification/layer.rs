//! B22 A compliant layer between pin and disk.
//!
//! * **At rest** a mass under the load F has pressed the layer by δ(F).
//! * **In contact** a mass m on a linear layer K under F is an oscillator about −F/K. Because the force belongs to the depth after the
//!   step, w = u + F/K satisfies (1 + κ)w_{n+1} − 2w_n + w_{n−1} = 0 with κ = KΔt²/m, so w_n is a combination of
//!   (1 + κ)^(−n/2) cos nθ and sin nθ, with tan θ = √κ. To first order in Δt it is cos ωt, ω² = K/m.
//! * **A bounce** on a linear layer takes half a period, and the mass leaves with the speed with which it came. The layer loses
//!   πωΔt of the energy to first order, which is the contact loss.
//! * **A stiff layer** is the rigid contact: depths, and so the changes of forces, fall like 1/k.

use crate::verification::common::{ROUNDINGS_PER_FORCE, advance};
use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, Z, audited_step};
use tribosweep_mechanics::analysis::drive;
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::Layer;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, Model, State, TimeStep};
use tribosweep_mechanics::spec::JobSpec;

const MASS_KG: f64 = 0.5;
const LOAD_N: f64 = 2.0;
/// The area of a node is 1 m², so this is also a stiffness in N/m.
const STIFFNESS_PA_M: f64 = 200.0;

const LINEAR: Layer = Layer { stiffness_pa_m: STIFFNESS_PA_M, exponent: 1.0, pressure_pa: 1.0 };

fn omega() -> f64 {
    (STIFFNESS_PA_M / MASS_KG).sqrt()
}

fn model(layer: Layer, time_step_s: f64) -> Model {
    let mut system = Particles::corners(MASS_KG);
    system.release(0, Z).load(0, Z, -1.0);
    let model = system.model(0.0, TimeStep::Given(time_step_s)).with_layer(layer);
    assert_eq!(model.slaves()[0].area_m2, 1.0);
    model
}

fn pressed(force_n: f64) -> Drive {
    Drive { law: Law::coulomb(0.0), rate: 0.0, force_n, ramp_s: 0.0 }
}

/// Protects: the law of the layer, linear and with an exponent.
#[test]
fn a_load_compresses_the_layer() {
    let mut depth = Evidence::new("B22", "depth of a loaded layer [m]", "p = p₀ (kδ/(m p₀))^m");
    for exponent in [1.0, 1.5, 3.0] {
        let layer = Layer { exponent, pressure_pa: 5.0, ..LINEAR };
        let model = model(layer, 0.5 / omega());
        let mut state = State::<1>::at_rest(&model);
        advance(&model, &pressed(LOAD_N), &mut state, 4000);
        let exact_m = exponent * 5.0 / STIFFNESS_PA_M * (LOAD_N / 5.0).powf(1.0 / exponent);
        depth.found(format!("m = {exponent}"), -state.u[Z], exact_m, exact_m);
        assert!((state.contacts.force_of(0, 0)[2] / LOAD_N - 1.0).abs() < 1.0e-12);
    }
    // Roundings of the gap, whose terms are not much larger than the depth.
    depth.judge_exact(1.0e3);
}

/// Protects: the frequency and the damping of the layer in time, and the share of the layer in the energies.
#[test]
fn a_mass_on_the_layer_oscillates() {
    let mut discrete = Evidence::new(
        "B22",
        "displacement of a mass on a layer [m]",
        "exact discrete solution, z = (1 ± i√κ)/(1 + κ), κ = KΔt²/m",
    );
    let mut continuous =
        Evidence::new("B22", "displacement of a mass on a layer after 3 periods [m]", "(F/K)(cos ωt − 1)");
    let mut energy = Evidence::new(
        "B22",
        "energy balance of a mass on a layer, relative to F²/K",
        "stored energy = work of the load − contact loss, an identity of the scheme",
    );
    let depth_m = LOAD_N / STIFFNESS_PA_M;
    // A third of a period more than three, where neither the displacement nor the speed vanishes.
    let end = 3.3 * std::f64::consts::TAU;
    for steps in [2000_usize, 4000, 8000, 16000] {
        let w = end / steps as f64;
        let resolution = format!("ωΔt = {w:.2e}");
        let model = model(LINEAR, w / omega());
        let (mut state, mut ledger) = (State::at_rest(&model), EnergyLedger::new(&model, 1));
        for _ in 0..steps {
            audited_step(&model, pressed(LOAD_N), &mut state, &mut ledger);
            assert!(state.contacts.force_of(0, 0)[2] > 0.0, "in contact");
        }
        let kappa = w * w;
        let theta = w.atan();
        // The first step has half of the factor of Δt².
        let [first, second] = [1.0, 1.0 / (1.0 + 0.5 * kappa)];
        let sine = (second * (1.0 + kappa).sqrt() - first * theta.cos()) / theta.sin();
        let angle = steps as f64 * theta;
        let amplitude = (-0.5 * steps as f64 * kappa.ln_1p()).exp();
        let exact_m = depth_m * (amplitude * (angle.cos() + sine * angle.sin()) - 1.0);
        discrete.found(&resolution, state.u[Z], exact_m, depth_m);
        continuous.found(&resolution, state.u[Z], depth_m * (end.cos() - 1.0), depth_m);
        let energies = ledger.energies(0);
        assert!(energies.elastic_j > 0.0 && energies.contact_loss_j > 0.0, "{energies:?}");
        let residual = energies.imbalance_j() / (LOAD_N * depth_m);
        energy.bounded(&resolution, residual, 0.0, 1.0, 50.0 * steps as f64 * f64::EPSILON);
    }
    // Each step rounds a displacement, and the roundings add up in displacement and speed.
    discrete.judge_exact(16000.0 * 16000.0 * 1.0e-2);
    continuous.judge_order(1.0, 2.0, 1.0e-9);
    energy.judge_bounded("fifty roundings a step");
}

/// Protects: the layer pushes and never pulls, and what a bounce loses is the contact loss.
#[test]
fn a_mass_bounces_on_the_layer() {
    let speed_m_s = 0.3;
    let mut rebound = Evidence::new("B22", "speed after a bounce on a layer [m/s]", "the speed before");
    let mut loss = Evidence::new(
        "B22",
        "contact loss of a bounce, over πωΔt of the kinetic energy",
        "a damper of KΔt during half a period",
    );
    for w in [0.02, 0.01, 0.005, 0.0025] {
        let resolution = format!("ωΔt = {w}");
        let dt = w / omega();
        let model = model(LINEAR, dt);
        let (mut state, mut ledger) = (State::at_rest(&model), EnergyLedger::new(&model, 1));
        state.p[Z] = -speed_m_s;
        let steps = (3.6 / w) as usize;
        for _ in 0..steps {
            audited_step(&model, pressed(0.0), &mut state, &mut ledger);
        }
        assert_eq!(state.contacts.force_of(0, 0)[2], 0.0, "it has left");
        rebound.found(&resolution, state.p[Z], speed_m_s, speed_m_s);
        let energies = ledger.energies(0);
        let input_j = 0.5 * MASS_KG * speed_m_s * speed_m_s;
        assert!(
            (energies.imbalance_j() / input_j).abs() < 50.0 * steps as f64 * f64::EPSILON,
            "{energies:?}"
        );
        loss.found(&resolution, energies.contact_loss_j / (input_j * std::f64::consts::PI * w), 1.0, 1.0);
    }
    rebound.judge_overall_order(1.0, 2.0, "the mass leaves anywhere in a step");
    loss.judge_overall_order(1.0, 2.0, "the mass leaves anywhere in a step");
}

/// Protects: an infinitely stiff layer is the rigid contact, and the energies close on a layer with an exponent under a pin that
/// sticks, slips and separates on a wavy disk.
#[test]
fn a_stiff_layer_is_rigid() {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.scene.load.ramp_s = 1.0e-4;
    let run = |spec: &JobSpec, steps: u64| {
        spec.check().unwrap();
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let (mut state, mut ledger) = (State::at_rest(&model), EnergyLedger::new(&model, 1));
        for _ in 0..steps {
            audited_step(&model, drive(spec), &mut state, &mut ledger);
        }
        (state, ledger)
    };
    let steps = 200;
    let mut difference = Evidence::new(
        "B22",
        "largest difference of a nodal displacement on a layer from that without it [m]",
        "rigid contact; the difference falls like 1/k",
    );
    let (rigid, _) = run(&spec, steps);
    let size_m = (0..63).fold(0.0_f64, |most, node| most.max(rigid.u[3 * node + Z].abs()));
    let largest_m = rigid.u.values().fold(0.0_f64, |most, u: f64| most.max(u.abs())).max(size_m);
    for stiffness_pa_m in [1.0e15, 1.0e16, 1.0e17, 1.0e18] {
        spec.scene.contact.stiffness_pa_m = Some(stiffness_pa_m);
        let (on_layer, _) = run(&spec, steps);
        let pairs = on_layer.u.values().zip(rigid.u.values());
        let worst_m = pairs.fold(0.0_f64, |most, (a, b): (f64, f64)| most.max((a - b).abs()));
        difference.found(format!("k = {stiffness_pa_m:e} Pa/m"), worst_m, 0.0, largest_m);
    }
    difference.judge_order(1.0, 10.0, 1.0e-9);

    let mut energy = Evidence::new(
        "B22",
        "energy balance of a pin on a layer and a wavy disk, relative to the energy put in",
        "energy balance of Newmark's method (Krenk 2006)",
    );
    spec.scene.contact.mu = 0.6;
    spec.scene.contact.stiffness_pa_m = Some(3.0e12);
    spec.scene.contact.stiffness_exponent = Some(2.0);
    spec.scene.contact.stiffness_pressure_pa = Some(2.0e5);
    spec.scene.disk.omega_rpm = 600.0;
    spec.scene.disk.waviness_height_m = Some(3.0e-6);
    spec.scene.disk.waviness_count = Some(70);
    let (_, ledger) = run(&spec, 3000);
    let energies = ledger.energies(0);
    energy.found("3000 steps", energies.relative_residual(), 0.0, 1.0);
    energy.judge_exact(ROUNDINGS_PER_FORCE * 3000.0);
}
