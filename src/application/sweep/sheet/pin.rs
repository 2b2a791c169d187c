//! The drawing of the pin on the disk, seen obliquely from above.

use super::colours::{DISK, DISK_EDGE, FRONT, INK, MESH, SIDE, TOP};
use super::lines;
use super::surface;
use super::survey::Survey;
use super::view::{DIRECTIONS, View};
use crate::publish::Drawing;
use crate::publish::chart::palette::{BLUE, VERMILLION};
use crate::publish::chart::{Anchor, At, Pen, Svg};
use crate::publish::value::quantity;
use crate::spec::{ClampSide, DiskKind, JobSpec, Shape, TopFace};
use std::fmt::Write;

const SIZE: (u32, u32) = (560, 470);
/// Length of the arrows of the load [px].
const LOAD_ARROW: f64 = 46.0;
/// With more elements along an edge the mesh would be a grey area, and is not drawn.
const MAX_DRAWN_ELEMENTS: usize = 60;

/// Draws the pin of a job. Texts give the values of all jobs.
pub(super) fn draw(spec: &JobSpec, survey: &Survey) -> Drawing {
    let [x, y, h] = spec.scene.pin.extent_m();
    let (x, y) = (x / 2.0, y / 2.0);
    let margin = 0.45 * x.max(y).min(2.5 * x.min(y));
    // The arrow of the motion is before the +x side.
    let before = 3.2 * margin;
    let elastic = spec.scene.disk.kind == DiskKind::Elastic;
    let depth = if elastic { spec.scene.disk.ring.thickness_m.min(1.5 * margin) } else { 0.0 };
    let disk = [
        [-x - margin, -y - margin],
        [x + before, -y - margin],
        [x + before, y + margin],
        [-x - margin, y + margin],
    ];
    let on = |z: f64, corners: [[f64; 2]; 4]| corners.map(|[x, y]| [x, y, z]);
    let view =
        View::of(&[on(0.0, disk), on(-depth, disk), on(h, [[-x, -y], [x, -y], [x, y], [-x, y]])].concat());

    let mut svg = Svg::new((f64::from(SIZE.0), f64::from(SIZE.1)));
    draw_disk(&mut svg, &view, disk, depth);
    if spec.scene.pin.is_plain_block() {
        draw_block(&mut svg, &view, spec);
    } else {
        surface::draw(&mut svg, &view, spec);
    }
    draw_load(&mut svg, &view, [x, y, h], survey);
    draw_dimensions(&mut svg, &view, [x, y, h], spec.scene.pin.shape, survey);
    draw_motion(&mut svg, &view, [x + 0.72 * before, y], elastic);
    draw_axes(&mut svg);
    Drawing { stem: "scene", svg: svg.finish(""), caption: caption(spec, survey) }
}

fn draw_block(svg: &mut Svg, view: &View, spec: &JobSpec) {
    let [x, y, h] = spec.scene.pin.extent_m();
    let (x, y) = (x / 2.0, y / 2.0);
    let place = |points: &[[f64; 3]]| -> Vec<At> { points.iter().map(|point| view.at(*point)).collect() };
    let outline = Some(Pen::solid(INK, 1.6));
    svg.polygon(&place(&[[x, -y, 0.0], [x, y, 0.0], [x, y, h], [x, -y, h]]), (SIDE, 1.0), None);
    svg.polygon(&place(&[[-x, -y, 0.0], [x, -y, 0.0], [x, -y, h], [-x, -y, h]]), (FRONT, 1.0), None);
    svg.polygon(&place(&[[-x, -y, h], [x, -y, h], [x, y, h], [-x, y, h]]), (TOP, 1.0), None);
    draw_clamp(svg, view, spec);
    draw_mesh(svg, view, spec);
    for face in [
        [[x, -y, 0.0], [x, y, 0.0], [x, y, h], [x, -y, h]],
        [[-x, -y, 0.0], [x, -y, 0.0], [x, -y, h], [-x, -y, h]],
        [[-x, -y, h], [x, -y, h], [x, y, h], [-x, y, h]],
    ] {
        svg.polygon(&place(&face), (TOP, 0.0), outline);
    }
}

