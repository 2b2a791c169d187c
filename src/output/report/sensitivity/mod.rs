//! What the results of a study depend on: sensitivity indices of its parameters, from its own points.

mod design;
mod indices;
mod movers;
mod parameter;
mod tables;
mod types;

pub use design::Design;
pub(super) use movers::{Mover, movers};
pub(super) use tables::{MainIndex, described};
pub use tables::{indices_table, markdown, page};
pub use types::{Index, Indices, REGIME, Sensitivity};

use super::parameters::{head, parameter_names};
use super::row::{JobRow, RowState};
use super::scalar::Scalar;
use super::trouble::doubts_in_words;
use crate::publish::table::{Column, Head, Table};
use crate::publish::value;
use crate::random::SplitMix64;
use design::{Estimator, design_of, estimator};
use indexmap::IndexMap;
use indices::{first_order, levels, of_classes, of_levels, on_grid, pawn, slices};
use parameter::Parameter;
use std::collections::BTreeMap;

/// Number of resamples for confidence intervals.
const RESAMPLES: usize = 200;

/// The share of its range by which a parameter changes in a Morris design.
const MORRIS_STEP: f64 = 2.0 / 3.0;

/// The sensitivities of some numbers, and of the regime, to all parameters that vary between the jobs that ended. They are the same in
/// every call. Jobs that the program added where something happens (waves) do not count: they are no sample. `is_morris` says that the rows
/// are those of a Morris design, in its order.
pub fn sensitivities(rows: &[JobRow], of: &[&'static Scalar], is_morris: bool) -> Vec<Sensitivity> {
    let asked: Vec<&JobRow> = rows.iter().filter(|row| row.wave == 0).collect();
    let ended = |row: &&JobRow| matches!(row.state, RowState::Done(_) | RowState::Failed { .. });
    let rows: Vec<&JobRow> = asked.iter().copied().filter(ended).collect();
    let points =
        Points { parameters: parameters(&rows), unfinished: asked.len() - rows.len(), rows, is_morris };
    let mut found: Vec<Sensitivity> = of.iter().map(|scalar| points.of_scalar(scalar)).collect();
    found.push(points.of_regimes());
    found
}

fn parameters(rows: &[&JobRow]) -> Vec<Parameter> {
    let names = parameter_names(rows.iter().map(|row| &row.parameters));
    let parameter = |name: &str| {
        let mut known: Vec<String> = Vec::new();
        let given: Vec<_> = rows.iter().map(|row| row.parameter(name)).collect();
        let is_number = given.iter().all(serde_json::Value::is_number);
        let number = |given: &serde_json::Value| {
            if let (true, Some(number)) = (is_number, given.as_f64()) {
                return number;
            }
            let text = value::text(given);
            let place = known.iter().position(|own| *own == text).unwrap_or(known.len());
            if place == known.len() {
                known.push(text);
            }
            place as f64
        };
        let values: Vec<f64> = given.iter().map(number).collect();
        let varies = values.iter().any(|value| *value != values[0]);
        varies.then(|| Parameter { name: name.to_owned(), is_number, values })
    };
    names.into_iter().filter_map(parameter).collect()
}

/// The jobs that ended, with the parameters that vary.
struct Points<'a> {
    rows: Vec<&'a JobRow>,
    parameters: Vec<Parameter>,
    /// Jobs that have not ended.
    unfinished: usize,
    is_morris: bool,
}

/// What the indices of one quantity are computed from: positions of rows and what they are.
struct Basis {
    points: Vec<usize>,
    design: Design,
}

