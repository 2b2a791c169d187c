//! States of runs at a measured point: steady sliding, and limit cycles of one branch of frequency.
//!
//! Each state has emulators of its own, because values jump between states. They do not jump between the contact regimes of one branch
//! (stick-slip, with separation, slip and separation): μ* and the frequency are continuous there, and emulators of each regime would have
//! fewer runs for the same curve.

use super::emulator::{Emulator, Group, Kernels, LeaveOneOut, Near, Scales, best_scales, is_enough};
use super::values::{Assessment, Expected, LOG_FREQUENCY, Outcome, QUANTITIES, Run, Target};
use nalgebra::{DMatrix, DVector};

/// The length over which it is known whether runs squeal, in units of the ranges.
const LABEL_LENGTH: f64 = 0.4;

/// The noise of labels. It keeps the matrix regular.
const LABEL_NOISE: f64 = 1.0e-4;

/// Frequencies that are further from a smooth trend than this, as a logarithm, are those of another branch. Period doubling is 0.69.
const JUMP: f64 = 0.3;

/// Most branches of a measured point.
const MOST_BRANCHES: usize = 3;

/// What is known at a measured point.
#[derive(Debug, Default)]
pub(super) struct States {
    /// 1 where runs squeal, and −1 where they slide steadily; none without runs.
    squeals: Option<Emulator>,
    states: Vec<State>,
}

/// Runs between which values are smooth.
#[derive(Debug)]
struct State {
    squeals: bool,
    /// 1 in this branch, and −1 in others; none if there is one branch.
    is_branch: Option<Emulator>,
    values: [Option<Emulator>; QUANTITIES],
    /// The errors that the mesh makes in the values of runs, where they are known, with the numbers of the runs.
    mesh: [Vec<(usize, f64)>; QUANTITIES],
    /// The largest one that is known in such a state at any measured point, where it is known of none here.
    largest_mesh: [f64; QUANTITIES],
}

/// The runs of a state before there are emulators.
struct Draft {
    target: usize,
    squeals: bool,
    runs: Vec<usize>,
    /// Runs that squeal on another branch.
    others: Vec<usize>,
}

/// The states at all measured points. `checks` gets the check of each emulator with the number of its quantity.
pub(super) fn all(
    runs: &[Run],
    targets: &[Target],
    kernels: &mut Kernels,
    checks: &mut Vec<(usize, LeaveOneOut)>,
) -> Vec<States> {
    let places: Vec<Vec<f64>> = runs.iter().map(|run| run.place.clone()).collect();
    let parameters = places.first().map_or(0, Vec::len);
    let labels = Scales { lengths: vec![LABEL_LENGTH; parameters], nugget: LABEL_NOISE, has_trend: false };
    let mut states: Vec<States> = targets.iter().map(|_| States::default()).collect();
    let mut drafts = Vec::new();
    for (target, own) in states.iter_mut().enumerate() {
        let of = |squeals: bool| -> Vec<usize> {
            let is_so =
                |at: &usize| outcome(&runs[*at], target).is_some_and(|own| own.squeals == Some(squeals));
            (0..runs.len()).filter(is_so).collect()
        };
        let (stable, squealing) = (of(false), of(true));
        own.squeals = labelled(&squealing, &stable, &places, &labels, kernels);
        drafts.push(Draft { target, squeals: false, runs: stable, others: Vec::new() });
        let branches = branches(&squealing, runs, target);
        for (number, branch) in branches.iter().enumerate() {
            let others = branches.iter().enumerate().filter(|(other, _)| *other != number);
            let others = others.flat_map(|(_, runs)| runs.iter().copied()).collect();
            drafts.push(Draft { target, squeals: true, runs: branch.clone(), others });
        }
    }
    drafts.retain(|draft| !draft.runs.is_empty());
    // Length scales are those of the physics, so they are common to all measured points.
    let scales = |squeals: bool, quantity: usize| {
        let mut groups: Vec<Group> = Vec::new();
        for draft in drafts.iter().filter(|draft| draft.squeals == squeals) {
            let (of, values) = column(draft, quantity, runs);
            if is_enough(of.len(), parameters) {
                let values = DVector::from_vec(values);
                match groups.iter_mut().find(|(own, _)| *own == of) {
                    Some((_, columns)) => columns.push(values),
                    None => groups.push((of, vec![values])),
                }
            }
        }
        (!groups.is_empty()).then(|| best_scales(&groups, &places, parameters))
    };
    let scales = [false, true].map(|squeals| std::array::from_fn(|quantity| scales(squeals, quantity)));
    for draft in &drafts {
        let own: &[Option<Scales>; QUANTITIES] = &scales[usize::from(draft.squeals)];
        let values = std::array::from_fn(|quantity| {
            targets[draft.target].values[quantity]?;
            let (of, values) = column(draft, quantity, runs);
            let found = kernels.emulator(&of, &places, &values, own[quantity].as_ref()?);
            let (emulator, check) = found.filter(|_| is_enough(of.len(), parameters))?;
            checks.push((quantity, check));
            Some(emulator)
        });
        let is_branch = (!draft.others.is_empty())
            .then(|| labelled(&draft.runs, &draft.others, &places, &labels, kernels))
            .flatten();
        let mesh = std::array::from_fn(|quantity| {
            let known = |at: &usize| Some((*at, mesh_of(draft, *at, quantity, runs)?));
            draft.runs.iter().filter_map(known).collect()
        });
        let largest_mesh = std::array::from_fn(|quantity| {
            let alike = drafts.iter().filter(|other| other.squeals == draft.squeals);
            let known = alike
                .flat_map(|other| other.runs.iter().filter_map(|at| mesh_of(other, *at, quantity, runs)));
            known.fold(0.0, f64::max)
        });
        let state = State { squeals: draft.squeals, is_branch, values, mesh, largest_mesh };
        states[draft.target].states.push(state);
    }
    states
}

