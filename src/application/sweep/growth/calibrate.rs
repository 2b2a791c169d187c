//! The waves of a calibration, and what it has found.
//!
//! A place of [`calibration`](crate::calibration) is the share of each free parameter's distribution below its value. The quantities are μ* and
//! the logarithm of the frequency, whose errors are shares.

use crate::analysis::{JobRecord, MeshError, Outcome, Regime};
use crate::calibration::{self, Assessment, Computed, History, LOG_FREQUENCY, Measured, Region, Run, Target};
use crate::publish::value::significant_number;
use crate::report::{Calibration, Check, Datum, FREQUENCY, Fit, Free, JobRow, MU_STAR, Nearest};
use crate::study::{Calibrate, FreeParameter, MeasuredPoint, Spacing, Study, sobol_points};
use indexmap::IndexMap;
use serde_json::Value;

/// Why jobs of a wave are added.
pub(super) const PURPOSE: &str = "calibration";

/// The bounds of mesh errors hold for 95 % of jobs: they are two standard deviations.
const DEVIATIONS_OF_BOUND: f64 = 2.0;

/// The first seed of candidates. Those of a study's own points are small.
const SEED: u64 = 0x0ca1_1b4a;

/// Values of the region in a report.
const SHOWN: usize = 400;

/// The name of whether a point squeals, as in files of measured points.
const SQUEALS: &str = "squeals";

/// The shares of a distribution that are shown as its ends where it has none.
const ENDS: [f64; 2] = [0.001, 0.999];

/// A calibration with the results so far.
struct Known<'a> {
    study: &'a Study,
    settings: &'a Calibrate,
    free: Vec<FreeParameter>,
    history: History,
    region: Region,
}

/// What the next wave is.
pub(super) enum Next {
    /// Points, each with all parameters that the study varies.
    Points(Vec<Vec<(String, Value)>>),
    /// Nothing more, for this reason.
    Ended(String),
}

/// The next points of a calibration.
pub(super) fn next(study: &Study, settings: &Calibrate, rows: &[JobRow]) -> Next {
    let known = Known::of(study, settings, rows);
    let (history, region) = (&known.history, &known.region);
    if history.runs().is_empty() {
        return Next::Ended("no point has a result".to_owned());
    }
    if region.inside.is_empty() {
        return Next::Ended("no point of these ranges explains the data".to_owned());
    }
    if history.is_known(region) {
        return Next::Ended(
            "the errors of the emulators are small enough in the region that is left".to_owned(),
        );
    }
    let points = points(rows, &known.free).len();
    let room = settings.most_points(known.free.len()).saturating_sub(points);
    if room == 0 {
        return Next::Ended(format!("the budget of {points} points is used up"));
    }
    let places = history.next(region, settings.wave_points.min(room));
    if places.is_empty() {
        return Next::Ended("the region that is left is full of points".to_owned());
    }
    Next::Points(places.iter().flat_map(|place| known.jobs_at(place)).collect())
}

/// What a calibration has found.
pub(super) fn found(study: &Study, settings: &Calibrate, rows: &[JobRow]) -> Calibration {
    Known::of(study, settings, rows).found(rows)
}

/// The implausibility of a point, and the one above which it is ruled out; none if a free parameter has no value.
pub(super) fn implausibility(
    study: &Study,
    settings: &Calibrate,
    rows: &[JobRow],
    point: &[(String, f64)],
) -> Option<(Nearest, f64)> {
    let known = Known::of(study, settings, rows);
    // The order of the parameters is that of the stored study.
    let share = |own: &FreeParameter| {
        let value = point.iter().find(|(name, _)| name == own.parameter.name).map(|(_, value)| *value);
        value.map(|value| own.share(value))
    };
    let place = known.free.iter().map(share).collect::<Option<Vec<f64>>>()?;
    Some((known.most_implausible(&place, &known.history.at(&place)), known.history.cutoff()))
}

