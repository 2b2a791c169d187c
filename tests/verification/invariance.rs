//! B15 Invariances of the problem: homogeneity, mirror symmetry, independence of lanes.

use tribosweep::solver::boundary;
use tribosweep::solver::disk;
use tribosweep::solver::energy::EnergyLedger;
use tribosweep::solver::field::Field;
use tribosweep::solver::material::Material;
use tribosweep::solver::mesh::BlockMesh;
use tribosweep::solver::{Drive, Model, ModelDefinition, State, Stiffness, TimeStep, step};
use tribosweep::spec::{Clamp, ClampSide, JobSpec, TopFace};

fn small_model() -> Model {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    Model::from_scene(&spec.scene, &spec.numerics).unwrap()
}

const DRIVE: Drive = Drive { mu: 0.4, rate: 0.733, force_n: 30.0, ramp_s: 5.0e-4 };

/// Homogeneity: (F, V) → s(F, V) scales displacements, velocities and contact forces by s. Scaling by
/// a power of two is exact in binary, so the whole trajectory, through stick, slip and separation,
/// must be the same bits but for the exponent.
#[test]
fn scaling_load_and_speed_by_powers_of_two_scales_the_bits() {
    let model = small_model();
    for scale in [2.0_f64.powi(-20), 0.5, 4.0, 2.0_f64.powi(15)] {
        let scaled_drive = Drive { rate: scale * DRIVE.rate, force_n: scale * DRIVE.force_n, ..DRIVE };
        let mut plain = State::<1>::at_rest(&model);
        let mut scaled = State::<1>::at_rest(&model);
        for _ in 0..3000 {
            step(&model, &[DRIVE], &mut plain);
            step(&model, &[scaled_drive], &mut scaled);
        }
        let same = |a: &Field<1>, b: &Field<1>| {
            a.values().zip(b.values()).all(|(a, b)| (scale * a).to_bits() == b.to_bits())
        };
        assert!(same(&plain.u, &scaled.u) && same(&plain.p, &scaled.p), "fields, scale {scale}");
        assert_eq!(plain.contacts.state, scaled.contacts.state, "states, scale {scale}");
        for (a, b) in plain.contacts.force_n.iter().zip(&scaled.contacts.force_n) {
            assert!(
                (0..3).all(|c| (scale * a[c][0]).to_bits() == b[c][0].to_bits()),
                "forces, scale {scale}"
            );
        }
        let states: Vec<_> = plain.contacts.state.iter().map(|s| s[0]).collect();
        assert!(states.windows(2).any(|pair| pair[0] != pair[1]), "a run with mixed contact states");
    }
}

/// The pin on a plane that moves straight towards +y.
fn straight(side: ClampSide) -> Model {
    let mesh = BlockMesh::new([0.012, 0.015, 0.010], [6, 8, 5]);
    let strip = boundary::clamped_strip(&mesh, &Clamp { side, width_m: 0.002 }).unwrap();
    Model::new(ModelDefinition {
        material: Material { young_modulus_pa: 1.0e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 },
        stiffness: Stiffness::Elastic,
        constraints: boundary::constraints(&mesh, &strip, TopFace::TiedInZ),
        load: boundary::normal_load(&mesh),
        surface_motion: disk::straight_plane(&mesh),
        beta2: 0.5,
        beta_r_s: 5.0e-8,
        time_step: TimeStep::FractionOfLimit(0.7),
        mesh,
    })
    .unwrap()
}

