//! The columns of files of measured points: what the names in a header mean.

use super::header::suggestion;
use crate::report::columns::ExportColumn;
use crate::report::{SCALARS, Scalar};
use crate::study::{PARAMETERS, Parameter};
use crate::units::name_and_unit;
use csv::StringRecord;
use std::collections::HashSet;

/// What a column has.
pub(super) enum Column {
    Parameter(&'static Parameter),
    Result(&'static Scalar),
    Error(&'static Scalar),
    /// The error of a threshold along a parameter.
    ParameterError(&'static Parameter),
    Squeals,
    Status,
    Ignored,
    /// A column of the file's author, which is ignored and named.
    Unknown,
}

/// Why a header cannot be used.
pub(super) struct WrongColumn {
    /// The column's name, if one column is wrong.
    pub column: Option<String>,
    /// What is wrong, and what is expected.
    pub message: String,
}

/// Columns that are not read: names and states, as an export has them, and remarks.
const IGNORED: [&str; 7] = ["study", "job", "regime", "error", "wall_s", "note", "comment"];

/// The column that says whether a point squeals, and that of an export, whose outcomes say it.
pub(super) const SQUEALS: &str = "squeals";
const STATUS: &str = "status";

/// The column with the error of another one: `mu_star_error`, `frequency_error_hz`.
fn error_column(name: &str) -> String {
    let (stem, _) = name_and_unit(name);
    format!("{stem}_error{}", &name[stem.len()..])
}

/// The result whose error an export calls so: `mu_star_se`.
fn exported_error(name: &str) -> Option<&'static Scalar> {
    Scalar::find(ExportColumn::find(name)?.error_of()?)
}

/// All names that a column can have.
fn known_names() -> Vec<String> {
    let parameters = PARAMETERS.iter().map(|parameter| parameter.name.to_owned());
    let own = IGNORED.iter().chain(&[SQUEALS, STATUS]).map(|name| (*name).to_owned());
    let thresholds = PARAMETERS.iter().filter(|own| own.is_number()).map(|own| error_column(own.name));
    let results = SCALARS.iter().flat_map(|scalar| [scalar.name.to_owned(), error_column(scalar.name)]);
    parameters.chain(results).chain(thresholds).chain(own).collect()
}

/// What the columns of a header have, or what is wrong with one of them.
pub(super) fn columns(header: &StringRecord) -> Result<Vec<Column>, WrongColumn> {
    let wrong =
        |column: Option<&str>, message| Err(WrongColumn { column: column.map(str::to_owned), message });
    let known = known_names();
    let mut columns = Vec::new();
    let mut names = HashSet::new();
    for name in header {
        if !names.insert(name) {
            return wrong(Some(name), "the file has this column twice; expected it once".to_owned());
        }
        let of_error = || SCALARS.iter().find(|scalar| error_column(scalar.name) == name);
        let of_threshold = || PARAMETERS.iter().find(|own| own.is_number() && error_column(own.name) == name);
        // A parameter that has the name of a result has another one in an export, too.
        let parameter = name.strip_prefix("parameter_").unwrap_or(name);
        columns.push(if IGNORED.contains(&name) {
            Column::Ignored
        } else if name == SQUEALS {
            Column::Squeals
        } else if name == STATUS {
            Column::Status
        } else if let Some(scalar) = exported_error(name) {
            Column::Error(scalar)
        } else if let Some(scalar) = Scalar::find(name) {
            Column::Result(scalar)
        } else if let Some(parameter) = Parameter::find(parameter) {
            Column::Parameter(parameter)
        } else if let Some(scalar) = of_error() {
            Column::Error(scalar)
        } else if let Some(parameter) = of_threshold() {
            Column::ParameterError(parameter)
        } else if let Some(meant) = suggestion(name, &known) {
            // Without it, a misspelt result would be missing in silence.
            let expected = "expected omega_rpm, mu or another parameter, a result such as mu_star or frequency_hz, its error \
                            such as mu_star_error or frequency_error_hz, squeals, the error of a threshold such as omega_error_rpm, or \
                            note";
            let message = format!("no such column; {meant}\n  help: {expected}");
            return wrong(Some(name), message);
        } else {
            Column::Unknown
        });
    }
    if !columns.iter().any(|column| matches!(column, Column::Result(_) | Column::Squeals)) {
        let message =
            "expected a column with results: mu_star, frequency_hz, squeals or another number of the export"
                .to_owned();
        return wrong(None, message);
    }
    Ok(columns)
}
