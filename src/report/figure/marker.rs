//! The arrow at the edge of a plot, for drawings that are not charts yet.

use crate::publish::plot::DrawError;
use crate::publish::plot::canvas::Area;
use plotters::prelude::{Polygon, RGBColor};

/// Radius of a marker [px].
pub(super) const RADIUS: i32 = 11;

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
