//! Markers: the shape shows the contact regime, and a hollow marker shows that the state is not periodic. Measured points
//! have crosses.

use super::style::SourceStyle;
use crate::analysis::Regime;
use crate::publish::plot::DrawError;
use crate::publish::plot::canvas::Area;
use plotters::prelude::{Circle, PathElement, Polygon, RGBColor, WHITE};
use plotters::style::Color;

/// Radius of a circle marker [px].
pub(super) const RADIUS: i32 = 11;
/// Size of the hole in a hollow marker, relative to the marker.
const HOLE: f64 = 0.58;

/// Draws one marker: a shape in `colour`, and a smaller white one on it if it is hollow.
pub(super) fn draw(
    area: &Area,
    at: (i32, i32),
    regime: Regime,
    periodic: bool,
    colour: RGBColor,
) -> Result<(), DrawError> {
    shape(area, at, regime, 1.0, colour)?;
    if periodic && regime != Regime::Undecided {
        return Ok(());
    }
    shape(area, at, regime, HOLE, WHITE)
}

/// Draws the mark of a measured point.
pub(super) fn draw_measured(
    area: &Area,
    (x, y): (i32, i32),
    style: SourceStyle,
    colour: RGBColor,
) -> Result<(), DrawError> {
    for (dx, dy) in style.strokes() {
        let reach = |share: f64| (share * 1.3 * f64::from(RADIUS)).round() as i32;
        let line = [(x - reach(*dx), y - reach(*dy)), (x + reach(*dx), y + reach(*dy))];
        area.draw(&PathElement::new(line, colour.stroke_width(5)))?;
    }
    Ok(())
}

/// Draws an arrow beyond a marker at the edge of a plot, which shows that the value is outside.
pub(super) fn draw_outside(
    area: &Area,
    (x, y): (i32, i32),
    upwards: bool,
    colour: RGBColor,
) -> Result<(), DrawError> {
    let sign = if upwards { -1 } else { 1 };
    let (near, far) = (y + sign * (RADIUS + 6), y + sign * (RADIUS + 18));
    area.draw(&Polygon::new([(x - 8, near), (x + 8, near), (x, far)], colour))
}

/// Corners of the shapes for a radius of 1, with y downwards; none for a circle. All shapes have about the same area.
fn corners(regime: Regime) -> &'static [(f64, f64)] {
    match regime {
        Regime::Stable | Regime::Undecided => &[],
        Regime::StickSlip => &[(0.0, -1.4), (1.25, 0.8), (-1.25, 0.8)],
        Regime::StickSlipSeparation => &[(-0.95, -0.95), (0.95, -0.95), (0.95, 0.95), (-0.95, 0.95)],
        Regime::SlipSeparation => &[(0.0, -1.35), (1.35, 0.0), (0.0, 1.35), (-1.35, 0.0)],
    }
}

fn shape(
    area: &Area,
    (x, y): (i32, i32),
    regime: Regime,
    scale: f64,
    colour: RGBColor,
) -> Result<(), DrawError> {
    let pixels = |offset: f64| (offset * scale * f64::from(RADIUS)).round() as i32;
    let corners: Vec<(i32, i32)> =
        corners(regime).iter().map(|&(dx, dy)| (x + pixels(dx), y + pixels(dy))).collect();
    if corners.is_empty() {
        area.draw(&Circle::new((x, y), pixels(1.0), colour.filled()))
    } else {
        area.draw(&Polygon::new(corners, colour))
    }
}