/// Mirror symmetry in x on a straight-moving plane: the clamp at −x gives the mirror image of the clamp
/// at +x. Summation orders differ, so the images agree to rounding, which the unstable sliding state
/// amplifies by at most e^(7000/s · 1 ms) ≈ 10³ over the run.
#[test]
fn mirrored_clamps_give_mirrored_motion() {
    let (inner, outer) = (straight(ClampSide::InnerSide), straight(ClampSide::OuterSide));
    let drive = Drive { rate: 0.067, ramp_s: 1.0e-4, ..DRIVE };
    let (mut a, mut b) = (State::<1>::at_rest(&inner), State::<1>::at_rest(&outer));
    let steps = (1.0e-3 / inner.time_step_s()) as usize;
    for _ in 0..steps {
        step(&inner, &[drive], &mut a);
        step(&outer, &[drive], &mut b);
    }
    let mesh = inner.mesh();
    let scale = a.u.values().fold(0.0_f64, |m, u| m.max(u.abs()));
    let mut sideways: f64 = 0.0;
    for node in 0..mesh.node_count() {
        let [i, j, k] = mesh.grid_position(node);
        let image = mesh.node(mesh.elements()[0] - i, j, k);
        for (c, sign) in [(0, -1.0), (1, 1.0), (2, 1.0)] {
            let error = (a.u[3 * node + c] - sign * b.u[3 * image + c]).abs();
            assert!(
                error < 1e3 * 1e3 * f64::EPSILON * scale,
                "node {node}, component {c}: {error:e} of {scale:e}"
            );
        }
        sideways = sideways.max(a.u[3 * node].abs());
    }
    assert!(sideways > 0.01 * scale, "the one-sided clamp does move the pin sideways");
}

/// Lanes: jobs advanced together give the bits that each gives alone, whatever its companions do.
#[test]
fn lanes_are_independent_to_the_last_bit() {
    let model = small_model();
    let drives: [Drive; 4] = std::array::from_fn(|l| Drive {
        mu: 0.2 + 0.15 * l as f64,
        rate: DRIVE.rate * (1.0 + 3.0 * l as f64),
        force_n: DRIVE.force_n / (1.0 + l as f64),
        ramp_s: DRIVE.ramp_s * l as f64,
    });
    let mut together = State::<4>::at_rest(&model);
    let mut ledger = EnergyLedger::<4>::new(&model, 16);
    let steps = 1500;
    for _ in 0..steps {
        ledger.before_step(&model, &together);
        step(&model, &drives, &mut together);
        ledger.after_step(&model, &drives, &together);
    }
    for lane in 0..4 {
        let mut alone = State::<1>::at_rest(&model);
        let mut ledger_alone = EnergyLedger::<1>::new(&model, 16);
        for _ in 0..steps {
            ledger_alone.before_step(&model, &alone);
            step(&model, &[drives[lane]], &mut alone);
            ledger_alone.after_step(&model, &[drives[lane]], &alone);
        }
        assert_eq!(ledger_alone.energies(0), ledger.energies(lane), "energies of lane {lane}");
        for (i, u) in alone.u.values().enumerate() {
            assert_eq!(u.to_bits(), together.u[4 * i + lane].to_bits(), "u[{i}] of lane {lane}");
            assert_eq!(alone.p[i].to_bits(), together.p[4 * i + lane].to_bits(), "p[{i}] of lane {lane}");
        }
        for (slave, force) in alone.contacts.force_n.iter().enumerate() {
            for c in 0..3 {
                assert_eq!(force[c][0].to_bits(), together.contacts.force_n[slave][c][lane].to_bits());
            }
        }
        assert_eq!(alone.reaction_n[1][0].to_bits(), together.reaction_n[1][lane].to_bits());
    }
}

/// The solver's bits belong to its version: a change of them must raise `solver::VERSION`, or results
/// stored under the old one would be taken for new ones. The step uses only IEEE operations and square
/// roots, and the time step is given, so the bits are the same on every machine.
#[test]
fn a_change_of_bits_raises_the_version() {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.numerics.time_step_s = Some(1.5e-6);
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let mut state = State::<1>::at_rest(&model);
    for _ in 0..2000 {
        step(&model, &[DRIVE], &mut state);
    }
    let bits: Vec<u8> = state.u.values().chain(state.p.values()).flat_map(f64::to_le_bytes).collect();
    let found = (tribosweep::solver::VERSION, blake3::hash(&bits).to_hex()[..16].to_owned());
    assert_eq!(found, ("1", "20ea3f919eb2da22".to_owned()), "raise solver::VERSION and write its bits here");
}
