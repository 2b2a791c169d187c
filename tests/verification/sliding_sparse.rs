//! B33 Complex modes of steady sliding by sparse factors, on rigid and elastic disks.
//!
//! * **On a rigid disk** they are those of the reduced problem (B30), whose corrections end at 10⁻¹⁰ of |λ|.
//! * **A stiff disk** of constant density is a rigid one: its deflection falls as 1/E, and so does the change of an eigenvalue of the
//!   pin.
//! * **A disk alone** has modes with three waves around. Their frequency comes from one column of nodes of its own K and M. A pin on a
//!   nodal line leaves one of the two such modes as it is.

use crate::verification::elastic::coarse_scene;
use crate::verification::sliding_modes::{EXACT, SURE, scene};
use faer::{Mat, Side, c64};
use std::f64::consts::TAU;
use tribosweep_mechanics::analysis;
use tribosweep_mechanics::solver::body::pin::{BlockMesh, Stiffness};
use tribosweep_mechanics::solver::body::ring::operator::RingOperator;
use tribosweep_mechanics::solver::body::ring::{RingDefinition, RingMesh};
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::interface::target::TargetDefinition;
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::support::Support;
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, TimeStep};
use tribosweep_mechanics::spec::{
    ClampSide, DiskKind, DiskTimeStep, Element, FrictionLaw, JobSpec, TargetSurface,
};
use tribosweep_mechanics::stability::{SparseStructure, Structure};

fn model(spec: &JobSpec) -> Model {
    Model::from_scene(&spec.scene, &spec.numerics).unwrap()
}

/// Protects: equilibrium and modes of the sparse equations are those of the reduced ones, with a holder, a law that depends on the
/// speed, lifted nodes, a crowned base, and damping in proportion to the mass, of which the masses of holders have none.
#[test]
fn rigid_scenes_have_the_modes_of_the_reduced_problem() {
    let mut crowned = scene([4, 5, 4], 0.003, 0.3, 20.0);
    crowned.scene.pin.base.crown_radius_m = Some(8.0);
    crowned.scene.contact.law = FrictionLaw::Exponential;
    (crowned.scene.contact.mu_static, crowned.scene.contact.speed_m_s) = (Some(0.45), Some(0.05));
    let mut damped = on_a_holder();
    damped.numerics.alpha_r_per_s = Some(2.0e3);
    have_the_modes_of_the_reduced_problem(&[crowned, damped]);
}

/// Protects: the same with fewer of these in one scene.
#[test]
#[ignore = "two more scenes, each with all its modes"]
fn more_rigid_scenes_have_the_modes_of_the_reduced_problem() {
    have_the_modes_of_the_reduced_problem(&[scene([4, 5, 4], 0.003, 0.4, 7.0), on_a_holder()]);
}

fn on_a_holder() -> JobSpec {
    let mut holder = scene([4, 5, 4], 0.003, 0.5, 7.0);
    holder.scene.clamp.side = ClampSide::TrailingEnd;
    holder.scene.holder.mass_kg = Some(0.02);
    holder.scene.holder.stiffness_y_n_m = Some(2.0e7);
    holder.scene.holder.damping_y_n_s_m = Some(5.0);
    holder
}

fn have_the_modes_of_the_reduced_problem(specs: &[JobSpec]) {
    for spec in specs {
        let (model, drive) = (model(spec), analysis::drive(spec));
        let reduced = Structure::new(&model).unwrap().point_with(&model, &drive, 4, EXACT).unwrap();
        let sparse = SparseStructure::new(&model).unwrap();
        let point = sparse.point(&model, &drive, 4).unwrap();
        assert_eq!(point.equilibrium.in_contact, reduced.equilibrium.in_contact);
        let forces = point.equilibrium.normal_n.iter().zip(&reduced.equilibrium.normal_n);
        let worst = forces.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // The reduced equilibrium ends at 10⁻¹¹ of the load or of what presses the crown flat.
        assert!(worst < 1.0e-7 * drive.force_n, "{worst:e} N");
        assert!((point.equilibrium.mu_star / reduced.equilibrium.mu_star - 1.0).abs() < 1.0e-9);
        assert!(point.modes[0].eigenvalue_per_s.re >= point.modes[1].eigenvalue_per_s.re);
        let mut compared = 0;
        for mode in reduced.modes.iter().filter(|mode| mode.is_converged) {
            let value = mode.eigenvalue_per_s;
            let near = sparse.near(&model, &drive, value.im / TAU).unwrap();
            let in_band = if value.im < TAU * point.band_hz { &point.modes } else { &near.modes };
            for modes in [in_band, &near.modes] {
                let errors = modes.iter().map(|near| (near.eigenvalue_per_s - value).norm() / value.norm());
                let error = errors.fold(f64::INFINITY, f64::min);
                println!("{value} differs by {error:e}");
                assert!(error < 1.0e-9, "{value}: {error:e}");
            }
            compared += 1;
        }
        assert!(compared >= 2, "only {compared} modes were compared");
    }
}

