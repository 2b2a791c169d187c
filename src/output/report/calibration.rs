//! What measured points say about free parameters: the region that they do not rule out.

use super::findings_table::FindingsTable;
use super::parameters::{self, assignment, in_words};
use super::row::JobRow;
use crate::publish::table::{Column, FileColumns, Table};
use crate::publish::value::{self, count};
use serde_json::{Map, Value, json};

/// What a calibration has found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Calibration {
    /// The free parameters.
    pub free: Vec<Free>,
    /// The measured values.
    pub data: Vec<Datum>,
    /// The share of the ranges that is not ruled out, weighted by the distributions.
    pub share: f64,
    /// Points of the free parameters that were run.
    pub points: usize,
    /// Jobs of these points.
    pub jobs: usize,
    /// The run that fits best; none if none has a result.
    pub best: Option<Fit>,
    /// Runs that nothing measured rules out.
    pub runs_that_fit: usize,
    /// If everything is ruled out: the place that is least implausible, by the emulators.
    pub nearest: Option<Nearest>,
    /// Pairs of parameters by their numbers, with their correlations inside the region.
    pub correlations: Vec<([usize; 2], f64)>,
    /// Values of the free parameters inside the region.
    pub inside: Vec<Vec<f64>>,
    /// Those of the points that were run.
    pub run: Vec<Vec<f64>>,
    /// How well the emulators foretold runs that were left out, by the names of the quantities.
    pub checks: Vec<Check>,
    /// Whether further runs would not change the region much.
    pub is_known: bool,
    /// Values of runs that squeal whose mesh error is not known, and all of them.
    pub unknown_mesh: [usize; 2],
    /// Measured values that runs which squeal do not have, and all that they could have.
    pub without_values: [usize; 2],
}

/// A free parameter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Free {
    /// Its name.
    pub name: String,
    /// The ends of its range; those of 99.8 % of a normal distribution.
    pub range: [f64; 2],
    /// Whether equal ratios of it are equally likely.
    pub is_log: bool,
    /// The ends of the region; none if everything is ruled out.
    pub region: Option<[f64; 2]>,
    /// The share of its distribution between the ends of the region.
    pub left: f64,
}

/// How well a run fits.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fit {
    /// The values of the free parameters.
    pub values: Vec<f64>,
    /// The largest distance from a measured value, in standard deviations of measurement, discrepancy and mesh.
    pub largest: f64,
    /// The root mean square of these distances.
    pub root_mean_square: f64,
    /// Measured values that it can be compared with.
    pub compared: usize,
    /// Points where it squeals and steady sliding was measured, or the other way round.
    pub other_state: usize,
    /// Whether it is ruled out itself: too far away, or in another state.
    pub is_ruled_out: bool,
}

/// A place, and the measured value that speaks most against it.
#[derive(Debug, Clone, PartialEq)]
pub struct Nearest {
    /// The values of the free parameters.
    pub values: Vec<f64>,
    /// Its implausibility.
    pub implausibility: f64,
    /// The quantity that rules it out, or `squeals`.
    pub of: &'static str,
    /// The parameters of the measured point.
    pub place: Vec<(String, Value)>,
    /// Whether the machine squeals there, if that is known.
    pub machine_squeals: Option<bool>,
}

/// A measured value, and what the simulation gives there.
#[derive(Debug, Clone, PartialEq)]
pub struct Datum {
    /// The parameters of the measured point.
    pub place: Vec<(String, Value)>,
    /// The quantity: a column of the export, or `squeals`.
    pub of: &'static str,
    /// The measured value.
    pub measured: Value,
    /// Its standard deviation.
    pub error: Option<f64>,
    /// The value of the best run; null if it has none.
    pub best: Value,
    /// The smallest and the largest value that emulators expect inside the region.
    pub band: Option<[f64; 2]>,
}

/// How well the emulators of a quantity foretold runs that were left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// The quantity.
    pub of: &'static str,
    /// Values that were left out, one at a time.
    pub values: usize,
    /// Those within two standard deviations.
    pub within_two: usize,
}

/// Values of a parameter that differ by less than this share are one: they are rounded to nine digits.
const SAME_VALUE: f64 = 1.0e-7;

/// Correlations from which on two parameters are not told apart.
const NOT_TOLD_APART: f64 = 0.8;

/// The share of the ranges from which on nothing is ruled out.
const NOTHING_RULED_OUT: f64 = 0.99;

/// The share of a distribution from which on the data say nearly nothing about a parameter.
const NOTHING_SAID: f64 = 0.8;

