//! Element matrices of a sector, in the nodes' own directions.

use super::mesh::RingMesh;
use crate::solver::body::hexahedron::{ElementStiffness, isoparametric};
use crate::solver::material::Material;
use crate::spec::Element;
use nalgebra::Vector3;

/// Stiffness \[N/m\] and masses of one element, which all sectors of the same angle share.
///
/// Corners are numbered r fastest, then θ, then z upwards. Vectors are (radial, tangential, axial) at their node.
#[derive(Debug, Clone)]
pub(super) struct SectorElement {
    pub stiffness: ElementStiffness,
    pub masses_kg: [f64; 8],
}

/// The element between the radii i and i + 1 and the depths k and k + 1 of a sector of `angle_rad`.
pub(super) fn element(
    mesh: &RingMesh,
    material: &Material,
    kind: Element,
    i: usize,
    k: usize,
    angle_rad: f64,
) -> SectorElement {
    let (radii, heights) = (mesh.radii_m(), mesh.heights_m());
    let angle = |corner: usize| if corner >> 1 & 1 == 0 { -0.5 * angle_rad } else { 0.5 * angle_rad };
    let corners = std::array::from_fn(|corner| {
        let radius = radii[i + (corner & 1)];
        let height = heights[k + 1 - (corner >> 2)];
        Vector3::new(radius * libm::cos(angle(corner)), radius * libm::sin(angle(corner)), height)
    });
    let (cartesian, volumes) =
        isoparametric(material, &corners, kind).expect("a sector of a ring is not inverted");
    let mut turned = ElementStiffness::zeros();
    for a in 0..8 {
        for b in 0..8 {
            let block = cartesian.fixed_view::<3, 3>(3 * a, 3 * b);
            let own = axes(angle(a)).transpose() * block * axes(angle(b));
            turned.fixed_view_mut::<3, 3>(3 * a, 3 * b).copy_from(&own);
        }
    }
    let symmetric = (turned + turned.transpose()) * 0.5;
    // A sector is symmetric about its middle. Rounding is not, so the matrix is averaged with its mirror image.
    let mirror = |index: usize| {
        let (corner, component) = (index / 3, index % 3);
        (3 * (corner ^ 2) + component, if component == 1 { -1.0 } else { 1.0 })
    };
    let mirrored = ElementStiffness::from_fn(|row, col| {
        let ((row, row_sign), (col, col_sign)) = (mirror(row), mirror(col));
        row_sign * col_sign * symmetric[(row, col)]
    });
    let volumes: [f64; 8] = std::array::from_fn(|corner| 0.5 * (volumes[corner] + volumes[corner ^ 2]));
    SectorElement {
        stiffness: (symmetric + mirrored) * 0.5,
        masses_kg: volumes.map(|volume| material.density_kg_m3 * volume),
    }
}

/// Matrix whose columns are the radial, tangential and axial direction at an angle.
fn axes(angle_rad: f64) -> nalgebra::Matrix3<f64> {
    let (sin, cos) = (libm::sin(angle_rad), libm::cos(angle_rad));
    nalgebra::Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
}
