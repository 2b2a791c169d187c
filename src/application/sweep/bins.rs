//! Means of measured points in bins of the parameter that varies most: a record of an instrument has a row for each sample.

use super::measured::{self, MeasuredError, MeasuredFile};
use crate::report::{JobRow, MeasuredValue, Measurement, Parameters, RowState};
use indexmap::IndexMap;
use serde_json::Value;
use std::path::Path;

/// From this ratio of the largest to the least value on, bins are equally wide in the logarithm.
const WIDE: f64 = 10.0;

/// Most bins.
pub const MOST_BINS: usize = 1000;

/// Reads a file of points, which get `source_name` as their study: its rows, or their means in `bins` bins.
pub(super) fn read(
    path: &Path,
    source_name: &str,
    bins: Option<usize>,
) -> Result<MeasuredFile, MeasuredError> {
    let points = measured::read(path, source_name)?;
    if bins.is_some() && points.has_thresholds {
        let message =
            "the file has thresholds, which are no samples; expected them in a file of their own, without --bins"
                .to_owned();
        return Err(MeasuredError::Content {
            file: path.display().to_string(),
            line: 1,
            column: None,
            message,
        });
    }
    match bins {
        None => Ok(points),
        Some(bins) => averaged(points, bins).ok_or_else(|| {
            let message =
                "no parameter that is a number varies; expected one, such as omega_rpm, for the bins"
                    .to_owned();
            MeasuredError::Content { file: path.display().to_string(), line: 1, column: None, message }
        }),
    }
}

/// The points of a file as their means in `bins` bins of the parameter that has the most values, apart for each set of the others. The error
/// of a mean has the standard deviation of its values, which need not be independent of each other, and the error that they have
/// themselves. Returns `None` if no number varies.
pub(super) fn averaged(file: MeasuredFile, bins: usize) -> Option<MeasuredFile> {
    let along = most_varied(&file)?;
    let of = |row: &JobRow| row.parameters.get(along).and_then(Value::as_f64);
    let values = || file.rows.iter().filter_map(of);
    let (low, high) =
        values().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let scale = |x: f64| if low > 0.0 && high / low >= WIDE { libm::log(x) } else { x };
    let bin = |x: f64| {
        (((scale(x) - scale(low)) / (scale(high) - scale(low)) * bins as f64) as usize).min(bins - 1)
    };
    let mut groups: IndexMap<String, Vec<Vec<&JobRow>>> = IndexMap::new();
    for row in &file.rows {
        let Some(x) = of(row) else { continue };
        let others = row.parameters.iter().filter(|(name, _)| *name != along);
        let others: Vec<String> = others.map(|(name, value)| format!("{name} {value}")).collect();
        groups.entry(others.join("\n")).or_insert_with(|| vec![Vec::new(); bins])[bin(x)].push(row);
    }
    let filled = groups.values().flatten().filter(|rows| !rows.is_empty());
    let rows: Vec<JobRow> = filled.map(|rows| mean(rows, along, &of)).collect();
    let without = file.rows.len() - values().count();
    let words = (without > 0).then(|| format!("{without} rows have no {along} and are in no bin"));
    let warnings = file.warnings.iter().cloned().chain(words).collect();
    Some(MeasuredFile { parameters: file.parameters, rows, warnings, has_thresholds: false })
}

/// The parameter with the most values, if it has two that are numbers.
fn most_varied(file: &MeasuredFile) -> Option<&'static str> {
    let count = |name: &&'static str| {
        let of = |row: &JobRow| row.parameters.get(name).and_then(Value::as_f64).map(f64::to_bits);
        let mut values: Vec<u64> = file.rows.iter().filter_map(of).collect();
        values.sort_unstable();
        values.dedup();
        values.len()
    };
    let counts = file.parameters.iter().map(|name| (count(name), *name)).filter(|(count, _)| *count > 1);
    counts.reduce(|most, own| if own.0 > most.0 { own } else { most }).map(|(_, name)| name)
}

