//! B19 A holder between the pin and the frame.
//!
//! * **Alone**, a holder of the mass M with a node of the mass m on a spring k is an oscillator. The central difference gives
//!   u_n = v₀Δt sin nθ/sin θ exactly, with sin(θ/2) = ωΔt/2 and ω² = k/(M + m). A damper d makes it decay at d/(2(M + m)).
//!   The scheme takes the damper's force with the velocity of half a step before, so the rate has an error of first order.
//! * **Without mass** it is a spring to the frame. Two masses on a belt with such a spring slip and stick as the same masses with
//!   a spring among the springs of the pin, and T is the force of that spring.
//! * **Rotating**, a holder of the inertia I with nodes on arms y is the same oscillator, with ω² = k/(I + Σ m y²).
//! * **With a large mass** it is an ideal clamp: it moves by at most ∫∫|T|/M, so the difference from the ideal clamp falls like
//!   1/M.

use crate::verification::common::advance;
use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, X, Y, Z, audited_step};
use std::f64::consts::TAU;
use tribosweep_mechanics::analysis::drive;
use tribosweep_mechanics::solver::body::pin::Stiffness;
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::law::{Law, StaticKinetic};
use tribosweep_mechanics::solver::interface::target::{self, TargetDefinition};
use tribosweep_mechanics::solver::support::{Held, Rocking, RockingWay, Support, Tied};
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, State, TimeStep, step};
use tribosweep_mechanics::spec::{ClampSide, JobSpec};
use tribosweep_mechanics::stability::SparseStructure;

const NODE_KG: f64 = 0.5;
const HOLDER_KG: f64 = 1.5;
const STIFFNESS_N_M: f64 = 50.0;
const OMEGA: f64 = 5.0;
const SPEED_M_S: f64 = 0.3;

fn held(mass_kg: f64, damping_n_s_m: f64) -> Support {
    let tied = Tied { component: Y, nodes: vec![4] };
    Support::Held(Held { tied, mass_kg, stiffness_n_m: STIFFNESS_N_M, damping_n_s_m })
}

fn model(mut system: Particles, holder: Option<Support>, time_step_s: f64) -> Model {
    system.release(4, Y);
    let mut definition = system.definition(0.0, TimeStep::Given(time_step_s));
    definition.supports.extend(holder);
    Model::new(definition).unwrap()
}

const STILL: Drive = Drive { law: Law::coulomb(0.0), rate: 0.0, force_n: 0.0, ramp_s: 0.0 };

/// Protects: mass, spring and damper of a holder, and its share of the energies.
#[test]
fn a_holder_alone_is_an_oscillator() {
    let mut motion = Evidence::new(
        "B19",
        "displacement of a holder on a spring [m]",
        "exact discrete solution v₀Δt sin nθ/sin θ, sin(θ/2) = ωΔt/2, ω² = k/(M + m)",
    );
    let mut decay = Evidence::new("B19", "decay rate of a holder with a damper [1/s]", "d/(2(M + m))");
    let mut energy = Evidence::new(
        "B19",
        "energy balance of a holder with a damper, relative to the energy at the start",
        "stored energy + work of the damper = energy at the start, an identity of the scheme",
    );
    for w in [0.2, 0.1, 0.05] {
        let resolution = format!("ωΔt = {w}");
        let dt = w / OMEGA;
        let free = model(Particles::corners(NODE_KG), Some(held(HOLDER_KG, 0.0)), dt);
        let mut state = State::at_rest(&free);
        state.p[3 * 4 + Y] = SPEED_M_S;
        let steps = (63.0 / w) as usize;
        advance(&free, &STILL, &mut state, steps);
        let theta = 2.0 * (w / 2.0).asin();
        let exact_m = SPEED_M_S * dt * (steps as f64 * theta).sin() / theta.sin();
        motion.found(&resolution, state.u[3 * 4 + Y], exact_m, SPEED_M_S / OMEGA);

        let damping_n_s_m = 0.8;
        let damped = model(Particles::corners(NODE_KG), Some(held(HOLDER_KG, damping_n_s_m)), dt);
        let (mut state, mut ledger) = (State::at_rest(&damped), EnergyLedger::new(&damped, 1));
        state.p[3 * 4 + Y] = SPEED_M_S;
        let mut stored_j = Vec::new();
        for _ in 0..steps {
            audited_step(&damped, STILL, &mut state, &mut ledger);
            stored_j.push(ledger.energies(0).kinetic_j + ledger.energies(0).elastic_j);
        }
        // The conserved form of the energy oscillates about its decay by W². A whole number of half periods cancels that.
        let half_period = (std::f64::consts::PI / theta).round() as usize;
        let mean = |from: usize| stored_j[from..from + half_period].iter().sum::<f64>();
        let (first, last) = (half_period, stored_j.len() - half_period - 1);
        let rate = -0.5 * (mean(last) / mean(first)).ln() / ((last - first) as f64 * dt);
        let exact = damping_n_s_m / (2.0 * (HOLDER_KG + NODE_KG));
        decay.found(&resolution, rate, exact, exact);
        let residual = ledger.energies(0).relative_residual();
        energy.bounded(&resolution, residual, 0.0, 1.0, 8.0 * steps as f64 * f64::EPSILON);
    }
    motion.judge_exact(100.0 * 63.0 / 0.05);
    decay.judge_overall_order(1.0, 2.0, "the ends of the window fall anywhere in a period");
    energy.judge_bounded("eight roundings a step");
}

