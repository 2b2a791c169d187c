//! B24 Elements that bend: incompatible modes on general meshes.
//!
//! * A slender cantilever of two elements across has the first bending mode of Timoshenko's beam: with b² = ρAL⁴ω²/EI, r² = I/(AL²) and
//!   s² = EI/(kAGL²), 2 + (b²(r² − s²)² + 2) cosh bα cos bβ − b (r² + s²)/√(1 − b²r²s²) sinh bα sin bβ = 0 (T. C. Huang, J. Appl. Mech.
//!   28, 1961) and k = 10(1 + ν)/(12 + 11ν) (G. R. Cowper, J. Appl. Mech. 33, 1966).
//! * Cook's membrane: a tapered panel that is held at one side and sheared at the other, in plane stress with E = 1, ν = ⅓, thickness 1 and
//!   force 1. The deflection of the middle of the free side converges to 23.96 (R. D. Cook, J. Struct. Div. ASCE 100, 1974; the value is that of
//!   J. C. Simo and M. S. Rifai, IJNME 29, 1990).

use crate::verification::common::definition;
use crate::verification::evidence::Evidence;
use crate::verification::shapes::{lowest_hz, solved};
use std::f64::consts::TAU;
use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::solver::body::pin::{BlockMesh, GeneralMesh, MeshParts, Tilt};
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::spec::Element;

fn model(parts: &MeshParts, material: Material) -> Model {
    Model::new(definition(GeneralMesh::new(parts, Tilt::default()).unwrap(), material, Vec::new())).unwrap()
}

const BEAM_M: [f64; 3] = [0.010, 0.010, 0.150];
const ALUMINIUM: Material = Material { young_modulus_pa: 7.0e10, poisson_ratio: 0.33, density_kg_m3: 2700.0 };

/// The lowest bending frequency \[Hz\] of the beam that is held at its top.
fn bending_hz(element: Element, across: usize, along: usize, material: Material) -> f64 {
    let block = BlockMesh::new(BEAM_M, [across, across, along]);
    let model = model(&MeshParts { element, ..MeshParts::of_block(&block) }, material);
    let height = |dof: usize| model.mesh().coordinates_m(dof / 3)[2] / BEAM_M[2];
    let held = |dof: usize| height(dof) > 1.0 - 1.0e-9;
    let bent = |dof: usize| if dof.is_multiple_of(3) { (1.0 - height(dof)).powi(2) } else { 0.0 };
    let start: Vec<f64> = (0..3 * model.mesh().node_count()).map(bent).collect();
    lowest_hz(&model, &start, &held)
}

/// The first bending frequency \[Hz\] of Timoshenko's cantilever.
fn timoshenko_hz(material: &Material) -> f64 {
    let [width, height, length] = BEAM_M;
    let (area, inertia) = (width * height, width * height.powi(3) / 12.0);
    let nu = material.poisson_ratio;
    let k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
    let bending = material.young_modulus_pa * inertia;
    let r2 = inertia / (area * length * length);
    let s2 = bending / (k * area * material.shear_modulus_pa() * length * length);
    let equation = |b: f64| {
        let root = ((r2 - s2).powi(2) + 4.0 / (b * b)).sqrt();
        let [alpha, beta] = [-1.0, 1.0].map(|sign| ((sign * (r2 + s2) + root) / 2.0).sqrt());
        2.0 + (b * b * (r2 - s2).powi(2) + 2.0) * (b * alpha).cosh() * (b * beta).cos()
            - b * (r2 + s2) / (1.0 - b * b * r2 * s2).sqrt() * (b * alpha).sinh() * (b * beta).sin()
    };
    // The root of Euler's beam is 3.516, and shear lowers it.
    let (mut low, mut high) = (2.0, 3.6);
    assert!(equation(low) > 0.0 && equation(high) < 0.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if equation(middle) > 0.0 { low = middle } else { high = middle }
    }
    low * (bending / (material.density_kg_m3 * area)).sqrt() / (length * length) / TAU
}

