//! The O-grid of a cylinder: a core of c × c elements, and rings of 4c elements around it.

use super::{Hexahedron, MeshParts};
use crate::spec::{Element, core_elements};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Distance of the core's corners from the axis over the radius. With it, elements of the core and of the rings have about the
/// same size.
const CORE: f64 = 0.62;

/// How far the sides of the core bulge. At a corner of the core three elements meet, and tan 15° = 2·0.134 gives each an angle of 120°.
const BULGE: f64 = 0.134;

/// A cylinder about z, with the diameters `size_m`\[0\] in x and `size_m`\[1\] in y, and the height `size_m`\[2\]. It has
/// `across` elements over its diameter and `along` over its height.
///
/// # Panics
/// If there are fewer than three elements over the diameter, or none over the height. Callers check their input first.
pub fn cylinder(size_m: [f64; 3], across: usize, along: usize) -> MeshParts {
    assert!(across >= 3 && along >= 1, "at least 3 elements over the diameter and one over the height");
    let core = core_elements(across);
    let rings = (across - core) / 2;
    let (plane, quadrilaterals) = disk(core, rings);
    let layer = plane.len();
    let coordinates_m = (0..=along).flat_map(|k| {
        let z = size_m[2] * k as f64 / along as f64;
        plane.iter().map(move |[x, y]| [0.5 * size_m[0] * x, 0.5 * size_m[1] * y, z])
    });
    let elements = (0..along).flat_map(|k| {
        quadrilaterals.iter().map(move |&[a, b, c, d]| {
            let [low, high] = [k * layer, (k + 1) * layer];
            let nodes = [low + a, low + b, low + d, low + c, high + a, high + b, high + d, high + c];
            Hexahedron { nodes, material: 0 }
        })
    });
    let face =
        |k: usize| quadrilaterals.iter().map(|corners| corners.map(|corner| corner + k * layer)).collect();
    MeshParts {
        coordinates_m: coordinates_m.collect(),
        elements: elements.collect(),
        names: Vec::new(),
        contact: face(0),
        top: face(along),
        clamped: None,
        divisions: Some([across, across, along]),
        element: Element::Full,
    }
}

/// Points of the unit disk, and quadrilaterals whose corners go around anticlockwise.
fn disk(core: usize, rings: usize) -> (Vec<[f64; 2]>, Vec<[usize; 4]>) {
    let half_side = CORE * std::f64::consts::FRAC_1_SQRT_2;
    let at = |i: usize| 2.0 * i as f64 / core as f64 - 1.0;
    let row = core + 1;
    let mut points = Vec::new();
    for j in 0..=core {
        for i in 0..=core {
            let (u, v) = (at(i), at(j));
            points.push([
                half_side * u * (1.0 + BULGE * (1.0 - v * v)),
                half_side * v * (1.0 + BULGE * (1.0 - u * u)),
            ]);
        }
    }
    let mut quadrilaterals: Vec<[usize; 4]> = (0..core)
        .flat_map(|j| {
            (0..core).map(move |i| [j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i])
        })
        .collect();
    // The boundary of the core, anticlockwise from its corner at −x, −y.
    let sides: [&dyn Fn(usize) -> usize; 4] =
        [&|s| s, &|s| s * row + core, &|s| core * row + core - s, &|s| (core - s) * row];
    let mut inner: Vec<usize> = sides.iter().flat_map(|side| (0..core).map(side)).collect();
    let starts: Vec<[f64; 2]> = inner.iter().map(|&node| points[node]).collect();
    let around = inner.len();
    for ring in 1..=rings {
        let share = ring as f64 / rings as f64;
        let first = points.len();
        for (number, [x, y]) in starts.iter().enumerate() {
            let angle = -3.0 * FRAC_PI_4 + FRAC_PI_2 * number as f64 / core as f64;
            let (sin, cos) = libm::sincos(angle);
            points.push([x + share * (cos - x), y + share * (sin - y)]);
        }
        let outer: Vec<usize> = (first..first + around).collect();
        for s in 0..around {
            let next = (s + 1) % around;
            quadrilaterals.push([inner[s], outer[s], outer[next], inner[next]]);
        }
        inner = outer;
    }
    (points, quadrilaterals)
}

#[cfg(test)]
mod tests {
    use super::super::{GeneralMesh, Tilt};
    use super::*;
    use std::f64::consts::PI;

    /// Protects: the mesh is a cylinder with elements of a good shape. Its base tends to the area of the disk like that of a
    /// polygon with 4c corners, and no corner is far from a right angle.
    #[test]
    fn elements_have_a_good_shape_and_fill_the_cylinder() {
        for across in 3..=24 {
            let mesh = GeneralMesh::new(&cylinder([0.008, 0.008, 0.01], across, 4), Tilt::default()).unwrap();
            let corners = 4.0 * core_elements(across) as f64;
            let polygon = corners / (2.0 * PI) * libm::sin(2.0 * PI / corners);
            let area: f64 = mesh.contact_areas_m2().iter().sum();
            let ratio = area / (PI * 0.004 * 0.004 * polygon);
            assert!((ratio - 1.0).abs() < 1e-12, "{across}: {ratio}");
            // Three elements of 120° meet at the corners of the core: sin 120° = 0.866. On meshes of few elements sides are not
            // as curved as the core, down to 135°.
            assert!(
                mesh.worst_jacobian() > libm::sin(0.75 * PI) - 1e-9,
                "{across}: {}",
                mesh.worst_jacobian()
            );
        }
    }
}
