//! Where jobs are in a figure: along its axis, and in which series.

use crate::publish::chart::{Axis, Rgb, Scale, Tip, palette};
use crate::publish::value;
use crate::report::layout::{Group, Layout, PlacedJob, Series};
use crate::report::row::JobRow;
use crate::report::tooltip::tooltip_text;
use serde_json::Value;

/// Up to so many values that people chose are the ticks of an axis.
const MOST_CHOSEN: usize = 12;

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
    pub colour: Rgb,
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

/// The abscissa of all panels. Its ticks are the values that the study's author chose, if they are few.
pub(super) fn x_scale(layout: &Layout) -> Scale {
    let mut scale = Scale::new(layout.axis_name(), layout.x_axis());
    if matches!(scale.axis, Axis::Names(_)) {
        return scale;
    }
    for (group, job) in layout.groups.iter().flat_map(|group| group.jobs.iter().map(move |job| (group, job)))
    {
        let value = &group.axis_values[job.axis_index];
        let is_chosen = !job.row.is_measured() && job.row.wave == 0;
        if let Some(x) = layout.position(&scale.axis, value).filter(|_| is_chosen)
            && !scale.ticks.iter().any(|(at, _)| *at == x)
        {
            scale.ticks.push((x, layout.axis_text(value).replace('-', "−")));
        }
        if scale.ticks.len() > MOST_CHOSEN {
            scale.ticks.clear();
            break;
        }
    }
    scale.ticks.sort_by(|a, b| a.0.total_cmp(&b.0));
    scale
}

/// All series of a study.
pub(super) fn series(layout: &Layout) -> Vec<SeriesLook> {
    let look = |series| SeriesLook { name: layout.series_name(series), colour: colour(layout, series) };
    layout.series.iter().map(look).collect()
}

/// The colour of a series: one for each value of the curves' parameter, and black where it is not known.
pub(super) fn colour(layout: &Layout, series: &Series) -> Rgb {
    let known =
        layout.series.iter().filter(|series| !series.value.is_null()).map(|series| series.value_index);
    let count = known.max().map_or(1, |last| last + 1);
    if series.value.is_null() { palette::INK } else { palette::colour(series.value_index, count) }
}

/// Name and unit of the parameter that has colours.
pub(super) fn series_title<'a>(layout: &'a Layout) -> &'a str {
    &layout.dimension(layout.by).title
}

impl Place<'_> {
    /// The job's tooltip with its key and its value along the axis, and further values for programs.
    pub fn tip(&self, further: impl IntoIterator<Item = (&'static str, String)>) -> Tip {
        let own = [("job", self.row.job.clone()), ("x", value::text(self.at))];
        Tip { title: tooltip_text(self.row), data: own.into_iter().chain(further).collect() }
    }
}
