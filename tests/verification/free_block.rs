//! B1 Free vibrations of a traction-free block.
//!
//! Problem: the eigenfrequencies of K φ = ω² M φ with the program's own stiffness and lumped mass. They tend
//! to those of the elastic block with order 2 in the element size. For smooth modes, the trilinear field
//! makes ω² O(h²) too high and lumping the mass makes it O(h²) too low (G. Strang, G. J. Fix, *An analysis of
//! the finite element method*, 1973, ch. 6).
//!
//! Exact answers:
//! * Six rigid motions cause no force.
//! * Lamé's equivoluminal mode of a square section of side a, u = (sin πx/a cos πy/a, −cos πx/a sin πy/a, 0)
//!   about its centre, in a plane or in a block of any height, has f = c_s/(√2 a) for any Poisson's ratio,
//!   because it has neither dilatation nor traction on any face (G. Lamé, *Leçons sur la théorie mathématique
//!   de l'élasticité*, 1852).
//! * All other modes come from the Rayleigh–Ritz method with Legendre polynomials up to degree 14 (Demarest
//!   1971; Visscher et al. 1991; see `ritz`), which the tests compute themselves. The error of degree 14 is
//!   less than its change from degree 12. For the 12 × 15 × 10 mm pin (1 GPa, ν = 0.3, 2500 kg/m³) the
//!   frequencies are 11594.8, 15191.1, 16238.8, 18083.2, 18329.0, 19833.4, 20149.3, 21144.1, 21371.6,
//!   22050.0, 22650.3 and 22801.9 Hz. For a cube of side L, f L/c_s = 0.45456, 0.61211, 0.62250, 1/√2,
//!   0.72778, 0.76276.
//!
//! Modes are matched by mirror class and rank within it, which refinement does not change (see `modes`).
//! Lamé's mode is matched by its shape. Frequencies of degenerate modes are shown once.
//!
//! In two modes (the pin's fifth, the cube's third) the h² errors of the lumped mass, which lower a
//! frequency, and of the trilinear field, which raise it, nearly cancel on elements of equal sides. The
//! remainder is small and has no single order, so the case there is the overall order from the coarsest mesh
//! on.

use crate::verification::common::{all_of, definition, pin_material, stiffness_rows};
use crate::verification::evidence::Evidence;
use crate::verification::modes::{CLASSES, MirrorClass, Mode, lowest_modes};
use crate::verification::ritz;
use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::solver::body::pin::BlockMesh;
use tribosweep_mechanics::solver::support::Support;

const PIN_M: [f64; 3] = [0.012, 0.015, 0.010];
const SIDE_M: f64 = 0.010;
const RITZ: &str = "Rayleigh–Ritz, Legendre polynomials to degree 14 (Demarest 1971)";
const LAME: &str = "Lamé's equivoluminal mode, c_s/(√2 a)";
const CANCELS: &str = "the h² errors of lumped mass and trilinear field nearly cancel in this mode";
/// This shift is below every elastic frequency here, so that the inverse iteration is well-conditioned and
/// quick.
const SHIFT_HZ: f64 = 3000.0;

/// A block with the rows of its stiffness.
struct Block {
    model: Model,
    rows: Vec<Vec<(usize, f64)>>,
}

impl Block {
    fn new(size_m: [f64; 3], poisson_ratio: f64, elements: [usize; 3], held: Vec<usize>) -> Self {
        let mesh = BlockMesh::new(size_m, elements);
        let supports = vec![Support::fixed(held)];
        let model = Model::new(definition(mesh, pin_material(poisson_ratio), supports)).unwrap();
        let rows = stiffness_rows(&model);
        Self { model, rows }
    }

    fn modes(&self, class: MirrorClass, count: usize) -> Vec<Mode> {
        lowest_modes(&self.model, &self.rows, class, count, SHIFT_HZ, &|_| false)
    }
}

/// A mode of the Rayleigh–Ritz method, its rank in its class, and the relative error that the method leaves.
struct Reference {
    class: MirrorClass,
    rank: usize,
    frequency_hz: f64,
    remainder: f64,
}

