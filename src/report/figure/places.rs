//! Where jobs are in a figure: along its axis, and in which series.

use super::style;
use crate::publish::plot::axis::Axis;
use crate::report::layout::{Group, Layout, PlacedJob};
use crate::report::row::JobRow;
use plotters::prelude::RGBColor;
use serde_json::Value;

/// A job in a figure.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub row: &'a JobRow,
    /// The value of the parameter along the axis.
    pub at: &'a Value,
    /// Its position on the axis.
    pub x: f64,
    /// Index of its series.
    pub series: usize,
}

/// The jobs with one value of the parameter that has colours.
pub(super) struct SeriesLook {
    pub name: String,
    pub colour: RGBColor,
    /// The position of its value on an axis of its own; none if it is no number.
    pub y: Option<f64>,
}

/// All jobs of a group that are on the axis, by series and from left to right.
pub(super) fn places<'a>(layout: &Layout, group: &'a Group, x_axis: &Axis) -> Vec<Place<'a>> {
    let place = |job: &'a PlacedJob<'a>| {
        let at = &group.axis_values[job.axis_index];
        Some(Place { row: job.row, at, x: layout.position(x_axis, at)?, series: job.series })
    };
    let mut places: Vec<Place> = group.jobs.iter().filter_map(place).collect();
    places.sort_by(|a, b| a.series.cmp(&b.series).then(a.x.total_cmp(&b.x)));
    places
}

/// All series of a study.
pub(super) fn series(layout: &Layout) -> Vec<SeriesLook> {
    let y_of = y_of(layout);
    let look = |series| SeriesLook {
        name: layout.series_name(series),
        colour: style::colour(layout, series),
        y: y_of(&series.value),
    };
    layout.series.iter().map(look).collect()
}

/// The position of a value of the parameter that has colours, on an axis of its own; none if it is no number.
pub(super) fn y_of(layout: &Layout) -> impl Fn(&Value) -> Option<f64> {
    let dimension = layout.dimension(layout.by);
    let axis = dimension.axis(false);
    move |value| match axis {
        Axis::Names(_) => None,
        _ => dimension.position(&axis, value),
    }
}

/// Name and unit of the parameter that has colours.
pub(super) fn series_title<'a>(layout: &'a Layout) -> &'a str {
    &layout.dimension(layout.by).title
}

/// Whether the figure of a group has tooltips.
pub(super) fn has_tooltips(group: &Group) -> bool {
    group.jobs.len() <= super::MAX_TOOLTIPS
}