/// Protects: damping α M + β K takes an undamped mode with ω² to λ² + (α + βω²) λ + ω² = 0 (Rayleigh), by both ways to compute modes. Without
/// friction and contact damping the modes are those of a symmetric problem.
#[test]
fn damping_moves_modes_as_rayleigh_says() {
    let (alpha, beta) = (4.0e3, 1.0e-7);
    let mut spec = scene([3, 4, 3], 0.004, 0.0, 7.0);
    spec.numerics.beta2 = 0.5;
    let with = |alpha: f64, beta: f64| {
        let mut spec = spec.clone();
        (spec.numerics.alpha_r_per_s, spec.numerics.beta_r_s) = (Some(alpha), beta);
        (model(&spec), analysis::drive(&spec))
    };
    let reduced = |(model, drive): &(Model, Drive)| {
        Structure::new(model).unwrap().point_with(model, drive, 1000, EXACT).unwrap().modes
    };
    let undamped = reduced(&with(0.0, 0.0));
    let damped = with(alpha, beta);
    let sparse = SparseStructure::new(&damped.0).unwrap().point(&damped.0, &damped.1, 6).unwrap().modes;
    // Each way for itself: an error in one of them must not hide behind the modes of the other.
    for (way, modes) in [("reduced", reduced(&damped)), ("sparse", sparse)] {
        let mut compared = 0;
        for mode in modes.iter().filter(|mode| mode.is_converged) {
            let value = mode.eigenvalue_per_s;
            let squares = undamped.iter().map(|mode| mode.eigenvalue_per_s.im.powi(2));
            let exact = squares.map(|square| {
                let damping = alpha + beta * square;
                nalgebra::Complex::new(-0.5 * damping, (square - 0.25 * damping * damping).sqrt())
            });
            let error =
                exact.map(|exact| (exact - value).norm() / value.norm()).fold(f64::INFINITY, f64::min);
            println!("{way}: {value} differs by {error:e}");
            assert!(error < 1.0e-9, "{way}: {value}: {error:e}");
            compared += 1;
        }
        assert!(compared >= 6, "only {compared} modes were compared: {way}");
    }
}

/// Protects: an elastic disk that gets stiffer tends to a rigid one, as 1/E.
#[test]
fn a_stiff_disk_is_rigid() {
    let mut spec = coarse_scene();
    spec.scene.contact.mu = 0.4;
    // A few elements show the limit as well as many.
    spec.scene.pin.elements = [3, 4, 3];
    spec.scene.clamp.width_m = 0.004;
    spec.scene.disk.ring.element_size_m = 0.012;
    spec.scene.disk.ring.coarse_element_size_m = 0.06;
    let elastic = |spec: &JobSpec, hz: f64| {
        let model = model(spec);
        let near = SparseStructure::new(&model).unwrap().near(&model, &analysis::drive(spec), hz).unwrap();
        near.modes.iter().map(|mode| mode.eigenvalue_per_s).collect::<Vec<_>>()
    };
    let mut rigid = spec.clone();
    rigid.scene.disk.kind = DiskKind::Rigid;
    let rigid_model = model(&rigid);
    let drive = analysis::drive(&rigid);
    let exact =
        Structure::new(&rigid_model).unwrap().point_with(&rigid_model, &drive, 4, EXACT).unwrap().modes[0]
            .eigenvalue_per_s;
    let mut errors = Vec::new();
    for young_modulus_pa in [2.0e13, 2.0e14, 2.0e15] {
        spec.scene.disk.ring.young_modulus_pa = young_modulus_pa;
        let values = elastic(&spec, exact.im / TAU);
        let error =
            values.iter().map(|value| (value - exact).norm() / exact.norm()).fold(f64::INFINITY, f64::min);
        println!("E = {young_modulus_pa:e}: {error:e} of {exact}");
        errors.push(error);
    }
    for pair in errors.windows(2) {
        // The next term is of the order of the error itself.
        assert!((pair[0] / pair[1] / 10.0 - 1.0).abs() < 0.1, "{errors:?}");
    }
}