/// The lowest `count` distinct elastic modes of the given classes, ascending.
fn references(size_m: [f64; 3], classes: &[MirrorClass], count: usize) -> Vec<Reference> {
    let material = pin_material(0.3);
    let mut all: Vec<Reference> = Vec::new();
    for &class in classes {
        let coarse = ritz::frequencies_hz(size_m, &material, 12, class);
        let fine = ritz::frequencies_hz(size_m, &material, 14, class);
        // The ω² of a rigid motion is a rounding error of the largest ω², so its frequency stays far below a
        // kilohertz.
        for rank in (0..count).filter(|&rank| fine[rank] > 1000.0) {
            let frequency_hz = fine[rank];
            let remainder = (coarse[rank] / frequency_hz - 1.0).abs();
            all.push(Reference { class, rank, frequency_hz, remainder });
        }
    }
    all.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    all.dedup_by(|a, b| a.class == b.class && (a.frequency_hz / b.frequency_hz - 1.0).abs() < 1e-9);
    all.truncate(count);
    all
}

fn label(elements: [usize; 3]) -> String {
    let [nx, ny, nz] = elements;
    format!("{nx} × {ny} × {nz} elements")
}

/// Protects: stiffness, mass and assembly of the solver together give the pin's twelve lowest modes.
#[test]
fn pin_frequencies_converge_with_order_two() {
    pin_frequencies("", &[1, 2, 4]);
}

/// Protects: the same on one finer mesh, 32 × 40 × 24. It takes a minute or two.
#[test]
#[ignore = "a mesh of 32 × 40 × 24 elements"]
fn pin_frequencies_on_a_fine_mesh() {
    pin_frequencies(" (fine)", &[1, 2, 4, 8]);
}

/// The pin's frequencies on meshes of `scales` times 4 × 5 × 3 elements.
fn pin_frequencies(suffix: &str, scales: &[usize]) {
    let stated = [
        11594.8, 15191.1, 16238.8, 18083.2, 18329.0, 19833.4, 20149.3, 21144.1, 21371.6, 22050.0, 22650.3,
        22801.9,
    ];
    let references = references(PIN_M, &CLASSES, stated.len());
    let meshes: Vec<[usize; 3]> = scales.iter().map(|s| [4 * s, 5 * s, 3 * s]).collect();
    let found: Vec<_> = meshes
        .iter()
        .map(|&elements| {
            let block = Block::new(PIN_M, 0.3, elements, Vec::new());
            CLASSES.map(|class| block.modes(class, 3))
        })
        .collect();
    for (number, (reference, stated)) in references.iter().zip(stated).enumerate() {
        let &Reference { class, rank, frequency_hz: exact, remainder } = reference;
        assert!((exact - stated).abs() < 0.1, "mode {number}: {exact} Hz, the head comment says {stated} Hz");
        let quantity = format!("pin, free mode {:02}{suffix}, frequency [Hz]", number + 1);
        let mut evidence = Evidence::new("B1", quantity, RITZ);
        let place = CLASSES.iter().position(|c| *c == class).expect("one of all classes");
        for (elements, modes) in meshes.iter().zip(&found) {
            evidence.found(label(*elements), modes[place][rank].frequency_hz, exact, exact);
        }
        if number == 4 {
            evidence.judge_overall_order(2.0, 2.0, CANCELS);
        } else {
            evidence.judge_order(2.0, 2.0, remainder);
        }
    }
}

/// Protects: the same on a cube, whose modes are degenerate. This tests the cubic symmetry of element and
/// assembly.
#[test]
fn cube_frequencies_converge_with_order_two() {
    let stated = [0.45456, 0.61211, 0.62250, 0.5_f64.sqrt(), 0.72778, 0.76276];
    // One class of each set of classes that are equal by the cube's symmetry.
    let classes = [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, -1.0]];
    let size_m = [SIDE_M; 3];
    let references = references(size_m, &classes, stated.len());
    let unit_hz = pin_material(0.3).shear_wave_speed_m_s() / SIDE_M;
    let meshes = [4, 8, 16].map(|n| [n; 3]);
    let blocks = meshes.map(|elements| Block::new(size_m, 0.3, elements, Vec::new()));
    for (number, (reference, stated)) in references.iter().zip(stated).enumerate() {
        let &Reference { class, rank, frequency_hz, remainder } = reference;
        let exact = frequency_hz / unit_hz;
        assert!((exact - stated).abs() < 1e-5, "mode {number}: {exact}, the head comment says {stated}");
        let mut evidence = Evidence::new("B1", format!("cube, free mode {}, f L/c_s", number + 1), RITZ);
        for (elements, block) in meshes.iter().zip(&blocks) {
            let found = block.modes(class, rank + 1)[rank].frequency_hz / unit_hz;
            evidence.found(label(*elements), found, exact, exact);
        }
        if number == 2 {
            evidence.judge_overall_order(2.0, 2.0, CANCELS);
        } else {
            evidence.judge_order(2.0, 2.0, remainder);
        }
    }
}