/// The rows of each point of the free parameters, by their values.
fn points<'a>(rows: &'a [JobRow], free: &[FreeParameter]) -> IndexMap<Vec<u64>, Vec<&'a JobRow>> {
    let mut found: IndexMap<Vec<u64>, Vec<&JobRow>> = IndexMap::new();
    for row in rows {
        let values = free.iter().map(|own| row.parameters.get(own.parameter.name).and_then(Value::as_f64));
        if let Some(values) = values.map(|value| value.map(f64::to_bits)).collect::<Option<Vec<_>>>() {
            found.entry(values).or_default().push(row);
        }
    }
    // The order of rows is that of the database.
    found.sort_unstable_keys();
    found
}

fn place_of(point: &MeasuredPoint) -> Vec<(String, Value)> {
    point.at.iter().map(|(name, value)| (name.clone(), value.clone())).collect()
}

fn target(point: &MeasuredPoint, settings: &Calibrate) -> Target {
    let measured = |value: f64, error: f64, discrepancy: f64| Measured {
        value,
        deviation: (error.powi(2) + discrepancy.powi(2)).sqrt(),
    };
    let discrepancy = settings.discrepancy;
    let mu_star = point.mu_star.zip(point.mu_star_error);
    let frequency = point.frequency_hz.zip(point.frequency_error_hz);
    Target {
        squeals: point.squeals(),
        values: [
            mu_star.map(|(value, error)| measured(value, error, discrepancy.mu_star * value)),
            frequency.map(|(hz, error)| measured(libm::log(hz), error / hz, discrepancy.frequency)),
        ],
    }
}

/// What a run gave, as quantities. A run that is not periodic squeals, but its averages are no results.
fn outcome(record: &JobRecord, mesh: Option<MeshError>) -> calibration::Outcome {
    let squeals = match record.outcome {
        Outcome::Periodic | Outcome::Unstable => Some(true),
        Outcome::Decayed => Some(false),
        Outcome::NotPeriodic => {
            (!matches!(record.regime, Regime::Stable | Regime::Undecided)).then_some(true)
        }
        Outcome::Completed => None,
    };
    let is_settled = matches!(record.outcome, Outcome::Periodic | Outcome::Decayed);
    let mu_star = is_settled.then(|| Computed {
        value: record.mu_star,
        mesh_deviation: mesh.map(|mesh| mesh.mu_star / DEVIATIONS_OF_BOUND),
    });
    let frequency = record.frequency_hz.filter(|_| record.outcome == Outcome::Periodic).map(|hz| Computed {
        value: libm::log(hz),
        mesh_deviation: mesh
            .and_then(|mesh| mesh.frequency_hz)
            .map(|error_hz| error_hz / DEVIATIONS_OF_BOUND / hz),
    });
    calibration::Outcome { squeals, values: [mu_star, frequency] }
}

impl<'a> Known<'a> {
    fn of(study: &'a Study, settings: &'a Calibrate, rows: &[JobRow]) -> Self {
        let free = study.free_parameters();
        let at = |row: &JobRow, point: &MeasuredPoint| {
            let is_equal = |(name, value): (&String, &Value)| {
                row.parameters.get(name).and_then(Value::as_f64) == value.as_f64()
                    && (value.is_number() || row.parameters.get(name) == Some(value))
            };
            point.at.iter().all(is_equal)
        };
        let run = |rows: Vec<&JobRow>| {
            let place = free.iter().map(|own| {
                own.share(rows[0].parameters.get(own.parameter.name).and_then(Value::as_f64).unwrap_or(0.0))
            });
            let outcomes = settings.data.iter().map(|point| {
                let row = rows.iter().find(|row| at(row, point))?;
                Some(outcome(row.record()?, row.mesh_error()))
            });
            Run { place: place.collect(), outcomes: outcomes.collect() }
        };
        let runs = points(rows, &free).into_values().map(run);
        let runs: Vec<Run> = runs.filter(|run| run.outcomes.iter().any(Option::is_some)).collect();
        let targets = settings.data.iter().map(|point| target(point, settings)).collect();
        let history = History::new(runs, targets);
        let parameters = free.len();
        let region = history.region(
            |number, count| sobol_points(count, parameters, SEED + number as u64),
            |place| free.iter().zip(place).all(|(own, share)| own.is_possible(*share)),
        );
        Self { study, settings, free, history, region }
    }

