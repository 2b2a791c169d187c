//! B15 Invariances of the problem: homogeneity, mirror symmetry, rotation of the scene, free flight, lanes.
//!
//! Source: linear elasticity, Coulomb's law and the rigid plane have no scale of force, no handedness and no
//! preferred direction in the plane. Two such runs differ only in the order of the program's sums. So they
//! agree to rounding (ROUNDINGS_PER_FORCE per step, in units of the largest displacement at (ω_maxΔt)² ≤ 2).
//! Unstable sliding amplifies this rounding: its fastest mode grows at 5000 to 7000/s in this scene, by e^7
//! at most in 1 ms. Rigid motions of the elastic operator are in `free_block`.

use crate::verification::common::{IDLE, ROUNDINGS_PER_FORCE, advance, definition, pin_material};
use crate::verification::evidence::Evidence;
use tribosweep_mechanics::solver::body::pin::Stiffness;
use tribosweep_mechanics::solver::body::pin::{BlockMesh, PinMesh};
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::field::Field;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::interface::target::TargetDefinition;
use tribosweep_mechanics::solver::support::clamp;
use tribosweep_mechanics::solver::support::load;
use tribosweep_mechanics::solver::{Drive, InLanes, Model, ModelDefinition, State, StateOf, TimeStep, step};
use tribosweep_mechanics::spec::{Clamp, ClampSide, Holder, JobSpec, TopFace};

fn small_model() -> Model {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    Model::from_scene(&spec.scene, &spec.numerics).unwrap()
}

const DRIVE: Drive = Drive { law: Law::coulomb(0.4), rate: 0.733, force_n: 30.0, ramp_s: 5.0e-4 };

/// Protects: homogeneity. (F, V) → s(F, V) scales displacements, velocities and contact forces by s. Scaling
/// by a power of two is exact in binary. So the whole trajectory, through stick, slip and separation, must
/// have the same bits except for the exponent.
#[test]
fn scaling_load_and_speed_by_powers_of_two_scales_the_bits() {
    let model = small_model();
    let mut evidence = Evidence::new(
        "B15",
        "homogeneity, 3000 steps, largest deviation of u, p and forces over their size",
        "the problem is homogeneous of degree one in (F, V)",
    );
    for exponent in [-20, -1, 2, 15] {
        let scale = 2.0_f64.powi(exponent);
        let scaled_drive = Drive { rate: scale * DRIVE.rate, force_n: scale * DRIVE.force_n, ..DRIVE };
        let mut plain = State::<1>::at_rest(&model);
        let mut scaled = State::<1>::at_rest(&model);
        for _ in 0..3000 {
            step(&model, &[DRIVE], &mut plain);
            step(&model, &[scaled_drive], &mut scaled);
        }
        let forces = |state: &State<1>| -> Vec<f64> { state.contacts.forces(0).flatten().collect() };
        let values = |field: &Field<1>| field.values().collect::<Vec<_>>();
        let deviation = |a: &[f64], b: &[f64]| {
            let size = b.iter().fold(0.0_f64, |m, b| m.max(b.abs()));
            a.iter().zip(b).map(|(a, b)| (scale * a - b).abs()).fold(0.0, f64::max) / size
        };
        let worst = deviation(&values(&plain.u), &values(&scaled.u))
            .max(deviation(&values(&plain.p), &values(&scaled.p)))
            .max(deviation(&forces(&plain), &forces(&scaled)));
        evidence.found(format!("s = 2^{exponent}"), worst, 0.0, 1.0);
        assert!(plain.contacts.states(0).eq(scaled.contacts.states(0)), "states, scale {scale}");
        let states: Vec<_> = plain.contacts.states(0).collect();
        assert!(states.windows(2).any(|pair| pair[0] != pair[1]), "a run with mixed contact states");
    }
    evidence.judge_exact(0.0);
}

/// The pin of `size_m` on a plane that moves straight in `direction`.
fn straight(size_m: [f64; 3], elements: [usize; 3], side: ClampSide, direction: [f64; 2]) -> Model {
    let mesh = PinMesh::from(BlockMesh::new(size_m, elements));
    let strip = clamp::clamped_strip(&mesh, &Clamp { side, width_m: 0.002 }).unwrap();
    Model::new(ModelDefinition {
        materials: vec![pin_material(0.3)],
        stiffness: Stiffness::Elastic,
        supports: clamp::supports(&mesh, &strip, TopFace::TiedInZ, &Holder::default()),
        load: load::normal_load(&mesh),
        target: TargetDefinition::Rigid(vec![direction; mesh.bottom_nodes().len()]),
        beta2: 0.5,
        beta_r_s: 5.0e-8,
        alpha_r_per_s: 0.0,
        // This is 0.7 of the limit, the same to the last bit in every direction.
        time_step: TimeStep::Given(1.7e-6),
        mesh,
    })
    .unwrap()
}

const STRAIGHT: Drive = Drive { law: Law::coulomb(0.4), rate: 0.067, force_n: 30.0, ramp_s: 1.0e-4 };

