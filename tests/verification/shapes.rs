//! B23 General meshes: cylinders, tilted pins and regions of other materials.
//!
//! * A free cylinder of height h has torsional modes with exactly f_n = n c_s/(2h). They are not dispersive, because u_θ ∝ r keeps cross
//!   sections plane (K. F. Graff, *Wave motion in elastic solids*, 1975, sec. 8.2). The polygon of the mesh and its elements
//!   both give order 2.
//! * A bar of two materials, free at its base and held at its top, has the frequencies of tan(ωh₁/c₁) tan(ωh₂/c₂) = Z₂/Z₁ with the
//!   impedances Z = ρc, from the continuity of force and displacement.
//! * A linear displacement causes no force inside any mesh (patch test: B. Irons, A. Razzaque, 1972).
//! * A tilted pin has the stiffness of the upright one in turned axes.
//! * A block has the same motion with the operator of general meshes as with its own.

use crate::verification::common::{all_of, definition, pin_material};
use crate::verification::evidence::Evidence;
use std::f64::consts::{PI, TAU};
use tribosweep_mechanics::analysis::drive;
use tribosweep_mechanics::solver::body::pin::{
    BlockMesh, GeneralMesh, Hexahedron, MeshParts, PinMesh, Tilt, cylinder,
};
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::support::Support;
use tribosweep_mechanics::solver::{Model, ModelDefinition, State, step};
use tribosweep_mechanics::spec::{Clamp, ClampSide, Element, JobSpec, Region};

const MATERIAL: Material = Material { young_modulus_pa: 1.0e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 };

/// A model without supports and load.
fn free(mesh: impl Into<PinMesh>) -> Model {
    Model::new(definition(mesh, MATERIAL, Vec::new())).unwrap()
}

/// The displacements of K u = f by conjugate gradients from `start`. Held degrees of freedom do not move.
pub fn solved(model: &Model, force: &[f64], start: Vec<f64>, held: &dyn Fn(usize) -> bool) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let free = |x: Vec<f64>| -> Vec<f64> {
        x.into_iter().enumerate().map(|(dof, x)| if held(dof) { 0.0 } else { x }).collect()
    };
    let product = |x: &[f64]| free(model.pin().stiffness_times(x));
    let force = free(force.to_vec());
    let mut solution = free(start);
    let mut residual: Vec<f64> = force.iter().zip(product(&solution)).map(|(f, y)| f - y).collect();
    let mut direction = residual.clone();
    let mut square = dot(&residual, &residual);
    let small = 1.0e-26 * dot(&force, &force);
    while square > small {
        let y = product(&direction);
        let length = square / dot(&direction, &y);
        for i in 0..solution.len() {
            solution[i] += length * direction[i];
            residual[i] -= length * y[i];
        }
        let next = dot(&residual, &residual);
        for i in 0..direction.len() {
            direction[i] = residual[i] + next / square * direction[i];
        }
        square = next;
    }
    solution
}

/// The lowest frequency [Hz] of the modes that a start contains, by inverse iteration. The start has no rigid motion, and all that it
/// has in common with modes are those of its symmetry. Held degrees of freedom do not move.
pub fn lowest_hz(model: &Model, start: &[f64], held: &dyn Fn(usize) -> bool) -> f64 {
    let masses = model.pin().masses_kg();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut x = start.to_vec();
    let mut omega_squared = f64::INFINITY;
    loop {
        let force: Vec<f64> = x.iter().enumerate().map(|(dof, x)| x * masses[dof / 3]).collect();
        let last: Vec<f64> = x.iter().map(|x| x / omega_squared.min(1.0e12)).collect();
        let solution = solved(model, &force, last, held);
        let weighted: Vec<f64> = solution.iter().enumerate().map(|(dof, x)| x * masses[dof / 3]).collect();
        let next = dot(&solution, &force) / dot(&solution, &weighted);
        let norm = dot(&solution, &weighted).sqrt();
        x = solution.iter().map(|x| x / norm).collect();
        if (next / omega_squared - 1.0).abs() < 1.0e-10 {
            return next.sqrt() / TAU;
        }
        omega_squared = next;
    }
}

