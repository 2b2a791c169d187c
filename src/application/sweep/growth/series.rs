//! Jobs that differ in one parameter, and in those that move with it.

use crate::analysis::{JobRecord, Outcome, Regime};
use crate::report::{Along, JobRow};
use crate::study::{Job, Side, Study};
use indexmap::IndexMap;
use serde_json::Value;

/// What can be a point of a series.
pub trait Point {
    /// Its parameters, in the order of the study.
    fn parameters(&self) -> &[(String, Value)];
    /// Whether the study's author asked for it.
    fn is_given(&self) -> bool;
}

impl Point for JobRow {
    fn parameters(&self) -> &[(String, Value)] {
        self.parameters.of_grid()
    }

    fn is_given(&self) -> bool {
        self.wave == 0
    }
}

impl Point for Job {
    fn parameters(&self) -> &[(String, Value)] {
        &self.parameters
    }

    fn is_given(&self) -> bool {
        true
    }
}

/// The way along a parameter that the study varies. The parameters of a zip move together.
pub fn along(study: &Study, parameter: &str) -> Along {
    let zipped: Vec<&str> = study.zipped().iter().map(|own| own.name).collect();
    let with = zipped.iter().filter(|name| zipped.contains(&parameter) && **name != parameter);
    Along { parameter: parameter.to_owned(), with: with.map(|name| (*name).to_owned()).collect() }
}

/// The points of a study that differ along one way alone, from its smallest value to its largest.
#[derive(Debug)]
pub struct Series<'a, P> {
    along: &'a Along,
    /// The parameters that do not change, with their values.
    pub rest: Vec<(String, Value)>,
    pub points: Vec<(f64, &'a P)>,
    /// Those that the study's author asked for.
    given: Vec<(f64, &'a P)>,
}

/// The series along a way by their names, in the order of their first points. Points without a number there are in none.
pub fn series_along<'a, P: Point>(points: &'a [P], along: &'a Along) -> IndexMap<String, Series<'a, P>> {
    let mut found: IndexMap<String, Series<'a, P>> = IndexMap::new();
    for point in points {
        let Some(at) = position(along, point.parameters()) else { continue };
        let rest = rest(along, point.parameters());
        let series = found.entry(name(&rest));
        let new = || Series { along, rest, points: Vec::new(), given: Vec::new() };
        series.or_insert_with(new).points.push((at, point));
    }
    for series in found.values_mut() {
        Along::sort(&mut series.points, |point| point.is_given());
        // The points of a zip at one place differ in what moves with it.
        if along.with.is_empty() {
            series.points.dedup_by_key(|(at, _)| at.to_bits());
        }
        series.given = series.points.iter().filter(|(_, point)| point.is_given()).copied().collect();
    }
    found
}

/// The value along a way.
pub fn position(along: &Along, parameters: &[(String, Value)]) -> Option<f64> {
    parameters.iter().find(|(name, _)| *name == along.parameter).and_then(|(_, value)| value.as_f64())
}

/// The parameters that do not change along a way.
pub fn rest(along: &Along, parameters: &[(String, Value)]) -> Vec<(String, Value)> {
    parameters.iter().filter(|(name, _)| !along.moves(name)).cloned().collect()
}

/// A name that no other series has.
pub fn name(rest: &[(String, Value)]) -> String {
    serde_json::to_string(rest).unwrap_or_default()
}

impl<P: Point> Series<'_, P> {
    /// Whether it has two points that the study's author asked for. A point that was added to one series is no beginning of another.
    pub fn is_given(&self) -> bool {
        self.given.len() >= 2
    }

    /// The distance of the points around an interval that the study's author asked for.
    pub fn width_given(&self, [low, high]: [f64; 2]) -> f64 {
        let places = || self.given.iter().map(|(at, _)| *at);
        let above = places().find(|at| *at >= high).unwrap_or(high);
        above - places().rfind(|at| *at <= low).unwrap_or(low)
    }

    /// The values of the parameters at a place. Parameters that move together keep doing so: between two given points each of them
    /// has its share of the way. None outside of them, and where one of them has no values in between.
    pub fn at(&self, x: f64) -> Option<Vec<(String, Value)>> {
        let along = self.along;
        if along.with.is_empty() {
            let (_, first) = self.given.first()?;
            let place = first.parameters().iter().position(|(name, _)| *name == along.parameter);
            let mut parameters = self.rest.clone();
            parameters.insert(place?, (along.parameter.clone(), x.into()));
            return Some(parameters);
        }
        let above = self.given.iter().position(|(at, _)| *at >= x)?;
        let (high, upper) = self.given[above];
        let (low, lower) = self.given[above.saturating_sub(1)];
        if x < low {
            return None;
        }
        let share = if high > low { (x - low) / (high - low) } else { 0.0 };
        let moved = |((name, from), (_, to)): (&(String, Value), &(String, Value))| {
            let value = if *name == along.parameter {
                x.into()
            } else if !along.moves(name) || from == to {
                from.clone()
            } else if x == high {
                to.clone()
            } else {
                let (from, to) = (from.as_f64()?, to.as_f64()?);
                (from + share * (to - from)).into()
            };
            Some((name.clone(), value))
        };
        lower.parameters().iter().zip(upper.parameters()).map(moved).collect()
    }

    /// The points with a value, and the positions of those without one.
    pub fn known<T>(&self, value: impl Fn(&P) -> Option<T>) -> (Vec<(f64, T)>, Vec<f64>) {
        let mut unknown = Vec::new();
        let mut known = Vec::new();
        for (x, point) in &self.points {
            match value(point) {
                Some(value) => known.push((*x, value)),
                None => unknown.push(*x),
            }
        }
        (known, unknown)
    }
}

