//! Four instants of a cycle: the middle plane of the pin and its contact face.

use super::style::{MICRO, STATES, colour_of};
use crate::inspect::capture::Frame;
use crate::inspect::grid::FaceGrid;
use crate::inspect::inspection::Inspection;
use crate::publish::chart::palette::{INK, Rgb};
use crate::publish::chart::{Anchor, At, Pen, Svg};
use crate::solver::body::pin::PinMesh;
use crate::solver::interface::ContactState;
use std::collections::BTreeMap;

// All lengths are in pixels.

const WIDTH: f64 = 780.0;
const ROW: f64 = 312.0;
/// Height of the title, with space for arrows that point out of the pin.
const TITLE: f64 = 48.0;
const FOOT: f64 = 106.0;
const MARGIN: f64 = 14.0;
const TEXT: f64 = 15.0;
/// Outlines of the pin.
const OUTLINE: Pen = Pen::solid(Rgb(0xB0, 0xB0, 0xB0), 1.3);
/// Largest radius of a contact node's dot.
const DOT: f64 = 4.3;
/// Approximate number of arrows along a line, so that a reader can tell them apart.
const ARROWS: usize = 15;
/// Shorter arrows are not drawn, because their direction could not be seen.
const SHORTEST: f64 = 1.3;

/// An instant with the frame that is nearest to it.
struct Snapshot<'a> {
    label: String,
    frame: &'a Frame,
}

/// Draws the snapshots, one below the other.
pub fn draw(inspection: &Inspection, alternative: &str) -> String {
    let snapshots = snapshots(inspection);
    let scales = Scales::of(inspection, &snapshots);
    let rows = ROW * snapshots.len() as f64;
    let mut svg = Svg::new((WIDTH, rows + FOOT));
    for (number, snapshot) in snapshots.iter().enumerate() {
        let top = ROW * number as f64;
        svg.plain((MARGIN, top + 16.0), Anchor::Start, INK, TEXT, &snapshot.label);
        let grid = inspection.face_grid();
        draw_side(&mut svg, inspection.mesh(), &grid, snapshot.frame, &scales, (WIDTH / 4.0, top + TITLE));
        draw_face(&mut svg, inspection.mesh(), &grid, snapshot.frame, &scales, (0.75 * WIDTH, top + TITLE));
    }
    draw_legend(&mut svg, &scales, rows);
    svg.finish(alternative)
}

/// The snapshots in the paper's phases of the first observed node that has all of them, or else at the four quarters of
/// the cycle.
fn snapshots(inspection: &Inspection) -> Vec<Snapshot<'_>> {
    let windows = &inspection.survey.windows;
    let complete = inspection.observed.iter().zip(&inspection.capture.nodes).find_map(|(observed, steps)| {
        let instants = observed.instants?;
        let (a, b, d) = (instants.contact_s?, instants.stick_s?, instants.slip_s?);
        let (c, e, f) = (instants.peak_s, instants.separation_s?, instants.end_s?);
        let name = &observed.node.title;
        let peak = steps.iter().find(|step| step.time_s == c)?;
        let times = [
            ("between t_A and t_B: contact has begun".to_owned(), (a + b) / 2.0),
            (format!("at t_C, largest stress: {}", peak.node.state.name()), c),
            ("between t_D and t_E: slip".to_owned(), (d + e) / 2.0),
            ("between t_E and t_F: separated".to_owned(), (e + f) / 2.0),
        ];
        let since = |time_s: f64| (time_s - a) * MICRO;
        Some(times.map(|(what, time_s)| (format!("{name} {what}, t_A + {:.1} µs", since(time_s)), time_s)))
    });
    let quarters = || {
        [0, 1, 2, 3].map(|quarter| {
            let label = format!("{quarter}/4 of the cycle");
            (label, windows.cycle_s[0] + f64::from(quarter) / 4.0 * windows.period_s)
        })
    };
    let times = complete.unwrap_or_else(quarters);
    let snapshot = |(label, time_s): (String, f64)| {
        let distance = |frame: &&Frame| {
            let apart = (frame.time_s - time_s) / windows.period_s;
            (apart - apart.round()).abs()
        };
        let frame = inspection.capture.frames.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        Some(Snapshot { label, frame })
    };
    times.into_iter().filter_map(snapshot).collect()
}