/// Largest deviation of the displacements of `b` from those of `a` over the largest one, after 1 ms, and the
/// number of steps. Node (i, j, k) of `a` is the node `image(i, j, k)` of `b`. Component c of `a` is
/// `turned[c]` (component, sign) of `b`.
fn deviation(
    a: &Model,
    b: &Model,
    image: impl Fn([usize; 3]) -> [usize; 3],
    turned: [(usize, f64); 3],
) -> (f64, usize) {
    let (mut first, mut second) = (State::<1>::at_rest(a), State::<1>::at_rest(b));
    assert_eq!(a.time_step_s().to_bits(), b.time_step_s().to_bits());
    let steps = (1.0e-3 / a.time_step_s()) as usize;
    let mut mixed = false;
    for _ in 0..steps {
        step(a, &[STRAIGHT], &mut first);
        step(b, &[STRAIGHT], &mut second);
        let states: Vec<_> = first.contacts.states(0).collect();
        mixed |= states.windows(2).any(|pair| pair[0] != pair[1]);
    }
    assert!(mixed, "a run with mixed contact states");
    let scale = first.u.values().fold(0.0_f64, |m, u| m.max(u.abs()));
    let sideways = (0..first.u.len() / 3).fold(0.0_f64, |m, node| m.max(first.u[3 * node].abs()));
    assert!(sideways > 0.01 * scale, "the one-sided clamp does move the pin sideways");
    let mut worst: f64 = 0.0;
    for node in 0..a.mesh().node_count() {
        let [i, j, k] = image(a.mesh().block().unwrap().grid_position(node));
        for (c, (to, sign)) in turned.into_iter().enumerate() {
            let found = second.u[3 * b.mesh().block().unwrap().node(i, j, k) + to];
            worst = worst.max((sign * first.u[3 * node + c] - found).abs());
        }
    }
    (worst / scale, steps)
}

const SIZE_M: [f64; 3] = [0.012, 0.015, 0.010];
const ELEMENTS: [usize; 3] = [6, 8, 5];

/// Protects: mirror symmetry in x, and rotation by a quarter turn about z, which exchanges x and y in mesh,
/// clamp and motion.
#[test]
fn mirrored_and_turned_scenes_give_mirrored_and_turned_motion() {
    let [nx, ny, _] = ELEMENTS;
    let mut evidence = Evidence::new(
        "B15",
        "mirrored and turned scenes, 1 ms, largest deviation of u over its size",
        "the problem has no handedness and no preferred direction",
    );
    let plain = straight(SIZE_M, ELEMENTS, ClampSide::InnerSide, [0.0, 1.0]);
    let mirrored = straight(SIZE_M, ELEMENTS, ClampSide::OuterSide, [0.0, 1.0]);
    let mirror = deviation(&plain, &mirrored, |[i, j, k]| [nx - i, j, k], [(0, -1.0), (1, 1.0), (2, 1.0)]);
    // x → y and y → −x: the clamp at −x moves to −y, and the motion towards +y becomes a motion towards −x.
    let turned = straight(
        [SIZE_M[1], SIZE_M[0], SIZE_M[2]],
        [ny, nx, ELEMENTS[2]],
        ClampSide::LeadingEnd,
        [-1.0, 0.0],
    );
    let turn = deviation(&plain, &turned, |[i, j, k]| [ny - j, i, k], [(1, 1.0), (0, -1.0), (2, 1.0)]);
    for (name, (found, steps)) in [("mirrored in x", mirror), ("turned by 90°", turn)] {
        let bound = 7.0_f64.exp() * steps as f64 * 2.0 * ROUNDINGS_PER_FORCE * f64::EPSILON;
        evidence.bounded(name, found, 0.0, 1.0, bound);
    }
    evidence.judge_bounded("rounding of every step, amplified by e^7");
}

/// Height of the free flight.
const HEIGHT_M: f64 = 0.01;