/// The frequency of the one mode that has Lamé's shape in the plane of the axes `plane`.
fn lame_frequency_hz(model: &Model, modes: &[Mode], plane: [usize; 2], side_m: f64) -> f64 {
    let mesh = model.mesh().block().unwrap();
    let centre = [0.0, 0.0, mesh.size_m()[2] / 2.0];
    let mut shape = vec![0.0; 3 * mesh.node_count()];
    for node in 0..mesh.node_count() {
        let x = mesh.coordinates_m(node);
        let [a, b] = plane.map(|axis| std::f64::consts::PI * (x[axis] - centre[axis]) / side_m);
        shape[3 * node + plane[0]] = a.sin() * b.cos();
        shape[3 * node + plane[1]] = -a.cos() * b.sin();
    }
    let product = |x: &[f64], y: &[f64]| -> f64 {
        (0..x.len()).map(|dof| x[dof] * y[dof] * model.pin().masses_kg()[dof / 3]).sum()
    };
    let norm = product(&shape, &shape);
    // The shares of the shape's square in orthonormal modes add up to at most 1, so only one share can exceed
    // a half.
    let alike: Vec<&Mode> =
        modes.iter().filter(|mode| product(&mode.shape, &shape).powi(2) > 0.5 * norm).collect();
    assert_eq!(alike.len(), 1, "one mode has Lamé's shape");
    alike[0].frequency_hz
}

/// Protects: shear stiffness and mass are right in three dimensions. The block is flat, so that no other mode
/// of its class is within a tenth of Lamé's frequency and mixes with it on a coarse mesh. ν is above 0,
/// because at ν = 0 the bar modes c_0/2a of both directions coincide with Lamé's mode.
#[test]
fn lame_mode_of_a_block_of_square_section() {
    for poisson_ratio in [0.15, 0.3] {
        let exact = pin_material(poisson_ratio).shear_wave_speed_m_s() / (2.0_f64.sqrt() * SIDE_M);
        let quantity = format!("Lamé mode of a 10 × 10 × 4 mm block, ν = {poisson_ratio}, frequency [Hz]");
        let mut evidence = Evidence::new("B1", quantity, LAME);
        for scale in [1, 2, 4] {
            let elements = [5 * scale, 5 * scale, 2 * scale];
            let block = Block::new([SIDE_M, SIDE_M, 0.004], poisson_ratio, elements, Vec::new());
            let modes = block.modes([1.0; 3], 4);
            let found = lame_frequency_hz(&block.model, &modes, [0, 1], SIDE_M);
            evidence.found(label(elements), found, exact, exact);
        }
        evidence.judge_order(2.0, 2.0, ITERATION);
    }
}

/// Relative error of a frequency after the subspace iteration. It stops at changes of 10⁻¹² of ω² + shift.
const ITERATION: f64 = 1e-11;

