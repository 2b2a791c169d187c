//! Files of measured points, for comparison with studies: CSV with a column for each parameter and result.

use crate::report::{
    Discretisation, JobRow, MeasuredValue, Measurement, RowState, SCALARS, Scalar, name_and_unit,
};
use crate::study::{PARAMETERS, Parameter, nearest_name};
use csv::{ReaderBuilder, StringRecord, Trim};
use serde_json::Value;
use std::path::Path;
use thiserror::Error;

/// Why a file of measured points cannot be used.
#[derive(Debug, Error)]
pub enum MeasuredError {
    /// The file cannot be read.
    #[error("{file}: cannot be read: {reason}")]
    Read {
        /// The file as given.
        file: String,
        /// What the operating system said.
        reason: std::io::Error,
    },
    /// A line, a column or a cell of the file.
    #[error("{file}:{line}: {}{message}", column.as_ref().map_or_else(String::new, |name| format!("column {name}: ")))]
    Content {
        /// The file as given.
        file: String,
        /// The line, counted from 1.
        line: u64,
        /// The column's name, if one column is wrong.
        column: Option<String>,
        /// What is wrong, and what is expected.
        message: String,
    },
}

/// The points of a file.
#[derive(Debug)]
pub(super) struct MeasuredFile {
    /// The parameters that the file has columns for.
    pub parameters: Vec<&'static str>,
    /// The points. Parameters other than ω and μ are in the order of `parameters`.
    pub rows: Vec<JobRow>,
}

/// Columns that are not read: names and states, as an export has them, and remarks.
const IGNORED: [&str; 8] = ["study", "job", "status", "regime", "error", "wall_s", "note", "comment"];

/// What a column has.
enum Column {
    Parameter(&'static Parameter),
    Result(&'static Scalar),
    Error(&'static Scalar),
    Ignored,
}

/// A file while it is read, for messages.
struct Place<'a> {
    file: &'a str,
    line: u64,
}

/// Reads a file of points, which get `source_name` as their study.
pub(super) fn read(path: &Path, source_name: &str) -> Result<MeasuredFile, MeasuredError> {
    let file = path.display().to_string();
    match std::fs::read_to_string(path) {
        Ok(text) => parse(&text, &file, source_name),
        Err(reason) => Err(MeasuredError::Read { file, reason }),
    }
}

fn parse(text: &str, file: &str, source_name: &str) -> Result<MeasuredFile, MeasuredError> {
    // Spreadsheets begin their files with a byte order mark.
    let text = text.trim_start_matches('\u{feff}');
    let mut reader = ReaderBuilder::new()
        .comment(Some(b'#'))
        .delimiter(delimiter(text))
        .trim(Trim::All)
        .flexible(true)
        .from_reader(text.as_bytes());
    let not_csv = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        Place { file, line }.error(None, format!("not a CSV file: {error}"))
    };
    let header = reader.headers().map_err(not_csv)?.clone();
    let place = Place { file, line: line(text, &header) };
    let columns = columns(&header, &place)?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(not_csv)?;
        let place = Place { file, line: line(text, &record) };
        if record.iter().all(str::is_empty) {
            continue;
        }
        if record.len() != header.len() {
            let message = format!("expected {} cells as in the header; found {}", header.len(), record.len());
            return Err(place.error(None, message));
        }
        rows.extend(row(&header, &columns, &record, &place, source_name)?);
    }
    if rows.is_empty() {
        return Err(place.error(None, "expected at least one line with a result below the header".to_owned()));
    }
    let parameters = columns.iter().filter_map(|column| match column {
        Column::Parameter(parameter) => Some(parameter.name),
        _ => None,
    });
    Ok(MeasuredFile { parameters: parameters.collect(), rows })
}

/// The line of a record, counted from 1. The reader's own position is before the blank lines and comments above the record.
fn line(text: &str, record: &StringRecord) -> u64 {
    let start = record.position().and_then(|position| usize::try_from(position.byte()).ok()).unwrap_or(0);
    let (above, below) = text.split_at_checked(start).unwrap_or(("", text));
    let skipped = below.lines().take_while(|line| line.trim().is_empty() || line.starts_with('#')).count();
    (above.matches('\n').count() + skipped) as u64 + 1
}

/// The character between cells: the first of comma, semicolon and tab in the header that occurs.
fn delimiter(text: &str) -> u8 {
    let header = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or("");
    [b',', b';', b'\t'].into_iter().find(|c| header.as_bytes().contains(c)).unwrap_or(b',')
}