/// Protects: a holder without mass acts on the pin as a spring does, in stick and slip, and T is the force of that spring.
#[test]
fn a_holder_without_mass_is_a_spring() {
    let two_masses = |with_spring: bool| {
        let mut system = Particles::corners(NODE_KG);
        system.release(0, X).release(0, Y).release(0, Z).load(0, Z, -1.0);
        system.spring(0, 4, [0.0, 1.0, 0.0], 200.0);
        if with_spring {
            system.spring(4, 6, [0.0, 1.0, 0.0], STIFFNESS_N_M);
        }
        system
    };
    let on_belt = Drive {
        law: Law::StaticKinetic(StaticKinetic { mu: 0.3, mu_static: 0.5 }),
        rate: 0.2,
        force_n: 10.0,
        ramp_s: 0.0,
    };
    let dt = 0.004;
    let spring = model(two_masses(true), None, dt);
    let holder = model(two_masses(false), Some(held(0.0, 0.0)), dt);
    let (mut on_spring, mut on_holder) = (State::<1>::at_rest(&spring), State::<1>::at_rest(&holder));
    let mut ledger = EnergyLedger::new(&holder, 1);
    let (mut stuck, steps) = (0, 3000);
    for n in 0..steps {
        let before_m = on_holder.u[3 * 4 + Y];
        step(&spring, &[on_belt], &mut on_spring);
        audited_step(&holder, on_belt, &mut on_holder, &mut ledger);
        // The sums are formed in another order. Stick removes what has accumulated before.
        for dof in [Y, 3 * 4 + Y] {
            let difference = (on_spring.u[dof] - on_holder.u[dof]).abs();
            assert!(difference < 1.0e-12, "step {n}: {difference:e}");
        }
        let force_n = on_holder.reaction_n[Y][0];
        assert!((force_n + STIFFNESS_N_M * before_m).abs() < 1.0e-12, "step {n}: {force_n}");
        stuck += usize::from(on_holder.contacts.state_of(0, 0).name() == "stick");
    }
    assert!(stuck > steps / 10 && stuck < steps, "stick and slip: {stuck}");
    assert!(ledger.energies(0).relative_residual() < steps as f64 * f64::EPSILON);
}

/// Protects: the pin on a holder of a large mass moves as under an ideal clamp.
#[test]
fn a_heavy_holder_is_an_ideal_clamp() {
    let mut clamp = Evidence::new(
        "B19",
        "displacement of the leading edge on a holder of mass M, against an ideal clamp [m]",
        "an ideal clamp; the difference falls like 1/M",
    );
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.numerics.time_step_s = Some(8.0e-7);
    let edge = |spec: &JobSpec| {
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let mut state = State::<1>::at_rest(&model);
        advance(&model, &drive(spec), &mut state, 800);
        state.u[3 * model.interface().edge_centres()[0] + Y]
    };
    let exact_m = edge(&spec);
    for mass_kg in [10.0, 20.0, 40.0, 80.0] {
        spec.scene.holder.mass_kg = Some(mass_kg);
        spec.scene.holder.stiffness_x_n_m = Some(0.0);
        spec.scene.holder.stiffness_y_n_m = Some(0.0);
        clamp.found(format!("M = {mass_kg} kg"), edge(&spec), exact_m, exact_m);
    }
    clamp.judge_order(1.0, 2.0, 1.0e-12);
}

