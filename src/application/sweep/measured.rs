//! Files of measured points, for comparison with studies: CSV with a column for each parameter and result.

use super::measured_columns::{Column, SQUEALS, columns};
use super::threshold::Threshold;
use crate::publish::value::significant;
use crate::report::{FREQUENCY, JobRow, MeasuredValue, Measurement, Parameters, RowState};
use crate::study::read_text;
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
    /// What was left out of the file, and what looks wrong in it, in sentences.
    pub warnings: Vec<String>,
    /// Whether the file has a column for errors of thresholds.
    pub has_thresholds: bool,
}

/// The largest file \[byte\]: some ten million rows.
const MOST_BYTES: u64 = 1 << 30;

/// A file while it is read, for messages.
struct Place<'a> {
    file: &'a str,
    line: u64,
    /// Whether numbers have a decimal comma where they have no point: commas separate no cells.
    has_decimal_comma: bool,
}

/// The lines of a text, counted on the way from record to record.
struct Lines<'a> {
    text: &'a str,
    byte: usize,
    line: u64,
}

impl Lines<'_> {
    /// The line of the next record, counted from 1. The reader's own position is before the blank lines and comments above the
    /// record.
    fn of(&mut self, record: &StringRecord) -> u64 {
        let start = record.position().and_then(|position| usize::try_from(position.byte()).ok()).unwrap_or(0);
        let Some(between) = self.text.get(self.byte..start) else { return self.line };
        self.line += between.matches('\n').count() as u64;
        self.byte = start;
        let below = self.text[start..].lines();
        let skipped = below.take_while(|line| line.trim().is_empty() || line.starts_with('#')).count();
        self.line + skipped as u64
    }
}

/// Reads a file of points, which get `source_name` as their study.
pub(super) fn read(path: &Path, source_name: &str) -> Result<MeasuredFile, MeasuredError> {
    let file = path.display().to_string();
    match read_text(path, MOST_BYTES) {
        Ok(text) => parse(&text, &file, source_name),
        Err(reason) => Err(MeasuredError::Read { file, reason }),
    }
}

pub(super) fn parse(text: &str, file: &str, source_name: &str) -> Result<MeasuredFile, MeasuredError> {
    // Spreadsheets begin their files with a byte order mark.
    let text = text.trim_start_matches('\u{feff}');
    let delimiter = delimiter(text);
    let has_decimal_comma = delimiter != b',';
    let mut reader = ReaderBuilder::new()
        .comment(Some(b'#'))
        .delimiter(delimiter)
        .trim(Trim::All)
        .flexible(true)
        .from_reader(text.as_bytes());
    let not_csv = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        Place { file, line, has_decimal_comma }.error(None, format!("not a CSV file: {error}"))
    };
    let header = reader.headers().map_err(not_csv)?.clone();
    let mut lines = Lines { text, byte: 0, line: 1 };
    let place = Place { file, line: lines.of(&header), has_decimal_comma };
    let header_line = place.line;
    let columns = columns(&header).map_err(|wrong| place.error(wrong.column.as_deref(), wrong.message))?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(not_csv)?;
        let place = Place { file, line: lines.of(&record), has_decimal_comma };
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
    let unknown = header.iter().zip(&columns).filter(|(_, column)| matches!(column, Column::Unknown));
    let unknown: Vec<String> = unknown.map(|(name, _)| format!("`{name}`")).collect();
    let named = (!unknown.is_empty()).then(|| {
        let (columns, are) = if unknown.len() == 1 { ("column", "is") } else { ("columns", "are") };
        let names = unknown.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
        let more = unknown.len().saturating_sub(MOST_NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!("{columns} {names}{more} {are} no parameter and no result")
    });
    // One point can belong to the only job of a study.
    if let Some(named) = &named
        && rows.len() > 1
        && !columns.iter().any(|column| matches!(column, Column::Parameter(_)))
    {
        let message =
            format!("{named}; expected a column with a parameter of the study, such as omega_rpm or mu");
        return Err(MeasuredError::Content {
            file: file.to_owned(),
            line: header_line,
            column: None,
            message,
        });
    }
    let left_out = named.map(|named| format!("{file}: {named}, and left out"));
    let has_thresholds = columns.iter().any(|column| matches!(column, Column::ParameterError(_)));
    let warnings = left_out.into_iter().chain(low_frequencies(file, &rows)).collect();
    Ok(MeasuredFile { parameters: parameters.collect(), rows, warnings, has_thresholds })
}

/// Squeal is above this frequency \[Hz\], and below as many kHz.
const LOW_HZ: f64 = 100.0;

