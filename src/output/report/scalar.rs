//! The numbers of a record that figures and tables can show: the columns of the export that are numbers of a run.

use super::columns::{Digits, ExportColumn, Last, Shown, column, fixed};
use super::row::{JobRow, RowState};
use crate::analysis::Outcome;
use crate::publish::value;
use std::borrow::Cow;
use std::sync::LazyLock;

/// A number that a job's record has, with its name in the export.
#[derive(Debug, Clone, Copy)]
pub struct Scalar {
    /// The name of its column in the export, with the unit at its end.
    pub name: &'static str,
    /// What it is, in words, without the unit.
    pub meaning: &'static str,
    pub(super) column: &'static ExportColumn,
    shown: &'static Shown,
}

/// The macroscopic friction coefficient.
pub static MU_STAR: &Scalar = &Scalar::of("mu_star");
/// The frequency of the limit cycle.
pub static FREQUENCY: &Scalar = &Scalar::of("frequency_hz");

/// All of them: the columns of the export that are numbers of a record.
pub static SCALARS: LazyLock<Vec<Scalar>> = LazyLock::new(|| fixed().filter_map(Scalar::new).collect());

impl PartialEq for Scalar {
    fn eq(&self, other: &Self) -> bool {
        // Names are unique.
        self.name == other.name
    }
}

impl Eq for Scalar {}

impl Scalar {
    /// The number of a column; none if it is no number of a run.
    const fn new(column: &'static ExportColumn) -> Option<Self> {
        let (Cow::Borrowed(name), Cow::Borrowed(meaning)) =
            (&column.column.head.name, &column.column.head.meaning)
        else {
            return None;
        };
        let Some(shown) = &column.shown else { return None };
        let meaning = if shown.title.is_empty() { beginning(meaning) } else { shown.title };
        Some(Self { name, meaning, column, shown })
    }

    /// A number that the program itself names. One that does not exist is an error of the compiler, in a `static`.
    pub(super) const fn of(name: &str) -> Self {
        Self::new(column(name)).expect("a number of a run")
    }

    /// The scalar of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        SCALARS.iter().find(|scalar| scalar.name == name)
    }

    /// Meaning and unit: `frequency [Hz]`.
    pub fn title(&self) -> String {
        let unit = self.unit();
        if unit.is_empty() { self.meaning.to_owned() } else { format!("{} [{unit}]", self.meaning) }
    }

    /// The unit; empty without one.
    pub fn unit(&self) -> &'static str {
        &self.column.column.head.unit
    }

    /// Its symbol; empty without one.
    pub(super) fn symbol(&self) -> &'static str {
        self.shown.symbol
    }

    /// Whether values may have both signs, and a change of the sign matters more than their sizes.
    pub(super) fn is_signed(&self) -> bool {
        self.shown.is_signed
    }

    /// How many digits a reader sees.
    pub(super) fn digits(&self) -> Digits {
        self.shown.digits
    }

    /// What it is called in a sentence: the symbol, or the title.
    pub(super) fn words(&self) -> &str {
        if self.symbol().is_empty() || !self.unit().is_empty() { self.shown.title } else { self.symbol() }
    }

    /// A short name with the unit, for a table with several quantities: the symbol, if there is no unit that it would not say.
    pub(super) fn short_title(&self) -> String {
        let is_enough = !self.symbol().is_empty() && self.unit().is_empty();
        if is_enough { self.symbol().to_owned() } else { self.title() }
    }

    /// An error for a reader. One that is too small to be seen beside the value is no zero.
    pub(super) fn error_text(&self, error: f64) -> String {
        match self.digits().last {
            Last::Place(place) if error > 0.0 && self.text(error) == self.text(0.0) => {
                format!("<{}", self.text(10_f64.powi(place)))
            }
            _ => self.text(error),
        }
    }

    /// A value with its error, if that is known: the error has two digits, and the value the same decimals, but never more than without it,
    /// because a small statistical error says nothing of that of the mesh.
    pub(super) fn text_with_error(&self, x: f64, error: Option<f64>) -> String {
        let Some(error) = error else { return self.text(x) };
        let place = (error.log10().floor() as i32).saturating_sub(1);
        match self.digits().last {
            Last::Place(finest) if error < 1.0 && place >= finest => {
                let decimals = place.unsigned_abs() as usize;
                format!("{} ± {}", value::fixed(x, decimals), value::fixed(error, decimals))
            }
            _ => format!("{} ± {}", self.text(x), self.error_text(error)),
        }
    }

    /// A value or an error for a reader, in the unit of the name.
    pub(super) fn text(&self, x: f64) -> String {
        match self.digits().last {
            Last::Place(place) => value::fixed(x, place.unsigned_abs() as usize),
            Last::Significant(digits) => value::significant(x, digits),
        }
    }

    /// The value in a row, if it has one that is a number.
    pub fn value(&self, row: &JobRow) -> Option<f64> {
        let value = row.has_result().then(|| self.column.value(row).as_f64()).flatten();
        value.filter(|x| x.is_finite())
    }

    /// The error of the value, if it is known: the statistical error of a simulated value, and what a file of measured points
    /// gives.
    pub(super) fn error(&self, row: &JobRow) -> Option<f64> {
        let error = match &row.state {
            RowState::Done(_) => {
                let own = SCALARS.iter().find(|own| own.shown.error_of == self.name);
                own.and_then(|own| own.value(row))
            }
            RowState::Measured(measured) => measured.value(self.name).and_then(|found| found.error),
            _ => None,
        };
        error.filter(|x| x.is_finite()).map(f64::abs)
    }

    /// The error of the value by the mesh, if it is known.
    pub(super) fn mesh_error(&self, row: &JobRow) -> Option<f64> {
        let own = SCALARS.iter().find(|own| own.shown.mesh_error_of == self.name)?;
        row.record().and_then(|_| own.value(row))
    }

    /// Whether the value in a row counts for the range of an axis or of colours. The frequency of a run that is not
    /// periodic is no frequency of a limit cycle, and an instrument does not measure μ\* of sliding that is unstable.
    pub(super) fn is_settled(&self, row: &JobRow) -> bool {
        let has_other = match row.record().map(|record| record.outcome) {
            Some(Outcome::NotPeriodic) => self == FREQUENCY,
            Some(Outcome::Unstable) => self == MU_STAR,
            _ => false,
        };
        !has_other
    }

    /// The value in a row, if it is settled.
    pub(super) fn settled_value(&self, row: &JobRow) -> Option<f64> {
        self.value(row).filter(|_| self.is_settled(row))
    }
}

/// A meaning up to its first comma or semicolon.
const fn beginning(meaning: &'static str) -> &'static str {
    let mut end = 0;
    while end < meaning.len() && !matches!(meaning.as_bytes()[end], b',' | b';') {
        end += 1;
    }
    meaning.split_at(end).0
}