const ROTATIONAL_STIFFNESS_N_M: f64 = 125.0;
const INERTIA_KG_M2: f64 = 3.0;

/// Protects: inertia, rotational spring and damper of a holder, and their share of the energies. Four nodes of 0.5 kg at arms of
/// 1 m have Σ m y² = 2 kg m².
#[test]
fn a_holder_that_rotates_is_an_oscillator() {
    let mut motion = Evidence::new(
        "B19",
        "rotation of a holder on a rotational spring, as the displacement of a node [m]",
        "exact discrete solution ω₀Δt y sin nθ/sin θ, sin(θ/2) = ωΔt/2, ω² = k/(I + Σ m y²)",
    );
    let mut energy = Evidence::new(
        "B19",
        "energy balance of a rotating holder with a damper, relative to the energy at the start",
        "stored energy + work of the damper = energy at the start, an identity of the scheme",
    );
    let top = [4, 5, 6, 7];
    let arms = [-1.0, -1.0, 1.0, 1.0];
    let rocking = |damping: f64| {
        let way = |shares: &[f64], inertia, stiffness, damping| RockingWay {
            shares: shares.to_vec(),
            inertia,
            stiffness,
            damping,
        };
        let ways = vec![
            way(&[1.0; 4], HOLDER_KG, STIFFNESS_N_M, 0.0),
            way(&arms, INERTIA_KG_M2, ROTATIONAL_STIFFNESS_N_M, damping),
            way(&[-1.0, 1.0, -1.0, 1.0], 0.5 * INERTIA_KG_M2, ROTATIONAL_STIFFNESS_N_M, 0.0),
        ];
        Support::Rocking(Rocking { nodes: top.to_vec(), ways })
    };
    let held = |damping: f64, dt: f64| {
        let mut system = Particles::corners(NODE_KG);
        for node in top {
            system.release(node, Z);
        }
        let mut definition = system.definition(0.0, TimeStep::Given(dt));
        definition.supports.push(rocking(damping));
        Model::new(definition).unwrap()
    };
    for w in [0.2, 0.1, 0.05] {
        let resolution = format!("ωΔt = {w}");
        let dt = w / OMEGA;
        let steps = (63.0 / w) as usize;
        let model = held(0.0, dt);
        let mut state = State::at_rest(&model);
        for (node, arm) in top.into_iter().zip(arms) {
            state.p[3 * node + Z] = SPEED_M_S * arm;
        }
        advance(&model, &STILL, &mut state, steps);
        let theta = 2.0 * (w / 2.0).asin();
        let exact_m = SPEED_M_S * dt * (steps as f64 * theta).sin() / theta.sin();
        motion.found(&resolution, state.u[3 * 7 + Z], exact_m, SPEED_M_S / OMEGA);

        let model = held(2.0, dt);
        let (mut state, mut ledger) = (State::at_rest(&model), EnergyLedger::new(&model, 1));
        // All three ways at once.
        for (node, speed) in top.into_iter().zip([0.1, -0.4, 0.6, 0.1]) {
            state.p[3 * node + Z] = SPEED_M_S * speed;
        }
        for _ in 0..steps {
            audited_step(&model, STILL, &mut state, &mut ledger);
        }
        assert!(ledger.energies(0).damping_j > 0.0);
        let residual = ledger.energies(0).relative_residual();
        energy.bounded(&resolution, residual, 0.0, 1.0, 24.0 * steps as f64 * f64::EPSILON);
    }
    motion.judge_exact(300.0 * 63.0 / 0.05);
    energy.judge_bounded("eight roundings a step in each of three ways");
}