fn outcome(run: &Run, target: usize) -> Option<&Outcome> {
    run.outcomes.get(target)?.as_ref()
}

/// The error that the mesh makes in a quantity of a run, if it is known.
fn mesh_of(draft: &Draft, at: usize, quantity: usize, runs: &[Run]) -> Option<f64> {
    outcome(&runs[at], draft.target)?.values[quantity]?.mesh_deviation
}

/// The runs of a state that have a quantity, with its values.
fn column(draft: &Draft, quantity: usize, runs: &[Run]) -> (Vec<usize>, Vec<f64>) {
    let value = |at: &usize| Some((*at, outcome(&runs[*at], draft.target)?.values[quantity]?.value));
    draft.runs.iter().filter_map(value).unzip()
}

/// An emulator that is 1 at some places and −1 at others; none without any.
fn labelled(
    of: &[usize],
    others: &[usize],
    places: &[Vec<f64>],
    scales: &Scales,
    kernels: &mut Kernels,
) -> Option<Emulator> {
    let mut labels: Vec<(usize, f64)> =
        of.iter().map(|at| (*at, 1.0)).chain(others.iter().map(|at| (*at, -1.0))).collect();
    labels.sort_by_key(|(at, _)| *at);
    let (of, labels): (Vec<usize>, Vec<f64>) = labels.into_iter().unzip();
    if of.is_empty() { None } else { kernels.labels(&of, places, &labels, scales) }
}

/// Runs that squeal, by the branch of their frequency: those near one linear trend, then those near the trend of the rest. Runs without a
/// frequency belong to the first branch, where nothing is known of their values.
fn branches(squealing: &[usize], runs: &[Run], target: usize) -> Vec<Vec<usize>> {
    let frequency = |at: usize| Some(outcome(&runs[at], target)?.values[LOG_FREQUENCY]?.value);
    let (mut left, silent): (Vec<usize>, Vec<usize>) =
        squealing.iter().copied().partition(|at| frequency(*at).is_some());
    let mut found: Vec<Vec<usize>> = Vec::new();
    while !left.is_empty() && found.len() < MOST_BRANCHES {
        let of: Vec<(&[f64], f64)> =
            left.iter().filter_map(|at| Some((runs[*at].place.as_slice(), frequency(*at)?))).collect();
        let far: Vec<bool> = distances(&of).into_iter().map(|distance| distance > JUMP).collect();
        let (mut near, mut rest) = (Vec::new(), Vec::new());
        left.iter().zip(far).for_each(|(at, is_far)| if is_far { rest.push(*at) } else { near.push(*at) });
        if near.is_empty() {
            std::mem::swap(&mut near, &mut rest);
        }
        found.push(near);
        left = rest;
    }
    match found.first_mut() {
        Some(first) => {
            first.extend(silent);
            first.sort_unstable();
        }
        None if !silent.is_empty() => found.push(silent),
        None => {}
    }
    found
}

