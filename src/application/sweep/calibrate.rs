//! From a file of measured points to a study that is calibrated with them.

use super::bins;
use super::error::SweepError;
use super::measured::MeasuredFile;
use crate::report::{FREQUENCY, JobRow, MU_STAR, RowState};
use crate::study::MeasuredPoint;
use serde_json::{Map, Value};
use std::path::Path;

/// Measured points for a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibrationData {
    /// The points, with the parameter that varies along them.
    pub points: Vec<MeasuredPoint>,
    /// What the file sets in the study, as `--set` does: the parameter that varies as a list, and the others, which have one value.
    pub settings: Vec<(String, String)>,
    /// What was left out of the file, and what looks wrong in it, in sentences.
    pub warnings: Vec<String>,
}

/// Reads a file of measured points for a calibration: its rows, or their means in `count` bins of the parameter that varies.
///
/// # Errors
/// If the file cannot be used as measured points, if two parameters vary in it, or if a line lacks a parameter.
pub fn read_calibration_data(path: &Path, count: Option<usize>) -> Result<CalibrationData, SweepError> {
    let file = bins::read(path, "data", count)?;
    let refuse = |message: String| Err(SweepError::CalibrationData(format!("{}: {message}", path.display())));
    let mut settings = Vec::new();
    let mut along: Option<&str> = None;
    for name in &file.parameters {
        let values = values(&file, name);
        if let Some(row) = values.iter().position(Value::is_null) {
            return refuse(format!("line {}: {name} is empty; expected its value", line(&file, row)));
        }
        let mut different: Vec<&Value> = Vec::new();
        for value in &values {
            if !different.contains(&value) {
                different.push(value);
            }
        }
        match different.as_slice() {
            [only] => settings.push(((*name).to_owned(), text(only))),
            _ if along.is_some() => {
                let first = along.unwrap_or_default();
                return refuse(format!(
                    "{first} and {name} both vary; expected one parameter that varies, in a file for each value of the other"
                ));
            }
            several => {
                along = Some(name);
                settings.push((
                    (*name).to_owned(),
                    several.iter().copied().cloned().collect::<Value>().to_string(),
                ));
            }
        }
    }
    let point = |own: &JobRow| {
        let RowState::Measured(measurement) = &own.state else { return MeasuredPoint::default() };
        let at: Map<String, Value> = along
            .iter()
            .filter_map(|name| Some(((*name).to_owned(), own.parameters.get(name)?.clone())))
            .collect();
        let value = |name: &str| measurement.value(name).map(|own| own.value);
        let error = |name: &str| measurement.value(name).and_then(|own| own.error);
        MeasuredPoint {
            at,
            mu_star: value(MU_STAR.name),
            mu_star_error: error(MU_STAR.name),
            frequency_hz: value(FREQUENCY.name),
            frequency_error_hz: error(FREQUENCY.name),
            squeals: measurement.squeals,
        }
    };
    let points: Vec<MeasuredPoint> = file.rows.iter().map(point).collect();
    for (number, own) in points.iter().enumerate() {
        let lacks = |value: Option<f64>, error: Option<f64>| value.is_some() && error.is_none();
        for (name, is_missing) in [
            ("mu_star_error", lacks(own.mu_star, own.mu_star_error)),
            ("frequency_error_hz", lacks(own.frequency_hz, own.frequency_error_hz)),
        ] {
            if is_missing {
                let why = if count.is_some() {
                    " in the bin that begins with it, which has no scatter: give fewer bins, or errors"
                } else {
                    ""
                };
                return refuse(format!(
                    "line {}: {name} is missing{why}; without the error of a value, nothing can be ruled out by it",
                    line(&file, number)
                ));
            }
        }
    }
    for (number, own) in points.iter().enumerate() {
        let place = line(&file, number);
        for (name, value) in [
            ("mu_star", own.mu_star),
            ("mu_star_error", own.mu_star_error),
            ("frequency_hz", own.frequency_hz),
            ("frequency_error_hz", own.frequency_error_hz),
        ] {
            if let Some(value) = value.filter(|value| *value <= 0.0) {
                return refuse(format!("line {place}: {name} = {value}: expected a number > 0"));
            }
        }
        if own.frequency_hz.is_some() && own.squeals == Some(false) {
            return refuse(format!(
                "line {place}: it has a frequency, and squeals is no; expected one of the two"
            ));
        }
        if let Some(first) = points[..number].iter().position(|other| other.at == own.at) {
            let name = |name: &&str| format!("{name} = {}, ", text(&values(&file, name)[number]));
            let point: String = file.parameters.iter().map(name).collect();
            return refuse(format!(
                "line {place}: {point}the same point as on line {}; expected one line for it, with the mean",
                line(&file, first)
            ));
        }
    }
    Ok(CalibrationData { points, settings, warnings: file.warnings })
}

fn values(file: &MeasuredFile, name: &str) -> Vec<Value> {
    file.rows.iter().map(|row| row.parameters.get(name).cloned().unwrap_or_default()).collect()
}

fn line(file: &MeasuredFile, row: usize) -> &str {
    file.rows[row].job.rsplit(':').next().unwrap_or_default()
}

fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