/// Protects: free flight. A pin that touches nothing keeps any rigid motion, translation or (linearised)
/// rotation.
#[test]
fn free_flight_is_rigid() {
    let mesh = BlockMesh::new(SIZE_M, ELEMENTS);
    let model = Model::new(definition(mesh, pin_material(0.3), Vec::new())).unwrap();
    let mesh = model.mesh().block().unwrap();
    let steps = 500;
    let mut evidence = Evidence::new(
        "B15",
        "free flight, 500 steps, largest deviation of u over the distance",
        "rigid motions are free of strain",
    );
    for (name, velocity, spin) in [
        ("translation", [0.3, -0.2, 0.5], [0.0; 3]),
        ("rotation", [0.0; 3], [20.0, 30.0, -40.0]),
        ("both", [0.3, -0.2, 0.5], [20.0, 30.0, -40.0]),
    ] {
        let mut state = State::<1>::at_rest(&model);
        for node in 0..mesh.node_count() {
            let x = mesh.coordinates_m(node);
            for c in 0..3 {
                let (d, e) = ((c + 1) % 3, (c + 2) % 3);
                state.p[3 * node + c] = velocity[c] + spin[d] * x[e] - spin[e] * x[d];
            }
            // The pin is so far above the plane that it touches nothing in 500 steps.
            state.u[3 * node + 2] = HEIGHT_M;
        }
        let before = state.p.clone();
        advance(&model, &IDLE, &mut state, steps);
        let time_s = steps as f64 * model.time_step_s();
        let fastest = before.values().fold(0.0_f64, |m, p| m.max(p.abs()));
        let worst = (0..state.u.len())
            .map(|dof| {
                let start = if dof % 3 == 2 { HEIGHT_M } else { 0.0 };
                (state.u[dof] - start - before[dof] * time_s).abs()
            })
            .fold(0.0, f64::max);
        // Each step rounds displacements of at most HEIGHT_M plus the distance, and in the force (ω_maxΔt)² ≤
        // 4 times as much. The effect of an error in the velocity grows linearly.
        let size = HEIGHT_M + fastest * time_s;
        let bound = ROUNDINGS_PER_FORCE * 4.0 * size * f64::EPSILON * (steps * steps) as f64 / 2.0;
        evidence.bounded(name, worst / (fastest * time_s), 0.0, 1.0, bound / (fastest * time_s));
    }
    evidence.judge_bounded("rounding: the error of each step drifts away at most linearly");
}

/// Protects: independent lanes. Jobs that are advanced together have the bits that each has alone, whatever
/// its companions do, in both precisions.
#[test]
fn lanes_are_independent_to_the_last_bit() {
    let model = small_model();
    let drives: [Drive; 4] = std::array::from_fn(|l| Drive {
        law: Law::coulomb(0.2 + 0.15 * l as f64),
        rate: DRIVE.rate * (1.0 + 3.0 * l as f64),
        force_n: DRIVE.force_n / (1.0 + l as f64),
        ramp_s: DRIVE.ramp_s * l as f64,
    });
    lanes_are_independent_in::<f64>(&model, &drives);
    lanes_are_independent_in::<f32>(&model, &drives);
}

fn lanes_are_independent_in<R: InLanes<1> + InLanes<4>>(model: &Model, drives: &[Drive; 4]) {
    let mut together = StateOf::<4, R>::at_rest(model);
    let mut ledger = EnergyLedger::<4, R>::new(model, 16);
    let steps = 1500;
    for _ in 0..steps {
        ledger.before_step(model, &together);
        step(model, drives, &mut together);
        ledger.after_step(model, drives, &together);
    }
    for lane in 0..4 {
        let mut alone = StateOf::<1, R>::at_rest(model);
        let mut ledger_alone = EnergyLedger::<1, R>::new(model, 16);
        for _ in 0..steps {
            ledger_alone.before_step(model, &alone);
            step(model, &[drives[lane]], &mut alone);
            ledger_alone.after_step(model, &[drives[lane]], &alone);
        }
        assert_eq!(ledger_alone.energies(0), ledger.energies(lane), "energies of lane {lane}");
        let bits = |number: R| number.to_f64().to_bits();
        for i in 0..alone.u.len() {
            assert_eq!(bits(alone.u[i]), bits(together.u[4 * i + lane]), "u[{i}] of lane {lane}");
            assert_eq!(bits(alone.p[i]), bits(together.p[4 * i + lane]), "p[{i}] of lane {lane}");
        }
        for (alone, together) in alone.contacts.forces(0).zip(together.contacts.forces(lane)) {
            assert_eq!(alone.map(f64::to_bits), together.map(f64::to_bits));
        }
        assert_eq!(alone.reaction_n[1][0].to_bits(), together.reaction_n[1][lane].to_bits());
    }
}

/// Protects: the solver's bits belong to its version. A change of the bits must raise `solver::VERSION`.
/// Otherwise results stored under the old version would be taken for new ones. The step uses only IEEE
/// operations and square roots, and the time step is given, so the bits are the same on every machine.
#[test]
fn a_change_of_bits_raises_the_version() {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.numerics.time_step_s = Some(1.5e-6);
    spec.numerics.beta_r_s = 5.0e-8;
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let found =
        (tribosweep_mechanics::solver::VERSION, hash_of_bits::<f64>(&model), hash_of_bits::<f32>(&model));
    let expected = ("10", "adbc250cfb330667".to_owned(), "2d06398b7d543222".to_owned());
    assert_eq!(found, expected, "raise solver::VERSION and write its bits here");
}

/// Hash of the fields after 2000 steps in one precision.
fn hash_of_bits<R: InLanes<1>>(model: &Model) -> String {
    let mut state = StateOf::<1, R>::at_rest(model);
    for _ in 0..2000 {
        step(model, &[DRIVE], &mut state);
    }
    let bits: Vec<u8> = state.u.values().chain(state.p.values()).flat_map(f64::to_le_bytes).collect();
    blake3::hash(&bits).to_hex()[..16].to_owned()
}
