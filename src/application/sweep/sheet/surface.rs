//! The surface of a pin that is not a plain block: a cylinder, a tilted pin, regions, or a mesh from a file.

use super::colours::{FRONT, INK, MESH, SIDE, TOP};
use super::view::View;
use crate::publish::chart::Rgb;
use crate::publish::chart::palette::VERMILLION;
use crate::publish::chart::{At, Pen, Svg};
use crate::solver::Model;
use crate::solver::body::pin::PinMesh;
use crate::solver::support::clamp::clamped_strip;
use crate::spec::JobSpec;
use std::collections::BTreeMap;

/// From the pin to the eye: the direction that vanishes on the sheet.
const EYE: [f64; 3] = [0.746, -0.519, 0.424];

/// With more faces the edges would be a grey area, and are not drawn.
const MOST_EDGED: usize = 6000;

/// The share of a colour that is left in a region of another material.
const REGION_SHADE: f64 = 0.82;

/// The corners of the six faces of an element, in order around them.
const FACES: [[usize; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// A face on the surface.
struct Face {
    corners_m: [[f64; 3]; 4],
    normal: [f64; 3],
    has_other_material: bool,
}

/// Draws the surface of the pin, and the nodes that the clamp holds. A mesh that cannot be used is not drawn.
pub(super) fn draw(svg: &mut Svg, view: &View, spec: &JobSpec) {
    let Ok(mesh) = Model::mesh_of(&spec.scene) else { return };
    let mut faces: Vec<Face> =
        surface(&mesh).into_iter().filter(|face| dot(face.normal, EYE) > 0.0).collect();
    // Faces that are nearer cover those behind them.
    let depth = |face: &Face| face.corners_m.iter().map(|corner| dot(*corner, EYE)).sum::<f64>();
    faces.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    let edge = (faces.len() <= MOST_EDGED).then(|| Pen::solid(MESH, 0.6));
    for face in &faces {
        let corners: Vec<At> = face.corners_m.iter().map(|corner| view.at(*corner)).collect();
        svg.polygon(&corners, (colour(face), 1.0), edge);
    }
    let Ok(strip) = clamped_strip(&mesh, &spec.scene.clamp) else { return };
    for node in strip.nodes {
        svg.circle(view.at(mesh.coordinates_m(node)), 2.6, Some(VERMILLION), Some(Pen::solid(INK, 0.4)));
    }
}

/// The faces that belong to one element only.
fn surface(mesh: &PinMesh) -> Vec<Face> {
    let materials: Vec<usize> = match mesh {
        PinMesh::Block(_) => vec![0; mesh.element_count()],
        PinMesh::General(general) => general.elements().iter().map(|element| element.material).collect(),
    };
    let mut found: BTreeMap<[usize; 4], Option<Face>> = BTreeMap::new();
    for (nodes, material) in mesh.element_nodes().iter().zip(materials) {
        let centre = mean(&nodes.map(|node| mesh.coordinates_m(node)));
        for corners in FACES {
            let face = corners.map(|corner| nodes[corner]);
            let mut key = face;
            key.sort_unstable();
            let corners_m = face.map(|node| mesh.coordinates_m(node));
            let [a, b] = [[2, 0], [3, 1]].map(|[to, from]| difference(corners_m[to], corners_m[from]));
            let mut normal =
                [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            if dot(normal, difference(mean(&corners_m), centre)) < 0.0 {
                normal = normal.map(|x| -x);
            }
            let face = Face { corners_m, normal, has_other_material: material > 0 };
            found.entry(key).and_modify(|known| *known = None).or_insert(Some(face));
        }
    }
    found.into_values().flatten().collect()
}

fn colour(face: &Face) -> Rgb {
    let [x, y, z] = face.normal.map(f64::abs);
    let plain = if z > x.max(y) {
        TOP
    } else if x > y {
        SIDE
    } else {
        FRONT
    };
    if !face.has_other_material {
        return plain;
    }
    let shaded = |level: u8| (f64::from(level) * REGION_SHADE) as u8;
    Rgb(shaded(plain.0), shaded(plain.1), shaded(plain.2))
}

fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64)
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}