fn draw_disk(svg: &mut Svg, view: &View, disk: [[f64; 2]; 4], depth: f64) {
    let corner = |index: usize, z: f64| view.at([disk[index][0], disk[index][1], z]);
    let line = Pen::solid(DISK_EDGE, 1.2);
    if depth > 0.0 {
        for (from, to) in [(0, 1), (1, 2)] {
            let side = [corner(from, 0.0), corner(to, 0.0), corner(to, -depth), corner(from, -depth)];
            svg.polygon(&side, (DISK_EDGE, 0.35), Some(line));
        }
    }
    svg.polygon(&[0, 1, 2, 3].map(|index| corner(index, 0.0)), (DISK, 1.0), Some(line));
    if depth == 0.0 {
        // Strokes below an edge are the sign of a rigid body.
        for (from, to) in [(corner(0, 0.0), corner(1, 0.0)), (corner(1, 0.0), corner(2, 0.0))] {
            let strokes = ((to.0 - from.0).hypot(to.1 - from.1) / 11.0) as u32;
            for number in 1..=strokes {
                let share = f64::from(number) / f64::from(strokes);
                let at = (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
                svg.lines(&[at, (at.0 - 7.0, at.1 + 8.0)], Pen::solid(DISK_EDGE, 1.0));
            }
        }
    }
}

/// The rectangles of the top face that are held: from and to, in x and y.
fn clamped(spec: &JobSpec) -> Vec<[[f64; 2]; 2]> {
    let [x, y, _] = spec.scene.pin.extent_m().map(|edge| edge / 2.0);
    // A clamp of no width holds one row of nodes, which is drawn as a narrow strip.
    let width = spec.scene.clamp.width_m;
    let wide = |edge: f64| width.max(0.03 * edge).min(2.0 * edge);
    let inner = [[-x, -x + wide(x)], [-y, y]];
    let outer = [[x - wide(x), x], [-y, y]];
    let leading = [[-x, x], [-y, -y + wide(y)]];
    let trailing = [[-x, x], [y - wide(y), y]];
    match spec.scene.clamp.side {
        ClampSide::InnerSide => vec![inner],
        ClampSide::OuterSide => vec![outer],
        ClampSide::LeadingEnd => vec![leading],
        ClampSide::TrailingEnd => vec![trailing],
        ClampSide::BothSides => vec![inner, outer],
        ClampSide::BothEnds => vec![leading, trailing],
        ClampSide::WholeTop => vec![[[-x, x], [-y, y]]],
        // It is drawn on the sides.
        ClampSide::Collet => Vec::new(),
    }
}

fn draw_clamp(svg: &mut Svg, view: &View, spec: &JobSpec) {
    let h = spec.scene.pin.extent_m()[2];
    for [[left, right], [near, far]] in clamped(spec) {
        let strip = [[left, near, h], [right, near, h], [right, far, h], [left, far, h]];
        svg.polygon(&strip.map(|point| view.at(point)), (VERMILLION, 0.75), None);
    }
    if spec.scene.clamp.side == ClampSide::Collet {
        let low = h - spec.scene.clamp.width_m.min(h);
        let [x, y, _] = spec.scene.pin.extent_m().map(|edge| edge / 2.0);
        // The sides that the drawing shows.
        let sides = [[[-x, -y], [x, -y]], [[x, -y], [x, y]]];
        for [[ax, ay], [bx, by]] in sides {
            let side = [[ax, ay, h], [bx, by, h], [bx, by, low], [ax, ay, low]];
            svg.polygon(&side.map(|point| view.at(point)), (VERMILLION, 0.75), None);
        }
    }
}

fn draw_mesh(svg: &mut Svg, view: &View, spec: &JobSpec) {
    let counts = spec.scene.pin.elements;
    if counts.iter().any(|&count| count > MAX_DRAWN_ELEMENTS) {
        return;
    }
    let size = spec.scene.pin.extent_m();
    let thin = Pen::solid(MESH, 0.6);
    // Each visible face is at one end of an axis, and has lines of constant coordinate along the two others.
    for (normal, end) in [(0, size[0] / 2.0), (1, -size[1] / 2.0), (2, size[2])] {
        for across in (0..3).filter(|axis| *axis != normal) {
            let along = 3 - normal - across;
            let start = |axis: usize| if axis == 2 { 0.0 } else { -size[axis] / 2.0 };
            for row in 1..counts[across] {
                let mut from = [0.0; 3];
                from[normal] = end;
                from[across] = start(across) + size[across] * row as f64 / counts[across] as f64;
                from[along] = start(along);
                let mut to = from;
                to[along] += size[along];
                svg.lines(&[view.at(from), view.at(to)], thin);
            }
        }
    }
}

fn draw_load(svg: &mut Svg, view: &View, [x, y, h]: [f64; 3], survey: &Survey) {
    for (share_x, share_y) in [(-0.6, -0.6), (0.6, -0.6), (0.0, 0.0), (-0.6, 0.6), (0.6, 0.6)] {
        let tip = view.at([share_x * x, share_y * y, h]);
        svg.arrow(&[(tip.0, tip.1 - LOAD_ARROW), tip], Pen::solid(BLUE, 2.2));
    }
    let (at_x, at_y) = view.at([0.0, 0.0, h]);
    let text = lines::assignment(survey, "load_n");
    svg.text((at_x, (at_y - LOAD_ARROW - 34.0).max(14.0)), Anchor::Middle, BLUE, &text);
}

fn draw_dimensions(svg: &mut Svg, view: &View, [x, y, h]: [f64; 3], shape: Shape, survey: &Survey) {
    let text = |name| lines::assignment(survey, name);
    // Dimensions are so many pixels away from their edges, whatever the size of the pin.
    let away = |px: f64| px / view.scale;
    let (near, side) = (-y - away(20.0), x + away(20.0));
    let (from, to) = (view.at([-x, near, 0.0]), view.at([x, near, 0.0]));
    let beside = (f64::midpoint(from.0, to.0) - 12.0, f64::midpoint(from.1, to.1) + 12.0);
    let name = if shape == Shape::Cylinder { "diameter_m" } else { "size_x_m" };
    svg.dimension(from, to, INK, &text(name), (beside, Anchor::End));
    if shape != Shape::Cylinder {
        let (from, to) = (view.at([side, -y, 0.0]), view.at([side, y, 0.0]));
        let below = (f64::midpoint(from.0, to.0) + 8.0, f64::midpoint(from.1, to.1) + 12.0);
        svg.dimension(from, to, INK, &text("size_y_m"), (below, Anchor::Start));
    }
    let (from, to) = (view.at([-x, -y, 0.0]), view.at([-x, -y, h]));
    let (from, to) = ((from.0 - 16.0, from.1), (to.0 - 16.0, to.1));
    let left = (from.0 - 8.0, f64::midpoint(from.1, to.1));
    svg.dimension(from, to, INK, &text("size_z_m"), (left, Anchor::End));
    let leading = view.at([0.0, -y, 0.45 * h]);
    svg.text(leading, Anchor::Middle, INK, "leading end");
}

fn draw_motion(svg: &mut Svg, view: &View, [x, y]: [f64; 2], elastic: bool) {
    let (from, to) = (view.at([x, -y, 0.0]), view.at([x, y, 0.0]));
    svg.arrow(&[from, to], Pen::solid(BLUE, 3.0));
    let text = if elastic { "surface of the ring, moves in +y" } else { "rigid disk, moves in +y" };
    let below = (f64::midpoint(from.0, to.0) + 16.0, f64::midpoint(from.1, to.1) + 20.0);
    svg.text(below, Anchor::Middle, BLUE, text);
}

/// The directions of the axes, in the lower left corner.
fn draw_axes(svg: &mut Svg) {
    let origin = (34.0, f64::from(SIZE.1) - 42.0);
    for ((dx, dy), name) in DIRECTIONS.into_iter().zip(["x", "y", "z"]) {
        let tip = (origin.0 + 40.0 * dx, origin.1 + 40.0 * dy);
        svg.arrow(&[origin, tip], Pen::solid(INK, 1.6));
        svg.text((origin.0 + 52.0 * dx, origin.1 + 52.0 * dy), Anchor::Middle, INK, name);
    }
}

fn caption(spec: &JobSpec, survey: &Survey) -> String {
    let drawn =
        ["size_x_m", "size_y_m", "size_z_m", "nx", "ny", "nz", "clamp_side", "clamp_width_m", "disk_kind"];
    let first = if drawn.iter().any(|name| survey.varies(name)) { " Drawn is the first job." } else { "" };
    let groups = spec.scene.pin.mesh.as_ref().map(|mesh| mesh.groups());
    let clamp = match (groups, spec.scene.clamp.side) {
        (Some([.., group]), _) => format!("the nodes of the group {group} are held in x and y"),
        (None, ClampSide::WholeTop) => "the whole top face is held in x and y".to_owned(),
        (None, ClampSide::Collet) => {
            let width = lines::of(survey, "clamp_width_m");
            format!("the side of the pin is held in x and y over {width} from the top")
        }
        (None, side) => {
            let width = lines::of(survey, "clamp_width_m");
            format!("a strip of {width} at the {} of the top face is held in x and y", name(side))
        }
    };
    let top = match spec.scene.top {
        TopFace::TiedInZ => "its nodes have one common displacement in z",
        TopFace::FreeInZ => "its nodes move freely in z",
    };
    let pin = &spec.scene.pin;
    let [nx, ny, nz] = pin.elements;
    let mesh = match pin.shape {
        Shape::Block => format!("The pin, {nx} × {ny} × {nz} elements,"),
        Shape::Cylinder => {
            format!("The pin, a cylinder with {nx} elements over its diameter and {nz} over its height,")
        }
        Shape::Mesh => format!("The pin, a mesh of {},", pin.mesh_words()),
    };
    let disk = match spec.scene.disk.kind {
        DiskKind::Rigid => "a rigid plane (strokes at its edges)",
        DiskKind::Elastic => "the surface of an elastic ring",
    };
    format!(
        "{mesh} on {disk}. The pin is drawn to scale. Red: {clamp}. The load F acts on the top face; {top}.{} x is the radial \
         direction, away from the disk's axis.{first}",
        beyond_the_block(spec)
    )
}

/// What the drawing shows of a pin and a holder that are not ideal, or leaves out.
fn beyond_the_block(spec: &JobSpec) -> String {
    let pin = &spec.scene.pin;
    let mut text = String::new();
    for region in &pin.regions {
        let place = match (region.above_m, &region.group) {
            (Some(above_m), _) => format!("above {}", quantity(above_m, "m")),
            (None, group) => format!("group {}", group.as_deref().unwrap_or_default()),
        };
        let _ = write!(
            text,
            " Darker: {place}, with E = {}, ν = {}, ρ = {}.",
            quantity(region.young_modulus_pa, "Pa"),
            region.poisson_ratio,
            quantity(region.density_kg_m3, "kg/m³")
        );
    }
    let [about_x, about_y] = [pin.tilt_x_deg, pin.tilt_y_deg].map(|angle| angle.unwrap_or(0.0));
    if about_x != 0.0 || about_y != 0.0 {
        let _ = write!(text, " The pin is tilted by {about_x}° about x and by {about_y}° about y.");
    }
    if !pin.base.is_flat() {
        text += " Its base is not flat; the gaps are too small to be drawn.";
    }
    if !spec.scene.holder.is_ideal() {
        text += " A holder, which is not drawn, moves with the clamp.";
    }
    text
}

fn name(side: ClampSide) -> &'static str {
    match side {
        ClampSide::InnerSide => "inner side (−x)",
        ClampSide::OuterSide => "outer side (+x)",
        ClampSide::LeadingEnd => "leading end (−y)",
        ClampSide::TrailingEnd => "trailing end (+y)",
        ClampSide::BothSides => "inner and the outer side",
        ClampSide::BothEnds => "leading and the trailing end",
        ClampSide::WholeTop => "whole",
        ClampSide::Collet => "side",
    }
}