/// The kind of a job on one side of a boundary, with the growth rate \[1/s\] that tells how far the boundary is.
#[derive(Debug, Clone, PartialEq)]
pub struct Kind {
    pub name: String,
    pub rate_per_s: Option<f64>,
}

/// The kind of a job; none if it is not known.
pub fn kind(row: &JobRow, side: Side) -> Option<Kind> {
    let record = row.record();
    match side {
        Side::Stability => {
            let of_mode = record?.stability.as_ref().and_then(|own| own.modes.first());
            let of_mode = of_mode.map(|mode| mode.growth_rate_per_s);
            let is_stable = of_mode.map(|rate| rate < 0.0).or_else(|| is_stable(record?))?;
            // The rate of a run counts if it says the same.
            let of_run = record?.growth_rate_per_s.filter(|rate| (*rate < 0.0) == is_stable);
            let name = if is_stable { "stable" } else { "unstable" }.to_owned();
            Some(Kind { name, rate_per_s: of_mode.or(of_run) })
        }
        Side::Regime => {
            let regime = record?.regime;
            (regime != Regime::Undecided).then(|| Kind { name: regime.name().to_owned(), rate_per_s: None })
        }
        Side::Status => {
            record?;
            Some(Kind { name: row.status().to_owned(), rate_per_s: None })
        }
    }
}

/// Whether the run says that sliding is stable; none if it says neither.
fn is_stable(record: &JobRecord) -> Option<bool> {
    match (record.outcome, record.regime) {
        (Outcome::Decayed, _) => Some(true),
        (Outcome::NotPeriodic | Outcome::Completed, Regime::Undecided | Regime::Stable) => None,
        (Outcome::Periodic | Outcome::Unstable | Outcome::NotPeriodic | Outcome::Completed, _) => Some(false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study(text: &str) -> Study {
        Study::parse(&format!("{{ \"name\": \"s\", {text} }}"), "s.json").unwrap()
    }

    /// Protects: the values of a zip move together, and so do those of a point in between: none belongs to another problem. Outside of
    /// the list there is no point, and its points themselves keep their values.
    #[test]
    fn a_zip_moves_together() {
        let study = study(
            r#""samples": { "zip": { "mu": [0.1, 0.3], "load_n": [10, 30] } }, "grid": { "omega_rpm": [7] }"#,
        );
        let along = along(&study, "mu");
        let jobs = study.expand("v").unwrap();
        let series = series_along(&jobs, &along);
        let [series] = &series.values().collect::<Vec<_>>()[..] else { panic!("one series") };
        assert_eq!(series.rest, [("omega_rpm".to_owned(), 7.0.into())]);
        let at = |x: f64| {
            let job = study.job_at(&series.at(x)?, "v")?;
            Some((job.spec.scene.contact.mu, job.spec.scene.load.force_n, job.key))
        };
        let (mu, force_n, _) = at(0.15).unwrap();
        assert!(mu == 0.15 && (force_n - 15.0).abs() < 1.0e-12, "{force_n}");
        assert_eq!(at(0.3).unwrap(), (0.3, 30.0, jobs[1].key.clone()));
        assert_eq!((at(0.05), at(0.31)), (None, None));
    }

    /// Protects: a zip may have a value twice, with others that differ. All its points stay, and a point in between is between its
    /// neighbours of the list.
    #[test]
    fn a_value_of_a_zip_may_be_there_twice() {
        let zips =
            [("[0.1, 0.3, 0.3, 0.5]", "[10, 30, 50, 70]"), ("[0.5, 0.3, 0.3, 0.1]", "[70, 50, 30, 10]")];
        for (mu, load_n) in zips {
            let study = study(&format!(r#""samples": {{ "zip": {{ "mu": {mu}, "load_n": {load_n} }} }}"#));
            let along = along(&study, "mu");
            let jobs = study.expand("v").unwrap();
            let series = &series_along(&jobs, &along)[0];
            assert_eq!(series.points.len(), 4);
            for (x, expected) in [0.1, 0.2, 0.4, 0.5].into_iter().zip([10.0, 20.0, 60.0, 70.0]) {
                let parameters = series.at(x).unwrap();
                let found =
                    position(&Along { parameter: "load_n".to_owned(), with: Vec::new() }, &parameters);
                assert!((found.unwrap() - expected).abs() < 1.0e-9, "{mu}: {found:?}, not {expected}");
            }
        }
    }

    /// Protects: a series is what differs along one parameter alone, and a point of it has the parameters in the order of the study.
    #[test]
    fn a_series_differs_in_one_parameter() {
        let study = study(r#""grid": { "omega_rpm": [5, 7], "mu": [0.2, 0.1], "load_n": [30] }"#);
        let along = along(&study, "mu");
        let jobs = study.expand("v").unwrap();
        let found = series_along(&jobs, &along);
        assert_eq!(found.len(), 2);
        let places: Vec<f64> = found[0].points.iter().map(|(at, _)| *at).collect();
        assert_eq!(places, [0.1, 0.2]);
        let point = found[1].at(0.15).unwrap();
        let names: Vec<&str> = point.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["omega_rpm", "mu", "load_n"]);
        assert_eq!(point[1].1, 0.15);
    }
}
