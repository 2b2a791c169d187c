//! Four instants of a cycle: the middle plane of the pin and its contact face.

use super::style::{MICRO, STATES, colour_of};
use crate::inspect::capture::Frame;
use crate::inspect::grid::FaceGrid;
use crate::inspect::inspection::Inspection;
use crate::publish::FigureError;
use crate::publish::plot::canvas::{Area, WIDTH, sheet, write};
use crate::publish::plot::{DrawError, MARGIN, TEXT};
use crate::solver::body::pin::PinMesh;
use crate::solver::interface::ContactState;
use plotters::element::{Circle, PathElement, Polygon};
use plotters::style::text_anchor::HPos;
use plotters::style::{BLACK, Color, RGBColor};
use std::collections::BTreeMap;

const ROW: u32 = 720;
/// Height of the title, with space for arrows that point out of the pin.
const TITLE: i32 = 110;
const FOOT: u32 = 150;
const GREY: RGBColor = RGBColor(0xB0, 0xB0, 0xB0);
/// Largest radius [px] of a contact node's dot.
const DOT: i32 = 10;
/// Approximate number of arrows along a line, so that a reader can tell them apart.
const ARROWS: usize = 15;

/// An instant with the frame that is nearest to it.
struct Snapshot<'a> {
    label: String,
    frame: &'a Frame,
}