/// The lowest frequency [Hz] of a disk alone with three waves around. K of a uniform ring couples a column of nodes with its two
/// neighbours, whose displacements differ by a factor e^(±3iΔ). So one column has all modes with three waves.
fn three_waves_hz(mesh: &RingMesh) -> f64 {
    let (operator, masses_kg) = RingOperator::of_mesh(mesh, &ALUMINIUM);
    let [columns, rows, planes] = mesh.nodes_per_axis();
    let unknown = |i: usize, k: usize, c: usize| (k * (rows - 1) + i - 1) * 3 + c;
    let size = 3 * (rows - 1) * planes;
    let mut matrix = Mat::<c64>::zeros(size, size);
    for (k, i, c) in (0..planes).flat_map(|k| (1..rows).flat_map(move |i| (0..3).map(move |c| (k, i, c)))) {
        let node = mesh.node(0, i, k);
        for (column, value) in operator.row(3 * node + c) {
            let [j, other_i, other_k] = mesh.grid_position(column / 3);
            if other_i == 0 {
                continue;
            }
            let step = if j == columns - 1 { -1.0 } else { j as f64 };
            let (sin, cos) = (3.0 * step * TAU / columns as f64).sin_cos();
            let mass_kg = (masses_kg[node] * masses_kg[mesh.node(0, other_i, other_k)]).sqrt();
            matrix[(unknown(i, k, c), unknown(other_i, other_k, column % 3))] +=
                c64::new(cos, sin) * (value / mass_kg);
        }
    }
    matrix.self_adjoint_eigenvalues(Side::Lower).unwrap()[0].sqrt() / TAU
}

const ALUMINIUM: Material = Material { young_modulus_pa: 7.0e10, poisson_ratio: 0.33, density_kg_m3: 2700.0 };

/// Protects: stiffness and mass of the disk, and which nodes it is held by. Without friction a pin that stands on a nodal line
/// leaves a mode of the disk as it is.
#[test]
fn a_mode_of_the_disk_is_left_alone() {
    let mesh = RingMesh::uniform(TAU, [0.008, 0.179], 0.025, [24, 6, 2]);
    let exact_hz = three_waves_hz(&mesh);
    let pin = BlockMesh::new([0.01, 0.01, 0.03], [2, 2, 4]);
    let held = (0..mesh.node_count()).filter(|node| mesh.grid_position(*node)[1] == 0).collect();
    let definition = ModelDefinition {
        supports: vec![Support::fixed(pin.top_nodes().flat_map(|node| 3 * node..3 * node + 3))],
        mesh: pin.into(),
        materials: vec![ALUMINIUM],
        stiffness: Stiffness::Elastic,
        load: Vec::new(),
        target: TargetDefinition::Ring(RingDefinition {
            element: Element::Full,
            mesh,
            material: ALUMINIUM,
            held,
            target: TargetSurface::Bilinear,
            clock: DiskTimeStep::Own,
            track_radius_m: 0.162,
        }),
        beta2: 0.5,
        beta_r_s: 0.0,
        alpha_r_per_s: 0.0,
        time_step: TimeStep::FractionOfLimit(0.5),
    };
    // Only the middle of the base touches, under which the nodal line is, and the held pin presses it down.
    let gap_m = |position_m: [f64; 2]| if position_m[1].abs() < 1.0e-4 { -1.0e-6 } else { 1.0e-4 };
    let model = Model::new(definition).unwrap().with_initial_gaps(|slave| gap_m(slave.position_m));
    let drive = Drive { law: Law::coulomb(0.0), rate: 2.0, force_n: 1.0, ramp_s: 0.0 };
    let near = SparseStructure::new(&model).unwrap().near(&model, &drive, exact_hz).unwrap();
    let errors = near.modes.iter().map(|mode| (mode.eigenvalue_per_s.im / (TAU * exact_hz) - 1.0).abs());
    let error = errors.fold(f64::INFINITY, f64::min);
    println!("{exact_hz} Hz, differs by {error:e}");
    // K ends at 10⁻¹⁶ of the fastest mode, whose ω² is 10⁴ times that of this one.
    assert!(error < 1.0e-10, "{exact_hz} Hz: {error:e}");
}