/// Protects: the same in plane strain by held degrees of freedom, up to a nearly incompressible material.
/// That material takes finer meshes before the order shows. ν is above 0 for the same reason.
#[test]
fn lame_mode_of_a_square_in_plane_strain() {
    for poisson_ratio in [0.15, 0.3, 0.45] {
        let exact = pin_material(poisson_ratio).shear_wave_speed_m_s() / (2.0_f64.sqrt() * SIDE_M);
        let quantity = format!("Lamé mode of a square, plane strain, ν = {poisson_ratio}, frequency [Hz]");
        let mut evidence = Evidence::new("B1", quantity, LAME);
        for n in [8, 16, 32] {
            let size_m = [SIDE_M; 3];
            let held = all_of(&BlockMesh::new(size_m, [1, n, n]), 0);
            let block = Block::new(size_m, poisson_ratio, [1, n, n], held);
            let held = |dof: usize| dof.is_multiple_of(3);
            let modes = lowest_modes(&block.model, &block.rows, [1.0; 3], 4, SHIFT_HZ, &held);
            let found = lame_frequency_hz(&block.model, &modes, [1, 2], SIDE_M);
            evidence.found(format!("{n} × {n} elements"), found, exact, exact);
        }
        evidence.judge_order(2.0, 2.0, ITERATION);
    }
}

/// Protects: the reference method itself is right. Lamé's mode is no polynomial, but degree 14 gives it to
/// rounding.
#[test]
fn rayleigh_ritz_finds_the_lame_mode() {
    let mut evidence = Evidence::new("B1", "cube, Lamé mode by Rayleigh–Ritz, f L/c_s", LAME);
    for poisson_ratio in [0.0, 0.3, 0.45] {
        let material = pin_material(poisson_ratio);
        let unit_hz = material.shear_wave_speed_m_s() / SIDE_M;
        let found = ritz::frequencies_hz([SIDE_M; 3], &material, 14, [1.0; 3]);
        let exact = 0.5_f64.sqrt();
        let nearest =
            found.iter().map(|f| f / unit_hz).min_by(|a, b| (a - exact).abs().total_cmp(&(b - exact).abs()));
        // The eigenvalues of an n × n matrix round by n ε of the largest; half of that goes to a frequency.
        let largest = found[found.len() - 1] / unit_hz / exact;
        let rounding = 0.5 * found.len() as f64 * f64::EPSILON * largest * largest;
        // The Taylor remainder of sine and cosine at π/2 beyond degree 15 is (π/2)^15/15! < 7·10⁻¹⁰ in the
        // shape, and its square in the frequency.
        let bound = rounding + 7e-10_f64.powi(2);
        evidence.bounded(format!("ν = {poisson_ratio}"), nearest.expect("modes"), exact, exact, bound);
    }
    evidence.judge_bounded("rounding of the dense eigenvalues");
}

/// Largest component of K u, relative to the sum of magnitudes of the terms that cancel in it.
fn relative_force(model: &Model, rows: &[Vec<(usize, f64)>], u: &[f64]) -> f64 {
    let force = model.pin().stiffness_times(u);
    let cancels = |row: &Vec<(usize, f64)>| row.iter().map(|(c, k)| (k * u[*c]).abs()).sum::<f64>();
    force.iter().zip(rows).map(|(f, row)| f.abs() / cancels(row)).fold(0.0, f64::max)
}

/// Protects: translations and linearised rotations cause no force (B15 for the elastic operator).
#[test]
fn rigid_motions_carry_no_force() {
    let mut evidence =
        Evidence::new("B15", "rigid motion, |K u| over Σ|K||u|", "rigid motion strains nothing");
    for elements in [[4, 5, 3], [12, 15, 10]] {
        let block = Block::new(PIN_M, 0.3, elements, Vec::new());
        let mesh = block.model.mesh().block().unwrap();
        for motion in 0..6 {
            let mut u = vec![0.0; 3 * mesh.node_count()];
            for node in 0..mesh.node_count() {
                let x = mesh.coordinates_m(node);
                let axis = motion % 3;
                let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
                if motion < 3 {
                    u[3 * node + axis] = 1.0;
                } else {
                    // Axis × x.
                    u[3 * node + c] = x[b];
                    u[3 * node + b] = -x[c];
                }
            }
            let name = ["translation", "rotation"][motion / 3];
            let resolution = format!("{}, {name} {}", label(elements), ["x", "y", "z"][motion % 3]);
            evidence.found(resolution, relative_force(&block.model, &block.rows, &u), 0.0, 1.0);
        }
    }
    // An entry of K is a sum over 8 Gauss points of some 10 roundings each and over 8 elements. A row has 81
    // products.
    evidence.judge_exact(8.0 * 10.0 + 8.0 + 81.0);
}
