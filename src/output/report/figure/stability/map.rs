//! The stability map: the growth rate of the leading mode over ω and μ, with the line on which it is zero.

use crate::publish::chart::palette::{DARK, INK, NO_VALUE};
use crate::publish::chart::{Chart, Entry, Layer, Marker, Point, Shape};
use crate::publish::value;
use crate::report::figure::cells::{self, Look};
use crate::report::layout::Group;
use crate::report::row::JobRow;
use crate::report::stability::Analysis;
use crate::report::stability_point::StabilityPoint;
use crate::report::words::parameters_in_words;

/// The map of a group. Points of the grid have cells; the other ones are dots.
pub(super) fn chart(analysis: &Analysis, group: &Group) -> Chart {
    let layout = &analysis.layout;
    let points = || group.jobs.iter().map(|job| analysis.point(job.row));
    let has_grid = points().any(|point| point.on_grid);
    let is_cell = |point: &StabilityPoint| point.on_grid || !has_grid;
    let on_grid = group.only(|row| is_cell(analysis.point(row)));
    // All figures of a report have the same colours.
    let everywhere = analysis.points().iter().filter_map(|point| Some(point.leading()?.growth_rate_per_s));
    let largest = everywhere.map(f64::abs).fold(0.0, f64::max);
    let look = |row: &JobRow| look(row, analysis.point(row), largest);
    let mut chart = cells::on_true_axes(layout, &on_grid, look);
    cells::add_growth_scale(&mut chart, largest);
    cells::add_boundary(&mut chart, &cells::nodes(layout, group, analysis.points()));
    let others: Vec<StabilityPoint> = points().filter(|point| !is_cell(point)).cloned().collect();
    if let (false, Some(panel)) = (others.is_empty(), chart.panels.first_mut()) {
        let marker = Marker::new(Shape::Circle, DARK).sized(2.0);
        let (across, up) = (panel.x.axis.range(), panel.y.axis.range());
        let others = cells::nodes(layout, group, &others).into_iter();
        let inside = others.filter(|node| across.contains(&node.x) && up.contains(&node.y));
        let dot = |node: crate::report::stability::Node| Point {
            at: (node.x, node.y),
            error: 0.0,
            marker,
            tip: None,
        };
        panel.layers.push(Layer::Points(inside.map(dot).collect()));
        chart.legend.push(Entry::marker(Marker { colour: INK, ..marker }, "point outside the grid"));
    }
    let is_unclear = |point: &StabilityPoint| point.leading().is_some_and(|mode| !mode.is_converged);
    if points().any(|point| is_cell(point) && is_unclear(point)) {
        chart.legend.push(Entry::cell(NO_VALUE, "", "not converged"));
    }
    chart
}

fn look(row: &JobRow, point: &StabilityPoint, largest: f64) -> Look {
    let hertz = |frequency_hz: f64| value::quantity(frequency_hz, "Hz");
    let Some(mode) = point.leading() else {
        let title = format!("{}\nno mode up to {}", parameters_in_words(row), hertz(point.stability.band_hz));
        let look = Look::new(NO_VALUE, value::MISSING.to_owned(), String::new());
        return Look { title: Some(title), is_job: false, ..look };
    };
    let rate = mode.growth_rate_per_s;
    let fill = if mode.is_converged { cells::growth_colour(rate, largest) } else { NO_VALUE };
    let mut lines = vec![
        parameters_in_words(row),
        format!("leading mode: {}", hertz(mode.frequency_hz)),
        format!("growth rate {} 1/s", cells::rate_text(rate)),
        format!("damping ratio {}", value::significant(mode.damping_ratio, 3).replace('-', "−")),
    ];
    if !mode.is_converged {
        lines.push("not converged".to_owned());
    }
    if point.stability.lifted_nodes > 0 {
        lines.push(format!("{} lifted", value::count(point.stability.lifted_nodes as u32, "contact node")));
    }
    let look = Look::new(fill, cells::rate_text(rate), value::number(rate));
    Look { title: Some(lines.join("\n")), is_job: false, ..look }
}