impl Place<'_> {
    fn error(&self, column: Option<&str>, message: String) -> MeasuredError {
        let column = column.map(str::to_owned);
        MeasuredError::Content { file: self.file.to_owned(), line: self.line, column, message }
    }
}

/// The column with the error of a scalar: `mu_star_error`, `frequency_error_hz`.
fn error_column(scalar: &Scalar) -> String {
    let (stem, _) = name_and_unit(scalar.name);
    format!("{stem}_error{}", &scalar.name[stem.len()..])
}

/// All names that a column can have.
fn known_names() -> Vec<String> {
    let parameters = PARAMETERS.iter().map(|parameter| parameter.name.to_owned());
    let results = SCALARS.iter().flat_map(|scalar| [scalar.name.to_owned(), error_column(scalar)]);
    parameters.chain(results).chain(IGNORED.map(str::to_owned)).collect()
}

fn columns(header: &StringRecord, place: &Place) -> Result<Vec<Column>, MeasuredError> {
    let mut columns = Vec::new();
    for (index, name) in header.iter().enumerate() {
        if header.iter().take(index).any(|other| other == name) {
            return Err(
                place.error(Some(name), "the file has this column twice; expected it once".to_owned())
            );
        }
        let of_error = || SCALARS.iter().find(|scalar| error_column(scalar) == name);
        // A parameter that has the name of a result has another one in an export, too.
        let parameter = name.strip_prefix("parameter_").unwrap_or(name);
        columns.push(if IGNORED.contains(&name) {
            Column::Ignored
        } else if let Some(scalar) = (name == "mu_star_se").then(|| Scalar::find("mu_star")).flatten() {
            // An export calls the error of μ* so.
            Column::Error(scalar)
        } else if let Some(scalar) = Scalar::find(name) {
            Column::Result(scalar)
        } else if let Some(parameter) = Parameter::find(parameter) {
            Column::Parameter(parameter)
        } else if let Some(scalar) = of_error() {
            Column::Error(scalar)
        } else {
            let known = known_names();
            let nearest = nearest_name(name, known.iter().map(String::as_str));
            let advice = nearest.map_or_else(String::new, |name| format!("; did you mean `{name}`?"));
            let expected = "expected omega_rpm, mu or another parameter, a result such as mu_star or frequency_hz, its error \
                            such as mu_star_error or frequency_error_hz, or note";
            return Err(place.error(Some(name), format!("no such column{advice}\n  help: {expected}")));
        });
    }
    if !columns.iter().any(|column| matches!(column, Column::Result(_))) {
        let message = "expected a column with results: mu_star, frequency_hz or another number of the export"
            .to_owned();
        return Err(place.error(None, message));
    }
    Ok(columns)
}

/// A point; none if the line has no result.
fn row(
    header: &StringRecord,
    columns: &[Column],
    record: &StringRecord,
    place: &Place,
    source_name: &str,
) -> Result<Option<JobRow>, MeasuredError> {
    let mut parameters: Vec<(String, Value)> = Vec::new();
    let mut values: Vec<MeasuredValue> = Vec::new();
    let mut errors: Vec<(&str, f64)> = Vec::new();
    let (mut omega_rpm, mut mu) = (f64::NAN, f64::NAN);
    for ((column, name), text) in columns.iter().zip(header).zip(record) {
        let number = || number(text).map_err(|message| place.error(Some(name), message));
        let require = |holds: bool, x: f64, expected: &str| {
            if holds { Ok(x) } else { Err(place.error(Some(name), format!("{text}: expected {expected}"))) }
        };
        match column {
            Column::Ignored => {}
            Column::Parameter(parameter) if text.is_empty() => {
                if !matches!(parameter.name, "omega_rpm" | "mu") {
                    parameters.push((name.to_owned(), Value::Null));
                }
            }
            Column::Parameter(parameter) => match parameter.name {
                "omega_rpm" => omega_rpm = number().and_then(|x| require(x > 0.0, x, "a number > 0"))?,
                "mu" => mu = number().and_then(|x| require(x >= 0.0, x, "a number >= 0"))?,
                _ if parameter.is_number() => parameters.push((name.to_owned(), number()?.into())),
                _ => parameters.push((name.to_owned(), text.into())),
            },
            _ if text.is_empty() => {}
            Column::Result(scalar) => {
                values.push(MeasuredValue { name: scalar.name.to_owned(), value: number()?, error: None });
            }
            Column::Error(scalar) => {
                let error = number()?;
                if error < 0.0 {
                    return Err(place.error(Some(name), format!("{text}: expected an error >= 0")));
                }
                errors.push((scalar.name, error));
            }
        }
    }
    for (name, error) in errors {
        if let Some(value) = values.iter_mut().find(|value| value.name == name) {
            value.error = Some(error);
        }
    }
    Ok((!values.is_empty()).then(|| JobRow {
        study: source_name.to_owned(),
        job: format!("{}:{}", place.file, place.line),
        parameters,
        omega_rpm,
        mu,
        state: RowState::Measured(Measurement { values }),
        wall_s: None,
        numerics: None,
        discretisation: Discretisation::NotMeasured,
        wave: 0,
        why: None,
    }))
}

