//! How tables and figures lay out the parameters of a study: one parameter along the rows, μ over the columns, and a
//! table or figure for each combination of the others.

use super::export::further_names;
use super::parameters::{MU, OMEGA, assignments};
use super::row::JobRow;
use crate::publish::value;
use serde_json::Value;
use std::collections::HashMap;

/// A study laid out in two dimensions, once per combination of its further parameters.
pub(super) struct Layout<'a> {
    /// The parameter along the rows of a table and the abscissa of a figure: ω if it varies, or if nothing else does.
    pub axis: &'a str,
    /// The other parameters that vary, without μ.
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
    pub jobs: Vec<PlacedJob<'a>>,
    /// The values along the axis: ascending if they are numbers, otherwise in the order of the study.
    pub axis_values: Vec<Value>,
}

/// A job with its position in the layout.
pub(super) struct PlacedJob<'a> {
    pub row: &'a JobRow,
    /// Index of its value in [`Group::axis_values`].
    pub axis_index: usize,
    /// Index of its friction coefficient in [`Layout::mus`].
    pub mu_index: usize,
}

impl<'a> Layout<'a> {
    /// Lays out a study. This compares the values of all jobs as text, which is slow: a report shares one layout between
    /// all its tables and figures.
    pub fn new(rows: &'a [JobRow]) -> Self {
        let varies = |name: &str| {
            let mut texts = rows.iter().map(|row| value::text(&row.parameter(name)));
            let first = texts.next();
            texts.any(|text| Some(text) != first)
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
        let groups = groups(rows, axis, &further, &mus);
        Self { axis, further, constants, mus, groups }
    }

    /// What is the same in all jobs, in words; may be empty.
    pub fn constants_in_words(&self) -> String {
        assignments(self.constants.iter().cloned())
    }

    /// Name and unit of the axis.
    pub fn axis_name(&self) -> &'a str {
        if self.axis == OMEGA { "disk speed ω [rpm]" } else { self.axis }
    }

    /// Symbol and unit of the axis.
    pub fn axis_label(&self) -> &'a str {
        if self.axis == OMEGA { "ω [rpm]" } else { self.axis }
    }
}

/// Figures with more jobs have no tooltips, because the files would become too large.
pub(super) const MAX_TOOLTIPS: usize = 2_000;

impl Group<'_> {
    /// Whether figures have a tooltip for each job.
    pub fn has_tooltips(&self) -> bool {
        self.jobs.len() <= MAX_TOOLTIPS
    }

    /// The combination in words; empty if there are no further parameters.
    pub fn caption(&self) -> String {
        assignments(self.key.iter().cloned())
    }

    fn sort_axis(&mut self) {
        let rank = value::sort_numbers(&mut self.axis_values);
        for job in &mut self.jobs {
            job.axis_index = rank[job.axis_index];
        }
    }
}

fn groups<'a>(rows: &'a [JobRow], axis: &str, further: &[&'a str], mus: &[f64]) -> Vec<Group<'a>> {
    let mut groups: Vec<Group<'a>> = Vec::new();
    // Values are compared as they are shown: 1 and 1.0 are equal.
    let mut known: HashMap<Vec<String>, usize> = HashMap::new();
    let mut axis_indices: Vec<HashMap<String, usize>> = Vec::new();
    for row in rows {
        let key: Vec<_> = further.iter().map(|&name| (name, row.parameter(name))).collect();
        let texts = key.iter().map(|(_, value)| value::text(value)).collect();
        let number = *known.entry(texts).or_insert(groups.len());
        if number == groups.len() {
            groups.push(Group { key, jobs: Vec::new(), axis_values: Vec::new() });
            axis_indices.push(HashMap::new());
        }
        let (group, indices) = (&mut groups[number], &mut axis_indices[number]);
        let value = row.parameter(axis);
        let axis_index = *indices.entry(value::text(&value)).or_insert(group.axis_values.len());
        if axis_index == group.axis_values.len() {
            group.axis_values.push(value);
        }
        let mu_index = mus.partition_point(|&mu| mu < row.mu);
        group.jobs.push(PlacedJob { row, axis_index, mu_index });
    }
    if groups.is_empty() {
        // A study without jobs has empty tables and figures.
        groups.push(Group { key: Vec::new(), jobs: Vec::new(), axis_values: Vec::new() });
    }
    groups.iter_mut().for_each(Group::sort_axis);
    groups
}

/// All parameters of a job in words, ω and μ first.
pub(super) fn parameters_in_words(row: &JobRow) -> String {
    let further = row.further().map(|(name, value)| (name, value.clone()));
    assignments([OMEGA, MU].map(|name| (name, row.parameter(name))).into_iter().chain(further))
}