/// Protects: the pin below a holder that rotates has its moment of inertia about the axis in the top face, in runs and in modes. It
/// hangs free on springs that are weak beside its own stiffness.
#[test]
fn a_pin_rocks_below_its_holder() {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [4, 5, 4];
    spec.scene.clamp.side = ClampSide::WholeTop;
    let scene_model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let (mesh, masses_kg) = (scene_model.mesh(), scene_model.pin().masses_kg());
    let height_m = mesh.size_m()[2];
    let of_pin: f64 = (0..mesh.node_count())
        .map(|node| {
            let [_, y, z] = mesh.coordinates_m(node);
            masses_kg[node] * (y * y + (z - height_m).powi(2))
        })
        .sum();
    let inertia = 2.0e-7;
    let omega = 1.0e3;
    let nodes = mesh.top_nodes();
    let way = |share: &dyn Fn([f64; 3]) -> f64, inertia, stiffness| RockingWay {
        shares: nodes.iter().map(|&node| share(mesh.coordinates_m(node))).collect(),
        inertia,
        stiffness,
        damping: 0.0,
    };
    let ways = vec![
        way(&|_| 1.0, 0.0, 1.0e4),
        way(&|[_, y, _]| y, inertia, (inertia + of_pin) * omega * omega),
        way(&|[x, _, _]| -x, 0.0, 10.0),
    ];
    let definition = ModelDefinition {
        mesh: mesh.clone(),
        materials: scene_model.pin().materials().to_vec(),
        stiffness: Stiffness::Elastic,
        supports: vec![
            Support::fixed(nodes.iter().flat_map(|node| [3 * node, 3 * node + 1])),
            Support::Rocking(Rocking { nodes: nodes.clone(), ways }),
        ],
        load: Vec::new(),
        target: TargetDefinition::Rigid(target::straight_plane(mesh)),
        beta2: 0.5,
        beta_r_s: 0.0,
        alpha_r_per_s: 0.0,
        time_step: TimeStep::FractionOfLimit(0.5),
    };
    let model = Model::new(definition).unwrap().with_initial_gaps(|_| 1.0e-3);
    let rate = 1.0e-3;
    let mut state = State::at_rest(&model);
    for node in 0..mesh.node_count() {
        let [_, y, z] = mesh.coordinates_m(node);
        state.p[3 * node + Y] = -rate * (z - height_m);
        state.p[3 * node + Z] = rate * y;
    }
    let steps = (1.5 / (omega * model.time_step_s())) as usize;
    advance(&model, &STILL, &mut state, steps);
    let corner = mesh.node_count() - 1;
    let [_, y, _] = mesh.coordinates_m(corner);
    let exact_m = rate * y / omega * (omega * steps as f64 * model.time_step_s()).sin();
    // The pin bends by (ω over its own lowest frequency)², which is below 10⁻⁴ here.
    let error = (state.u[3 * corner + Z] / exact_m - 1.0).abs();
    assert!(error < 1.0e-3, "{error:e}");

    let drive = Drive { law: Law::coulomb(0.0), rate: 1.0, force_n: 1.0, ramp_s: 0.0 };
    let near = SparseStructure::new(&model).unwrap().near(&model, &drive, omega / TAU).unwrap();
    let errors = near.modes.iter().map(|mode| (mode.eigenvalue_per_s.im / omega - 1.0).abs());
    let error = errors.fold(f64::INFINITY, f64::min);
    assert!(error < 1.0e-3, "{error:e}");
}

/// Protects: the axes of a holder cross above the pin's own axis, so that the load does not turn the holder, whatever the tilt.
#[test]
fn the_load_does_not_turn_the_holder() {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [4, 5, 4];
    (spec.scene.pin.tilt_x_deg, spec.scene.pin.tilt_y_deg) = (Some(5.0), Some(-3.0));
    spec.scene.clamp.side = ClampSide::WholeTop;
    let holder = &mut spec.scene.holder;
    (holder.rotational_stiffness_x_nm_rad, holder.rotational_stiffness_y_nm_rad) = (Some(10.0), Some(20.0));
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let rocking = model.supports().iter().find_map(|support| match support {
        Support::Rocking(rocking) => Some(rocking),
        _ => None,
    });
    let rocking = rocking.unwrap();
    assert_eq!(rocking.ways.len(), 3);
    for (way, expected) in rocking.ways.iter().zip([-1.0, 0.0, 0.0]) {
        let share = |dof: usize| model.load().iter().find(|load| load.dof == dof).unwrap().share;
        let force: f64 = rocking.dofs().zip(&way.shares).map(|(dof, arm)| share(dof) * arm).sum();
        // Arms are some millimetres, with a rounding error of their coordinates.
        assert!((force - expected).abs() < 1.0e-14, "{force:e}");
    }
}
