//! Inputs and derived quantities as lines of a table.

use super::survey::{InputValues, Survey};
use crate::publish::value::{self, multiple, quantity, rounded, significant};
use crate::publish::{SheetGroup, SheetLine};
use crate::report::JobRow;
use crate::report::columns::{ExportColumn, column};
use crate::study::Parameter;
use serde_json::Value;

/// Up to so many values are listed. Of more, the number, the smallest and the largest are given.
const MAX_LISTED: usize = 4;

/// The groups of inputs: heading, and the beginnings of the pointers of its parameters.
const GROUPS: [(&str, &[&str]); 4] = [
    ("Pin", &["/scene/pin"]),
    ("Disk, contact, clamp and load", &["/scene"]),
    ("Integrator", &["/numerics"]),
    ("Run and detection", &[""]),
];

/// The inputs in groups.
pub(super) fn of_inputs(survey: &Survey, origin: impl Fn(&Parameter) -> &'static str) -> Vec<SheetGroup> {
    let mut groups = GROUPS.map(|(heading, _)| SheetGroup { heading, lines: Vec::new() });
    for input in &survey.inputs {
        let is_in = |(_, starts): &(&str, &[&str])| {
            starts.iter().any(|start| input.parameter.pointer.starts_with(start))
        };
        let group = GROUPS.iter().position(is_in).unwrap_or(GROUPS.len() - 1);
        groups[group].lines.push(line(input, &origin));
    }
    groups.into_iter().filter(|group| !group.lines.is_empty()).collect()
}

fn line(input: &InputValues, origin: impl Fn(&Parameter) -> &'static str) -> SheetLine {
    let parameter = input.parameter;
    SheetLine {
        symbol: parameter.symbol,
        name: parameter.meaning.to_owned(),
        value: values(&input.values, parameter.unit),
        key: parameter.name,
        origin: origin(parameter),
        varies: input.values.len() > 1,
    }
}

/// The values of the input of that name in the jobs, as people write them.
pub(super) fn of(survey: &Survey, name: &str) -> String {
    values(survey.values(name), Parameter::named(name).unit)
}

/// The same with the symbol of the input: `R = 91.4 mm`.
pub(super) fn assignment(survey: &Survey, name: &str) -> String {
    format!("{} = {}", Parameter::named(name).symbol, of(survey, name))
}

/// Values of an input as people write them: `0.5 GPa`, `0.2, 0.4`, `6 values, 0.1 … 0.6`.
fn values(values: &[Value], unit: &str) -> String {
    let numbers: Option<Vec<f64>> = values.iter().map(Value::as_f64).collect();
    let Some(mut numbers) = numbers else {
        let words: Vec<String> = values.iter().map(word).collect();
        return words.join(", ");
    };
    numbers.sort_by(f64::total_cmp);
    let (Some(low), Some(high)) = (numbers.first(), numbers.last()) else { return value::MISSING.to_owned() };
    let (factor, name) = multiple(unit, *high);
    let text = if numbers.len() <= MAX_LISTED {
        let texts: Vec<String> = numbers.iter().map(|x| rounded(x / factor)).collect();
        texts.join(", ")
    } else {
        let ends = [low, high].map(|x| significant(x / factor, 4));
        format!("{} values, {} … {}", numbers.len(), ends[0], ends[1])
    };
    with_unit(&text, name)
}

/// A word for a reader: `inner side` for `inner_side`.
fn word(value: &Value) -> String {
    match value {
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        Value::Null => "not set".to_owned(),
        other => value::text(other).replace('_', " "),
    }
}

fn with_unit(text: &str, unit: &str) -> String {
    if unit.is_empty() { text.to_owned() } else { format!("{text} {unit}") }
}

/// Whether the ends of a range are two values: a difference of rounding is none.
fn differ(low: f64, high: f64) -> bool {
    (high - low).abs() > 1e-9 * high.abs()
}

/// A quantity, or the range of it, as people write it.
pub(super) fn range(low: f64, high: f64, unit: &str) -> String {
    if !differ(low, high) {
        return quantity(high, unit);
    }
    let (factor, name) = multiple(unit, high);
    with_unit(&format!("{} … {}", significant(low / factor, 4), significant(high / factor, 4)), name)
}

/// What the runs found, and its words beside the inputs.
static OF_RUNS: [(&ExportColumn, &str); 3] = [
    (column("time_step_s"), "time step that was used"),
    (column("time_step_limit_s"), "largest stable time step"),
    (column("clamp_width_on_mesh_m"), "width of the clamp on the mesh"),
];

/// The derived quantities: those that follow from the inputs, and those that the runs found.
pub(super) fn of_derived(survey: &Survey, rows: &[JobRow]) -> SheetGroup {
    let line = |symbol, name: &str, [low, high]: [f64; 2], unit: &str| SheetLine {
        symbol,
        name: name.to_owned(),
        value: range(low, high, unit),
        varies: differ(low, high),
        ..SheetLine::default()
    };
    let of_inputs =
        survey.derived.iter().map(|(found, ends)| line(found.symbol, found.name, *ends, found.unit));
    let of_runs = OF_RUNS.iter().filter_map(|(figure, words)| {
        let (low, high) = rows
            .iter()
            .filter(|row| row.record().is_some())
            .filter_map(|row| figure.value(row).as_f64())
            // Modes without a run have no time step.
            .filter(|x| *x > 0.0)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        (low <= high).then(|| line(figure.symbol(), words, [low, high], &figure.column.head.unit))
    });
    SheetGroup { heading: "What follows from them", lines: of_inputs.chain(of_runs).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Protects: a value is written as people write it, a few values are listed, and of many the ends are given.
    #[test]
    fn values_are_written_as_people_write_them() {
        let cases = [
            (json!([5e8]), "Pa", "0.5 GPa"),
            (json!([0.002_666_666_666_666_667]), "m", "2.666666667 mm"),
            (json!([0.4, 0.2]), "", "0.2, 0.4"),
            (json!([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]), "", "6 values, 0.1 … 0.6"),
            (json!([5e8, 1e9, 2e9]), "Pa", "0.5, 1, 2 GPa"),
            (json!(["inner_side", "whole_top"]), "", "inner side, whole top"),
            (json!([true]), "", "yes"),
        ];
        for (list, unit, text) in cases {
            assert_eq!(values(list.as_array().unwrap(), unit), text);
        }
        assert_eq!(
            (range(0.1, 0.1, "m"), range(0.05, 0.5, "m/s")),
            ("100 mm".into(), "50 … 500 mm/s".into())
        );
    }
}
