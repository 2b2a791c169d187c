//! R2 Statics of the ring: the patch test and a point load on its top.
//!
//! # The patch test
//! The displacements are linear in Cartesian x, y and z on the graded mesh, with each of the nine gradients.
//! Exact answer: inner nodes have no force, and the work is u·K u = V σ:ε of the polygonal ring, V = H (b² −
//! a²) Σ ½ sin α over the sectors of the angles α. Isoparametric elements contain these fields, and 2 × 2 × 2
//! points integrate ∂N/∂x det J, which is quadratic in each coordinate, exactly (B. M. Irons, A. Razzaque,
//! *Experience with the patch test*, 1972).
//!
//! # The point load
//! A load P acts at a node in the middle of the top of a uniform sector. Exact answer: the half-space of J.
//! Boussinesq (*Application des potentiels*, 1885; K. L. Johnson, *Contact mechanics*, 1985, §3.2),
//!
//! ```text
//! u_z = (1+ν)P/(2πE) [z²/ρ³ + 2(1−ν)/ρ]      u_r = (1+ν)P/(2πE) [rz/ρ³ − (1−2ν) r/(ρ(ρ+z))]
//! ```
//!
//! at the depth z, the distance r from the load's axis and ρ² = r² + z². On the surface u_z = (1−ν²)P/(πE r).
//! The whole surface of the sector except its top is held at exactly these displacements. So the exact
//! solution of the body is that of the half-space, whatever the body's size, and the only error is that of
//! the mesh.
//!
//! At a fixed distance from the load the error is of order 2. The field is smooth there. The singular load
//! contributes the product of two energy errors, a(G − G_h, g − g_h), one of the Green function of each
//! point. Each function is singular at its own point and smooth at the other one, so each neighbourhood gives
//! O(h²), up to a logarithm (A. H. Schatz, L. B. Wahlbin, *Interior maximum norm estimates for finite element
//! methods*, Math. Comp. 31, 1977). The nearest evaluated node is 4 elements away on the coarsest mesh.

use crate::verification::evidence::Evidence;
use crate::verification::ring_tools::{RADII_M, RingBody, STEEL, graded_mesh};
use std::f64::consts::PI;
use tribosweep_mechanics::solver::body::ring::RingMesh;

const PATCH: &str = "linear fields (Irons and Razzaque 1972)";
const BOUSSINESQ: &str = "Boussinesq's half-space, the far surface held at its displacements";

/// The nine displacement gradients ∂u_a/∂x_b of size 1.
fn gradients() -> impl Iterator<Item = [usize; 2]> {
    (0..9).map(|number| [number / 3, number % 3])
}

/// Protects: element matrices and assembly are right on the graded mesh, in the nodes' own directions.
#[test]
fn ring_patch_test() {
    let mut forces = Evidence::new("R2", "ring patch test, inner |K u| over Σ|K| max|u|", PATCH);
    let mut works = Evidence::new("R2", "ring patch test, u K u over V σ:ε", PATCH);
    let mut most = 0.0_f64;
    for sizes_mm in [[5.0, 12.0], [3.0, 12.0]] {
        let body = RingBody::new(graded_mesh(1e-3 * sizes_mm[0], 1e-3 * sizes_mm[1]));
        most = most.max(body.roundings());
        let mesh = &body.mesh;
        let [_, rows, planes] = mesh.nodes_per_axis();
        let fields: Vec<_> = gradients()
            .map(|[a, b]| body.field(|x| std::array::from_fn(|c| if c == a { x[b] } else { 0.0 })))
            .collect();
        let inner = |[_, i, k]: [usize; 3]| (1..rows - 1).contains(&i) && (1..planes - 1).contains(&k);
        let found = body.relative_forces(&fields, inner);
        let (radii, heights) = (mesh.radii_m(), mesh.heights_m());
        let face: f64 = mesh.sectors_rad().iter().map(|angle| 0.5 * angle.sin()).sum();
        let volume = face * (radii[rows - 1].powi(2) - radii[0].powi(2)) * (heights[0] - heights[planes - 1]);
        let (lambda, shear) = (STEEL.lame_lambda_pa(), STEEL.shear_modulus_pa());
        for (([a, b], u), force) in gradients().zip(&fields).zip(found) {
            let name = format!("{}/{} mm, ∂u_{a}/∂x_{b}", sizes_mm[0], sizes_mm[1]);
            forces.found(name.clone(), force, 0.0, 1.0);
            let energy = volume * if a == b { lambda + 2.0 * shear } else { shear };
            works.bounded(
                name,
                u.dot(&body.force(u))[0],
                energy,
                energy,
                body.work_roundings(u) * f64::EPSILON / energy,
            );
        }
    }
    forces.judge_exact(most);
    works.judge_bounded("the roundings of the forces times the displacements");
}