/// Draws the snapshots, one below the other.
///
/// # Errors
/// [`FigureError`].
pub fn draw(inspection: &Inspection) -> Result<String, FigureError> {
    let snapshots = snapshots(inspection);
    let scales = Scales::of(inspection, &snapshots);
    sheet((WIDTH, ROW * snapshots.len() as u32 + FOOT), |root| {
        let mut rest = root.clone();
        for snapshot in &snapshots {
            let (row, below) = rest.split_vertically(ROW);
            draw_row(&row, inspection, snapshot, &scales)?;
            rest = below;
        }
        draw_legend(&rest, &scales)?;
        Ok(Vec::new())
    })
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
    /// Pixels per metre.
    px_per_m: f64,
    /// Radius [px] of a node's dot.
    dot: i32,
    /// Distance of the arrows, in nodes.
    stride: usize,
    /// Pixels per m/s.
    px_per_m_s: f64,
    /// Largest speed [m/s].
    speed_m_s: f64,
    /// Pixels per newton.
    px_per_n: f64,
    /// Largest contact force [N].
    force_n: f64,
    /// Pixels per newton of friction, seen from above.
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
        let room = f64::from(WIDTH) / 2.0 - 3.0 * f64::from(MARGIN);
        let high = f64::from(ROW) - f64::from(TITLE) - f64::from(MARGIN);
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
        let dot = ((0.4 * hx.min(hy) * px_per_m) as i32).clamp(2, DOT);
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

fn draw_row(
    area: &Area,
    inspection: &Inspection,
    snapshot: &Snapshot,
    scales: &Scales,
) -> Result<(), DrawError> {
    write(area, &snapshot.label, (MARGIN, 34), TEXT, HPos::Left)?;
    let (left, right) = area.split_horizontally(WIDTH / 2);
    draw_side(&left, inspection, snapshot.frame, scales)?;
    draw_face(&right, inspection, snapshot.frame, scales)
}

/// The middle plane: velocities at its nodes, forces under it.
fn draw_side(area: &Area, inspection: &Inspection, frame: &Frame, scales: &Scales) -> Result<(), DrawError> {
    let mesh = inspection.mesh();
    let grid = inspection.face_grid();
    let [_, ly, lz] = mesh.size_m();
    let middle = i64::from(WIDTH / 4) as f64;
    let base = f64::from(TITLE) + lz * scales.px_per_m;
    let pixel = |y: f64, z: f64| (middle + y * scales.px_per_m, base - z * scales.px_per_m);
    let corners = [(-ly / 2.0, 0.0), (ly / 2.0, 0.0), (ly / 2.0, lz), (-ly / 2.0, lz), (-ly / 2.0, 0.0)];
    let outline = corners.map(|(y, z)| rounded(pixel(y, z)));
    area.draw(&PathElement::new(outline, GREY.stroke_width(3)))?;
    for node in middle_plane(mesh, &grid, scales.stride) {
        let [_, y, z] = mesh.coordinates_m(node);
        let v = &frame.velocity_m_s[3 * node..3 * node + 3];
        let from = pixel(y, z);
        let to = (from.0 + v[1] * scales.px_per_m_s, from.1 - v[2] * scales.px_per_m_s);
        arrow(area, from, to, BLACK, 2)?;
    }
    for (j, slave) in grid.middle().enumerate() {
        let [_, y, _] = mesh.coordinates_m(slave);
        let (node, tip) = (&frame.face[slave], pixel(y, 0.0));
        let [_, friction, normal] = node.force_n;
        // The arrow of a force on the pin ends at the node on which it acts.
        let from = (tip.0 - friction * scales.px_per_n, tip.1 + normal * scales.px_per_n);
        if node.state != ContactState::Separated && j % scales.stride == 0 {
            arrow(area, from, tip, colour_of(node.state), 3)?;
        }
        dot(area, rounded(tip), node.state, scales.dot)?;
    }
    write(area, "front", rounded(pixel(-ly / 2.0, -0.12 * lz)), TEXT - 4, HPos::Right)?;
    write(area, "rear", rounded(pixel(ly / 2.0, -0.12 * lz)), TEXT - 4, HPos::Left)
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

/// The contact face from above: states and friction forces.
fn draw_face(area: &Area, inspection: &Inspection, frame: &Frame, scales: &Scales) -> Result<(), DrawError> {
    let mesh = inspection.mesh();
    let grid = inspection.face_grid();
    let [lx, ly, _] = mesh.size_m();
    let middle = f64::from(WIDTH / 4);
    let centre = f64::from(TITLE) + lx / 2.0 * scales.px_per_m;
    let pixel = |x: f64, y: f64| (middle + y * scales.px_per_m, centre - x * scales.px_per_m);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let outline = corners.map(|(x, y)| rounded(pixel(x * lx / 2.0, y * ly / 2.0)));
    area.draw(&PathElement::new(outline, GREY.stroke_width(3)))?;
    let place = |slave| {
        let [x, y, _] = mesh.coordinates_m(slave);
        pixel(x, y)
    };
    for (slave, node) in frame.face.iter().enumerate() {
        dot(area, rounded(place(slave)), node.state, scales.dot)?;
    }
    // The arrows are drawn after the dots, which would hide them.
    for (slave, node) in frame.face.iter().enumerate() {
        let [i, j] = grid.place(slave);
        if node.state != ContactState::Separated && i % scales.stride == 0 && j % scales.stride == 0 {
            let from = place(slave);
            let [sideways, along, _] = node.force_n;
            let scale = scales.px_per_friction_n;
            let to = (from.0 + along * scale, from.1 - sideways * scale);
            arrow(area, from, to, BLACK, 3)?;
        }
    }
    Ok(())
}

/// Draws a node. Its shape shows the state as well.
fn dot(area: &Area, at: (i32, i32), state: ContactState, radius: i32) -> Result<(), DrawError> {
    let colour = colour_of(state);
    match state {
        ContactState::Stick => area.draw(&Circle::new(at, radius, colour.filled())),
        ContactState::Slip => {
            let corners =
                [(0, -radius), (radius, 0), (0, radius), (-radius, 0)].map(|(dx, dy)| (at.0 + dx, at.1 + dy));
            area.draw(&Polygon::new(corners, colour))
        }
        ContactState::Separated => area.draw(&Circle::new(at, radius - 1, colour.stroke_width(2))),
    }
}

/// Shorter arrows [px] are not drawn, because their direction could not be seen.
const SHORTEST: f64 = 3.0;

fn arrow(
    area: &Area,
    from: (f64, f64),
    to: (f64, f64),
    colour: RGBColor,
    width: u32,
) -> Result<(), DrawError> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy);
    if length < SHORTEST {
        return Ok(());
    }
    area.draw(&PathElement::new([rounded(from), rounded(to)], colour.stroke_width(width)))?;
    let (ux, uy) = (dx / length, dy / length);
    let head = (0.4 * length).min(14.0);
    let corner = |side: f64| {
        rounded((to.0 - head * ux - 0.4 * side * head * uy, to.1 - head * uy + 0.4 * side * head * ux))
    };
    area.draw(&Polygon::new([rounded(to), corner(1.0), corner(-1.0)], colour))
}

fn draw_legend(area: &Area, scales: &Scales) -> Result<(), DrawError> {
    let mut x = MARGIN + DOT;
    for state in STATES {
        dot(area, (x, 30), state, DOT)?;
        write(area, state.name(), (x + 26, 30), TEXT, HPos::Left)?;
        x += 240;
    }
    let scale = |x: f64, length: f64, colour, width, text: &str| {
        arrow(area, (x, 95.0), (x + length, 95.0), colour, width)?;
        write(area, text, ((x + length) as i32 + 24, 95), TEXT, HPos::Left)
    };
    let text = format!("velocity {:.0} mm/s", scales.speed_m_s * 1e3);
    scale(f64::from(MARGIN), scales.speed_m_s * scales.px_per_m_s, BLACK, 2, &text)?;
    let text = format!("contact force {:.2} N", scales.force_n);
    scale(540.0, scales.force_n * scales.px_per_n, colour_of(ContactState::Slip), 3, &text)?;
    let text = format!("friction, from above, {:.3} N", scales.friction_n);
    scale(1140.0, scales.friction_n * scales.px_per_friction_n, BLACK, 3, &text)
}

fn rounded((x, y): (f64, f64)) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}