/// Protects: no growing mode is missed where most nodes are lifted, which then have patterns of forces instead of one force each.
#[test]
fn no_growing_mode_is_missed_where_most_nodes_are_lifted() {
    let mut crowned = scene([6, 8, 5], 0.002, 0.8, 100.0);
    crowned.scene.clamp.side = ClampSide::WholeTop;
    crowned.scene.pin.base.crown_radius_m = Some(2.0);
    crowned.numerics.beta_r_s = 1.0e-8;
    let [lifted, growing] = no_growing_mode_is_missed(&crowned);
    assert!(lifted > 40 && growing >= 3, "{lifted} nodes are lifted, {growing} modes grow");
}

/// Protects: no growing mode is missed where nodes are lifted. The basis of the reduced problem holds all slave nodes in z, and a mode in which
/// lifted nodes move may grow fastest.
#[test]
#[ignore = "twenty scenes, each with all its modes"]
fn no_growing_mode_is_missed_where_nodes_are_lifted() {
    let mut lifting = 0;
    for elements in [[5, 6, 4], [6, 8, 5], [8, 10, 7]] {
        for side in [ClampSide::TrailingEnd, ClampSide::WholeTop, ClampSide::BothSides] {
            for (mu, beta_r_s) in [(0.5, 5.0e-8), (0.6, 2.0e-7)] {
                let along = if side == ClampSide::TrailingEnd { 0.015 / elements[1] as f64 } else { 0.0 };
                let mut spec = scene(elements, along.max(0.012 / elements[0] as f64), mu, 100.0);
                spec.scene.clamp.side = side;
                spec.numerics.beta_r_s = beta_r_s;
                let [lifted, _] = no_growing_mode_is_missed(&spec);
                lifting += usize::from(lifted > 0);
            }
        }
    }
    // A holder's damper and the slope of a law act beside the lifted nodes.
    let mut holder = scene([6, 8, 5], 0.001_875, 0.5, 100.0);
    holder.scene.clamp.side = ClampSide::TrailingEnd;
    (holder.scene.holder.mass_kg, holder.scene.holder.stiffness_y_n_m) = (Some(0.02), Some(2.0e7));
    holder.scene.holder.damping_y_n_s_m = Some(5.0);
    let mut falling = scene([6, 8, 5], 0.002, 0.5, 100.0);
    falling.scene.clamp.side = ClampSide::BothSides;
    falling.scene.contact.law = FrictionLaw::Exponential;
    (falling.scene.contact.mu_static, falling.scene.contact.speed_m_s) = (Some(0.65), Some(0.5));
    for spec in [holder, falling] {
        let [lifted, growing] = no_growing_mode_is_missed(&spec);
        assert!(lifted > 0 && growing == 3, "{lifted} nodes are lifted, {growing} modes grow");
    }
    assert!(lifting > 12, "only {lifting} scenes have lifted nodes");
}

/// Compares the three fastest growing modes of the sparse problem with those of the reduced one. Returns the numbers of lifted nodes and of
/// these modes.
fn no_growing_mode_is_missed(spec: &JobSpec) -> [usize; 2] {
    let (model, drive) = (model(spec), analysis::drive(spec));
    let reduced = Structure::new(&model).unwrap().point(&model, &drive, 8).unwrap();
    let sparse = SparseStructure::new(&model).unwrap().point(&model, &drive, 16).unwrap();
    // A mode of the sparse problem is one beyond its band, too.
    let sure = TAU * SURE * reduced.band_hz;
    let values = sparse.modes.iter().map(|mode| mode.eigenvalue_per_s);
    let growing: Vec<c64> = values.filter(|value| value.re > 0.0 && value.im < sure).take(3).collect();
    for value in &growing {
        let errors = reduced.modes.iter().map(|other| (other.eigenvalue_per_s - value).norm());
        // The corrections end at a residual of 0.5 %.
        let error = errors.fold(f64::INFINITY, f64::min) / value.norm();
        assert!(error < 0.003, "{:?}, {:?}: {value} is missed, {error}", spec.scene.pin, spec.scene.clamp);
    }
    let in_contact = reduced.equilibrium.in_contact.iter();
    [in_contact.filter(|on| !**on).count(), growing.len()]
}
