//! What the results of a study depend on: sensitivity indices of its parameters, from its own points.

mod indices;

use super::export::further_names;
use super::parameters::{MU, OMEGA};
use super::row::{JobRow, RowState};
use super::scalar::Scalar;
use crate::publish::value;
use indices::{first_order, of_classes, pawn, slices};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Number of resamples for confidence intervals.
const RESAMPLES: usize = 200;

/// The share of its range by which a parameter changes in a Morris design.
const MORRIS_STEP: f64 = 2.0 / 3.0;

/// With fewer points, indices say little.
const FEW_POINTS: usize = 100;

/// An index with its interval of confidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Index {
    /// The index of all points.
    pub value: f64,
    /// Its 5 % and 95 % quantiles over resamples of the points, moved so that their mean is the value.
    pub interval: [f64; 2],
}

/// The indices of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Indices {
    /// Its name.
    pub name: String,
    /// The first-order index; none for regimes, and for parameters that are no numbers.
    pub first_order: Option<Index>,
    /// The PAWN index; of regimes, the index of shares.
    pub pawn: Option<Index>,
    /// The elementary effects of a Morris design: the mean of their sizes, in the unit of the quantity for the whole range of the
    /// parameter, and their standard deviation.
    pub effects: Option<(Index, f64)>,
}

/// The indices of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// The name of the quantity; `regime` for the regimes, of which failed jobs are one.
    pub of: String,
    /// The number of points with a value.
    pub points: usize,
    /// The indices of each parameter that varies.
    pub parameters: Vec<Indices>,
    /// What the index of a parameter without any effect would be, above which few of them are by chance: the 95 % quantile of the last
    /// index with shuffled parameters.
    pub chance: f64,
}

/// The name of the sensitivity of regimes.
pub const REGIME: &str = "regime";

