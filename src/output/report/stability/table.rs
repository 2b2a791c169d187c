//! Modes and thresholds as tables for people and for programs.

use super::along::Along;
use super::analysis::{Analysis, MOVES, rows};
use super::caveats::{above_band, small_contact};
use super::ranges::{Known, Onset, Speed};
use crate::analysis::{ComplexMode, UnknownError};
use crate::publish::table::{Column, FileColumns, Head, Table};
use crate::publish::value;
use crate::report::layout::Group;
use crate::report::parameters::{self, MU, parameter_names};
use crate::report::stability_point::StabilityPoint;
use crate::report::view::View;
use crate::units::name_and_unit;
use indexmap::IndexMap;
use serde_json::Value;

/// A mode at a point, with its number from 1.
#[derive(Clone, Copy)]
struct NumberedMode<'a> {
    point: &'a StabilityPoint,
    number: usize,
    mode: &'a ComplexMode,
}

#[rustfmt::skip]
fn of_mode<'a>() -> [Column<NumberedMode<'a>>; 12] {
    [
        Column::new(MODE_NUMBER, "", "number of the mode, from 1, the fastest growing one first", |of| of.number.into()),
        Column::new("frequency_hz", "Hz", "its frequency", |of| of.mode.frequency_hz.into()),
        Column::new("frequency_mesh_error_hz", "Hz", "bound of the error that the mesh makes; empty if it is unknown", |of| of.mode.frequency_mesh_error_hz.into()),
        Column::new("growth_rate_per_s", "1/s", "growth rate; negative: it decays", |of| of.mode.growth_rate_per_s.into()),
        Column::new("growth_rate_mesh_error_per_s", "1/s", "bound of the error that the mesh makes; empty if it is unknown", |of| of.mode.growth_rate_mesh_error_per_s.into()),
        Column::new("damping_ratio", "", "ζ = −Re λ/|λ|", |of| of.mode.damping_ratio.into()),
        Column::new("residual", "", "relative residual of the mode in the full problem", |of| of.mode.residual.into()),
        Column::new("converged", "", "whether the residual is within its tolerance", |of| of.mode.is_converged.into()),
        Column::new("contact_nodes", "", "nodes in contact in steady sliding", |of| of.point.stability.contact_nodes.into()),
        Column::new("lifted_nodes", "", "nodes that steady sliding lifts off", |of| of.point.stability.lifted_nodes.into()),
        Column::new("band_hz", "Hz", "modes are known below this frequency", |of| of.point.stability.band_hz.into()),
        Column::new("above_band", "", ABOVE, |of| of.point.stability.above_band.name().into()),
    ]
}

/// The name of the first column after the parameters of a point.
pub const MODE_NUMBER: &str = "mode";

const ABOVE: &str = "what is known above band_hz: nothing is there, damped, coarser_run or not_looked_at";

/// Which modes of a point are shown.
#[derive(Clone, Copy, Debug)]
pub struct ShownModes {
    /// The largest number of modes; with a frequency the largest number of those that decay.
    pub count: usize,
    /// All modes that grow come first, and then the others in the order of their distance from this frequency (Hz); `None` if all are in
    /// the order of their growth.
    pub near_hz: Option<f64>,
}

impl ShownModes {
    /// All modes, the fastest growing ones first.
    pub const ALL: Self = Self { count: usize::MAX, near_hz: None };

    /// Indices of the modes that are shown, in their order, among those of a point, whose first one grows fastest.
    pub fn of<'a>(self, modes: impl IntoIterator<Item = &'a ComplexMode>) -> Vec<usize> {
        let modes: Vec<&ComplexMode> = modes.into_iter().collect();
        let Some(near_hz) = self.near_hz else { return (0..modes.len().min(self.count)).collect() };
        let (mut shown, mut others): (Vec<usize>, Vec<usize>) =
            (0..modes.len()).partition(|&index| modes[index].grows());
        let distance = |index: usize| (modes[index].frequency_hz - near_hz).abs();
        others.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        shown.extend(others.into_iter().take(self.count));
        shown
    }
}

