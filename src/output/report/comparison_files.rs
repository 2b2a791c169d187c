//! The differences between several sources as files.

use super::comparison::{Comparison, Contradiction, Difference};
use super::parameters;
use crate::publish::table::{Column, FileColumns, Table};
use serde_json::Value;

/// A line of the differences: a point at which one of two squeals, or a quantity of a point.
#[derive(Clone, Copy)]
enum Found<'a> {
    Contradiction(&'a Contradiction),
    Difference(&'a Difference),
}

#[derive(Clone, Copy)]
struct Line<'a> {
    reference: &'a str,
    found: Found<'a>,
}

impl Line<'_> {
    fn source(&self) -> &str {
        match self.found {
            Found::Contradiction(own) => &own.source,
            Found::Difference(own) => &own.source,
        }
    }

    fn parameters(&self) -> &[Value] {
        match self.found {
            Found::Contradiction(own) => &own.parameters,
            Found::Difference(own) => &own.parameters,
        }
    }

    fn is_interpolated(&self) -> bool {
        match self.found {
            Found::Contradiction(own) => own.is_between,
            Found::Difference(own) => own.interpolated,
        }
    }

    /// How far the simulation is above a measured value, or one study above the other.
    fn difference(&self) -> Value {
        match self.found {
            Found::Contradiction(own) => Value::from(if own.squeals == own.is_measured { -1.0 } else { 1.0 }),
            Found::Difference(own) => own.difference().into(),
        }
    }

    /// A number: 1 or 0 for whether it squeals.
    fn of(&self, squeals: impl Fn(bool) -> Option<f64>, number: fn(&Difference) -> Option<f64>) -> Value {
        match self.found {
            Found::Contradiction(own) => squeals(own.squeals).into(),
            Found::Difference(own) => number(own).into(),
        }
    }
}

fn as_number(is_true: bool) -> f64 {
    f64::from(u8::from(is_true))
}

#[rustfmt::skip]
fn names<'a>() -> [Column<Line<'a>>; 3] {
    [
        Column::new("source", "", "study or file of the point", |of| of.source().into()),
        Column::new("reference", "", "study with which it is compared", |of| of.reference.into()),
        Column::new("quantity", "", "column that is compared; squeals in the first lines, where only one of the two squeals (1)", |of| match of.found {
            Found::Contradiction(_) => "squeals".into(),
            Found::Difference(own) => own.scalar.name.into(),
        }),
    ]
}

#[rustfmt::skip]
fn results<'a>() -> [Column<Line<'a>>; 8] {
    [
        Column::new("value", "that of the quantity", "its value", |of| of.of(|own| Some(as_number(own)), |own| Some(own.value))),
        Column::new("error", "that of the quantity", "its error", |of| of.of(|_| None, |own| own.error)),
        Column::new("reference_value", "that of the quantity", "the value of the reference at the same parameters", |of| of.of(|own| Some(as_number(!own)), |own| Some(own.reference))),
        Column::new("reference_error", "that of the quantity", "its error", |of| of.of(|_| None, |own| own.reference_error)),
        Column::new("difference", "that of the quantity", "value of the reference minus a measured value; of another study, its value minus that of the reference", Line::difference),
        Column::new("combined_error", "that of the quantity", "root of the sum of the squares of both errors", |of| of.of(|_| None, Difference::combined_error)),
        Column::new("relative_difference", "", "difference over what is subtracted", |of| of.of(|_| None, Difference::deviation)),
        Column::new("interpolated", "", "whether the value of the reference was interpolated: yes or no", |of| if of.is_interpolated() { "yes" } else { "no" }.into()),
    ]
}

/// Contradictions about squeal (1: it squeals) and then all differences, one line each, with numbers in full and in the units of their names.
pub(super) fn table(comparison: &Comparison) -> Table {
    let of_parameter = |(index, name): (usize, &String)| {
        Column::made(parameters::head(name), move |of: &Line| of.parameters().get(index).cloned().into())
    };
    let parameters = comparison.names.iter().enumerate().map(of_parameter);
    let columns: Vec<Column<Line>> = names().into_iter().chain(parameters).chain(results()).collect();
    let contradictions = comparison.contradictions.iter().map(Found::Contradiction);
    let all = contradictions.chain(comparison.differences.iter().map(Found::Difference));
    let lines: Vec<Line> = all.map(|found| Line { reference: &comparison.reference, found }).collect();
    Table::of("differences", &columns, &lines)
}

/// The columns, for the page of columns.
pub(super) fn described() -> FileColumns {
    let lines = "A line is a point of a source that is compared with the first source.";
    FileColumns::new(&["differences.csv"], lines, names().iter().chain(&results()))
}