impl Points<'_> {
    fn basis(&self, points: Vec<usize>) -> Basis {
        let design = if self.is_morris {
            Design::Unknown(
                "the points of a Morris design follow each other, so they are no sample; it has effects"
                    .to_owned(),
            )
        } else {
            match &*self.parameters {
                [only] => {
                    Design::Unknown(format!("only {} varies, so everything depends on it alone", only.name))
                }
                parameters => design_of(parameters, &points),
            }
        };
        Basis { points, design }
    }

    /// The number of jobs that are not among so many points.
    fn missing(&self, points: usize) -> usize {
        self.rows.len() + self.unfinished - points
    }

    /// The values of a parameter at the points.
    fn column(basis: &Basis, parameter: &Parameter) -> Vec<f64> {
        basis.points.iter().map(|&at| parameter.values[at]).collect()
    }

    /// The points of each combination of all parameters but one.
    fn without(&self, basis: &Basis, parameter: &Parameter) -> Vec<Vec<usize>> {
        let mut groups: IndexMap<Vec<u64>, Vec<usize>> = IndexMap::new();
        for (place, &at) in basis.points.iter().enumerate() {
            let others = self.parameters.iter().filter(|other| other.name != parameter.name);
            groups.entry(others.map(|other| other.values[at].to_bits()).collect()).or_default().push(place);
        }
        groups.into_values().collect()
    }

    fn of_scalar(&self, scalar: &Scalar) -> Sensitivity {
        let with_value: Vec<(usize, f64)> = self
            .rows
            .iter()
            .enumerate()
            .filter_map(|(at, row)| Some((at, scalar.settled_value(row)?)))
            .collect();
        let y: Vec<f64> = with_value.iter().map(|(_, y)| *y).collect();
        let mut basis = self.basis(with_value.iter().map(|(at, _)| *at).collect());
        if !self.is_morris && y.len() > 1 && is_constant(&y) {
            basis.design = Design::Unknown("it is the same at all points".to_owned());
        }
        let mut remarks: Vec<String> = self.doubtful(&basis.points).into_iter().collect();
        let last = |slices: &[Vec<usize>], points: &[usize]| {
            let own: Vec<f64> = points.iter().map(|&at| y[at]).collect();
            pawn(slices, &own)
        };
        let (last, chance) = self.last_indices(&basis, last, &mut remarks);
        let indices = |(parameter, pawn): (&Parameter, Option<Index>)| {
            let x = Self::column(&basis, parameter);
            let levels_of_x = levels(&x);
            let [mut main, mut total] = [None, None];
            match basis.design {
                // A parameter of which one value is left decides nothing here.
                Design::Grid(_) if levels_of_x.len() == 1 => {}
                Design::Grid(_) => {
                    let found = on_grid(&levels_of_x, &self.without(&basis, parameter), &y);
                    [main, total] =
                        found.map_or([None; 2], |found| found.map(|index| Some(Index::exact(index))));
                }
                Design::Sample => match estimator(&parameter.name, parameter.is_number, &x) {
                    Ok(estimator) => main = estimated(&estimator, &x, &y),
                    Err(why) => remarks.push(format!("{why}, so it has no first-order index.")),
                },
                Design::Unknown(_) => {}
            }
            let effects = self.is_morris.then(|| self.elementary_effects(parameter, scalar));
            Indices {
                name: parameter.name.clone(),
                first_order: main,
                total,
                pawn,
                effects: effects.and_then(|effects| of_effects(&effects)),
            }
        };
        let parameters = self.parameters.iter().zip(last).map(indices).collect();
        Sensitivity {
            of: scalar.name.to_owned(),
            points: y.len(),
            missing: self.missing(y.len()),
            design: basis.design,
            parameters,
            remarks,
            chance,
        }
    }

    /// Which results count although they should be doubted, in a sentence; `None` if there are none.
    fn doubtful(&self, points: &[usize]) -> Option<String> {
        let words = doubts_in_words(points.iter().map(|&at| self.rows[at]), true)?;
        Some(format!("{words} They count here."))
    }

    fn of_regimes(&self) -> Sensitivity {
        let mut names: BTreeMap<&str, usize> = BTreeMap::new();
        let class = |row: &&JobRow| row.record().map_or("failed", |record| record.regime.name());
        let classes: Vec<&str> = self.rows.iter().map(class).collect();
        for name in &classes {
            let next = names.len();
            names.entry(name).or_insert(next);
        }
        let class: Vec<usize> = classes.iter().map(|name| names[name]).collect();
        let basis = self.basis((0..class.len()).collect());
        let mut remarks: Vec<String> = self.doubtful(&basis.points).into_iter().collect();
        let last = |slices: &[Vec<usize>], points: &[usize]| {
            let own: Vec<usize> = points.iter().map(|&at| class[at]).collect();
            of_classes(slices, &own, names.len())
        };
        let (last, chance) = self.last_indices(&basis, last, &mut remarks);
        let indices = |(parameter, shares): (&Parameter, Option<Index>)| Indices {
            name: parameter.name.clone(),
            first_order: None,
            total: None,
            pawn: shares,
            effects: None,
        };
        let parameters = self.parameters.iter().zip(last).map(indices).collect();
        Sensitivity {
            of: REGIME.to_owned(),
            points: class.len(),
            missing: self.missing(class.len()),
            design: basis.design,
            parameters,
            remarks,
            chance,
        }
    }

    /// The index of slices of each parameter, and how large it can be by chance. On a full grid each value of a parameter is a slice, and a
    /// parameter without effect has exactly 0. `index` takes slices of some points.
    fn last_indices(
        &self,
        basis: &Basis,
        index: impl Fn(&[Vec<usize>], &[usize]) -> f64,
        remarks: &mut Vec<String>,
    ) -> (Vec<Option<Index>>, Option<f64>) {
        let count = basis.points.len();
        let all: Vec<usize> = (0..count).collect();
        let mut chance: Option<f64> = None;
        let of_parameter = |parameter: &Parameter| {
            let x = Self::column(basis, parameter);
            match basis.design {
                Design::Grid(_) => {
                    let levels = levels(&x);
                    (levels.len() > 1).then(|| Index::exact(index(&levels, &all)))
                }
                Design::Sample => {
                    let of = |x: Vec<f64>, points: &[usize]| Some(index(&slices(&x)?, points));
                    let at = |points: &[usize]| points.iter().map(|&at| x[at]).collect::<Vec<_>>();
                    let found = with_interval(count, |points| of(at(points), points));
                    if found.is_none() {
                        let name = &parameter.name;
                        remarks.push(format!(
                            "{name} has nearly one value only, so it has no slices to compare."
                        ));
                    }
                    let own = by_chance(count, |order| of(at(order), &all));
                    chance = chance.into_iter().chain(own).reduce(f64::max);
                    found
                }
                Design::Unknown(_) => None,
            }
        };
        let found = self.parameters.iter().map(of_parameter).collect();
        (found, chance)
    }

    /// The elementary effects of a parameter: the differences of the quantity between neighbours in the design that differ in it alone, over
    /// the share of its range by which it changes (Morris, Technometrics 33, 1991).
    fn elementary_effects(&self, own: &Parameter, scalar: &Scalar) -> Vec<f64> {
        let Self { rows, parameters, .. } = self;
        let effect = |at: usize| {
            let is_alone = parameters
                .iter()
                .all(|other| (other.values[at] != other.values[at - 1]) == (other.name == own.name));
            let step = MORRIS_STEP.copysign(own.values[at] - own.values[at - 1]);
            is_alone.then(|| {
                Some((scalar.settled_value(rows[at])? - scalar.settled_value(rows[at - 1])?) / step)
            })?
        };
        (1..rows.len()).filter_map(effect).collect()
    }
}