#[rustfmt::skip]
const FREE: [Column<(Free, Option<f64>)>; 7] = [
    Column::new("parameter", "", "free parameter", |(own, _)| own.name.as_str().into()),
    Column::new("from", "that of the parameter", "lower end of its range; of a normal distribution, 0.1 % are below", |(own, _)| own.range[0].into()),
    Column::new("to", "that of the parameter", "upper end", |(own, _)| own.range[1].into()),
    Column::new("region_from", "that of the parameter", "smallest value that is not ruled out; empty if all are", |(own, _)| own.region.map(|[low, _]| value::significant_number(low, 4)).into()),
    Column::new("region_to", "that of the parameter", "largest value that is not ruled out", |(own, _)| own.region.map(|[_, high]| value::significant_number(high, 4)).into()),
    Column::new("left", "", "share of its distribution between these two", |(own, _)| value::significant_number(own.left, 3)),
    Column::new("best", "that of the parameter", "its value in the run that fits best", |(_, best)| (*best).into()),
];

#[rustfmt::skip]
const DATA: [Column<Datum>; 6] = [
    Column::new("of", "", "measured quantity", |own| own.of.into()),
    Column::new("measured", "that of the quantity", "measured value", |own| own.measured.clone()),
    Column::new("error", "that of the quantity", "its standard deviation, without the discrepancy", |own| own.error.into()),
    Column::new("best", "that of the quantity", "value of the run that fits best", |own| own.best.clone()),
    Column::new("region_from", "that of the quantity", "smallest value that emulators expect where nothing is ruled out", |own| own.band.map(|[low, _]| value::significant_number(low, 5)).into()),
    Column::new("region_to", "that of the quantity", "largest value", |own| own.band.map(|[_, high]| value::significant_number(high, 5)).into()),
];

/// The columns, for the page of columns.
pub(super) fn described() -> [FileColumns; 2] {
    [
        FileColumns::new(&["calibration.csv"], "A line is a free parameter of a calibration.", &FREE),
        FileColumns::new(
            &["calibration_data.csv"],
            "A line is a measured value, with its parameters.",
            &DATA,
        ),
    ]
}

impl Nearest {
    /// How far the place is from which measured value, as the end of a sentence.
    pub fn in_words(&self) -> String {
        let place: Vec<String> = self.place.iter().map(|(name, value)| assignment(name, value)).collect();
        let at = if place.is_empty() { String::new() } else { format!(" at {}", place.join(", ")) };
        if self.implausibility.is_infinite() {
            return match self.machine_squeals {
                Some(true) => format!("slides steadily{at}, where the machine squeals"),
                _ => format!("squeals{at}, where the machine does not"),
            };
        }
        let distance = value::significant(self.implausibility, 2);
        format!("is {distance} standard deviations away from {}{at}", self.of)
    }
}

impl Calibration {
    /// The tables.
    pub(super) fn tables(&self) -> Vec<FindingsTable> {
        let best = |at: usize| self.best.as_ref().map(|best| best.values[at]);
        let free: Vec<_> = self.free.iter().cloned().enumerate().map(|(at, own)| (own, best(at))).collect();
        let names: Vec<&str> = self
            .data
            .first()
            .map_or_else(Vec::new, |own| own.place.iter().map(|(name, _)| &**name).collect());
        let place = |name: &str| {
            let own = name.to_owned();
            let of = move |datum: &Datum| datum.place.iter().find(|(name, _)| *name == own).cloned();
            Column::made(parameters::head(name), move |datum| of(datum).map(|(_, value)| value).into())
        };
        let columns: Vec<Column<Datum>> = names.into_iter().map(place).chain(DATA).collect();
        vec![
            FindingsTable {
                heading: "Free parameters",
                meaning: "What the measured values leave of the ranges of the free parameters, and the run that fits best.",
                table: Table::of("calibration", &FREE, &free),
            },
            FindingsTable {
                heading: "Measured values",
                meaning: "Each measured value, that of the best run, and the range that the emulators expect inside the region.",
                table: Table::of("calibration_data", &columns, &self.data),
            },
        ]
    }

    /// The jobs of the best run and the measured points; none without a best run. The runs are points of several parameters, so that tables and
    /// figures of all of them would have a panel for each.
    pub(super) fn rows_of_best(&self, rows: &[JobRow]) -> Option<Vec<JobRow>> {
        let best = self.best.as_ref()?;
        let is_own = |row: &JobRow| {
            self.free.iter().zip(&best.values).all(|(free, value)| {
                let own = row.parameters.get(&free.name).and_then(Value::as_f64);
                own.is_some_and(|own| (own - value).abs() <= SAME_VALUE * value.abs())
            })
        };
        Some(rows.iter().filter(|row| row.is_measured() || is_own(row)).cloned().collect())
    }

    fn point(&self, values: &[f64]) -> String {
        let one = |(free, value): (&Free, &f64)| assignment(&free.name, &rounded(*value));
        self.free.iter().zip(values).map(one).collect::<Vec<_>>().join(", ")
    }