/// The sensitivities of some numbers, and of the regime, to all parameters that vary between the jobs that ended. They are the same in
/// every call. `is_morris` says that the rows are those of a Morris design, in its order.
pub fn sensitivities(rows: &[JobRow], of: &[&'static Scalar], is_morris: bool) -> Vec<Sensitivity> {
    let ended = |row: &&JobRow| matches!(row.state, RowState::Done(_) | RowState::Failed { .. });
    let rows: Vec<&JobRow> = rows.iter().filter(ended).collect();
    let parameters = parameters(&rows);
    let mut found: Vec<Sensitivity> =
        of.iter().map(|scalar| of_scalar(&rows, &parameters, scalar, is_morris)).collect();
    found.push(of_regimes(&rows, &parameters));
    found
}

/// A parameter with its value in each row as a number. Names are numbered in the order of the rows.
struct Parameter {
    name: String,
    is_number: bool,
    values: Vec<f64>,
}

fn parameters(rows: &[&JobRow]) -> Vec<Parameter> {
    let names = [OMEGA, MU].into_iter().chain(further_names(rows.iter().copied()));
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
    names.filter_map(parameter).collect()
}

/// The elementary effects of a parameter: the differences of the quantity between neighbours in the design that differ in it alone, over
/// the share of its range by which it changes (Morris, Technometrics 33, 1991).
fn elementary_effects(
    rows: &[&JobRow],
    parameters: &[Parameter],
    own: &Parameter,
    scalar: &Scalar,
) -> Vec<f64> {
    let effect = |at: usize| {
        let is_alone = parameters
            .iter()
            .all(|other| (other.values[at] != other.values[at - 1]) == (other.name == own.name));
        let step = MORRIS_STEP.copysign(own.values[at] - own.values[at - 1]);
        is_alone.then(|| Some((scalar.value(rows[at])? - scalar.value(rows[at - 1])?) / step))?
    };
    (1..rows.len()).filter_map(effect).collect()
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

fn of_scalar(rows: &[&JobRow], parameters: &[Parameter], scalar: &Scalar, is_morris: bool) -> Sensitivity {
    let with_value: Vec<(usize, f64)> =
        rows.iter().enumerate().filter_map(|(at, row)| Some((at, scalar.value(row)?))).collect();
    let y: Vec<f64> = with_value.iter().map(|(_, y)| *y).collect();
    let mut chance = Vec::new();
    let all = parameters;
    let of_parameter = |parameter: &Parameter| {
        let effects = is_morris.then(|| elementary_effects(rows, all, parameter, scalar));
        let x: Vec<f64> = with_value.iter().map(|(at, _)| parameter.values[*at]).collect();
        let first = |points: &[usize]| {
            let [x, y] = [&x, &y].map(|all| points.iter().map(|&at| all[at]).collect::<Vec<_>>());
            first_order(&x, &y)
        };
        let of_pawn = |points: &[usize]| {
            let [x, y] = [&x, &y].map(|all| points.iter().map(|&at| all[at]).collect::<Vec<_>>());
            Some(pawn(&slices(&x)?, &y))
        };
        chance.push(by_chance(y.len(), |order| {
            let shuffled: Vec<f64> = order.iter().map(|&at| x[at]).collect();
            Some(pawn(&slices(&shuffled)?, &y))
        }));
        let first = parameter.is_number.then(|| with_interval(y.len(), first)).flatten();
        Indices {
            name: parameter.name.clone(),
            first_order: first,
            pawn: with_interval(y.len(), of_pawn),
            effects: effects.and_then(|effects| of_effects(&effects)),
        }
    };
    let parameters = parameters.iter().map(of_parameter).collect();
    Sensitivity {
        of: scalar.name.to_owned(),
        points: y.len(),
        parameters,
        chance: chance.into_iter().flatten().fold(0.0, f64::max),
    }
}

fn of_regimes(rows: &[&JobRow], parameters: &[Parameter]) -> Sensitivity {
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    let class = |row: &&JobRow| row.record().map_or("failed", |record| record.regime.name());
    let classes: Vec<&str> = rows.iter().map(class).collect();
    for name in &classes {
        let next = names.len();
        names.entry(name).or_insert(next);
    }
    let class: Vec<usize> = classes.iter().map(|name| names[name]).collect();
    let mut chance = Vec::new();
    let of_parameter = |parameter: &Parameter| {
        let index = |points: &[usize]| {
            let x: Vec<f64> = points.iter().map(|&at| parameter.values[at]).collect();
            let own: Vec<usize> = points.iter().map(|&at| class[at]).collect();
            Some(of_classes(&slices(&x)?, &own, names.len()))
        };
        chance.push(by_chance(class.len(), |order| {
            let x: Vec<f64> = order.iter().map(|&at| parameter.values[at]).collect();
            Some(of_classes(&slices(&x)?, &class, names.len()))
        }));
        Indices {
            name: parameter.name.clone(),
            first_order: None,
            pawn: with_interval(class.len(), index),
            effects: None,
        }
    };
    let parameters = parameters.iter().map(of_parameter).collect();
    Sensitivity {
        of: REGIME.to_owned(),
        points: class.len(),
        parameters,
        chance: chance.into_iter().flatten().fold(0.0, f64::max),
    }
}

/// An index of all points, with the quantiles over resamples with replacement.
fn with_interval(count: usize, index: impl Fn(&[usize]) -> Option<f64>) -> Option<Index> {
    let all: Vec<usize> = (0..count).collect();
    let value = index(&all)?;
    let mut random = Random(1);
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
    Some(Index { value, interval: [quantile(0.05), quantile(0.95)] })
}

/// The 95 % quantile of an index with shuffled points.
fn by_chance(count: usize, index: impl Fn(&[usize]) -> Option<f64>) -> Option<f64> {
    let mut random = Random(2);
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

/// The generator `SplitMix64` (Steele, Lea and Flood 2014): resamples are the same on every machine.
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        word ^= word >> 31;
        ((u128::from(word) * count.max(1) as u128) >> 64) as usize
    }
}

/// The indices as a text with tables.
pub fn markdown(found: &[Sensitivity]) -> String {
    let mut text = String::new();
    for one in found {
        let index = |index: &Option<Index>| {
            let interval = |index: &Index| {
                let [low, high] = index.interval.map(|bound| value::fixed(bound, 2));
                format!("{} ({low} … {high})", value::fixed(index.value, 2))
            };
            index.as_ref().map_or_else(|| value::MISSING.to_owned(), interval)
        };
        let is_regime = one.of == REGIME;
        let title = Scalar::find(&one.of).map_or_else(|| one.of.clone(), Scalar::title);
        let _ = writeln!(text, "# {title}: {} points\n", one.points);
        let mut ranked: Vec<_> = one.parameters.iter().collect();
        let of = |index: &Option<Index>| index.as_ref().map_or(-1.0, |index| index.value);
        ranked.sort_by(|a, b| of(&b.pawn).total_cmp(&of(&a.pawn)).then(a.name.cmp(&b.name)));
        let is_morris = one.parameters.iter().any(|own| own.effects.is_some());
        text += if is_regime {
            "| parameter | shares |\n| --- | --- |\n"
        } else if is_morris {
            "| parameter | first order | PAWN | mean size of effects | their deviation |\n| --- | --- | --- | --- | --- |\n"
        } else {
            "| parameter | first order | PAWN |\n| --- | --- | --- |\n"
        };
        for Indices { name, first_order, pawn, effects } in ranked {
            if is_regime {
                let _ = writeln!(text, "| `{name}` | {} |", index(pawn));
                continue;
            }
            let _ = write!(text, "| `{name}` | {} | {} |", index(first_order), index(pawn));
            if is_morris {
                let size = |(index, deviation): &(Index, f64)| {
                    let [size, low, high, deviation] =
                        [index.value, index.interval[0], index.interval[1], *deviation]
                            .map(|number| value::significant(number, 3));
                    format!(" {size} ({low} … {high}) | {deviation} |")
                };
                text += &effects.as_ref().map_or_else(|| " – | – |".to_owned(), size);
            }
            text += "\n";
        }
        let what = if is_regime { "shares" } else { "PAWN" };
        let chance = value::fixed(one.chance, 2);
        let _ = writeln!(text, "\nA parameter without effect has {what} up to {chance} by chance.");
        if one.points < FEW_POINTS {
            let points = one.points;
            let _ =
                writeln!(text, "Only {points} points: the indices say little; give at least {FEW_POINTS}.");
        }
        text += "\n";
    }
    text
}

/// The indices as CSV: quantity, points, parameter, index, its value and its interval.
pub fn csv(found: &[Sensitivity]) -> String {
    let mut text = "quantity,points,parameter,index,value,low,high,by_chance\n".to_owned();
    for one in found {
        for Indices { name, first_order, pawn, effects } in &one.parameters {
            let last_name = if one.of == REGIME { "shares" } else { "pawn" };
            let sizes = effects.map(|(index, _)| index);
            let deviations =
                effects.map(|(_, deviation)| Index { value: deviation, interval: [f64::NAN; 2] });
            let all = [
                ("first_order", first_order),
                (last_name, pawn),
                ("effects_mean_size", &sizes),
                ("effects_deviation", &deviations),
            ];
            for (kind, index) in all {
                if let Some(Index { value, interval: [low, high] }) = index {
                    let chance = if kind == last_name { one.chance.to_string() } else { String::new() };
                    let [low, high] = [low, high]
                        .map(|bound| if bound.is_nan() { String::new() } else { bound.to_string() });
                    let Sensitivity { of, points, .. } = one;
                    let _ = writeln!(text, "{of},{points},{name},{kind},{value},{low},{high},{chance}");
                }
            }
        }
    }
    text
}

/// The points and their results as a table of numbers, for other programs: a column for each parameter that varies, then one for each
/// quantity. Jobs without a value of every quantity are left out. Parameters that are names have numbers from 0.
///
/// Returns the text and the number of jobs that are left out.
pub fn points_csv(rows: &[JobRow], of: &[&'static Scalar]) -> (String, usize) {
    let ended = |row: &&JobRow| matches!(row.state, RowState::Done(_) | RowState::Failed { .. });
    let rows: Vec<&JobRow> = rows.iter().filter(ended).collect();
    let parameters = parameters(&rows);
    let names = parameters.iter().map(|parameter| parameter.name.as_str());
    let mut text = names.chain(of.iter().map(|scalar| scalar.name)).collect::<Vec<_>>().join(",") + "\n";
    let mut left_out = 0;
    for (at, row) in rows.iter().enumerate() {
        let values: Option<Vec<f64>> = of.iter().map(|scalar| scalar.value(row)).collect();
        let Some(values) = values else {
            left_out += 1;
            continue;
        };
        let numbers = parameters.iter().map(|parameter| parameter.values[at]).chain(values);
        text += &(numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(",") + "\n");
    }
    (text, left_out)
}