/// The scales, which are the same in all snapshots.
struct Scales {
    px_per_m: f64,
    /// Radius of a node's dot.
    dot: f64,
    /// Distance of the arrows, in nodes.
    stride: usize,
    px_per_m_s: f64,
    /// Largest speed [m/s].
    speed_m_s: f64,
    px_per_n: f64,
    /// Largest contact force [N].
    force_n: f64,
    /// Of friction, seen from above.
    px_per_friction_n: f64,
    /// Largest friction force [N].
    friction_n: f64,
}

impl Scales {
    fn of(inspection: &Inspection, snapshots: &[Snapshot]) -> Self {
        let [lx, ly, lz] = inspection.mesh().size_m();
        let grid = inspection.face_grid();
        let ([hx, hy], [_, ny]) = (grid.width_m, grid.elements);
        let stride = ny.div_ceil(ARROWS);
        let room = WIDTH / 2.0 - 3.0 * MARGIN;
        let high = ROW - TITLE - MARGIN;
        // Below the side view there is space for the forces.
        let px_per_m = (room / ly).min(high / (lz * 1.4)).min(high / lx);
        let plane = || {
            snapshots
                .iter()
                .flat_map(|snapshot| snapshot.frame.velocity_m_s.chunks_exact(3))
                .map(|v| v[1].hypot(v[2]))
        };
        let speed_m_s = plane().fold(f64::MIN_POSITIVE, f64::max);
        let largest = |size: fn([f64; 3]) -> f64| {
            let nodes = snapshots.iter().flat_map(|snapshot| &snapshot.frame.face);
            nodes.map(|node| size(node.force_n)).fold(f64::MIN_POSITIVE, f64::max)
        };
        let force_n = largest(|[x, y, n]| x.hypot(y).hypot(n));
        let friction_n = largest(|[x, y, _]| x.hypot(y));
        // The longest arrow is one and a half times as long as the distance of the arrows.
        let longest = 1.5 * stride as f64 * hy * px_per_m;
        let dot = (0.4 * hx.min(hy) * px_per_m).clamp(1.0, DOT);
        Self {
            px_per_m,
            dot,
            stride,
            px_per_m_s: longest / speed_m_s,
            speed_m_s,
            px_per_n: 0.3 * lz * px_per_m / force_n,
            force_n,
            px_per_friction_n: 1.5 * longest / friction_n,
            friction_n,
        }
    }
}

/// The middle plane: velocities at its nodes, forces under it. `top` is the middle of its upper side.
fn draw_side(svg: &mut Svg, mesh: &PinMesh, grid: &FaceGrid, frame: &Frame, scales: &Scales, top: At) {
    let [_, ly, lz] = mesh.size_m();
    let pixel = |y: f64, z: f64| (top.0 + y * scales.px_per_m, top.1 + (lz - z) * scales.px_per_m);
    let corners = [(-ly / 2.0, 0.0), (ly / 2.0, 0.0), (ly / 2.0, lz), (-ly / 2.0, lz), (-ly / 2.0, 0.0)];
    svg.lines(&corners.map(|(y, z)| pixel(y, z)), OUTLINE);
    for node in middle_plane(mesh, grid, scales.stride) {
        let [_, y, z] = mesh.coordinates_m(node);
        let v = &frame.velocity_m_s[3 * node..3 * node + 3];
        let from = pixel(y, z);
        let to = (from.0 + v[1] * scales.px_per_m_s, from.1 - v[2] * scales.px_per_m_s);
        arrow(svg, from, to, Pen::solid(INK, 1.0));
    }
    for (j, slave) in grid.middle().enumerate() {
        let [_, y, _] = mesh.coordinates_m(slave);
        let (node, tip) = (&frame.face[slave], pixel(y, 0.0));
        let [_, friction, normal] = node.force_n;
        // The arrow of a force on the pin ends at the node on which it acts.
        let from = (tip.0 - friction * scales.px_per_n, tip.1 + normal * scales.px_per_n);
        if node.state != ContactState::Separated && j % scales.stride == 0 {
            arrow(svg, from, tip, Pen::solid(colour_of(node.state), 1.5));
        }
        dot(svg, tip, node.state, scales.dot);
    }
    svg.plain(pixel(-ly / 2.0, -0.12 * lz), Anchor::End, INK, TEXT - 2.0, "front");
    svg.plain(pixel(ly / 2.0, -0.12 * lz), Anchor::Start, INK, TEXT - 2.0, "rear");
}