/// Displacement [m] of the half-space under a load of 1 N at the origin, at a Cartesian place with z upwards.
pub fn boussinesq_m([x, y, z]: [f64; 3]) -> [f64; 3] {
    let depth = -z;
    let rho = (x * x + y * y + z * z).sqrt();
    let nu = STEEL.poisson_ratio;
    let unit = (1.0 + nu) / (2.0 * PI * STEEL.young_modulus_pa);
    // u_r/r.
    let outwards = unit * (depth / rho.powi(3) - (1.0 - 2.0 * nu) / (rho * (rho + depth)));
    let down = unit * (depth * depth / rho.powi(3) + 2.0 * (1.0 - nu) / rho);
    [outwards * x, outwards * y, -down]
}

/// Protects: loads on the top give the right displacements of the top, with the same operator as in a run.
#[test]
fn ring_point_load_converges_to_boussinesq() {
    let middle_m = 0.5 * (RADII_M[0] + RADII_M[1]);
    let (width_m, thickness_m) = (RADII_M[1] - RADII_M[0], 0.025);
    // Offsets (θ, r, z) of the places in 16ths of the sector. They are at least 4 elements of the coarsest
    // mesh away.
    let places = [[4, 0, 0], [0, 4, 0], [0, -4, 0], [4, 4, 0], [0, 0, 4], [4, 0, 2]];
    let mut settled = places.map(|[j, i, k]| {
        let name = format!("point load, settlement at ({j}, {i}, {k})/16 of 50 mm in θ, r, z [m/N]");
        Evidence::new("R2", name, BOUSSINESQ)
    });
    let mut least = f64::INFINITY;
    for scale in [1, 2, 4] {
        let elements = [16 * scale, 16 * scale, 8 * scale];
        let mesh = RingMesh::uniform(width_m / middle_m, RADII_M, thickness_m, elements);
        let body = RingBody::new(mesh);
        let (mesh, centre) = (&body.mesh, [8 * scale, 8 * scale, 0]);
        let loaded = mesh.node(centre[0], centre[1], centre[2]);
        let load_at = body.position_m(loaded);
        let exact = |x: [f64; 3]| boussinesq_m(std::array::from_fn(|c| x[c] - load_at[c]));
        let far = |node: usize| {
            let at = mesh.grid_position(node);
            (0..2).any(|axis| at[axis] == 0 || at[axis] == elements[axis]) || at[2] == elements[2]
        };
        let mut start = body.field(exact);
        for node in (0..mesh.node_count()).filter(|node| !far(*node)) {
            for c in 0..3 {
                start[3 * node + c] = 0.0;
            }
        }
        let mut load = body.zeros();
        load[3 * loaded + 2] = -1.0;
        let u = body.solve(&load, |dof| far(dof / 3), start);
        for (evidence, offset) in settled.iter_mut().zip(places) {
            let at: [usize; 3] = std::array::from_fn(|axis| {
                centre[axis].checked_add_signed(offset[axis] * scale.cast_signed()).expect("inside")
            });
            let node = mesh.node(at[0], at[1], at[2]);
            let x = body.position_m(node);
            least = least.min((0..3).map(|c| (x[c] - load_at[c]).powi(2)).sum::<f64>().sqrt());
            let [.., down] = exact(x);
            let name = format!("{} × {} × {} elements", elements[0], elements[1], elements[2]);
            evidence.found(name, -u[3 * node + 2], -down, down);
        }
    }
    assert!(least > 3.0 * width_m / 16.0, "no place is within three elements of the load");
    for evidence in settled {
        evidence.judge_order(2.0, 2.0, 1e-9);
    }
}
