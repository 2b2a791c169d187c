//! The moving target under the slave nodes.

use super::mesh::BlockMesh;

/// Velocity of the target's surface under each slave node per unit of the drive's rate, x and y.
///
/// For the rotating disk the rate is ω [rad/s] and the entries are the lever arms (−Y, X) [m]; for a
/// straight-moving plane the rate is a speed [m/s] and the entries are a direction.
pub type SurfaceMotion = Vec<[f64; 2]>;

/// A rigid disk that turns about z; the pin's centre is at (R, 0) from its axis.
///
/// The velocity under a slave node at (X, Y) from the axis is ω(−Y, X), evaluated at the node's
/// reference position: displacements are 10⁻⁴ of the radius, and the problem stays exactly
/// homogeneous in (F, ω).
pub fn rotating_disk(mesh: &BlockMesh, track_radius_m: f64) -> SurfaceMotion {
    mesh.bottom_nodes()
        .map(|node| {
            let [x, y, _] = mesh.coordinates_m(node);
            [-y, track_radius_m + x]
        })
        .collect()
}

/// A plane that moves straight towards +y.
pub fn straight_plane(mesh: &BlockMesh) -> SurfaceMotion {
    vec![[0.0, 1.0]; mesh.bottom_nodes().len()]
}