fn number(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ if text.contains(',') => {
            Err(format!("{text}: expected a number with a point: {}", text.replace(',', ".")))
        }
        _ => Err(format!("{text}: expected a number")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> String {
        parse(text, "points.csv", "points").unwrap_err().to_string()
    }

    /// Protects: a file as spreadsheets and people write it is read: comments, blank lines, spaces, other separators, empty
    /// cells, columns of an export.
    #[test]
    fn points_are_read() {
        let text = "\u{feff}# from the rig\n\nomega_rpm, mu, mu_star, mu_star_error, frequency_hz, frequency_error_hz, clamp_side, note\n\
                    7, 0.4, 0.27, 0.01, 15200, 50, inner_side,\"first, dry\"\n\n# second day\n,,,,,,,\n20, , 0.3, , , , , \n35,0.4,,,,,,no result\n";
        let found = parse(text, "points.csv", "points").unwrap();
        assert_eq!(found.parameters, ["omega_rpm", "mu", "clamp_side"]);
        let [first, second] = found.rows.as_slice() else { panic!("{found:?}") };
        assert_eq!((first.omega_rpm, first.mu, first.job.as_str()), (7.0, 0.4, "points.csv:4"));
        assert_eq!(first.parameters, [("clamp_side".to_owned(), "inner_side".into())]);
        let value = |name: &str, value, error| MeasuredValue { name: name.to_owned(), value, error };
        let values = vec![value("mu_star", 0.27, Some(0.01)), value("frequency_hz", 15_200.0, Some(50.0))];
        assert_eq!(first.state, RowState::Measured(Measurement { values }));
        assert!(second.mu.is_nan() && second.job == "points.csv:8", "{second:?}");
        assert_eq!(second.parameters, [("clamp_side".to_owned(), Value::Null)]);
        for text in [
            "omega_rpm;mu_star\n7;0.3\n",
            "omega_rpm\tmu_star\n7\t0.3\n",
            "study,job,omega_rpm,mu_star,mu_star_se\na,b,7,0.3,0.01",
        ] {
            assert_eq!(parse(text, "points.csv", "points").unwrap().rows.len(), 1, "{text}");
        }
    }

    /// Protects: an error names file, line and column, the value, and what is expected.
    #[test]
    fn errors_name_their_place() {
        for (text, expected) in [
            (
                "omega_rpm,mu_str\n7,0.3\n",
                "points.csv:1: column mu_str: no such column; did you mean `mu_star`?",
            ),
            ("omega_rpm,mu_star\n7,0.3\n\n8,high\n", "points.csv:4: column mu_star: high: expected a number"),
            (
                "omega_rpm;mu_star\n7;0,3\n",
                "points.csv:2: column mu_star: 0,3: expected a number with a point: 0.3",
            ),
            ("omega_rpm,mu_star\n7,NaN\n", "points.csv:2: column mu_star: NaN: expected a number"),
            ("omega_rpm,mu_star\n-7,0.3\n", "points.csv:2: column omega_rpm: -7: expected a number > 0"),
            ("mu,mu_star\n-1,0.3\n", "points.csv:2: column mu: -1: expected a number >= 0"),
            ("omega_rpm,mu_star\n", "points.csv:1: expected at least one line with a result"),
            ("omega_rpm,mu_star\n7,0.3,1\n", "points.csv:2: expected 2 cells as in the header; found 3"),
            ("mu_star,mu_star\n7,0.3\n", "points.csv:1: column mu_star: the file has this column twice"),
            (
                "mu_star,mu_star_error\n0.3,-1\n",
                "points.csv:2: column mu_star_error: -1: expected an error >= 0",
            ),
            ("# nothing\nomega_rpm,mu\n7,0.3\n", "points.csv:2: expected a column with results"),
            ("mu_star,load_n\n0.3,much\n", "points.csv:2: column load_n: much: expected a number"),
            ("", "points.csv:1: expected a column with results"),
        ] {
            let found = refusal(text);
            assert!(found.starts_with(expected), "{text:?}: {found}");
        }
    }
}
