//! Modes and thresholds as tables for people and for programs.

use super::along::Along;
use super::analysis::{Analysis, MOVES, rows};
use super::ranges::{Onset, Speed};
use crate::publish::value::{self, MISSING};
use crate::report::export::{add_further_names, io_error};
use crate::report::parameters::{self, MU, OMEGA, is_further};
use crate::report::stability_point::StabilityPoint;
use crate::report::view::View;
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;
use std::io::{self, Write};

/// A table with named columns.
#[derive(Debug, Clone, PartialEq)]
pub struct StabilityTable {
    /// The names of the columns.
    pub columns: Vec<String>,
    /// Its lines, with a value for each column.
    pub lines: Vec<Vec<Value>>,
}

/// Significant digits of numbers in a text.
const DIGITS: usize = 6;

/// The columns of a mode, after those of its point.
const OF_MODE: [&str; 10] = [
    "mode",
    "frequency_hz",
    "growth_rate_1_s",
    "damping_ratio",
    "residual",
    "converged",
    "contact_nodes",
    "lifted_nodes",
    "band_hz",
    "above_band",
];

/// The leading `modes` modes at each point: a line for each of them.
pub fn modes_table<'a>(points: impl IntoIterator<Item = &'a StabilityPoint>, modes: usize) -> StabilityTable {
    let points: Vec<&StabilityPoint> = points.into_iter().collect();
    let mut further: Vec<&str> = Vec::new();
    for point in &points {
        add_further_names(&mut further, &point.parameters);
    }
    let names = || [OMEGA, MU].into_iter().chain(further.iter().copied());
    let mut lines = Vec::new();
    for point in points {
        let stability = &point.stability;
        let place: Vec<Value> = names().map(|name| point.parameter(name)).collect();
        for (index, mode) in stability.modes.iter().take(modes).enumerate() {
            let own: [Value; OF_MODE.len()] = [
                (index + 1).into(),
                mode.frequency_hz.into(),
                mode.growth_rate_per_s.into(),
                mode.damping_ratio.into(),
                mode.residual.into(),
                mode.is_converged.into(),
                stability.contact_nodes.into(),
                stability.lifted_nodes.into(),
                stability.band_hz.into(),
                stability.above_band.name().into(),
            ];
            lines.push(place.iter().cloned().chain(own).collect());
        }
    }
    StabilityTable { columns: names().chain(OF_MODE).map(str::to_owned).collect(), lines }
}

/// A line for each range in which a mode grows, and one for a series in which none does.
pub(in crate::report) fn onsets_table(analysis: &Analysis) -> StabilityTable {
    let of_onset = |onset: &Onset| -> [Value; 8] {
        let ends = onset.ends;
        [
            onset.below.map(|_| onset.mu).into(),
            onset.below.into(),
            onset.above.into(),
            ends.map(|ends| ends.at).into(),
            ends.map(|ends| ends.below).into(),
            ends.map(|ends| ends.above).into(),
            onset.frequency_hz.into(),
            onset.is_converged.into(),
        ]
    };
    let of_speed = |speed: &Speed| -> Vec<[Value; 8]> {
        if speed.onsets.is_empty() && speed.mus[1].is_finite() {
            let mut line = [const { Value::Null }; 8];
            line[1] = speed.mus[1].into();
            return vec![line];
        }
        speed.onsets.iter().map(of_onset).collect()
    };
    let mut lines = Vec::new();
    for_each_speed(analysis, |place, speed| {
        let known: [Value; 2] = [speed.known.band_hz.into(), speed.known.above.name().into()];
        let line = |own| place.iter().cloned().chain(own).chain(known.clone()).collect();
        lines.extend(of_speed(speed).into_iter().map(line));
    });
    let name = &analysis.along.parameter;
    let own = ["c", "below", "above", "end", "end_below", "end_above"].map(|end| format!("{name}_{end}"));
    let further = ["frequency_hz", "converged", "band_hz", "above_band"].map(str::to_owned);
    StabilityTable { columns: columns(analysis, own.into_iter().chain(further)), lines }
}

