//! What the trilinear elements do near ν = ½.
//!
//! Fully integrated trilinear elements are too stiff for bodies that hardly change their volume, because an element
//! cannot bend at constant volume (volumetric locking). The error still falls with the mesh, so a refined mesh shows
//! it. Problem: the static deflection of the reference pin under the loads of steady sliding. Its base lies on
//! the disk (u_z = 0) and carries a uniform traction of μF/A in y. Its top is tied in z and carries F. The strip of
//! the clamp, 2 mm wide, is held in x and y. The measure is the base's mean displacement in y. An independent assembly
//! (`scripts/peers/lagrange.py`) has its converged values, and the same values on these meshes. `scripts/accuracy.py` writes the
//! table of docs/evidence/accuracy.md from both.
//! The threshold of the warning in `study::plausibility` follows from this table.

use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::spec::elasticity::LOCKING_POISSON_RATIO;
use tribosweep_mechanics::spec::{Clamp, JobSpec, Scene};

const DRAFT: [usize; 3] = [12, 15, 10];
const STANDARD: [usize; 3] = [24, 30, 20];
const CLAMP_M: f64 = 0.002;

/// What other programs have found.
const CONVERGED: &str = include_str!("../../scripts/peers/converged.json");

/// Relative residual at which the conjugate gradients stop.
const LEFT: f64 = 1e-9;

/// Mean displacement \[m\] of the base in y under the shear force μF.
fn deflection_m(poisson_ratio: f64, elements: [usize; 3]) -> f64 {
    let JobSpec { mut scene, numerics, .. } = JobSpec::default();
    scene.pin.poisson_ratio = poisson_ratio;
    scene.pin.elements = elements;
    scene.clamp = Clamp { width_m: CLAMP_M, ..scene.clamp };
    let Scene { load, contact, .. } = &scene;
    let model = Model::from_scene(&scene, &numerics).unwrap();
    let mesh = model.mesh().block().unwrap();
    let area_m2 = mesh.size_m()[0] * mesh.size_m()[1];
    let top: Vec<usize> = mesh.top_nodes().collect();
    let is_clamped =
        |node: usize| mesh.grid_position(node)[0] as f64 * mesh.element_size_m()[0] < CLAMP_M * 1.001;
    let mut held = vec![false; 3 * mesh.node_count()];
    let mut force = vec![0.0; 3 * mesh.node_count()];
    for node in mesh.bottom_nodes() {
        held[3 * node + 2] = true;
        force[3 * node + 1] = contact.mu * load.force_n * mesh.tributary_area_m2(node) / area_m2;
    }
    for &node in &top {
        if is_clamped(node) {
            (held[3 * node], held[3 * node + 1]) = (true, true);
        }
    }
    // The tie as one degree of freedom, that of the first top node.
    let share = |x: &mut Vec<f64>| top.iter().for_each(|node| x[3 * node + 2] = x[3 * top[0] + 2]);
    let gather = |x: &mut Vec<f64>| {
        let sum: f64 = top.iter().map(|node| x[3 * node + 2]).sum();
        for node in &top {
            x[3 * node + 2] = 0.0;
        }
        x[3 * top[0] + 2] = sum;
        x.iter_mut().zip(&held).filter(|(_, held)| **held).for_each(|(x, _)| *x = 0.0);
    };
    force[3 * top[0] + 2] = -load.force_n;
    let product = |x: &[f64]| {
        let mut x = x.to_vec();
        share(&mut x);
        let mut force = model.pin().stiffness_times(&x);
        gather(&mut force);
        force
    };
    // The diagonal of K falls towards faces and edges as the lumped mass does.
    let mut weights: Vec<f64> = model.pin().masses_kg().iter().flat_map(|mass| [*mass; 3]).collect();
    gather(&mut weights);
    let scaled = |x: &[f64]| -> Vec<f64> {
        x.iter().zip(&weights).map(|(x, w)| if *w == 0.0 { 0.0 } else { x / w }).collect()
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut u = vec![0.0; force.len()];
    let mut residual = force.clone();
    let mut z = scaled(&residual);
    let mut p = z.clone();
    let mut size = dot(&residual, &z);
    let start = size;
    while size > LEFT * LEFT * start {
        let k_p = product(&p);
        let along = size / dot(&p, &k_p);
        u.iter_mut().zip(&p).for_each(|(u, p)| *u += along * p);
        residual.iter_mut().zip(&k_p).for_each(|(r, k)| *r -= along * k);
        z = scaled(&residual);
        let next = dot(&residual, &z);
        p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + next / size * *p);
        size = next;
    }
    mesh.bottom_nodes().map(|node| u[3 * node + 1] * mesh.tributary_area_m2(node) / area_m2).sum()
}

/// An entry of the converged values: ν = `poisson_ratio`, with the clamp of [`CLAMP_M`].
fn converged(poisson_ratio: f64) -> serde_json::Value {
    let all: serde_json::Value = serde_json::from_str(CONVERGED).unwrap();
    let is_wanted = |entry: &&serde_json::Value| {
        entry["clamp_m"].as_f64() == Some(CLAMP_M) && entry["poisson_ratio"].as_f64() == Some(poisson_ratio)
    };
    all["deflections"].as_array().unwrap().iter().find(is_wanted).unwrap().clone()
}

/// Protects: the threshold of the warning about ν near ½, and the numbers of docs/evidence/accuracy.md. On each mesh the deflection is that of
/// the independent assembly with the same elements: both solve the same equations, so they differ by what the conjugate gradients leave (10⁻⁹ of
/// the residual, whose effect on a mean displacement is of the same size times the square root of the condition, some 10³). From the
/// converged value it is 7.6 % and 3.8 % away at ν = 0.3, and half as far again at the threshold.
#[test]
fn elements_lock_near_incompressibility() {
    let error = |nu, elements| {
        let known = converged(nu);
        let found = deflection_m(nu, elements);
        let place = usize::from(elements == STANDARD);
        let same = known["trilinear_m"][place].as_f64().unwrap();
        assert!((found / same - 1.0).abs() < 1e-6, "ν = {nu}, {elements:?}: {found:e}, not {same:e}");
        found / known["value"].as_f64().unwrap() - 1.0
    };
    let usual = [DRAFT, STANDARD].map(|elements| error(0.3, elements));
    // The other ratios are solved on the coarser mesh alone, because the finer one takes long near ½.
    let (at_threshold, nearly) = (error(LOCKING_POISSON_RATIO, DRAFT), error(0.499, DRAFT));
    // The converged value is known to 0.1 %.
    for (found, stated) in usual.into_iter().zip([-0.076, -0.038]) {
        assert!((found - stated).abs() < 1.5e-3, "{found}, not {stated}");
    }
    assert!(at_threshold < 1.4 * usual[0] && nearly < 1.9 * usual[0], "{at_threshold} {nearly}");
}

/// Prints the lines from which `scripts/accuracy.py` makes its table: ν, and the deflections on the two meshes in metres.
#[test]
#[ignore = "takes half a minute, and the other test has what it says"]
fn deflections_for_the_page() {
    for nu in [0.3, 0.4, 0.45, LOCKING_POISSON_RATIO, 0.49, 0.495, 0.499] {
        let [draft, standard] = [DRAFT, STANDARD].map(|elements| deflection_m(nu, elements));
        println!("deflections {nu} {draft:e} {standard:e}");
    }
}
