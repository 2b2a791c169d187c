//! The parameters of jobs and points, and how they are written for a reader.

use crate::publish::table::Head;
use crate::publish::value::{self, short, text};
use crate::units::name_and_unit;
use indexmap::IndexSet;
use serde_json::Value;
use std::borrow::Borrow;

/// The parameter that is the disk speed.
pub(super) const OMEGA: &str = "omega_rpm";
/// The parameter that is the local friction coefficient.
pub(super) const MU: &str = "mu";
/// Where a row comes from: the name of its study or of its file of measured points. It can be chosen like a parameter.
pub(super) const SOURCE: &str = "source";

/// The parameters of a job or of a point, by name. ω and μ are always among them, whether or not a grid has them. A value that is
/// not known, as in a file of measured points, is null.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parameters {
    all: Vec<(String, Value)>,
    /// The number of those before the grid's.
    before_grid: usize,
}

impl Parameters {
    /// Those of a `grid`, in the order of the study, with the speed and the friction coefficient of the job. NaN stands for one that is
    /// not known. The values of the grid hold where it has them.
    pub fn new(omega_rpm: f64, mu: f64, grid: Vec<(String, Value)>) -> Self {
        let is_missing = |name: &str| grid.iter().all(|(own, _)| own != name);
        let own = [(OMEGA, omega_rpm), (MU, mu)].into_iter().filter(|(name, _)| is_missing(name));
        let mut all: Vec<_> = own.map(|(name, value)| (name.to_owned(), value.into())).collect();
        let before_grid = all.len();
        all.extend(grid);
        Self { all, before_grid }
    }

    /// The value of a parameter, if there is one of that name.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.all.iter().find(|(own, _)| own == name).map(|(_, value)| value)
    }

    /// Disk speed ω in revolutions per minute; NaN if it is not known.
    pub fn omega_rpm(&self) -> f64 {
        self.number(OMEGA)
    }

    /// Local friction coefficient μ; NaN if it is not known.
    pub fn mu(&self) -> f64 {
        self.number(MU)
    }

    fn number(&self, name: &str) -> f64 {
        self.get(name).and_then(Value::as_f64).unwrap_or(f64::NAN)
    }

    /// All of them, ω and μ first.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Value)> {
        let leading = [OMEGA, MU].into_iter().filter_map(|name| Some((name, self.get(name)?)));
        let all = self.all.iter().map(|(name, value)| (name.as_str(), value));
        leading.chain(all.filter(|(name, _)| ![OMEGA, MU].contains(name)))
    }

    /// Those of the grid, in the order of the study.
    pub fn of_grid(&self) -> &[(String, Value)] {
        &self.all[self.before_grid..]
    }
}

impl Extend<(String, Value)> for Parameters {
    fn extend<T: IntoIterator<Item = (String, Value)>>(&mut self, more: T) {
        self.all.extend(more);
    }
}

/// The names of all parameters of some jobs or points, each once, in the order in which they first appear. ω and μ come first.
pub fn parameter_names<'a>(of: impl IntoIterator<Item = &'a Parameters>) -> Vec<&'a str> {
    let mut found = IndexSet::from([OMEGA, MU]);
    for parameters in of {
        found.extend(parameters.all.iter().map(|(name, _)| name.as_str()));
    }
    found.into_iter().collect()
}

/// The symbol of a parameter that is written with one.
pub(super) fn symbol(name: &str) -> Option<&'static str> {
    match name {
        OMEGA => Some("ω"),
        MU => Some("μ"),
        _ => None,
    }
}

/// The head of a column of a parameter.
pub(super) fn head(name: &str) -> Head {
    let meaning = match name {
        OMEGA => "rotation speed ω of the disk",
        MU => "local friction coefficient μ",
        SOURCE => "study or file",
        _ => "the grid parameter of that name",
    };
    Head::new(name.to_owned(), name_and_unit(name).1, meaning)
}

/// `name = value` as people write it: `clamp_width = 2.5 mm`, with the symbol in place of the name if there is one.
pub fn assignment(name: &str, value: &Value) -> String {
    match (name, symbol(name)) {
        (_, Some(symbol)) => format!("{symbol} = {}", in_words(name, value)),
        _ if value.is_null() => format!("{name} not set"),
        (SOURCE, _) => in_words(name, value),
        _ => format!("{} = {}", name_and_unit(name).0, in_words(name, value)),
    }
}

/// The value of a parameter with its unit, as people write it.
pub(super) fn in_words(name: &str, value: &Value) -> String {
    let unit = name_and_unit(name).1;
    match value.as_f64() {
        Some(_) if value.is_u64() && unit.is_empty() => text(value),
        Some(x) => {
            let (factor, unit) = value::multiple(unit, x);
            with_unit(short(x / factor), unit)
        }
        None if value.is_null() => value::MISSING.to_owned(),
        None => text(value),
    }
}

/// `name = first … last`, with the unit once if it is the same.
pub(super) fn range(name: &str, first: &Value, last: &Value) -> String {
    let (from, to) = (assignment(name, first), in_words(name, last));
    let shared = to.split_once(' ').and_then(|(_, unit)| from.strip_suffix(unit));
    format!("{} … {to}", shared.unwrap_or(&from).trim_end())
}

/// A number with its unit, if it has one.
pub(super) fn with_unit(number: String, unit: &str) -> String {
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// Several parameters in words.
pub(super) fn assignments<'a, V: Borrow<Value>>(
    parameters: impl IntoIterator<Item = (&'a str, V)>,
) -> String {
    let words = parameters.into_iter().map(|(name, value)| assignment(name, value.borrow()));
    words.collect::<Vec<_>>().join(", ")
}
