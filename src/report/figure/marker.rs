//! Markers: the shape shows the contact regime, and a hollow marker shows that the state is not periodic.

use crate::analysis::Regime;
use crate::publish::plot::DrawError;
use crate::publish::plot::canvas::Area;
use plotters::prelude::{Circle, Polygon, RGBColor, WHITE};

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
        area.draw(&Circle::new((x, y), pixels(1.0), plotters::style::Color::filled(&colour)))
    } else {
        area.draw(&Polygon::new(corners, colour))
    }
}