/// Numbers whose range is a smaller share of the largest are one number: what is left is rounding and the end of an iteration.
const SAME: f64 = 1.0e-6;

fn is_constant(y: &[f64]) -> bool {
    let [least, most] =
        y.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], own| [a.min(*own), b.max(*own)]);
    most - least <= SAME * most.abs().max(least.abs())
}

/// The first-order index of a parameter of a sample.
fn estimated(estimator: &Estimator, x: &[f64], y: &[f64]) -> Option<Index> {
    with_interval(y.len(), |points| {
        let [x, y] = [x, y].map(|all| points.iter().map(|&at| all[at]).collect::<Vec<_>>());
        match estimator {
            Estimator::Levels => of_levels(&levels(&x), &y),
            Estimator::Harmonics => first_order(&x, &y),
        }
    })
}

/// The mean size of effects, and their standard deviation; none with fewer than two.
fn of_effects(effects: &[f64]) -> Option<(Index, f64)> {
    let count = effects.len() as f64;
    let mean = effects.iter().sum::<f64>() / count;
    let variance = effects.iter().map(|effect| (effect - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let size = |points: &[usize]| Some(points.iter().map(|&at| effects[at].abs()).sum::<f64>() / count);
    let index = (effects.len() > 1).then(|| with_interval(effects.len(), size)).flatten();
    index.map(|index| (index, variance.sqrt()))
}

/// An index of all points, with the quantiles over resamples with replacement.
fn with_interval(count: usize, index: impl Fn(&[usize]) -> Option<f64>) -> Option<Index> {
    let all: Vec<usize> = (0..count).collect();
    let value = index(&all)?;
    let mut random = SplitMix64::new(1);
    let resample = |_| {
        let points: Vec<usize> = (0..count).map(|_| random.below(count)).collect();
        index(&points)
    };
    let mut found: Vec<f64> = (0..RESAMPLES).filter_map(resample).collect();
    found.sort_by(f64::total_cmp);
    // Points that a resample repeats move the distances upwards. The spread about the mean of the resamples does not have this shift.
    let mean = found.iter().sum::<f64>() / found.len().max(1) as f64;
    let quantile = |share: f64| {
        let found = found.get((share * found.len() as f64) as usize);
        found.map_or(value, |found| value + found - mean)
    };
    Some(Index { value, interval: Some([quantile(0.05), quantile(0.95)]) })
}

/// The 95 % quantile of an index with shuffled points.
fn by_chance(count: usize, index: impl Fn(&[usize]) -> Option<f64>) -> Option<f64> {
    let mut random = SplitMix64::new(2);
    let mut order: Vec<usize> = (0..count).collect();
    let shuffle = |_| {
        for last in (1..count).rev() {
            order.swap(last, random.below(last + 1));
        }
        index(&order)
    };
    let mut found: Vec<f64> = (0..RESAMPLES).filter_map(shuffle).collect();
    found.sort_by(f64::total_cmp);
    found.get((0.95 * found.len() as f64) as usize).copied()
}

/// A point with the numbers of its varied parameters and of some quantities.
struct PointOfStudy {
    parameters: Vec<f64>,
    results: Vec<f64>,
}

/// The points and their results as a table of numbers, for other programs: a column for each parameter that varies, then one for each
/// quantity. Jobs without a value of every quantity are left out. Parameters that are names have numbers from 0.
///
/// Returns the table and the number of jobs that are left out.
pub fn points_table(rows: &[JobRow], of: &[&'static Scalar]) -> (Table, usize) {
    let ended = |row: &&JobRow| matches!(row.state, RowState::Done(_) | RowState::Failed { .. });
    let rows: Vec<&JobRow> = rows.iter().filter(ended).collect();
    let parameters = parameters(&rows);
    let point = |(at, row): (usize, &&JobRow)| {
        let results = of.iter().map(|scalar| scalar.settled_value(row)).collect::<Option<_>>()?;
        Some(PointOfStudy { parameters: parameters.iter().map(|own| own.values[at]).collect(), results })
    };
    let points: Vec<PointOfStudy> = rows.iter().enumerate().filter_map(point).collect();
    let of_parameter = |(index, own): (usize, &Parameter)| {
        Column::made(head(&own.name), move |point: &PointOfStudy| point.parameters[index].into())
    };
    let of_result = |(index, scalar): (usize, &&'static Scalar)| {
        let head = Head::new(scalar.name, scalar.unit(), scalar.meaning);
        Column::made(head, move |point: &PointOfStudy| point.results[index].into())
    };
    let of_parameters = parameters.iter().enumerate().map(of_parameter);
    let columns: Vec<_> = of_parameters.chain(of.iter().enumerate().map(of_result)).collect();
    let left_out = rows.len() - points.len();
    (Table::of("sensitivity_points", &columns, &points), left_out)
}