/// Protects: the O-grid, its stiffness and its masses, by the torsion of a free cylinder.
#[test]
fn a_cylinder_turns_at_its_torsional_frequency() {
    let height_m = 0.010;
    let exact = MATERIAL.shear_wave_speed_m_s() / (2.0 * height_m);
    let mut evidence = Evidence::new(
        "B23",
        "torsion of a free cylinder, diameter 8 mm, height 10 mm [Hz]",
        "c_s/(2h), not dispersive",
    );
    for across in [4, 8, 16] {
        let mesh =
            GeneralMesh::new(&cylinder([0.008, 0.008, height_m], across, across), Tilt::default()).unwrap();
        let model = free(mesh);
        let mesh = model.mesh();
        let shape: Vec<f64> = (0..mesh.node_count())
            .flat_map(|node| {
                let [x, y, z] = mesh.coordinates_m(node);
                let turn = (PI * z / height_m).cos();
                [-y * turn, x * turn, 0.0]
            })
            .collect();
        let found = lowest_hz(&model, &shape, &|_| false);
        evidence.found(format!("{across} × {across} × {across} elements"), found, exact, exact);
    }
    evidence.judge_order(2.0, 2.0, 1.0e-9);
}

/// Protects: regions of other materials, by the lowest frequency of a bar of two materials.
#[test]
fn a_bar_of_two_regions_vibrates_like_two_bars() {
    let (length_m, below_m) = (0.010, 0.004);
    let upper = Material { young_modulus_pa: 5.0e9, poisson_ratio: 0.0, density_kg_m3: 7000.0 };
    let lower = pin_material(0.0);
    let speed = |material: &Material| material.pressure_wave_speed_m_s();
    let impedance = |material: &Material| material.density_kg_m3 * speed(material);
    let excess = |omega: f64| {
        (omega * below_m / speed(&lower)).tan() * (omega * (length_m - below_m) / speed(&upper)).tan()
            - impedance(&upper) / impedance(&lower)
    };
    // The left side rises from 0 to the first pole of a tangent.
    let pole = (0.5 * PI * speed(&lower) / below_m).min(0.5 * PI * speed(&upper) / (length_m - below_m));
    let (mut low, mut high) = (0.0, pole);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        *(if excess(middle) < 0.0 { &mut low } else { &mut high }) = middle;
    }
    let exact = low / TAU;
    let mut evidence = Evidence::new(
        "B23",
        "lowest axial frequency of a bar of two materials [Hz]",
        "tan(ωh₁/c₁) tan(ωh₂/c₂) = Z₂/Z₁",
    );
    for layers in [5, 10, 20] {
        let block = BlockMesh::new([0.1, 0.1, length_m], [1, 1, layers]);
        let mut parts = MeshParts::of_block(&block);
        for Hexahedron { nodes, material } in &mut parts.elements {
            *material = usize::from(block.grid_position(nodes[0])[2] * 5 >= 2 * layers);
        }
        let mesh = PinMesh::from(GeneralMesh::new(&parts, Tilt::default()).unwrap());
        let top = mesh.top_nodes();
        let fixed: Vec<usize> = [all_of(&block, 0), all_of(&block, 1)]
            .concat()
            .into_iter()
            .chain(top.iter().map(|node| 3 * node + 2))
            .collect();
        let model = Model::new(ModelDefinition {
            materials: vec![lower, upper],
            ..definition(mesh, lower, vec![Support::fixed(fixed.clone())])
        })
        .unwrap();
        let shape: Vec<f64> = (0..model.mesh().node_count())
            .flat_map(|node| [0.0, 0.0, length_m - model.mesh().coordinates_m(node)[2]])
            .collect();
        let found = lowest_hz(&model, &shape, &|dof| fixed.contains(&dof));
        evidence.found(format!("{layers} layers"), found, exact, exact);
    }
    evidence.judge_order(2.0, 2.0, 1.0e-9);
}

