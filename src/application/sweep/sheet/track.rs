//! The drawing of the disk with the pin's track, seen from above.

use super::colours::{DISK, DISK_EDGE, INK};
use super::derived::SLIDING_SPEED;
use super::lines;
use super::survey::Survey;
use crate::publish::Drawing;
use crate::publish::chart::Rgb;
use crate::publish::chart::palette::{BLUE, PAPER};
use crate::publish::chart::{Anchor, At, Pen, Svg};
use crate::spec::{DiskKind, JobSpec, Shape};

const SIZE: (u32, u32) = (470, 470);
const CENTRE: At = (225.0, 215.0);
/// Radius of the largest circle [px].
const RADIUS: f64 = 180.0;
/// Smallest edge of the pin's footprint on the sheet [px].
const SMALLEST: f64 = 5.0;

const PIN: Rgb = Rgb(0xCD, 0xDC, 0xEA);

/// Draws the disk of a job. Texts give the values of all jobs.
pub(super) fn draw(spec: &JobSpec, survey: &Survey) -> Drawing {
    let (disk, pin) = (&spec.scene.disk, &spec.scene.pin);
    let track_m = disk.track_radius_m;
    let elastic = disk.kind == DiskKind::Elastic;
    let reach_m = track_m + pin.extent_m()[0];
    let largest_m = if elastic { disk.ring.outer_radius_m } else { reach_m };
    let scale = RADIUS / largest_m;
    let on_circle = |radius: f64, degrees: f64| {
        let angle = degrees.to_radians();
        (CENTRE.0 + radius * angle.cos(), CENTRE.1 - radius * angle.sin())
    };

    let mut svg = Svg::new((f64::from(SIZE.0), f64::from(SIZE.1)));
    let edge = if elastic { Pen::solid(DISK_EDGE, 1.2) } else { Pen::dashed(DISK_EDGE, 1.2) };
    svg.circle(CENTRE, RADIUS, Some(DISK), Some(edge));
    if elastic {
        svg.circle(CENTRE, disk.ring.inner_radius_m * scale, Some(PAPER), Some(edge));
    }
    svg.circle(CENTRE, track_m * scale, None, Some(Pen::dashed(INK, 1.0)));
    let half = [0, 1].map(|axis| (pin.extent_m()[axis] * scale / 2.0).max(SMALLEST / 2.0));
    let at = on_circle(track_m * scale, 0.0);
    if pin.shape == Shape::Cylinder {
        svg.circle(at, half[0], Some(PIN), Some(Pen::solid(INK, 1.6)));
    } else {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let footprint = corners.map(|(x, y)| (at.0 + x * half[0], at.1 + y * half[1]));
        svg.polygon(&footprint, (PIN, 1.0), Some(Pen::solid(INK, 1.6)));
    }

    let radius = lines::assignment(survey, "track_radius_m");
    let beside = ((CENTRE.0 + at.0) / 2.0, CENTRE.1 - 13.0);
    svg.dimension(CENTRE, (at.0 - half[0], at.1), INK, &radius, (beside, Anchor::Middle));
    svg.circle(CENTRE, 3.5, Some(INK), Some(Pen::solid(INK, 1.0)));
    svg.text((CENTRE.0, CENTRE.1 + 18.0), Anchor::Middle, INK, "disk axis");

    // Seen from above, the disk turns counter-clockwise: its surface moves towards +y under the pin.
    let arc: Vec<At> = (0..=30).map(|step| on_circle(0.45 * RADIUS, 110.0 + 4.0 * f64::from(step))).collect();
    svg.arrow(&arc, Pen::solid(BLUE, 2.4));
    svg.text(on_circle(0.45 * RADIUS, 100.0), Anchor::Start, BLUE, "ω");
    let beside_pin = at.0 + half[0] + 14.0;
    svg.arrow(&[(beside_pin, at.1 + 30.0), (beside_pin, at.1 - 30.0)], Pen::solid(BLUE, 2.4));
    svg.text((beside_pin + 9.0, at.1 - 22.0), Anchor::Start, BLUE, "V");
    draw_axes(&mut svg);
    let below = f64::from(SIZE.1);
    let speed = survey.derived.iter().find(|(derived, _)| derived.name == SLIDING_SPEED);
    svg.text((90.0, below - 44.0), Anchor::Start, BLUE, &lines::assignment(survey, "omega_rpm"));
    if let Some((_, [low, high])) = speed {
        let speed = format!("V = ωR = {}", lines::range(*low, *high, "m/s"));
        svg.text((90.0, below - 22.0), Anchor::Start, BLUE, &speed);
    }
    Drawing { stem: "track", svg: svg.finish(""), caption: caption(spec, survey) }
}

fn draw_axes(svg: &mut Svg) {
    let origin = (22.0, f64::from(SIZE.1) - 22.0);
    for ((dx, dy), name) in [((1.0, 0.0), "x"), ((0.0, -1.0), "y")] {
        svg.arrow(&[origin, (origin.0 + 36.0 * dx, origin.1 + 36.0 * dy)], Pen::solid(INK, 1.6));
        svg.text((origin.0 + 46.0 * dx, origin.1 + 46.0 * dy), Anchor::Middle, INK, name);
    }
}

fn caption(spec: &JobSpec, survey: &Survey) -> String {
    let ring = match spec.scene.disk.kind {
        DiskKind::Rigid => "The disk is a rigid plane, which has no edge.".to_owned(),
        DiskKind::Elastic => {
            let radius = |name| lines::of(survey, name);
            format!(
                "The disk is an elastic ring from r = {} to r = {}, {} thick.",
                radius("disk_inner_radius_m"),
                radius("disk_outer_radius_m"),
                radius("disk_thickness_m")
            )
        }
    };
    let footprint = match spec.scene.pin.shape {
        Shape::Block | Shape::Cylinder => "the footprint of the pin",
        Shape::Mesh => "the rectangle around the pin's footprint",
    };
    let drawn = [
        "size_x_m",
        "size_y_m",
        "diameter_m",
        "track_radius_m",
        "disk_kind",
        "disk_inner_radius_m",
        "disk_outer_radius_m",
    ];
    let first = if drawn.iter().any(|name| survey.varies(name)) { " Drawn is the first job." } else { "" };
    format!(
        "The disk from above, with {footprint} and its track (dashed), to scale. {ring} It turns under the pin \
         towards +y.{first}"
    )
}