/// The modes at each point that are shown: a line for each of them.
pub fn modes_table<'a>(points: impl IntoIterator<Item = &'a StabilityPoint>, shown: ShownModes) -> Table {
    let points: Vec<&StabilityPoint> = points.into_iter().collect();
    let of_parameter = |name: &str| {
        let (head, name) = (parameters::head(name), name.to_owned());
        Column::made(head, move |of: &NumberedMode| of.point.parameter(&name))
    };
    let names = parameter_names(points.iter().map(|point| &point.parameters));
    let columns: Vec<_> = names.into_iter().map(of_parameter).chain(of_mode()).collect();
    let of_point = |point: &'a StabilityPoint| {
        let modes = &point.stability.modes;
        let of_number = move |index: usize| NumberedMode { point, number: index + 1, mode: &modes[index] };
        shown.of(modes).into_iter().map(of_number)
    };
    Table::of("modes", &columns, &points.into_iter().flat_map(of_point).collect::<Vec<_>>())
}

/// Why modes that are shown have no mesh error, in words; `None` if all of them have one, or there are none.
pub fn unknown_errors<'a>(
    points: impl IntoIterator<Item = &'a StabilityPoint>,
    shown: ShownModes,
) -> Option<String> {
    let mut all = 0;
    let mut reasons: IndexMap<&str, usize> = IndexMap::new();
    for point in points {
        let modes = &point.stability.modes;
        let shown = shown.of(modes);
        let unknown =
            shown.iter().filter(|&&index| modes[index].growth_rate_mesh_error_per_s.is_none()).count();
        let reason = point
            .stands_alone
            .map_or("no mode on the coarser mesh that is clearly the same", UnknownError::reason);
        if unknown > 0 {
            *reasons.entry(reason).or_default() += unknown;
        }
        all += shown.len();
    }
    let unknown: usize = reasons.values().sum();
    let none = if unknown == all { "No mesh error is known." } else { "Not every mesh error is known." };
    let reasons: Vec<String> = reasons
        .into_iter()
        .map(|(what, count)| format!("{count} {} {what}", if count == 1 { "has" } else { "have" }))
        .collect();
    let all = value::count(all, "mode");
    (!reasons.is_empty()).then(|| format!("{none} Of {all}, {}.", reasons.join(", and ")))
}

/// A series of points along the parameter of the thresholds, with the other parameters, and a range in which a mode grows.
struct Range<'a> {
    place: Vec<Value>,
    onset: Option<&'a Onset>,
    /// The largest value of a series in which no mode grows.
    last: Option<f64>,
    known: &'a Known,
}

impl Range<'_> {
    fn read<T: Into<Value>>(&self, read: impl FnOnce(&Onset) -> Option<T>) -> Value {
        self.onset.and_then(read).into()
    }
}

/// The columns of a range along the parameter of this name.
#[rustfmt::skip]
fn of_range<'a>(along: &str) -> [Column<Range<'a>>; 11] {
    let symbol = if along == MU { "μ" } else { along };
    let edge = |end: &str, meaning: String, read: fn(&Range) -> Value| {
        Column::made(Head::new(format!("{along}_{end}"), name_and_unit(along).1, meaning), read)
    };
    [
        edge("c", format!("{symbol} at which the mode begins to grow; empty if it grows at the first {symbol} at which it is known already, or at none"), |of| of.read(|onset| onset.below.map(|_| onset.mu))),
        edge("c_mesh_error", format!("bound of the error of {symbol} there that the mesh makes; empty if it is unknown"), |of| of.read(|onset| onset.mesh_error)),
        edge("below", format!("largest {symbol} below at which it decays or is not there; of a series without a mode that grows, the largest one"), |of| of.last.map_or_else(|| of.read(|onset| onset.below), Value::from)),
        edge("above", format!("smallest {symbol} above"), |of| of.read(|onset| Some(onset.above))),
        edge("end", format!("{symbol} at which the mode ceases to grow; empty if it still grows at its last point"), |of| of.read(|onset| onset.ends.map(|ends| ends.at))),
        edge("end_below", format!("largest {symbol} below that"), |of| of.read(|onset| onset.ends.map(|ends| ends.below))),
        edge("end_above", format!("smallest {symbol} above that"), |of| of.read(|onset| onset.ends.map(|ends| ends.above))),
        Column::new("frequency_hz", "Hz", "frequency of the mode where it begins to grow", |of| of.read(|onset| Some(onset.frequency_hz))),
        Column::new("converged", "", "whether the modes on both sides are converged", |of| of.read(|onset| Some(onset.is_converged))),
        Column::new("band_hz", "Hz", "lowest frequency, of the points of the series at which no mode grows, below which modes are known", |of| of.known.band_hz.into()),
        Column::new("above_band", "", "the worst of what is known above band_hz at the points of the series at which no mode grows", |of| of.known.above.name().into()),
    ]
}

