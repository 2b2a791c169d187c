//! The residuals of the energy balance and of the identities, for every job of a study.

use super::colour_key::{self, KeyEntry, Swatch};
use crate::analysis::JobRecord;
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, Chart, X_LABELS};
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{DrawError, MARGIN, TEXT, palette};
use crate::publish::value;
use crate::report::layout::MAX_TOOLTIPS;
use crate::report::row::JobRow;
use crate::report::tooltip::tooltip_text;
use plotters::chart::ChartBuilder;
use plotters::prelude::{Circle, Polygon, RGBColor};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;
use serde_json::Value;

const SIZE: (u32, u32) = (canvas::WIDTH, 860);
const LEGEND_WIDTH: u32 = 400;
const Y_LABELS: u32 = 170;
const RADIUS: i32 = 9;

/// A kind of residual and its marker.
struct Kind {
    name: &'static str,
    label: &'static str,
    colour: RGBColor,
    round: bool,
    of: fn(&JobRecord) -> f64,
}

const KINDS: [Kind; 2] = [
    Kind {
        name: "identity_residual",
        label: "identities",
        colour: palette::VERMILLION,
        round: false,
        of: JobRecord::identity_residual,
    },
    Kind {
        name: "energy_residual",
        label: "energy balance",
        colour: palette::BLUE,
        round: true,
        of: |record| record.energy_residual.abs(),
    },
];

/// Draws the residuals of all rows in their order. A residual of exactly zero is left out, because the axis is logarithmic.
pub(in crate::report) fn draw(rows: &[JobRow]) -> Result<String, FigureError> {
    canvas::sheet(SIZE, |root| {
        let (left, right) = root.split_horizontally(SIZE.0 - LEGEND_WIDTH);
        let targets = draw_plot(&left, rows)?;
        let entry = |kind: &Kind| KeyEntry {
            swatch: Swatch::coloured(kind.colour, if kind.round { '●' } else { '◆' }),
            label: kind.label.to_owned(),
        };
        colour_key::draw_column(&right, MARGIN, &KINDS.map(|kind| entry(&kind)))?;
        Ok(if rows.len() <= MAX_TOOLTIPS { targets } else { Vec::new() })
    })
}

fn draw_plot(area: &Area, rows: &[JobRow]) -> Result<Vec<TooltipTarget>, DrawError> {
    let points = |kind: &'static Kind| {
        rows.iter().enumerate().filter_map(move |(place, row)| {
            let residual = (kind.of)(row.record()?);
            (residual.is_finite() && residual > 0.0).then_some((place, row, residual))
        })
    };
    let all: Vec<Value> = KINDS.iter().flat_map(points).map(|(_, _, residual)| residual.into()).collect();
    if all.is_empty() {
        let (width, height) = area.dim_in_pixel();
        canvas::write(area, "no results yet", (width as i32 / 2, height as i32 / 3), TEXT, HPos::Center)?;
        return Ok(Vec::new());
    }
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(X_LABELS)
        .y_label_area_size(Y_LABELS)
        .build_cartesian_2d(Axis::spanning(1.0, rows.len() as f64, 1.0), Axis::for_values(&all, Some(true)))?;
    canvas::mesh(&mut chart).x_desc("job, in the order of the study").y_desc("residual").draw()?;
    canvas::frame(&chart)?;
    let mut targets = Vec::new();
    for kind in &KINDS {
        for (place, row, residual) in points(kind) {
            let at = (place as f64 + 1.0, residual);
            draw_marker(area, &chart, at, kind)?;
            targets.push(TooltipTarget {
                shape: Shape::Around { at: chart.backend_coord(&at), radius: 2 * RADIUS },
                title: tooltip_text(row),
                data: vec![
                    ("job", row.job.clone()),
                    ("x", (place + 1).to_string()),
                    ("y", value::number(residual)),
                    ("kind", kind.name.to_owned()),
                ],
            });
        }
    }
    Ok(targets)
}

fn draw_marker(area: &Area, chart: &Chart, at: (f64, f64), kind: &Kind) -> Result<(), DrawError> {
    let (left, top) = area.get_base_pixel();
    let (x, y) = chart.backend_coord(&at);
    let (x, y) = (x - left, y - top);
    if kind.round {
        return area.draw(&Circle::new((x, y), RADIUS, kind.colour.filled()));
    }
    let reach = RADIUS + 3;
    area.draw(&Polygon::new([(x, y - reach), (x + reach, y), (x, y + reach), (x - reach, y)], kind.colour))
}