/// Where sliding is unstable in each series, in words: the first place at which it becomes so (`0.3142`, `≤ 0.1` if it is unstable at
/// the smallest one already, `> 0.6` if no mode grows), and the ranges in which it is. The lines after it say what the table does not.
pub fn thresholds_table(points: &[StabilityPoint], along: &Along) -> (StabilityTable, Vec<String>) {
    let rows = rows(points, along);
    let analysis = Analysis::of(points, &rows, along, &View::DEFAULT);
    let mut lines = Vec::new();
    let names = [along.across()].into_iter().chain(analysis.layout.further.iter().copied());
    let names: Vec<&str> = names.collect();
    // ω and μ are plain numbers everywhere.
    let in_words = |(name, cell): (&&str, Value)| match cell {
        Value::Null if along.moves(name) => MOVES.into(),
        cell if is_further(name) && cell.is_f64() => parameters::in_words(name, &cell).into(),
        cell => cell,
    };
    for_each_speed(&analysis, |place, speed| {
        let words = analysis.words(speed).map(Value::from);
        lines.push(names.iter().zip(place).map(in_words).chain(words).collect());
    });
    let own = [along.threshold()].into_iter().chain(["unstable", "frequency", "note"].map(str::to_owned));
    let notes = analysis.along_in_words().into_iter().chain(analysis.above_band()).collect();
    (StabilityTable { columns: columns(&analysis, own), lines }, notes)
}

/// Calls `visit` with the parameters of each speed and its modes.
fn for_each_speed(analysis: &Analysis, mut visit: impl FnMut(Vec<Value>, &Speed)) {
    for (group, modes) in analysis.layout.groups.iter().zip(&analysis.groups) {
        for speed in &modes.speeds {
            let values = [&speed.omega].into_iter().chain(group.key.iter().map(|(_, value)| value));
            visit(values.cloned().collect(), speed);
        }
    }
}

fn columns(analysis: &Analysis, own: impl IntoIterator<Item = String>) -> Vec<String> {
    let names = [analysis.along.across()].into_iter().chain(analysis.layout.further.iter().copied());
    names.map(str::to_owned).chain(own).collect()
}

impl StabilityTable {
    /// Writes CSV with a header. A cell without a value is empty.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut writer = ::csv::Writer::from_writer(out);
        writer.write_record(&self.columns).map_err(io_error)?;
        for line in &self.lines {
            let cells =
                line.iter().map(|cell| if cell.is_null() { String::new() } else { value::text(cell) });
            writer.write_record(cells).map_err(io_error)?;
        }
        writer.flush()
    }

    /// Writes a JSON object per line.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_json_lines(&self, out: &mut dyn Write) -> io::Result<()> {
        for line in &self.lines {
            serde_json::to_writer(&mut *out, &Object(&self.columns, line))?;
            out.write_all(b"\n")?;
        }
        Ok(())
    }

    /// The table as text, with the cells at the right of their columns.
    pub fn as_text(&self) -> String {
        let cells = |line: &Vec<Value>| line.iter().map(in_words).collect::<Vec<_>>();
        let lines: Vec<Vec<String>> =
            std::iter::once(self.columns.clone()).chain(self.lines.iter().map(cells)).collect();
        let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max();
        let widths: Vec<usize> =
            (0..self.columns.len()).map(|column| width(column).unwrap_or_default()).collect();
        let text = |line: &Vec<String>| {
            let padded: Vec<String> =
                line.iter().zip(&widths).map(|(cell, &width)| format!("{cell:>width$}")).collect();
            padded.join("  ") + "\n"
        };
        lines.iter().map(text).collect()
    }
}

fn in_words(cell: &Value) -> String {
    match cell {
        Value::Null => MISSING.to_owned(),
        Value::Bool(is_true) => if *is_true { "yes" } else { "no" }.to_owned(),
        Value::Number(number) if number.is_f64() => {
            number.as_f64().map_or_else(|| MISSING.to_owned(), |x| value::significant(x, DIGITS))
        }
        cell => value::text(cell),
    }
}

/// A line as an object whose fields have the order of the columns.
struct Object<'a>(&'a [String], &'a [Value]);

impl Serialize for Object<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in self.0.iter().zip(self.1) {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}