/// A line for each range in which a mode grows, and one for a series in which none does.
pub(in crate::report) fn onsets_table(analysis: &Analysis) -> Table {
    let mut ranges: Vec<Range> = Vec::new();
    for_each_speed(analysis, |place, speed| {
        let range = |onset, last| Range { place: place.clone(), onset, last, known: &speed.known };
        if speed.onsets.is_empty() && speed.mus[1].is_finite() {
            ranges.push(range(None, Some(speed.mus[1])));
        }
        ranges.extend(speed.onsets.iter().map(|onset| range(Some(onset), None)));
    });
    let of_place =
        |(index, head): (usize, Head)| Column::made(head, move |of: &Range| of.place[index].clone());
    let place = place_heads(analysis).enumerate().map(of_place);
    let columns: Vec<Column<Range>> = place.chain(of_range(&analysis.along.parameter)).collect();
    Table::of("thresholds", &columns, &ranges)
}

/// Where sliding is unstable in each series, in words: the first place at which it becomes so (`0.3142`, `≤ 0.1` if it is unstable at
/// the smallest one already, `> 0.6` if no mode grows), and the ranges in which it is. The lines after it say what the table does not.
pub fn thresholds_table(points: &[StabilityPoint], along: &Along) -> (Table, Vec<String>) {
    let rows = rows(points, along);
    let analysis = Analysis::of(points, &rows, along, &View::DEFAULT);
    let mut lines = Vec::new();
    let names = [along.across()].into_iter().chain(analysis.layout.further.iter().copied());
    let names: Vec<&str> = names.collect();
    // What has a symbol is a plain number everywhere.
    let in_words = |(name, cell): (&&str, Value)| match cell {
        Value::Null if along.moves(name) => MOVES.into(),
        cell if parameters::symbol(name).is_none() && cell.is_f64() => {
            parameters::in_words(name, &cell).into()
        }
        cell => cell,
    };
    for_each_speed(&analysis, |place, speed| {
        let words = analysis.words(speed).map(Value::from);
        lines.push(names.iter().zip(place).map(in_words).chain(words).collect());
    });
    let own = [along.threshold()].into_iter().chain(["unstable", "frequency", "note"].map(str::to_owned));
    let heads = place_heads(&analysis).chain(own.map(|name| Head::new(name, "", ""))).collect();
    let notes = [analysis.along_in_words(), above_band(points), small_contact(points)]
        .into_iter()
        .flatten()
        .collect();
    (Table { stem: "thresholds".into(), heads, lines }, notes)
}

/// Calls `visit` with the parameters of each speed and its modes.
fn for_each_speed<'a>(analysis: &'a Analysis, mut visit: impl FnMut(Vec<Value>, &'a Speed)) {
    for (group, modes) in analysis.layout.groups.iter().zip(&analysis.groups) {
        for (index, speed) in modes.speeds.iter().enumerate() {
            let key = group.key.iter().map(|(_, value)| value.clone());
            let scattered = scattered(analysis).map(|name| common(group, index, name));
            visit([speed.omega.clone()].into_iter().chain(key).chain(scattered).collect(), speed);
        }
    }
}

fn place_heads(analysis: &Analysis) -> impl Iterator<Item = Head> {
    let names = [analysis.along.across()].into_iter().chain(analysis.layout.further.iter().copied());
    names.chain(scattered(analysis)).map(parameters::head)
}

/// The parameters of points that are no grid, besides those of the series and of the thresholds.
fn scattered<'a>(analysis: &'a Analysis) -> impl Iterator<Item = &'a str> {
    let is_placed = |name: &&str| *name == analysis.along.across() || *name == analysis.along.parameter;
    analysis.layout.scattered.iter().copied().filter(move |name| !is_placed(name))
}

/// The value of a parameter that all points of a series have; null if they differ.
fn common(group: &Group, series: usize, name: &str) -> Value {
    let mut values =
        group.jobs.iter().filter(|job| job.axis_index == series).map(|job| job.row.parameter(name));
    let first = values.next().unwrap_or_default();
    if values.all(|value| value == first) { first } else { Value::Null }
}

/// The columns, for the page of columns.
pub(in crate::report) fn described() -> [FileColumns; 2] {
    [
        FileColumns::new(&["modes.csv"], "A line is a mode of steady sliding at a point.", &of_mode()),
        FileColumns::new(
            &["thresholds.csv"],
            "A line is a range in which a mode grows, along the parameter of the thresholds, whose name takes the place of `mu` if it is \
             another one.",
            &of_range(MU),
        ),
    ]
}
