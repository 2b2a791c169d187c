//! The band that the error of mesh and time step makes around a curve of μ\* or of the frequency.

use super::data::{Curve, Point};
use crate::publish::plot::DrawError;
use crate::publish::plot::canvas::Chart;
use crate::report::discretisation::Discretisation;
use crate::report::scalar::{FREQUENCY, MU_STAR, Scalar};
use plotters::prelude::{Polygon, RGBColor, Rectangle};
use plotters::style::Color;

/// How much the band covers of what is behind it, if the error was measured on the jobs' own scene.
const MEASURED: f64 = 0.22;
/// The same if it is indicative.
const INDICATIVE: f64 = 0.11;
/// Half the width of the band of a single point [px].
const HALF_WIDTH_PX: i32 = 9;

/// The lower and the upper end of the error at a point; both are its value if the error is not measured.
pub(super) fn ends(point: &Point, scalar: &Scalar) -> [f64; 2] {
    let error = relative_error(point, scalar).map_or(0.0, |(error, _)| error * point.y.abs());
    [point.y - error, point.y + error]
}

/// Whether a band is drawn for any of these points.
pub(super) fn exists<'a>(mut points: impl Iterator<Item = &'a Point<'a>>, scalar: &Scalar) -> bool {
    points.any(|point| relative_error(point, scalar).is_some())
}

/// Draws the band of a curve: along its lines, and beside single points.
pub(super) fn draw(
    chart: &mut Chart,
    curve: &Curve,
    scalar: &Scalar,
    colour: RGBColor,
) -> Result<(), DrawError> {
    let error_at = |x: f64| {
        curve.points.iter().filter(|point| point.x == x).find_map(|point| relative_error(point, scalar))
    };
    let cover = |is_measured: bool| if is_measured { MEASURED } else { INDICATIVE };
    for stretch in &curve.stretches {
        for pair in stretch.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            if let (Some((here, measured_here)), Some((there, measured_there))) =
                (error_at(from.0), error_at(to.0))
            {
                let corners = [
                    (from.0, from.1 * (1.0 - here)),
                    (to.0, to.1 * (1.0 - there)),
                    (to.0, to.1 * (1.0 + there)),
                    (from.0, from.1 * (1.0 + here)),
                ];
                let style = colour.mix(cover(measured_here && measured_there));
                chart.draw_series([Polygon::new(corners.to_vec(), style)])?;
            }
        }
    }
    let is_joined = |point: &Point| curve.stretches.iter().flatten().any(|(x, _)| *x == point.x);
    let area = chart.plotting_area().strip_coord_spec();
    let (left, top) = area.get_base_pixel();
    for point in curve.points.iter().filter(|point| !is_joined(point)) {
        if let Some((_, is_measured)) = relative_error(point, scalar) {
            let [low, high] = ends(point, scalar).map(|y| chart.backend_coord(&(point.x, y)));
            let (x, upper, lower) = (high.0 - left, high.1 - top, low.1 - top);
            let style = colour.mix(cover(is_measured)).filled();
            area.draw(&Rectangle::new([(x - HALF_WIDTH_PX, upper), (x + HALF_WIDTH_PX, lower)], style))?;
        }
    }
    Ok(())
}

/// The error at a point relative to its value, and whether it was measured on the job's own scene.
fn relative_error(point: &Point, scalar: &Scalar) -> Option<(f64, bool)> {
    let error = point.row.discretisation.error().filter(|_| point.settled)?;
    let error = match scalar {
        scalar if scalar == *MU_STAR => error.mu_star_relative,
        scalar if scalar == *FREQUENCY => error.frequency_relative,
        _ => return None,
    };
    (error > 0.0).then_some((error, matches!(point.row.discretisation, Discretisation::Measured(_))))
}
