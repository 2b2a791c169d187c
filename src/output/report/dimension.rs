//! How the values of one parameter are written and drawn: its unit, the labels of its values, its axis.

use super::parameters::{self, MU, OMEGA, SOURCE, symbol, with_unit};
use super::row::JobRow;
use crate::publish::chart::Axis;
use crate::publish::value;
use crate::units::name_and_unit;
use serde_json::Value;
use std::collections::HashMap;

/// A parameter of a layout. Its numbers are written in one unit, which fits the median of their sizes.
#[derive(Clone)]
pub(super) struct Dimension {
    name: String,
    /// Name and unit, for an axis: `disk speed ω [rpm]`.
    pub title: String,
    /// Symbol or short name, and unit, for the head of a table: `ω [rpm]`.
    pub label: String,
    /// The different values: ascending if they are numbers, otherwise in the order of the rows.
    values: Vec<Value>,
    factor: f64,
    unit: &'static str,
    /// The labels of the values by their text.
    labels: HashMap<String, String>,
    /// Whether the axis is logarithmic, if that is known.
    is_log: Option<bool>,
}

impl Dimension {
    /// The parameter `name` of these rows. Its description, if there is one, is a phrase without a unit.
    pub fn new(name: &str, description: Option<&str>, is_log: Option<bool>, rows: &[&JobRow]) -> Self {
        let mut values: Vec<Value> = Vec::new();
        let mut labels: HashMap<String, String> = HashMap::new();
        for row in rows {
            let value = row.parameter(name);
            if !value.is_null() && !labels.contains_key(&value::text(&value)) {
                labels.insert(value::text(&value), String::new());
                values.push(value);
            }
        }
        value::sort_numbers(&mut values);
        let numbers: Vec<f64> = values.iter().filter_map(Value::as_f64).collect();
        let (short_name, base) = name_and_unit(name);
        let (factor, unit) = value::multiple(base, median_size(&numbers));
        let scaled: Vec<f64> = numbers.iter().map(|x| x / factor).collect();
        let mut texts = value::labels(&scaled).into_iter();
        for value in &values {
            let label = if value.is_number() { texts.next() } else { None };
            labels.insert(value::text(value), label.unwrap_or_else(|| value::text(value)));
        }
        let title = match name {
            OMEGA => "disk speed ω",
            MU => "local friction coefficient μ",
            _ => description.unwrap_or(short_name),
        };
        let bracketed = |words: &str| {
            if unit.is_empty() { words.to_owned() } else { format!("{words} [{unit}]") }
        };
        let (title, label) = (bracketed(title), bracketed(symbol(name).unwrap_or(short_name)));
        Self { name: name.to_owned(), title, label, values, factor, unit, labels, is_log }
    }

    /// A value in the unit of [`Dimension::label`], without the unit.
    pub fn text(&self, value: &Value) -> String {
        self.labels.get(&value::text(value)).cloned().unwrap_or_else(|| value::rounded_text(value))
    }

    /// `name = value` with the unit.
    pub fn assignment(&self, value: &Value) -> String {
        match self.name.as_str() {
            _ if value.is_null() => parameters::assignment(&self.name, value),
            SOURCE => self.text(value),
            _ => format!("{} = {}", self.symbol(), self.with_unit(value)),
        }
    }

    /// A number in the unit of the axis.
    pub fn scaled(&self, x: f64) -> f64 {
        x / self.factor
    }

    /// The symbol or short name without the unit.
    pub fn symbol(&self) -> &str {
        self.label.split(" [").next().unwrap_or_default()
    }

    /// `name = number` with the unit, for a number that no row need have.
    pub fn near(&self, x: f64) -> String {
        format!("{} = {}", self.symbol(), with_unit(value::significant(self.scaled(x), 4), self.unit))
    }

    fn with_unit(&self, value: &Value) -> String {
        if value.is_number() { with_unit(self.text(value), self.unit) } else { self.text(value) }
    }

    /// The axis of a figure: names if some values are not numbers. `logarithmic` says what an axis is of whose values nothing is
    /// known but themselves.
    pub fn axis(&self, logarithmic: bool) -> Axis {
        let scaled =
            |value: &Value| value.as_f64().map_or_else(|| value.clone(), |x| (x / self.factor).into());
        let values: Vec<Value> = self.values.iter().map(scaled).collect();
        Axis::for_values(&values, self.is_log.or(logarithmic.then_some(true)))
    }

    /// The position of a value on the axis; none if it is not on it.
    pub fn position(&self, axis: &Axis, value: &Value) -> Option<f64> {
        match axis {
            Axis::Names(_) => {
                self.values.iter().position(|own| value::text(own) == value::text(value)).map(|i| i as f64)
            }
            _ => value.as_f64().map(|x| x / self.factor),
        }
    }
}

/// The median of the sizes of these numbers that are not zero; 0 if there are none.
fn median_size(numbers: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = numbers.iter().map(|x| x.abs()).filter(|x| *x > 0.0).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied().unwrap_or(0.0)
}