/// Steps of the fit of least absolute deviations.
const STEPS: usize = 30;

/// The distances of values from the linear trend with the least sum of absolute deviations, which a few jumps do not move. It is found by
/// least squares with weights that are the inverse of the distances.
fn distances(of: &[(&[f64], f64)]) -> Vec<f64> {
    let columns = 1 + of[0].0.len();
    if of.len() <= columns {
        let mut sorted: Vec<f64> = of.iter().map(|(_, value)| *value).collect();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted[sorted.len() / 2];
        return of.iter().map(|(_, value)| (value - middle).abs()).collect();
    }
    let trend = DMatrix::from_fn(of.len(), columns, |i, j| if j == 0 { 1.0 } else { of[i].0[j - 1] });
    let values = DVector::from_iterator(of.len(), of.iter().map(|(_, value)| *value));
    let mut distances = vec![1.0; of.len()];
    for _ in 0..STEPS {
        let weighted =
            DMatrix::from_fn(of.len(), columns, |i, j| trend[(i, j)] / f64::max(distances[i], 1.0e-3));
        let Some(normal) = (weighted.transpose() * &trend).cholesky() else { break };
        let rest = &values - &trend * normal.solve(&(weighted.transpose() * &values));
        distances = rest.iter().map(|rest| rest.abs()).collect();
    }
    distances
}

/// How far a label is on the wrong side, in standard deviations.
fn wrong_side((mean, deviation): (f64, f64), is_wanted: bool) -> f64 {
    let towards = if is_wanted { mean } else { -mean };
    (-towards).max(0.0) / deviation
}

impl State {
    /// The standard deviation of the error that the mesh makes at a place: the largest of those of the nearest runs, one more than there are
    /// parameters. If none of the state knows its own, that of the other measured points.
    fn mesh_at(&self, place: &[f64], quantity: usize, runs: &[Run]) -> f64 {
        let distance =
            |at: usize| -> f64 { runs[at].place.iter().zip(place).map(|(a, b)| (a - b).powi(2)).sum() };
        let mut near: Vec<(f64, f64)> =
            self.mesh[quantity].iter().map(|(at, error)| (distance(*at), *error)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        near.iter()
            .take(place.len() + 1)
            .map(|(_, error)| *error)
            .reduce(f64::max)
            .unwrap_or(self.largest_mesh[quantity])
    }
}

impl States {
    /// What a place is expected to give: of the states that were measured, or of all if that is not known, the one that fits best.
    pub fn assess(&self, place: &[f64], target: &Target, near: &[Near], runs: &[Run]) -> Assessment {
        let of_squeals = |is_wanted: bool| {
            self.squeals.as_ref().map_or(0.0, |label| wrong_side(label.at(near), is_wanted))
        };
        let is_possible = |state: &&State| target.squeals.is_none_or(|own| own == state.squeals);
        let of_state = |state: &State| {
            let of_branch = state.is_branch.as_ref().map_or(0.0, |label| wrong_side(label.at(near), true));
            let of_kind = of_squeals(state.squeals).max(of_branch);
            let mut all =
                Assessment { implausibility: of_kind, square_sum: of_kind.powi(2), ..Assessment::default() };
            for (quantity, (emulator, measured)) in state.values.iter().zip(&target.values).enumerate() {
                let (Some(emulator), Some(measured)) = (emulator, measured) else { continue };
                let (mean, deviation) = emulator.at(near);
                let mesh = state.mesh_at(place, quantity, runs);
                let expected = Expected { mean, emulator: deviation, mesh };
                let own = expected.implausibility(measured);
                all.implausibility = all.implausibility.max(own);
                all.square_sum += own.powi(2);
                all.values[quantity] = Some(expected);
            }
            all
        };
        let best = self.states.iter().filter(is_possible).map(of_state);
        let best = best.reduce(|best, own| if own.implausibility < best.implausibility { own } else { best });
        best.unwrap_or_else(|| {
            let implausibility = target.squeals.map_or(0.0, of_squeals);
            Assessment { implausibility, square_sum: implausibility.powi(2), ..Assessment::default() }
        })
    }
}
