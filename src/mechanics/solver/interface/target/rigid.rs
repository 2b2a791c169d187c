//! Rigid targets: the velocity of the surface under the slave nodes.

use crate::solver::body::pin::PinMesh;

/// Velocity of the target's surface under each slave node per unit of the drive's rate, x and y.
///
/// For the rotating disk the rate is ω \[rad/s\], and the entries are the lever arms (−Y, X) \[m\]. For a plane in
/// straight motion the rate is a speed \[m/s\], and the entries are a direction.
pub type SurfaceMotion = Vec<[f64; 2]>;

/// A rigid disk that rotates about z. The pin's centre is at (R, 0) from its axis.
///
/// The velocity under a slave node at (X, Y) from the axis is ω(−Y, X). It is evaluated at the node's reference
/// position, because displacements are 10⁻⁴ of the radius. The problem then stays exactly homogeneous in (F, ω).
pub fn rotating_disk(mesh: &PinMesh, track_radius_m: f64) -> SurfaceMotion {
    mesh.bottom_nodes()
        .map(|node| {
            let [x, y, _] = mesh.coordinates_m(node);
            [-y, track_radius_m + x]
        })
        .collect()
}

/// A plane that moves in +y.
pub fn straight_plane(mesh: &PinMesh) -> SurfaceMotion {
    vec![[0.0, 1.0]; mesh.bottom_nodes().len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::body::pin::BlockMesh;

    /// Protects: the velocity v = ω × r under the contact face is that of a rigid anticlockwise rotation about the
    /// axis.
    #[test]
    fn turns_rigidly_about_the_axis() {
        let mesh = PinMesh::from(BlockMesh::new([0.012, 0.015, 0.010], [3, 4, 2]));
        for (node, v) in mesh.bottom_nodes().zip(rotating_disk(&mesh, 0.0914)) {
            let [x, y, _] = mesh.coordinates_m(node);
            let r = [0.0914 + x, y];
            let squared = r[0] * r[0] + r[1] * r[1];
            let rounding = 4.0 * f64::EPSILON * squared;
            assert!((r[0] * v[0] + r[1] * v[1]).abs() <= rounding, "node {node}: v is not normal to r");
            assert!((r[0] * v[1] - r[1] * v[0] - squared).abs() <= rounding, "node {node}: |v| is not r");
        }
    }
}
