//! Regions of the grid of a study.

use super::cause::Cause;
use crate::publish::value;
use crate::report::parameters::{MU, OMEGA, assignment, is_further};
use serde_json::Value;
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};

/// Jobs that are neighbours in the grid and in trouble for the same cause.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Region {
    /// How many they are.
    pub jobs: usize,
    /// How many jobs there are between the smallest and the largest values of their parameters.
    pub of: usize,
    /// These values in words, of the parameters that are not the same in all jobs; empty if it is everywhere.
    pub place: String,
    /// What is wrong, in the words of the first of them.
    pub cause: Cause,
    /// The first of them.
    pub example: String,
}

/// All regions of a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Regions {
    /// The largest ones, the largest first.
    pub largest: Vec<Region>,
    /// How many more there are.
    pub more: usize,
    /// How many jobs are in these.
    pub jobs_in_more: usize,
}

/// The points of a study, one a row, and the values of its parameters.
#[derive(Debug, Default)]
pub struct Grid {
    axes: Vec<Axis>,
    points: Vec<Vec<usize>>,
}

/// A parameter.
#[derive(Debug)]
struct Axis {
    name: String,
    values: Vec<Value>,
    numbers: HashMap<String, usize>,
}

/// A job in trouble.
struct Troubled<'a> {
    point: &'a [usize],
    job: String,
    cause: Cause,
}

impl Grid {
    /// Adds the next row. ω and μ may be among the parameters as well.
    pub fn add(&mut self, omega_rpm: f64, mu: f64, parameters: &[(String, Value)]) {
        let own = [(OMEGA, Value::from(omega_rpm)), (MU, Value::from(mu))];
        let further = parameters.iter().map(|(name, value)| (name.as_str(), value));
        let further = further.filter(|(name, _)| is_further(name));
        let mut point = vec![ABSENT; self.axes.len()];
        for (name, value) in own.iter().map(|(name, value)| (*name, value)).chain(further) {
            let axis = self.axis(name);
            point.resize(self.axes.len(), ABSENT);
            point[axis] = self.axes[axis].number(value);
        }
        self.points.push(point);
    }

    fn axis(&mut self, name: &str) -> usize {
        self.axes.iter().position(|axis| axis.name == name).unwrap_or_else(|| {
            self.axes.push(Axis { name: name.to_owned(), values: Vec::new(), numbers: HashMap::new() });
            self.axes.len() - 1
        })
    }

    /// The regions of those rows that are in trouble (by place, with job and cause), the largest first, of which so many
    /// are looked at closely.
    pub fn regions(
        mut self,
        troubled: impl IntoIterator<Item = (usize, String, Cause)>,
        limit: usize,
    ) -> Regions {
        self.sort();
        let mut causes: BTreeMap<(&'static str, String), Vec<Troubled>> = BTreeMap::new();
        for (place, job, cause) in troubled {
            // A study that is replaced while it is read may have more rows than it had.
            let Some(point) = self.points.get(place) else { continue };
            let same = causes.entry((cause.what, cause.class.clone())).or_default();
            same.push(Troubled { point, job, cause });
        }
        let mut parts: Vec<Vec<&Troubled>> = causes.values().flat_map(|same| self.connected(same)).collect();
        // Stable: equal studies have equal regions.
        parts.sort_by_key(|part| Reverse(part.len()));
        let rest = parts.split_off(limit.min(parts.len()));
        Regions {
            largest: parts.iter().map(|part| self.region(part)).collect(),
            more: rest.len(),
            jobs_in_more: rest.iter().map(Vec::len).sum(),
        }
    }

    fn region(&self, part: &[&Troubled]) -> Region {
        let ranges: Vec<(usize, usize)> = (0..self.axes.len())
            .map(|axis| {
                let values = part.iter().map(|troubled| troubled.point[axis]);
                values.fold((usize::MAX, 0), |(low, high), at| (low.min(at), high.max(at)))
            })
            .collect();
        Region {
            jobs: part.len(),
            of: self.points.iter().filter(|point| is_within(point, &ranges)).count(),
            place: self.in_words(&ranges),
            cause: part[0].cause.clone(),
            example: part[0].job.clone(),
        }
    }

    /// Puts the values of every parameter into an order in which neighbours are near.
    fn sort(&mut self) {
        for point in &mut self.points {
            point.resize(self.axes.len(), ABSENT);
        }
        for (number, axis) in self.axes.iter_mut().enumerate() {
            for point in self.points.iter_mut().filter(|point| point[number] == ABSENT) {
                point[number] = axis.number(&Value::Null);
            }
            let rank = value::sort_numbers(&mut axis.values);
            for point in &mut self.points {
                point[number] = rank[point[number]];
            }
        }
    }

    /// The troubled in connected parts, each in the order of the rows.
    fn connected<'a, 'b>(&self, troubled: &'b [Troubled<'a>]) -> Vec<Vec<&'b Troubled<'a>>> {
        let mut at: HashMap<&[usize], Vec<usize>> = HashMap::new();
        for (index, job) in troubled.iter().enumerate() {
            at.entry(job.point).or_default().push(index);
        }
        let steps = self.steps();
        let mut neighbour = Vec::with_capacity(self.axes.len());
        let mut parts = Vec::new();
        let mut is_taken = vec![false; troubled.len()];
        for first in 0..troubled.len() {
            if is_taken[first] {
                continue;
            }
            is_taken[first] = true;
            let mut part = vec![first];
            let mut next = 0;
            while next < part.len() {
                let point = troubled[part[next]].point;
                next += 1;
                for step in &steps {
                    neighbour.clear();
                    // A place before the first is none.
                    neighbour.extend(point.iter().zip(step).map(|(at, by)| at.wrapping_add_signed(*by)));
                    for &index in at.get(neighbour.as_slice()).into_iter().flatten() {
                        if !std::mem::replace(&mut is_taken[index], true) {
                            part.push(index);
                        }
                    }
                }
            }
            part.sort_unstable();
            parts.push(part.into_iter().map(|index| &troubled[index]).collect());
        }
        parts
    }