    fn values(&self, place: &[f64]) -> Vec<f64> {
        let value = |(own, share): (&FreeParameter, &f64)| own.value(*share).as_f64().unwrap_or(f64::NAN);
        self.free.iter().zip(place).map(value).collect()
    }

    /// The parameters of all jobs of a place: one for each combination of the study's axes.
    fn jobs_at(&self, place: &[f64]) -> Vec<Vec<(String, Value)>> {
        let free: Vec<(String, Value)> = self
            .free
            .iter()
            .zip(place)
            .map(|(own, share)| (own.parameter.name.to_owned(), own.value(*share)))
            .collect();
        let mut jobs = vec![free];
        for (parameter, values) in self.study.axes() {
            let with = |job: &Vec<(String, Value)>, value: &Value| {
                job.iter().cloned().chain([(parameter.name.to_owned(), value.clone())]).collect()
            };
            jobs = jobs.iter().flat_map(|job| values.iter().map(move |value| with(job, value))).collect();
        }
        jobs
    }

    fn found(&self, rows: &[JobRow]) -> Calibration {
        let Self { study, history, region, .. } = self;
        let extent = region.extent();
        let free = self.free.iter().enumerate().map(|(at, own)| {
            let number = |share: f64| own.value(share).as_f64().unwrap_or(f64::NAN);
            let ends = if own.has_ends() { [0.0, 1.0] } else { ENDS };
            let region = extent.get(at).copied();
            Free {
                name: own.parameter.name.to_owned(),
                range: ends.map(number),
                is_log: study.spacing(own.parameter.name) == Some(Spacing::Log),
                region: region.map(|ends| ends.map(number)),
                left: region.map_or(0.0, |[low, high]| high - low),
            }
        });
        let best = self.best_run();
        let points = points(rows, &self.free);
        let of_quantity = [MU_STAR.name, FREQUENCY.name];
        let checks = history.checks().into_iter().zip(of_quantity);
        let pairs = (0..self.free.len()).flat_map(|b| (0..b).map(move |a| [a, b]));
        let nearest = region
            .best
            .as_ref()
            .filter(|_| region.inside.is_empty())
            .map(|own| self.most_implausible(&own.place, &own.at));
        let step = region.inside.len().div_ceil(SHOWN).max(1);
        Calibration {
            free: free.collect(),
            data: self.data(best.as_ref().map(|(run, _)| *run)),
            share: region.share,
            points: points.len(),
            jobs: rows.len(),
            best: best.map(|(_, fit)| fit),
            runs_that_fit: history.runs_that_fit(),
            nearest,
            correlations: pairs.map(|[a, b]| ([a, b], region.correlation(a, b))).collect(),
            inside: region.inside.iter().step_by(step).map(|own| self.values(&own.place)).collect(),
            run: history.runs().iter().map(|run| self.values(&run.place)).collect(),
            checks: checks
                .map(|(own, of)| Check { of, values: own.values, within_two: own.within_two })
                .collect(),
            is_known: history.is_known(region),
            unknown_mesh: self.unknown_mesh(),
            without_values: self.without_values(),
        }
    }

    /// The run that fits best.
    fn best_run(&self) -> Option<(&Run, Fit)> {
        let (number, own) = self.history.best_run()?;
        let run = &self.history.runs()[number];
        let fit = Fit {
            values: self.values(&run.place),
            largest: own.largest,
            root_mean_square: (own.square_sum / own.compared.max(1) as f64).sqrt(),
            compared: own.compared,
            other_state: own.other_state,
            is_ruled_out: self.history.is_ruled_out(&own),
        };
        Some((run, fit))
    }

