//! The stability map: the growth rate of the leading mode over ω and μ, with the line on which it is zero.

use super::boundary::{self, Sign};
use crate::publish::FigureError;
use crate::publish::plot::canvas::Chart;
use crate::publish::plot::{MARGIN, palette};
use crate::publish::value;
use crate::report::figure::growth::{self, NO_VALUE, SCALE};
use crate::report::figure::plane::{self, CellStyle};
use crate::report::layout::Group;
use crate::report::row::JobRow;
use crate::report::stability::Analysis;
use crate::report::stability_point::StabilityPoint;
use crate::report::words::parameters_in_words;
use plotters::prelude::{BLACK, Circle};
use plotters::style::Color;
use std::cell::Cell;

/// Radius of the dot of a point that is not on the grid [px].
const DOT: i32 = 4;

/// Draws the map of a group. Points of the grid have cells; the other ones are dots.
pub(super) fn draw(analysis: &Analysis, group: &Group) -> Result<String, FigureError> {
    let layout = &analysis.layout;
    let points = || group.jobs.iter().map(|job| analysis.point(job.row));
    let has_grid = points().any(|point| point.on_grid);
    let is_cell = |point: &StabilityPoint| point.on_grid || !has_grid;
    let cells = group.only(|row| is_cell(analysis.point(row)));
    // All figures of a report have the same colours.
    let everywhere = analysis.points().iter().filter_map(|point| Some(point.leading()?.growth_rate_per_s));
    let largest = everywhere.map(f64::abs).fold(0.0, f64::max);
    let style = |row: &JobRow| style(row, analysis.point(row), largest);
    let nodes = boundary::nodes(layout, group, analysis.points());
    let others: Vec<StabilityPoint> = points().filter(|point| !is_cell(point)).cloned().collect();
    let others = boundary::nodes(layout, group, &others);
    let has_line = Cell::new(false);
    let overlay = |chart: &mut Chart| {
        has_line.set(boundary::draw(chart, &nodes)?);
        let (across, up) = (chart.x_range(), chart.y_range());
        let inside = others.iter().filter(|node| across.contains(&node.x) && up.contains(&node.y));
        chart.draw_series(inside.map(|node| Circle::new((node.x, node.y), DOT, BLACK.filled())))?;
        Ok(())
    };
    let is_unclear = |point: &StabilityPoint| point.leading().is_some_and(|mode| !mode.is_converged);
    plane::draw(layout, &cells, style, overlay, |area| {
        growth::draw_scale(area, largest)?;
        let mut signs = Vec::new();
        signs.extend(has_line.get().then_some(Sign::ZeroLine));
        signs.extend(
            (!others.is_empty())
                .then_some(Sign::Dot { is_hollow: false, label: "point that refines\na threshold" }),
        );
        let mut grey = points().filter(|point| is_cell(point));
        if grey.any(is_unclear) {
            signs.push(Sign::Swatch(NO_VALUE, "not converged"));
        }
        boundary::draw_signs(area, MARGIN + SCALE, &signs)
    })
}

fn style(row: &JobRow, point: &StabilityPoint, largest: f64) -> CellStyle {
    let Some(mode) = point.leading() else {
        let title = format!("{}\nno mode up to {}", parameters_in_words(row), hertz(point.stability.band_hz));
        return CellStyle {
            title: Some(title),
            is_job: false,
            ..CellStyle::new(NO_VALUE, value::MISSING.to_owned(), String::new())
        };
    };
    let rate = mode.growth_rate_per_s;
    let fill = if mode.is_converged { palette::diverging(growth::share(rate, largest)) } else { NO_VALUE };
    let mut lines = vec![
        parameters_in_words(row),
        format!("leading mode: {}", hertz(mode.frequency_hz)),
        format!("growth rate {} 1/s", growth::rate_text(rate)),
        format!("damping ratio {}", value::significant(mode.damping_ratio, 3).replace('-', "−")),
    ];
    if !mode.is_converged {
        lines.push("not converged".to_owned());
    }
    if point.stability.lifted_nodes > 0 {
        lines.push(format!("{} lifted", value::count(point.stability.lifted_nodes as u32, "contact node")));
    }
    let style = CellStyle::new(fill, growth::rate_text(rate), value::number(rate));
    CellStyle { title: Some(lines.join("\n")), is_job: false, ..style }
}

fn hertz(frequency_hz: f64) -> String {
    value::quantity(frequency_hz, "Hz")
}