/// Protects: incompatible elements bend. One and two elements across have the frequency of four, and that is the frequency of Timoshenko's
/// beam. The end is held across as well, which makes it stiffer than that of a beam, the more the larger ν is, and few elements feel more of
/// this: 1 % of the frequency is allowed, and 2 % near ν = ½. Trilinear elements are 8 and 26 % too high with two elements across.
#[test]
fn few_elements_across_bend() {
    for (poisson_ratio, of_the_end, least_of_full) in [(0.33, 0.01, 0.05), (0.49, 0.02, 0.2)] {
        let material = Material { poisson_ratio, ..ALUMINIUM };
        let all = [1, 2, 4].map(|n| bending_hz(Element::Incompatible, n, 15 * n, material));
        let full = bending_hz(Element::Full, 2, 30, material);
        let exact = timoshenko_hz(&material);
        println!("ν = {poisson_ratio}: {exact:.2} Hz, found {all:?}, full {full:.2}");
        assert!(all.iter().all(|hz| (hz / all[2] - 1.0).abs() < of_the_end), "{all:?}");
        assert!((all[2] / exact - 1.0).abs() < of_the_end, "{all:?}, {exact}");
        assert!(full / exact - 1.0 > least_of_full, "{full}");
    }
}

/// The deflection of the middle of the free side of Cook's membrane on n × n elements, of which n is even.
fn cooks_deflection(element: Element, n: usize) -> f64 {
    let block = BlockMesh::new([48.0, 1.0, 1.0], [n, 1, n]);
    let mut parts = MeshParts { element, ..MeshParts::of_block(&block) };
    for (node, x) in parts.coordinates_m.iter_mut().enumerate() {
        let [i, _, k] = block.grid_position(node).map(|at| at as f64 / n as f64);
        // The base of the mesh is the lower edge of the panel, which rises from 0 to 44; its upper edge rises from 44 to 60.
        x[2] = (1.0 - k) * 44.0 * i + k * (44.0 + 16.0 * i);
    }
    // A mesh has its contact face below. Here the panel lies on its side: (x, z) becomes (x, y) and the thickness z.
    for x in &mut parts.coordinates_m {
        *x = [x[0], x[2], 0.5 - x[1]];
    }
    parts.contact = Vec::new();
    parts.top = Vec::new();
    for i in 0..n {
        for k in 0..n {
            let at = |i, j, k| block.node(i, j, k);
            parts.contact.push([at(i, 1, k), at(i, 1, k + 1), at(i + 1, 1, k + 1), at(i + 1, 1, k)]);
            parts.top.push([at(i, 0, k), at(i, 0, k + 1), at(i + 1, 0, k + 1), at(i + 1, 0, k)]);
        }
    }
    let material = Material { young_modulus_pa: 1.0, poisson_ratio: 1.0 / 3.0, density_kg_m3: 1.0 };
    let model = model(&parts, material);
    let mesh = model.mesh();
    let place = |dof: usize| mesh.coordinates_m(dof / 3);
    // The mesh is centred about its axis.
    let x_of = |dof: usize| place(dof)[0] + 24.0;
    let left = |dof: usize| x_of(dof) < 1.0e-6;
    let mut force = vec![0.0; 3 * mesh.node_count()];
    let edge: Vec<usize> = (0..mesh.node_count()).filter(|node| x_of(3 * node) > 48.0 - 1.0e-6).collect();
    let heights: Vec<f64> = edge.iter().map(|node| mesh.coordinates_m(*node)[1]).collect();
    let (low, high) =
        heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(*y), h.max(*y)));
    for (node, y) in edge.iter().zip(&heights) {
        let is_end = (y - low).abs() < 1.0e-6 || (y - high).abs() < 1.0e-6;
        // Two nodes through the thickness share the force of a row.
        force[3 * node + 1] = if is_end { 0.25 } else { 0.5 } / n as f64;
    }
    let u = solved(&model, &force, vec![0.0; force.len()], &left);
    let middle =
        edge.iter().zip(&heights).find(|(_, y)| (**y - 0.5 * (low + high)).abs() < 1.0e-6).unwrap().0;
    u[3 * middle + 1]
}

/// Protects: distorted elements bend and shear. Cook's membrane converges to 23.96 with incompatible elements, which have less than half the
/// error of trilinear ones on each mesh.
#[test]
fn cooks_membrane_converges() {
    let mut evidence = Evidence::new("B24", "Cook's membrane, deflection", "Simo and Rifai 1990");
    for n in [4, 8, 16] {
        let [full, incompatible] =
            [Element::Full, Element::Incompatible].map(|element| cooks_deflection(element, n));
        println!("{n} × {n}: full {full:.3}, incompatible {incompatible:.3}");
        assert!((incompatible - 23.96).abs() < 0.5 * (full - 23.96).abs(), "{n}: {incompatible}, {full}");
        evidence.found(format!("{n} × {n}"), incompatible, 23.96, 23.96);
    }
    evidence.judge_overall_order(
        1.0,
        2.0,
        "the corner of the held edge, where stresses are singular, and the plane of the reference",
    );
}