/// The nodes of the middle plane that get an arrow: every `stride`th in y and in z.
fn middle_plane(mesh: &PinMesh, grid: &FaceGrid, stride: usize) -> Vec<usize> {
    if let Some(block) = mesh.block() {
        let [nx, ny, nz] = block.elements();
        let rows = (0..=nz).step_by(stride);
        return rows.flat_map(|k| (0..=ny).step_by(stride).map(move |j| block.node(nx / 2, j, k))).collect();
    }
    // Of the nodes in a cell of a grid, the one nearest to the middle plane.
    let cell_m = stride as f64 * grid.width_m[1];
    let mut nearest: BTreeMap<[i64; 2], usize> = BTreeMap::new();
    for node in 0..mesh.node_count() {
        let [x, y, z] = mesh.own_coordinates_m(node);
        if x.abs() > 0.5 * grid.width_m[0] {
            continue;
        }
        let cell = [y, z].map(|at| (at / cell_m).round() as i64);
        let kept = nearest.entry(cell).or_insert(node);
        if x.abs() < mesh.own_coordinates_m(*kept)[0].abs() {
            *kept = node;
        }
    }
    nearest.into_values().collect()
}

/// The contact face from above: states and friction forces. `top` is the middle of its upper side.
fn draw_face(svg: &mut Svg, mesh: &PinMesh, grid: &FaceGrid, frame: &Frame, scales: &Scales, top: At) {
    let [lx, ly, _] = mesh.size_m();
    let pixel = |x: f64, y: f64| (top.0 + y * scales.px_per_m, top.1 + (lx / 2.0 - x) * scales.px_per_m);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
    svg.lines(&corners.map(|(x, y)| pixel(x * lx / 2.0, y * ly / 2.0)), OUTLINE);
    let place = |slave| {
        let [x, y, _] = mesh.coordinates_m(slave);
        pixel(x, y)
    };
    for (slave, node) in frame.face.iter().enumerate() {
        dot(svg, place(slave), node.state, scales.dot);
    }
    // The arrows are drawn after the dots, which would hide them.
    for (slave, node) in frame.face.iter().enumerate() {
        let [i, j] = grid.place(slave);
        if node.state != ContactState::Separated && i % scales.stride == 0 && j % scales.stride == 0 {
            let from = place(slave);
            let [sideways, along, _] = node.force_n;
            let scale = scales.px_per_friction_n;
            arrow(svg, from, (from.0 + along * scale, from.1 - sideways * scale), Pen::solid(INK, 1.5));
        }
    }
}

/// Draws a node. Its shape shows the state as well.
fn dot(svg: &mut Svg, at: At, state: ContactState, radius: f64) {
    let colour = colour_of(state);
    match state {
        ContactState::Stick => svg.circle(at, radius, Some(colour), None),
        ContactState::Slip => {
            let corners = [(0.0, -radius), (radius, 0.0), (0.0, radius), (-radius, 0.0)];
            svg.polygon(&corners.map(|(dx, dy)| (at.0 + dx, at.1 + dy)), (colour, 1.0), None);
        }
        ContactState::Separated => {
            svg.circle(at, (radius - 0.5).max(0.8), None, Some(Pen::solid(colour, 1.0)));
        }
    }
}

fn arrow(svg: &mut Svg, from: At, to: At, pen: Pen) {
    if (to.0 - from.0).hypot(to.1 - from.1) >= SHORTEST {
        svg.arrow(&[from, to], pen);
    }
}

fn draw_legend(svg: &mut Svg, scales: &Scales, top: f64) {
    for (number, state) in STATES.into_iter().enumerate() {
        let at = (MARGIN + DOT + 104.0 * number as f64, top + 14.0);
        dot(svg, at, state, DOT);
        svg.plain((at.0 + 12.0, at.1), Anchor::Start, INK, TEXT, state.name());
    }
    let slip = colour_of(ContactState::Slip);
    let velocity = format!("velocity {:.0} mm/s", scales.speed_m_s * 1e3);
    let force = format!("contact force {:.2} N", scales.force_n);
    let friction = format!("friction, from above, {:.3} N", scales.friction_n);
    let lines = [
        (scales.speed_m_s * scales.px_per_m_s, Pen::solid(INK, 1.0), velocity),
        (scales.force_n * scales.px_per_n, Pen::solid(slip, 1.5), force),
        (scales.friction_n * scales.px_per_friction_n, Pen::solid(INK, 1.5), friction),
    ];
    for (number, (length, pen, text)) in lines.into_iter().enumerate() {
        let y = top + 40.0 + 24.0 * number as f64;
        arrow(svg, (MARGIN, y), (MARGIN + length, y), pen);
        svg.plain((MARGIN + length + 10.0, y), Anchor::Start, INK, TEXT, &text);
    }
}