    /// What was found, in sentences.
    pub fn in_words(&self) -> Vec<String> {
        let mut words = Vec::new();
        let [missing, values] = self.without_values;
        let without_values = (missing > 0).then(|| {
            format!(
                "{missing} of {values} values of runs that squeal are missing, because these runs have no period; they rule out nothing."
            )
        });
        let has_emulator = self.checks.iter().any(|check| check.values > 0);
        let has_values = self.data.iter().any(|own| own.error.is_some());
        let is_no_answer = self.nearest.is_none()
            && self.points > 0
            && has_values
            && !has_emulator
            && self.share >= NOTHING_RULED_OUT;
        let too_few = "too few runs have a result for an emulator, so the measured values rule out nothing";
        if is_no_answer {
            words.push(format!("There is no usable answer yet: {too_few}."));
        }
        let all = format!("{} ({})", count(self.points as u64, "point"), count(self.jobs as u64, "job"));
        if let Some(nearest) = &self.nearest {
            words.push(format!(
                "No point of these ranges explains the data, after {all}. The nearest one, {}, {}.",
                self.point(&nearest.values),
                nearest.in_words()
            ));
        } else if self.points > 0 {
            let share = value::significant(100.0 * self.share, 2);
            words
                .push(format!("The data leave {share} % of the ranges of the free parameters, after {all}."));
            if has_values && !has_emulator {
                words.extend((!is_no_answer).then(|| format!("This is from squeal alone: {too_few}.")));
            } else if self.runs_that_fit == 0 {
                // An interval that no run has confirmed is not to be taken for a result.
                words.push(
                    "No run agrees with all data yet, so this region is only what emulators expect between the runs. More points would show \
                     whether a run does."
                        .to_owned(),
                );
            } else if !self.is_known {
                words.push("More points would make the region smaller.".to_owned());
            }
        }
        let verb = if self.runs_that_fit > 0 { "lies" } else { "could lie" };
        for free in &self.free {
            let Some([low, high]) = free.region else { continue };
            words.push(if free.left >= NOTHING_SAID {
                format!(
                    "The data say nearly nothing about {}: {} % of its range is left.",
                    free.name,
                    value::fixed(100.0 * free.left, 0)
                )
            } else {
                let [low, high] = [low, high].map(|x| in_words(&free.name, &rounded(x)));
                format!("{} {verb} between {low} and {high}.", free.name)
            });
        }
        for ([a, b], correlation) in &self.correlations {
            if correlation.abs() >= NOT_TOLD_APART {
                let [a, b] = [a, b].map(|at| &self.free[*at].name);
                let way = if *correlation > 0.0 { "a larger" } else { "a smaller" };
                words.push(format!(
                    "The data do not tell {a} and {b} apart: a larger {a} with {way} {b} explains them as well (correlation {}).",
                    value::fixed(*correlation, 2)
                ));
            }
        }
        words.extend(self.best.as_ref().map(|best| self.best_in_words(best)));
        for check in self.checks.iter().filter(|check| check.values > 0) {
            words.push(format!(
                "Of {} values of {} that were left out of the emulators, {} % lay within two standard deviations of what they expected.",
                check.values,
                check.of,
                value::fixed(100.0 * check.within_two as f64 / check.values as f64, 0)
            ));
        }
        words.extend(without_values);
        words.extend(self.unused_in_words());
        let [unknown, values] = self.unknown_mesh;
        if unknown > 0 {
            let counts = if unknown == values {
                "it is taken as zero, so that places may be ruled out wrongly; `mesh_error_unknown` in `jobs.csv` says why it is unknown"
            } else {
                "it counts as the largest one of the neighbours that know it"
            };
            words.push(format!(
                "The mesh error is unknown in {unknown} of {values} values of runs that squeal; there {counts}."
            ));
        }
        words
    }

    /// Measured values that rule nothing out, because no emulator has enough runs for them; `None` if there are none, or no emulator at all.
    fn unused_in_words(&self) -> Option<String> {
        let with_error = || self.data.iter().filter(|own| own.error.is_some());
        let place = |own: &Datum| {
            let at: Vec<String> = own.place.iter().map(|(name, value)| assignment(name, value)).collect();
            if at.is_empty() { own.of.to_owned() } else { format!("{} at {}", own.of, at.join(", ")) }
        };
        let unused: Vec<String> = with_error().filter(|own| own.band.is_none()).map(place).collect();
        let all = with_error().count();
        (self.nearest.is_none() && !unused.is_empty() && unused.len() < all).then(|| {
            format!(
                "{} of {} rule nothing out, because too few runs have such a value: {}.",
                unused.len(),
                count(all as u64, "measured value"),
                unused.join("; ")
            )
        })
    }

