//! How the parameters of a study are laid out: one along the rows, μ over the columns, the others apart.

use super::export::further_names;
use super::row::{MU, OMEGA, Row};
use super::value;
use serde_json::Value;
use std::collections::HashSet;

/// A study laid out in two dimensions, once per combination of its further parameters.
pub(super) struct Layout<'a> {
    /// The parameter along the rows of a table and the abscissa of a figure: ω wherever it varies.
    pub axis: &'a str,
    /// The further parameters that vary.
    pub further: Vec<&'a str>,
    /// The parameters that are the same in every job.
    pub constants: Vec<(&'a str, Value)>,
    /// All friction coefficients, ascending.
    pub mus: Vec<f64>,
    /// One group per combination of `further`, in the order of the study.
    pub groups: Vec<Group<'a>>,
}

/// The jobs with one combination of the further parameters.
pub(super) struct Group<'a> {
    /// The combination, in the order of [`Layout::further`].
    pub key: Vec<(&'a str, Value)>,
    /// Its jobs.
    pub rows: Vec<&'a Row>,
    /// The values along the axis: ascending if they are numbers, otherwise in the order of the study.
    pub axis_values: Vec<Value>,
}

impl<'a> Layout<'a> {
    pub fn new(rows: &'a [Row]) -> Self {
        let varies = |name: &str| {
            rows.iter().map(|row| value::text(&row.parameter(name))).collect::<HashSet<_>>().len() > 1
        };
        let (mut further, constant): (Vec<&str>, Vec<&str>) =
            further_names(rows).into_iter().partition(|name| varies(name));
        let axis = if varies(OMEGA) || further.is_empty() { OMEGA } else { further.remove(0) };
        let fixed_speed = (axis != OMEGA && !rows.is_empty()).then_some(OMEGA);
        let constants =
            fixed_speed.into_iter().chain(constant).map(|name| (name, rows[0].parameter(name))).collect();
        let mut mus: Vec<f64> = rows.iter().map(|row| row.mu).collect();
        mus.sort_by(f64::total_cmp);
        mus.dedup();
        let groups = groups(rows, axis, &further);
        Self { axis, further, constants, mus, groups }
    }

    /// The axis as a label, with its unit.
    pub fn axis_label(&self) -> &'a str {
        if self.axis == OMEGA { "ω [rpm]" } else { self.axis }
    }
}

impl Group<'_> {
    /// The combination in words; empty if there are no further parameters.
    pub fn caption(&self) -> String {
        self.key.iter().map(|(name, value)| value::assignment(name, value)).collect::<Vec<_>>().join(", ")
    }
}

fn groups<'a>(rows: &'a [Row], axis: &str, further: &[&'a str]) -> Vec<Group<'a>> {
    let mut groups: Vec<Group<'a>> = Vec::new();
    for row in rows {
        let key: Vec<_> = further.iter().map(|&name| (name, row.parameter(name))).collect();
        // The last group first: a study's jobs come mostly in runs of one combination.
        match groups.iter_mut().rev().find(|group| same(&group.key, &key)) {
            Some(group) => group.rows.push(row),
            None => groups.push(Group { key, rows: vec![row], axis_values: Vec::new() }),
        }
    }
    if groups.is_empty() {
        // A study without jobs still has tables and figures to look at: empty ones.
        groups.push(Group { key: Vec::new(), rows: Vec::new(), axis_values: Vec::new() });
    }
    for group in &mut groups {
        group.axis_values = distinct_sorted(group.rows.iter().map(|row| row.parameter(axis)));
    }
    groups
}

/// Equality of what is shown: 1 and 1.0 are the same value.
fn same(a: &[(&str, Value)], b: &[(&str, Value)]) -> bool {
    a.iter().zip(b).all(|((_, a), (_, b))| value::text(a) == value::text(b))
}

fn distinct_sorted(values: impl Iterator<Item = Value>) -> Vec<Value> {
    let mut seen = HashSet::new();
    let mut distinct: Vec<Value> = values.filter(|value| seen.insert(value::text(value))).collect();
    if distinct.iter().all(Value::is_number) {
        let key = |value: &Value| value.as_f64().unwrap_or_default();
        distinct.sort_by(|a, b| key(a).total_cmp(&key(b)));
    }
    distinct
}

/// All parameters of a job in words, ω and μ first.
pub(super) fn parameters_in_words(row: &Row) -> String {
    [(OMEGA, row.parameter(OMEGA)), (MU, row.parameter(MU))]
        .into_iter()
        .chain(row.further().map(|(name, value)| (name, value.clone())))
        .map(|(name, value)| value::assignment(name, &value))
        .collect::<Vec<_>>()
        .join(", ")
}