/// A warning if all frequencies look like kHz.
fn low_frequencies(file: &str, rows: &[JobRow]) -> Option<String> {
    let values = || rows.iter().filter_map(|row| FREQUENCY.value(row));
    let largest_hz = values().reduce(f64::max).filter(|largest_hz| *largest_hz < LOW_HZ)?;
    Some(format!(
        "{file}: column {} has no frequency above {largest_hz} Hz; if they are in kHz, write {} instead of {largest_hz}",
        FREQUENCY.name,
        significant(1000.0 * largest_hz, 6)
    ))
}

/// Most columns that a message names.
const MOST_NAMED: usize = 10;

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

/// The point of a line, or the two around a threshold; none if the line has no result.
fn row(
    header: &StringRecord,
    columns: &[Column],
    record: &StringRecord,
    place: &Place,
    source_name: &str,
) -> Result<Vec<JobRow>, MeasuredError> {
    let mut parameters: Vec<(String, Value)> = Vec::new();
    let mut values: Vec<MeasuredValue> = Vec::new();
    let mut errors: Vec<(&str, f64)> = Vec::new();
    let mut squeals = None;
    let mut threshold = Threshold::default();
    for ((column, name), text) in columns.iter().zip(header).zip(record) {
        let number = || number(text, place).map_err(|message| place.error(Some(name), message));
        let require = |holds: bool, x: f64, expected: &str| {
            if holds { Ok(x) } else { Err(place.error(Some(name), format!("{text}: expected {expected}"))) }
        };
        match column {
            Column::Ignored | Column::Unknown => {}
            Column::Parameter(parameter) => {
                let value = match parameter.name {
                    _ if text.is_empty() => Value::Null,
                    "omega_rpm" => number().and_then(|x| require(x > 0.0, x, "a number > 0"))?.into(),
                    "mu" => number().and_then(|x| require(x >= 0.0, x, "a number >= 0"))?.into(),
                    _ if parameter.is_number() => number()?.into(),
                    _ => text.into(),
                };
                parameters.push((parameter.name.to_owned(), value));
            }
            _ if text.is_empty() => {}
            Column::Squeals => match text.to_ascii_lowercase().as_str() {
                "yes" | "true" | "1" => squeals = Some(true),
                "no" | "false" | "0" => squeals = Some(false),
                "below" => threshold.squeals_below = Some(true),
                "above" => threshold.squeals_below = Some(false),
                _ => {
                    let message = format!("{text}: expected yes or no, or below or above for a threshold");
                    return Err(place.error(Some(name), message));
                }
            },
            Column::Status => match text {
                "periodic" | "unstable" => squeals = squeals.or(Some(true)),
                "decayed" => squeals = squeals.or(Some(false)),
                _ => {}
            },
            // Of what does not vibrate, people write 0 Hz.
            // Only what squeals has a frequency.
            Column::Result(scalar) if *scalar == FREQUENCY && number()? == 0.0 => {
                squeals = squeals.or(Some(false));
            }
            Column::Result(scalar) => {
                if *scalar == FREQUENCY {
                    squeals = squeals.or(Some(true));
                }
                values.push(MeasuredValue { name: scalar.name.to_owned(), value: number()?, error: None });
            }
            Column::ParameterError(parameter) => {
                threshold.errors.push((parameter.name, require(number()? > 0.0, number()?, "an error > 0")?));
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
    for &(name, error) in &errors {
        if let Some(value) = values.iter_mut().find(|value| value.name == name) {
            value.error = Some(error);
        }
    }
    let point = |parameters, values, squeals| JobRow {
        study: source_name.to_owned(),
        job: format!("{}:{}", place.file, place.line),
        parameters: Parameters::new(f64::NAN, f64::NAN, parameters),
        has_one_mu: false,
        state: RowState::Measured(Measurement { values, squeals }),
        wall_s: None,
        numerics: None,
        wave: 0,
        why: None,
        inputs: Vec::new(),
    };
    let refused = |message| place.error(Some(SQUEALS), message);
    if let Some(sides) = threshold
        .sides(&parameters, !values.is_empty() || !errors.is_empty() || squeals.is_some())
        .map_err(refused)?
    {
        return Ok(sides.map(|(parameters, squeals)| point(parameters, Vec::new(), Some(squeals))).into());
    }
    let has_result = !values.is_empty() || squeals.is_some();
    Ok(has_result.then(|| point(parameters, values, squeals)).into_iter().collect())
}

fn number(text: &str, place: &Place) -> Result<f64, String> {
    let pointed = text.replacen(',', ".", 1);
    let is_german = place.has_decimal_comma && !text.contains('.');
    match if is_german { &pointed } else { text }.parse::<f64>() {
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
        assert_eq!(first.job, "points.csv:4");
        let own: Vec<_> = first.parameters.iter().map(|(name, value)| (name, value.clone())).collect();
        assert_eq!(own, [("omega_rpm", 7.0.into()), ("mu", 0.4.into()), ("clamp_side", "inner_side".into())]);
        let value = |name: &str, value, error| MeasuredValue { name: name.to_owned(), value, error };
        let values = vec![value("mu_star", 0.27, Some(0.01)), value("frequency_hz", 15_200.0, Some(50.0))];
        assert_eq!(first.state, RowState::Measured(Measurement { values, squeals: Some(true) }));
        assert_eq!(second.job, "points.csv:8");
        assert!(second.parameters.mu().is_nan(), "{second:?}");
        assert_eq!(second.parameters.get("clamp_side"), Some(&Value::Null));
        for text in [
            "omega_rpm;mu_star\n7;0.3\n",
            "omega_rpm;mu_star\n7;0,3\n",
            "omega_rpm\tmu_star\n7,0\t0,3\n",
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
                "omega_rpm,mu_star\n7,\"0,3\"\n",
                "points.csv:2: column mu_star: 0,3: expected a number with a point: 0.3",
            ),
            ("rpm,mu_star\n7,0.3\n", "points.csv:1: column rpm: no such column; did you mean `omega_rpm`?"),
            ("omega_rpm,squeals\n7,maybe\n", "points.csv:2: column squeals: maybe: expected yes or no"),
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

    /// Protects: a column of the author's own is left out and named, and the others are read.
    #[test]
    fn unknown_columns_are_left_out_and_named() {
        let found = parse("omega_rpm;mu_star;Bemerkung\n7;0,3;erste\n", "points.csv", "points").unwrap();
        assert_eq!(found.rows.len(), 1);
        let left_out = "points.csv: column `Bemerkung` is no parameter and no result, and left out";
        assert_eq!(found.warnings, [left_out]);
        let found = parse("omega_rpm,mu_star,note\n7,0.3,first\n", "points.csv", "points").unwrap();
        assert!(found.warnings.is_empty(), "{found:?}");
        // Several points without a parameter belong to no job.
        assert_eq!(parse("Bemerkung,mu_star\nx,0.3\n", "points.csv", "points").unwrap().rows.len(), 1);
        let refused = refusal("# day 1\nomega_rads,mu_star\n7,0.3\n8,0.3\n");
        assert!(
            refused.starts_with(
                "points.csv:2: column `omega_rads` is no parameter and no result; expected a column with"
            ),
            "{refused}"
        );
    }

    /// Protects: who writes frequencies in kHz is asked, and who has one low frequency among others is not.
    #[test]
    fn frequencies_in_khz_are_named() {
        let warnings = |text: &str| parse(text, "points.csv", "points").unwrap().warnings;
        let low = "points.csv: column frequency_hz has no frequency above 11.5 Hz; if they are in kHz, write 11500 instead of 11.5";
        assert_eq!(warnings("omega_rpm,frequency_hz\n7,11\n8,11.5\n9,0\n"), [low]);
        assert_eq!(warnings("omega_rpm,frequency_hz\n7,90\n8,11500\n"), Vec::<String>::new());
        assert_eq!(warnings("omega_rpm,frequency_hz,squeals\n7,0,\n8,,no\n"), Vec::<String>::new());
    }

    /// Protects: a point says whether it squeals: in a column of its own, by a frequency, by none of 0 Hz, or by the outcome in an
    /// export; an empty cell says nothing.
    #[test]
    fn points_say_whether_they_squeal() {
        let text = "omega_rpm,mu_star,frequency_hz,squeals,status\n1,0.3,15200,,\n2,0.3,0,,\n3,0.3,,,\n4,,,no,\n5,,,Yes,\n6,0.3,,,decayed\n\
                    7,0.3,,,periodic\n8,0.3,,,not_periodic\n9,0.3,15200,no,\n";
        let rows = parse(text, "points.csv", "points").unwrap().rows;
        let found: Vec<Option<bool>> = rows.iter().map(JobRow::squeals).collect();
        let (yes, no) = (Some(true), Some(false));
        assert_eq!(found, [yes, no, None, no, yes, no, yes, None, no]);
        // 0 Hz is no frequency that could be compared.
        assert_eq!(
            rows[1].state,
            RowState::Measured(Measurement {
                values: vec![MeasuredValue { name: "mu_star".to_owned(), value: 0.3, error: None }],
                squeals: no,
            })
        );
    }

    /// Protects: the lines of a long file are counted in one pass: each record adds what lies between it and the one before.
    #[test]
    fn lines_are_counted_in_one_pass() {
        let rows = 200_000;
        let text: String =
            std::iter::once("omega_rpm,mu_star\n".to_owned())
                .chain((0..rows).map(|row| {
                    format!("{}{}.5,0.3\n", if row % 1000 == 0 { "\n# day\n" } else { "" }, row % 50)
                }))
                .collect();
        let found = parse(&text, "p", "p").unwrap();
        assert_eq!(found.rows.len(), rows);
        assert_eq!(found.rows[rows - 1].job, format!("p:{}", text.lines().count()));
    }
}