    /// From a point to its neighbours, itself included: a place further along any of the ordered parameters, or along one
    /// of them where there are so many that the corners between them are too many to look at.
    fn steps(&self) -> Vec<Vec<isize>> {
        let ordered: Vec<usize> = (0..self.axes.len())
            .filter(|&axis| self.axes[axis].is_ordered() && self.axes[axis].values.len() > 1)
            .collect();
        let mut steps = vec![vec![0; self.axes.len()]];
        for &axis in &ordered {
            let from = if ordered.len() > WITH_CORNERS { 1 } else { steps.len() };
            for step in 0..from {
                for way in [-1, 1] {
                    let mut further = steps[step].clone();
                    further[axis] = way;
                    steps.push(further);
                }
            }
        }
        steps
    }

    fn in_words(&self, ranges: &[(usize, usize)]) -> String {
        let varying = self.axes.iter().zip(ranges).filter(|(axis, _)| axis.values.len() > 1);
        let is_everywhere = varying.clone().all(|(axis, &(low, high))| high - low + 1 == axis.values.len());
        if is_everywhere {
            return String::new();
        }
        let words = varying.map(|(axis, &(low, high))| {
            let [first, last] = [&axis.values[low], &axis.values[high]];
            match axis.name.as_str() {
                _ if low == high => assignment(&axis.name, first),
                OMEGA => format!("ω = {} … {} rpm", value::rounded_text(first), value::rounded_text(last)),
                MU => format!("μ = {} … {}", value::rounded_text(first), value::rounded_text(last)),
                name => format!("{name} = {} … {}", value::rounded_text(first), value::rounded_text(last)),
            }
        });
        words.collect::<Vec<_>>().join(", ")
    }
}

/// Up to so many parameters, neighbours across corners are neighbours: 3³ places around a point.
const WITH_CORNERS: usize = 3;

/// In place of a value's number where a point has none.
const ABSENT: usize = usize::MAX;

impl Axis {
    /// The number of a value; 1 and 1.0 are the same.
    fn number(&mut self, value: &Value) -> usize {
        let next = self.values.len();
        let number = *self.numbers.entry(value::text(value)).or_insert(next);
        if number == next {
            self.values.push(value.clone());
        }
        number
    }

    /// Whether the values are numbers, and so have neighbours.
    fn is_ordered(&self) -> bool {
        self.values.iter().all(Value::is_number)
    }
}

fn is_within(point: &[usize], ranges: &[(usize, usize)]) -> bool {
    point.iter().zip(ranges).all(|(at, (low, high))| (low..=high).contains(&at))
}