    /// The measured values with what the simulation gives: one entry for each quantity of each point, or for whether it squeals.
    fn data(&self, best: Option<&Run>) -> Vec<Datum> {
        let mut found = Vec::new();
        for (number, point) in self.settings.data.iter().enumerate() {
            let place = place_of(point);
            let outcome = best.and_then(|run| run.outcomes[number].as_ref());
            let given = [
                (MU_STAR.name, point.mu_star, point.mu_star_error),
                (FREQUENCY.name, point.frequency_hz, point.frequency_error_hz),
            ];
            for (quantity, (of, measured, error)) in given.into_iter().enumerate() {
                let Some(measured) = measured else { continue };
                let in_unit = |x: f64| if quantity == LOG_FREQUENCY { libm::exp(x) } else { x };
                let means = self.region.inside.iter().filter_map(|own| own.at[number].values[quantity]);
                let ends = means.fold(None, |ends: Option<[f64; 2]>, own| {
                    let [low, high] = ends.unwrap_or([own.mean; 2]);
                    Some([low.min(own.mean), high.max(own.mean)])
                });
                found.push(Datum {
                    place: place.clone(),
                    of,
                    measured: measured.into(),
                    error,
                    best: outcome
                        .and_then(|own| own.values[quantity])
                        .map(|own| significant_number(in_unit(own.value), 5))
                        .into(),
                    band: ends.map(|ends| ends.map(in_unit)),
                });
            }
            // A frequency says it, too.
            if point.frequency_hz.is_none() && point.squeals.is_some() {
                let word = |own: bool| Value::from(if own { "yes" } else { "no" });
                let measured = point.squeals.map(word).unwrap_or_default();
                let best = outcome.and_then(|own| own.squeals).map(word).unwrap_or_default();
                found.push(Datum { place, of: SQUEALS, measured, error: None, best, band: None });
            }
        }
        found
    }

    /// What speaks most against a place: the measured value with the largest implausibility, or whether it squeals.
    fn most_implausible(&self, place: &[f64], at: &[Assessment]) -> Nearest {
        let mut worst: Option<(f64, usize, &'static str)> = None;
        for (number, (at, target)) in at.iter().zip(self.history.targets()).enumerate() {
            let of_values =
                [MU_STAR.name, FREQUENCY.name].into_iter().enumerate().filter_map(|(quantity, of)| {
                    Some((at.values[quantity]?.implausibility(&target.values[quantity]?), of))
                });
            let of_state = at.is_other_state.then_some((f64::INFINITY, SQUEALS));
            for (distance, of) in of_values.chain(of_state) {
                if worst.is_none_or(|worst| distance > worst.0) {
                    worst = Some((distance, number, of));
                }
            }
        }
        let (implausibility, number, of) = worst.unwrap_or((0.0, 0, SQUEALS));
        Nearest {
            values: self.values(place),
            implausibility,
            of,
            place: place_of(&self.settings.data[number]),
            machine_squeals: self.history.targets()[number].squeals,
        }
    }

    /// Values of runs that squeal whose mesh error is not known, of those that are compared with measured ones.
    fn unknown_mesh(&self) -> [usize; 2] {
        self.count_of_squealing(|own| Some(own?.mesh_deviation.is_none()))
    }

    /// Measured values that runs which squeal do not have, and all that they could have.
    fn without_values(&self) -> [usize; 2] {
        self.count_of_squealing(|own| Some(own.is_none()))
    }

    /// The measured values of runs that squeal for which `is_counted` is true, and those for which it is not `None`.
    fn count_of_squealing(&self, is_counted: fn(Option<&Computed>) -> Option<bool>) -> [usize; 2] {
        let mut found = [0; 2];
        for run in self.history.runs() {
            for (outcome, target) in run.outcomes.iter().zip(self.history.targets()) {
                let Some(outcome) = outcome.as_ref().filter(|own| own.squeals == Some(true)) else {
                    continue;
                };
                for (own, _) in outcome.values.iter().zip(&target.values).filter(|(_, own)| own.is_some()) {
                    let Some(is_counted) = is_counted(own.as_ref()) else { continue };
                    found[0] += usize::from(is_counted);
                    found[1] += 1;
                }
            }
        }
        found
    }
}
