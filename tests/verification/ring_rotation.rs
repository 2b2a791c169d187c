//! R3 Rigid motions of the ring.
//!
//! Problem: K u of the three translations and the three linearised rotations u = e × x, in the nodes' own
//! directions. There a translation along x is (cos θ, −sin θ, 0) and the rotation about the axis is (0, r,
//! 0). So this tests the rotated element matrices, the class of columns of each row, and the ring's closure.
//!
//! Exact answer: no force. Isoparametric elements contain all linear fields, whatever their shape. Rounding is
//! counted in [`RingBody::roundings`].

use crate::verification::evidence::Evidence;
use crate::verification::ring_tools::{Nodal, RADII_M, RingBody, THICKNESS_M, graded_mesh};
use tribosweep_mechanics::solver::body::ring::RingMesh;

/// The six rigid motions: translations, then rotations.
fn rigid_motions(body: &RingBody) -> Vec<Nodal> {
    let unit = |axis: usize| -> [f64; 3] { std::array::from_fn(|c| f64::from(c == axis)) };
    let cross = |e: [f64; 3], x: [f64; 3]| {
        [e[1] * x[2] - e[2] * x[1], e[2] * x[0] - e[0] * x[2], e[0] * x[1] - e[1] * x[0]]
    };
    let translations = (0..3).map(|axis| body.field(|_| unit(axis)));
    let rotations = (0..3).map(|axis| body.field(|x| cross(unit(axis), x)));
    translations.chain(rotations).collect()
}

/// Protects: all rows of K give no force in rigid motions, including those at the joint of the closed ring,
/// at the ends of a sector and between unequal sectors.
#[test]
fn ring_rigid_motions_carry_no_force() {
    let mut evidence =
        Evidence::new("R3", "ring, rigid motion, |K u| over Σ|K| max|u|", "rigid motion strains nothing");
    let mut most = 0.0_f64;
    for (name, mesh) in [
        ("graded, 5/12 mm", graded_mesh(0.005, 0.012)),
        ("graded, 3/12 mm", graded_mesh(0.003, 0.012)),
        ("uniform, 40 × 4 × 6", RingMesh::uniform(std::f64::consts::TAU, RADII_M, THICKNESS_M, [40, 4, 6])),
        ("sector of 60°, 11 × 4 × 6", RingMesh::uniform(1.047, RADII_M, THICKNESS_M, [11, 4, 6])),
    ] {
        let body = RingBody::new(mesh);
        most = most.max(body.roundings());
        let forces = body.relative_forces(&rigid_motions(&body), |_| true);
        for (motion, force) in forces.into_iter().enumerate() {
            let kind = ["translation", "rotation"][motion / 3];
            evidence.found(format!("{name}, {kind} {}", ["x", "y", "z"][motion % 3]), force, 0.0, 1.0);
        }
    }
    evidence.judge_exact(most);
}

/// Protects: the test above can fail. A twist is not rigid, and its force is far above rounding.
#[test]
fn ring_twist_carries_a_force() {
    let body = RingBody::new(graded_mesh(0.005, 0.012));
    let twist = body.field(|[x, y, z]| [-y * z, x * z, 0.0]);
    let [force] = body.relative_forces(&[twist], |_| true)[..] else { unreachable!("one motion") };
    assert!(force > 1e6 * body.roundings() * f64::EPSILON, "{force:e}");
}