/// A block whose nodes, but for those of its faces, are moved by up to a quarter of an element.
pub fn distorted() -> MeshParts {
    let block = BlockMesh::new([0.012, 0.015, 0.010], [4, 5, 3]);
    let h = block.element_size_m();
    let mut parts = MeshParts::of_block(&block);
    for (node, x) in parts.coordinates_m.iter_mut().enumerate() {
        let grid = block.grid_position(node);
        if (0..3).all(|axis| grid[axis] > 0 && grid[axis] < block.elements()[axis]) {
            for (axis, x) in x.iter_mut().enumerate() {
                *x += h[axis] * 0.25 * ((node * 7919 + axis * 104_729) % 101) as f64 / 101.0;
            }
        }
    }
    parts
}

/// Protects: elements of any shape hold a uniform stress. Forces are zero at all nodes that are not on the surface.
#[test]
fn a_linear_displacement_causes_no_force_inside() {
    let mut evidence =
        Evidence::new("B23", "patch test: force inside over the force on the surface", "a uniform stress");
    let tilt = Tilt { x_rad: 0.03, y_rad: -0.02 };
    let incompatible = |parts: MeshParts| MeshParts { element: Element::Incompatible, ..parts };
    let round = || cylinder([0.008, 0.008, 0.01], 8, 4);
    for (name, parts) in [
        ("distorted block", distorted()),
        ("cylinder", round()),
        ("distorted block, incompatible elements", incompatible(distorted())),
        ("cylinder, incompatible elements", incompatible(round())),
    ] {
        let mesh = GeneralMesh::new(&parts, tilt).unwrap();
        let model = free(mesh);
        let mesh = model.mesh();
        let gradient = [[1.0, 0.3, -0.2], [0.5, -0.7, 0.4], [0.1, 0.6, 0.8]];
        let u: Vec<f64> = (0..mesh.node_count())
            .flat_map(|node| {
                let x = mesh.coordinates_m(node);
                gradient.map(|row| 1.0e-3 * (0..3).map(|axis| row[axis] * x[axis]).sum::<f64>())
            })
            .collect();
        let force = model.pin().stiffness_times(&u);
        // A face inside belongs to two elements.
        let mut faces = std::collections::BTreeMap::new();
        for nodes in mesh.element_nodes() {
            for axis in 0..3 {
                for side in 0..2 {
                    let mut face: Vec<usize> = (0..8)
                        .filter(|corner| corner >> axis & 1 == side)
                        .map(|corner| nodes[corner])
                        .collect();
                    face.sort_unstable();
                    *faces.entry(face).or_insert(0) += 1;
                }
            }
        }
        let surface: std::collections::BTreeSet<usize> =
            faces.iter().filter(|(_, count)| **count == 1).flat_map(|(face, _)| face.clone()).collect();
        let size = |node: usize| force[3 * node..3 * node + 3].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let largest = |inside: bool| {
            (0..mesh.node_count())
                .filter(|node| surface.contains(node) != inside)
                .map(size)
                .fold(0.0, f64::max)
        };
        assert!(mesh.node_count() > surface.len(), "{name}: no node inside");
        evidence.found(name, largest(true) / largest(false), 0.0, 1.0);
    }
    // A row has 81 products of at most E u each; u is a hundred times the differences of u that make the stress.
    evidence.judge_exact(100.0 * crate::verification::common::ROUNDINGS_PER_FORCE);
}

