//! Regions of a study's grid in which jobs are in trouble.

use super::cause::Cause;
use crate::publish::value;
use crate::report::parameters::{Parameters, assignment, range};
use serde::Serialize;
use serde_json::Value;
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};

/// Jobs that are connected in the grid and in trouble for the same cause.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Region {
    /// Number of these jobs.
    pub jobs: usize,
    /// Number of all jobs within the ranges of their parameters.
    pub of: usize,
    /// These ranges in words, without parameters that are equal in all jobs; empty if they cover the whole grid.
    pub place: String,
    /// The cause, with the numbers of the first of these jobs.
    #[serde(flatten)]
    pub cause: Cause,
    /// Key of the first of these jobs.
    pub example: String,
}

/// All regions of a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Regions {
    /// The largest regions, the largest first.
    pub largest: Vec<Region>,
    /// Number of the other regions.
    pub omitted: usize,
    /// Number of jobs in the other regions.
    pub jobs_in_omitted: usize,
}

/// The grid of a study: the values of its parameters, and a point for each row.
#[derive(Debug, Default)]
pub struct Grid {
    axes: Vec<GridAxis>,
    points: Vec<Vec<usize>>,
}

/// A parameter.
#[derive(Debug)]
struct GridAxis {
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
    /// Adds the next row.
    pub fn add(&mut self, parameters: &Parameters) {
        let mut point = vec![ABSENT; self.axes.len()];
        for (name, value) in parameters.iter() {
            let axis = self.axis(name);
            point.resize(self.axes.len(), ABSENT);
            point[axis] = self.axes[axis].number(value);
        }
        self.points.push(point);
    }

    fn axis(&mut self, name: &str) -> usize {
        self.axes.iter().position(|axis| axis.name == name).unwrap_or_else(|| {
            self.axes.push(GridAxis { name: name.to_owned(), values: Vec::new(), numbers: HashMap::new() });
            self.axes.len() - 1
        })
    }

    /// The regions of the rows in trouble, which are given by index, job key and cause. The `limit` largest ones are
    /// described.
    pub fn regions(
        mut self,
        troubled: impl IntoIterator<Item = (usize, String, Cause)>,
        limit: usize,
    ) -> Regions {
        self.sort();
        let mut causes: BTreeMap<(&'static str, String), Vec<Troubled>> = BTreeMap::new();
        for (index, job, cause) in troubled {
            // A study that is replaced while it is read may have more rows than before.
            let Some(point) = self.points.get(index) else { continue };
            let same = causes.entry((cause.what, cause.class.clone())).or_default();
            same.push(Troubled { point, job, cause });
        }
        let mut parts: Vec<Vec<&Troubled>> = causes.values().flat_map(|same| self.connected(same)).collect();
        // The sort is stable, so that equal studies have equal regions.
        parts.sort_by_key(|part| Reverse(part.len()));
        let rest = parts.split_off(limit.min(parts.len()));
        Regions {
            largest: parts.iter().map(|part| self.region(part)).collect(),
            omitted: rest.len(),
            jobs_in_omitted: rest.iter().map(Vec::len).sum(),
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

    /// Sorts the values of every parameter, so that neighbours have consecutive numbers.
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

    /// The connected parts of the jobs in trouble, each in the order of the rows.
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
                    // A step below 0 wraps around to an index that no point has.
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

    /// The steps from a point to its neighbours and to itself: by one value along any of the ordered parameters. With more
    /// than [`WITH_CORNERS`] of them, a step changes one parameter only, because the diagonals would be too many.
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
                name => range(name, first, last),
            }
        });
        words.collect::<Vec<_>>().join(", ")
    }
}

/// Up to so many ordered parameters, diagonal neighbours count: there are 3³ of them at most.
const WITH_CORNERS: usize = 3;

/// Stands for the number of a value that a point does not have.
const ABSENT: usize = usize::MAX;

impl GridAxis {
    /// The number of a value. The values 1 and 1.0 have the same number.
    fn number(&mut self, value: &Value) -> usize {
        let next = self.values.len();
        let number = *self.numbers.entry(value::text(value)).or_insert(next);
        if number == next {
            self.values.push(value.clone());
        }
        number
    }

    /// Whether the values are numbers. Only numbers have neighbours.
    fn is_ordered(&self) -> bool {
        self.values.iter().all(Value::is_number)
    }
}

fn is_within(point: &[usize], ranges: &[(usize, usize)]) -> bool {
    point.iter().zip(ranges).all(|(at, (low, high))| (low..=high).contains(&at))
}
