//! The numbers of a record that figures and tables can show.

use super::columns::{self, ExportColumn};
use super::parameters::name_and_unit;
use super::row::{JobRow, RowState};
use crate::analysis::Outcome;
use crate::publish::value;
use std::sync::LazyLock;

/// A number that a job's record has, with its name in the export.
#[derive(Debug)]
pub struct Scalar {
    /// The name of its column in the export, with the unit at its end.
    pub name: &'static str,
    /// What it is, in words, without the unit.
    pub meaning: &'static str,
    column: &'static ExportColumn,
}

/// The macroscopic friction coefficient.
pub(super) static MU_STAR: LazyLock<&Scalar> = LazyLock::new(|| known("mu_star"));
/// The frequency of the limit cycle.
pub(super) static FREQUENCY: LazyLock<&Scalar> = LazyLock::new(|| known("frequency_hz"));

/// Titles of axes, for columns whose meaning is too long for that.
#[rustfmt::skip]
const TITLES: [(&str, &str); 28] = [
    ("mu_star", "macroscopic friction coefficient μ*"),
    ("frequency_hz", "frequency"),
    ("mu_star_contact", "μ* from the contact forces"),
    ("stick_share", "share of stick"),
    ("slip_share", "share of slip"),
    ("separated_share", "share of separation"),
    ("n_over_f_min", "smallest normal force N/F"),
    ("n_over_f_max", "largest normal force N/F"),
    ("sigma_n_max_pa", "largest normal contact stress"),
    ("slip_speed_max_m_s", "largest slip speed"),
    ("lift_max_m", "largest gap"),
    ("growth_rate_per_s", "growth rate"),
    ("mu_reduction_stick", "reduction of μ* by stick"),
    ("mu_reduction_slip", "reduction of μ* by sideways slip"),
    ("contact_loss_share", "contact loss over the work of the drive"),
    ("cycles", "limit cycles in the window"),
    ("crossings_per_cycle", "section crossings per limit cycle"),
    ("simulated_s", "simulated time"),
    ("steps", "time steps"),
    ("time_step_s", "time step"),
    ("energy_residual", "residual of the energy balance"),
    ("identity_residual", "residual of the identities"),
    ("energy_kinetic_j", "kinetic energy at the end"),
    ("energy_elastic_j", "elastic energy at the end"),
    ("energy_drive_work_j", "work of the drive"),
    ("energy_friction_j", "energy dissipated by friction"),
    ("energy_damping_j", "energy dissipated by damping"),
    ("energy_contact_loss_j", "energy lost in contact impacts"),
];

/// Whether a column has the numbers of runs: neither text, nor what only some runs that are not periodic have.
fn is_scalar(column: &ExportColumn) -> bool {
    let name = &*column.column.head.name;
    let is_text = matches!(name, "regime" | "decided_by" | "start_outcome");
    column.group != columns::Group::Job && !is_text && !name.starts_with("obstacle")
}

/// All of them: the columns of the export that are numbers of a record.
pub static SCALARS: LazyLock<Vec<Scalar>> = LazyLock::new(|| {
    let numbers = columns::PLAIN.iter().chain(&columns::FURTHER).filter(|column| is_scalar(column));
    let scalar = |column: &'static ExportColumn| {
        let head = &column.column.head;
        let title = TITLES.iter().find(|(name, _)| *name == head.name).map(|(_, title)| *title);
        let meaning = head.meaning.split([',', ';']).next().unwrap_or_default();
        Scalar { name: &head.name, meaning: title.unwrap_or(meaning), column }
    };
    numbers.map(scalar).collect()
});

/// A scalar that the program itself names.
fn known(name: &str) -> &'static Scalar {
    Scalar::find(name).expect("the export has this column")
}

impl PartialEq for Scalar {
    fn eq(&self, other: &Self) -> bool {
        // Names are unique.
        self.name == other.name
    }
}

impl Eq for Scalar {}

impl Scalar {
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
        name_and_unit(self.name).1
    }

    /// A short name with the unit, for a table with several quantities.
    pub(super) fn short_title(&self) -> String {
        if self == *MU_STAR { "μ*".to_owned() } else { self.title() }
    }

    /// An error for a reader. One that is too small to be seen beside the value is no zero.
    pub(super) fn error_text(&self, error: f64) -> String {
        let text = self.text(error);
        match self.name {
            "mu_star" if error > 0.0 && text == "0.0000" => "<0.0001".to_owned(),
            "frequency_hz" if error > 0.0 && text == "0" => "<1".to_owned(),
            _ => text,
        }
    }

    /// A value with its error, if that is known: the error has two digits, and the value the same decimals, but never more than without it,
    /// because a small statistical error says nothing of that of the mesh.
    pub(super) fn text_with_error(&self, x: f64, error: Option<f64>) -> String {
        match error {
            Some(error) if self == *MU_STAR && (1e-3..1.0).contains(&error) => {
                let decimals = (1.0 - error.log10().floor()) as usize;
                format!("{} ± {}", value::fixed(x, decimals), value::fixed(error, decimals))
            }
            Some(error) => format!("{} ± {}", self.text(x), self.error_text(error)),
            None => self.text(x),
        }
    }

    /// A value or an error for a reader, in the unit of the name.
    pub(super) fn text(&self, x: f64) -> String {
        match self.name {
            "mu_star" => value::fixed(x, 4),
            "frequency_hz" => value::fixed(x, 0),
            _ => value::significant(x, 4),
        }
    }

    /// The value in a row, if it has one that is a number.
    pub fn value(&self, row: &JobRow) -> Option<f64> {
        let value = row.has_result().then(|| self.column.value(row).as_f64()).flatten();
        value.filter(|x| x.is_finite())
    }

    /// The error of the value, if it is known: the standard error of a simulated μ\*, and what a file of measured points
    /// gives.
    pub(super) fn error(&self, row: &JobRow) -> Option<f64> {
        let error = match &row.state {
            RowState::Done(record) => (self == *MU_STAR).then_some(record.mu_star_se),
            RowState::Measured(measured) => measured.value(self.name).and_then(|found| found.error),
            _ => None,
        };
        error.filter(|x| x.is_finite()).map(f64::abs)
    }

    /// Whether the value in a row counts for the range of an axis or of colours. The frequency of a run that is not
    /// periodic is no frequency of a limit cycle.
    pub(super) fn is_settled(&self, row: &JobRow) -> bool {
        self != *FREQUENCY || row.record().is_none_or(|record| record.outcome != Outcome::NotPeriodic)
    }
}