/// The mean of the rows of a bin.
fn mean(rows: &[&JobRow], along: &str, of: &impl Fn(&JobRow) -> Option<f64>) -> JobRow {
    let first = rows[0];
    let at = average(&rows.iter().filter_map(|row| of(row)).collect::<Vec<_>>());
    let parameters = first
        .parameters
        .iter()
        .map(|(name, value)| (name.to_owned(), if name == along { at.into() } else { value.clone() }));
    let measured = || {
        rows.iter().filter_map(|row| match &row.state {
            RowState::Measured(measurement) => Some(measurement),
            _ => None,
        })
    };
    let mut by_name: IndexMap<&str, Vec<&MeasuredValue>> = IndexMap::new();
    for value in measured().flat_map(|own| &own.values) {
        by_name.entry(&value.name).or_default().push(value);
    }
    let values = by_name.into_iter().map(|(name, own)| {
        let numbers: Vec<f64> = own.iter().map(|one| one.value).collect();
        let given: Vec<f64> = own.iter().filter_map(|one| one.error).collect();
        let given = (!given.is_empty()).then(|| average(&given));
        let error = match (deviation(&numbers), given) {
            (Some(deviation), given) => Some(libm::hypot(deviation, given.unwrap_or(0.0))),
            (None, given) => given,
        };
        MeasuredValue { name: name.to_owned(), value: average(&numbers), error }
    });
    let known: Vec<bool> = measured().filter_map(|own| own.squeals).collect();
    // A bin with both says neither.
    let squeals = known.first().copied().filter(|first| known.iter().all(|own| own == first));
    JobRow {
        parameters: Parameters::new(f64::NAN, f64::NAN, parameters.collect()),
        state: RowState::Measured(Measurement { values: values.collect(), squeals }),
        ..first.clone()
    }
}

fn average(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The standard deviation; `None` of fewer than two different values, which say nothing about it.
fn deviation(values: &[f64]) -> Option<f64> {
    let mean = average(values);
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    (values.len() > 1 && squares > 0.0).then(|| (squares / (values.len() - 1) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::measured::parse;

    fn points(text: &str, bins: usize) -> Vec<(Vec<f64>, Measurement)> {
        let file = averaged(parse(text, "points.csv", "points").unwrap(), bins).unwrap();
        let of = |row: JobRow| {
            let at = row.parameters.iter().filter_map(|(_, value)| value.as_f64().filter(|x| x.is_finite()));
            let at = at.collect();
            let RowState::Measured(measurement) = row.state else { panic!("no measured point") };
            (at, measurement)
        };
        file.rows.into_iter().map(of).collect()
    }

    /// Protects: each row is in the bin of its speed, apart for each load, and an error has the scatter and what is given.
    #[test]
    fn rows_are_averaged_in_bins() {
        let text = "omega_rpm,load_n,mu_star,mu_star_error,frequency_hz,squeals\n\
                    1,30,0.3,0.04,,no\n2,30,0.36,0.04,,no\n9,30,0.5,0.01,15000,yes\n10,30,0.5,0.01,,no\n5,60,0.7,,,\n";
        let found = points(text, 2);
        let [low, high, other] = &found[..] else { panic!("{found:?}") };
        assert_eq!((low.0.clone(), low.1.squeals), (vec![1.5, 30.0], Some(false)));
        let [value] = &low.1.values[..] else { panic!("{low:?}") };
        // Two values 0.06 apart deviate by 0.06/√2.
        assert!((value.value - 0.33).abs() < 1e-15);
        assert!((value.error.unwrap() - (0.0018_f64 + 0.0016).sqrt()).abs() < 1e-15, "{value:?}");
        assert_eq!((high.0.clone(), high.1.squeals), (vec![9.5, 30.0], None), "a bin with both says neither");
        assert_eq!(high.1.value("frequency_hz").unwrap().error, None, "one value has no scatter");
        assert_eq!((other.0.clone(), other.1.value("mu_star").unwrap().value), (vec![5.0, 60.0], 0.7));
    }

    /// Protects: bins of speeds over several decades are equally wide in the logarithm, and a file without a speed has none.
    #[test]
    fn wide_ranges_have_bins_in_the_logarithm() {
        let text = "omega_rpm,mu_star\n0.01,0.1\n0.02,0.3\n1,0.5\n100,0.7\n";
        assert_eq!(points(text, 2).iter().map(|(at, _)| at[0]).collect::<Vec<_>>(), [0.015, 50.5]);
        assert!(averaged(parse("omega_rpm,mu_star\n7,0.1\n7,0.3\n", "p", "p").unwrap(), 3).is_none());
    }
}