    fn best_in_words(&self, best: &Fit) -> String {
        let point = self.point(&best.values);
        let other = if best.other_state == 0 {
            String::new()
        } else {
            format!(
                ", and at {} it squeals where the machine does not, or the other way round",
                count(best.other_state as u64, "point")
            )
        };
        let distance = if best.compared == 0 {
            "has no value that was measured".to_owned()
        } else {
            format!(
                "is up to {} standard deviations away from the {} that it can be compared with (root mean square {})",
                value::significant(best.largest, 2),
                count(best.compared as u64, "value"),
                value::significant(best.root_mean_square, 2)
            )
        };
        let is_out =
            if best.is_ruled_out && self.nearest.is_none() { " It is ruled out itself." } else { "" };
        format!("The best run, {point}, {distance}{other}.{is_out}")
    }

    /// The answer for programs.
    pub fn as_json(&self) -> Value {
        let named = |of: &dyn Fn(usize, &Free) -> Value| -> Map<String, Value> {
            self.free.iter().enumerate().map(|(at, free)| (free.name.clone(), of(at, free))).collect()
        };
        let best = self.best.as_ref().map(|best| named(&|at, _| best.values[at].into()));
        let has_region = self.free.iter().any(|free| free.region.is_some());
        let region = has_region.then(|| named(&|_, free| json!(free.region)));
        json!({
            "best": best,
            "region": region,
            "ruled_out": 1.0 - self.share,
            "is_known": self.is_known,
            "largest_distance_of_best": self.best.as_ref().map(|best| best.largest),
            "wrong_states_of_best": self.best.as_ref().map(|best| best.other_state),
            "points": self.points,
            "jobs": self.jobs,
        })
    }
}

/// A value of a parameter for a reader.
fn rounded(x: f64) -> Value {
    value::significant_number(x, 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: an interval that no run has confirmed is not said to have the value.
    #[test]
    fn a_region_without_a_run_is_an_expectation() {
        let free = Free { name: "mu".to_owned(), region: Some([0.2, 0.3]), left: 0.1, ..Free::default() };
        let of = |runs_that_fit| {
            let own = Calibration {
                free: vec![free.clone()],
                points: 20,
                jobs: 60,
                share: 0.1,
                runs_that_fit,
                ..Calibration::default()
            };
            own.in_words().join("\n")
        };
        let (without, with) = (of(0), of(2));
        assert!(
            without.contains("No run agrees with all data yet")
                && without.contains("mu could lie between 0.2 and 0.3."),
            "{without}"
        );
        assert!(!with.contains("No run agrees") && with.contains("mu lies between 0.2 and 0.3."), "{with}");
    }

    /// Protects: a measured value for which too few runs have a value is named, because it rules nothing out.
    #[test]
    fn unused_values_are_named() {
        let datum = |omega: f64, band| Datum {
            place: vec![("omega_rpm".to_owned(), json!(omega))],
            of: "mu_star",
            measured: json!(0.3),
            error: Some(0.01),
            best: Value::Null,
            band,
        };
        let own = Calibration {
            data: vec![datum(50.0, Some([0.2, 0.3])), datum(400.0, None)],
            points: 20,
            ..Calibration::default()
        };
        let words = own.in_words();
        let said = "1 of 2 measured values rule nothing out, because too few runs have such a value: mu_star at ω = 400 rpm.";
        assert!(words.iter().any(|own| own == said), "{words:?}");
    }

    /// Protects: data that rule nothing out, because runs have no values, are not read as an answer: this is the first sentence. Where states or
    /// other values have ruled something out, there is an answer.
    #[test]
    fn no_answer_comes_first() {
        let datum = Datum {
            place: Vec::new(),
            of: "mu_star",
            measured: json!(0.3),
            error: Some(0.01),
            best: Value::Null,
            band: None,
        };
        let of = |share: f64, checked: usize| {
            let check = Check { of: "mu_star", values: checked, within_two: checked };
            let own = Calibration {
                data: vec![datum.clone()],
                points: 20,
                jobs: 20,
                share,
                checks: vec![check],
                without_values: [11, 20],
                ..Calibration::default()
            };
            own.in_words()
        };
        let nothing = of(1.0, 0);
        assert!(nothing[0].starts_with("There is no usable answer yet: too few runs"), "{nothing:?}");
        for known in [of(0.3, 0), of(1.0, 9), of(0.3, 9)] {
            assert!(known[0].starts_with("The data leave"), "{known:?}");
            assert!(known.iter().any(|words| words.starts_with("11 of 20 values")), "{known:?}");
            assert!(!known.iter().any(|words| words.contains("usable")), "{known:?}");
        }
    }
}