/// Protects: the frame of a tilted pin. Its stiffness is that of the upright pin in turned axes, and its gaps are those of a turned
/// plane.
#[test]
fn a_tilted_pin_is_a_turned_pin() {
    let mut evidence =
        Evidence::new("B23", "tilted pin: K in turned axes, and gaps", "rotation of an isotropic body");
    let parts = MeshParts::of_block(&BlockMesh::new([0.012, 0.015, 0.010], [3, 4, 2]));
    let tilt = Tilt { x_rad: 4.0_f64.to_radians(), y_rad: -2.0_f64.to_radians() };
    let [upright, tilted] = [Tilt::default(), tilt].map(|tilt| free(GeneralMesh::new(&parts, tilt).unwrap()));
    let u: Vec<f64> =
        (0..3 * upright.mesh().node_count()).map(|i| ((i * 7919) % 101) as f64 - 50.0).collect();
    let turned =
        |u: &[f64]| -> Vec<f64> { u.as_chunks::<3>().0.iter().flat_map(|u| tilt.turned(*u)).collect() };
    let exact = turned(&upright.pin().stiffness_times(&u));
    let found = tilted.pin().stiffness_times(&turned(&u));
    let scale = exact.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let worst = exact.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    evidence.found("force", worst / scale, 0.0, 1.0);

    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [3, 4, 2];
    spec.scene.clamp.width_m = 0.004;
    spec.scene.pin.tilt_x_deg = Some(4.0);
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let (sin, cos) = 4.0_f64.to_radians().sin_cos();
    let worst = model
        .slaves()
        .iter()
        .map(|slave| (slave.initial_gap_m - (slave.position_m[1] / cos + 0.0075) * sin).abs())
        .fold(0.0, f64::max);
    evidence.found("gap", worst / (0.015 * sin), 0.0, 1.0);
    evidence.judge_exact(10.0 * crate::verification::common::ROUNDINGS_PER_FORCE);
}

/// Protects: the operator of general meshes. A block in two regions of one material moves like the block, under a clamp of the top face and
/// in a collet, and their macroscopic friction agrees.
#[test]
fn a_block_moves_alike_with_both_operators() {
    let mut evidence = Evidence::new(
        "B23",
        "reference scene on 6 × 8 × 5 elements as a general mesh: displacements after 400 steps, over the largest",
        "the same scene as a block",
    );
    for (side, width_m) in [(ClampSide::InnerSide, 0.002), (ClampSide::Collet, 0.006)] {
        compare_operators(side, width_m, &mut evidence);
    }
    // Rounding of the forces, some 170 units, adds up in every step. Contact makes the motion sensitive to it: an error grows about
    // linearly while nodes open and close in the same step.
    evidence.judge_exact(crate::verification::common::ROUNDINGS_PER_FORCE * STEPS as f64);
}

/// Steps of the comparison of operators.
const STEPS: usize = 400;

fn compare_operators(side: ClampSide, width_m: f64, evidence: &mut Evidence) {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp = Clamp { side, width_m };
    spec.scene.contact.mu = 0.4;
    spec.numerics.time_step_s = Some(1.7e-6);
    let mut regions = spec.clone();
    let pin = &spec.scene.pin;
    regions.scene.pin.regions = vec![Region {
        above_m: Some(0.004),
        group: None,
        young_modulus_pa: pin.young_modulus_pa,
        poisson_ratio: pin.poisson_ratio,
        density_kg_m3: pin.density_kg_m3,
        plasticity: None,
    }];
    let run = |spec: &JobSpec| {
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let mut state = State::<1>::at_rest(&model);
        for _ in 0..STEPS {
            step(&model, &[drive(spec)], &mut state);
        }
        let u: Vec<f64> = state.u.values().collect();
        (model, u)
    };
    let ((block, expected), (general, found)) = (run(&spec), run(&regions));
    assert!(block.mesh().block().is_some() && general.mesh().block().is_none());
    let scale = expected.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let mut worst: f64 = 0.0;
    for node in 0..block.mesh().node_count() {
        // Nodes are matched by their places.
        let at = block.mesh().coordinates_m(node);
        let distance = |other: &usize| {
            let x = general.mesh().coordinates_m(*other);
            (0..3).map(|axis| (x[axis] - at[axis]).abs()).sum::<f64>()
        };
        let other =
            (0..general.mesh().node_count()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
        for c in 0..3 {
            worst = worst.max((expected[3 * node + c] - found[3 * other + c]).abs());
        }
    }
    evidence.found(side.name(), worst / scale, 0.0, 1.0);
    let limit = |model: &Model| model.pin().omega_max_rad_s();
    // The bound of a block is that of patches of elements, at most a quarter too high; that of Lanczos is 1 % too high.
    let ratio = limit(&general) / limit(&block);
    assert!(ratio <= 1.005 && ratio > 0.75, "{ratio}");
}
