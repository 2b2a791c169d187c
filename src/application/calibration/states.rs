//! States of runs at a measured point: steady sliding, and limit cycles of one branch of frequency.
//!
//! Each state has emulators of its own, because values jump between states. They do not jump between the contact regimes of one branch
//! (stick-slip, with separation, slip and separation): μ* and the frequency are continuous there, and emulators of each regime would have
//! fewer runs for the same curve.

use super::emulator::{Emulator, Group, Kernels, LeaveOneOut, Near, Scales, best_scales, is_enough};
use super::values::{Assessment, Expected, LOG_FREQUENCY, Outcome, QUANTITIES, Run, Target};
use nalgebra::{DMatrix, DVector};

/// Runs around a place that must all be of another state to rule a state out, for each parameter. Next to a straight boundary each of them is on
/// either side with the same probability, so that a state is ruled out wrongly in one of 2³ places with one parameter, of 2⁶ with two.
const AROUND: usize = 3;

/// Frequencies that are further from a smooth trend than this, as a logarithm, are those of another branch. Period doubling is 0.69.
const JUMP: f64 = 0.3;

/// Most branches of a measured point.
const MOST_BRANCHES: usize = 3;

/// What is known at a measured point.
#[derive(Debug, Default)]
pub(super) struct States {
    /// Runs that slide steadily and runs that squeal, by the numbers of their states.
    kinds: Vec<(usize, Kind)>,
    states: Vec<State>,
}

/// What a run is known to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Kind {
    squeals: bool,
    /// The number of the branch of its frequency; none if it has no frequency.
    branch: Option<usize>,
}

/// Runs between which values are smooth.
#[derive(Debug)]
struct State {
    kind: Kind,
    values: [Option<Emulator>; QUANTITIES],
    /// The errors that the mesh makes in the values of runs, where they are known, with the numbers of the runs.
    mesh: [Vec<(usize, f64)>; QUANTITIES],
    /// The largest one that is known in such a state at any measured point, where it is known of none here.
    largest_mesh: [f64; QUANTITIES],
}

/// The runs of a state before there are emulators.
struct Draft {
    target: usize,
    kind: Kind,
    runs: Vec<usize>,
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
    let mut states: Vec<States> = targets.iter().map(|_| States::default()).collect();
    let mut drafts = Vec::new();
    for (target, own) in states.iter_mut().enumerate() {
        let of = |squeals: bool| -> Vec<usize> {
            let is_so =
                |at: &usize| outcome(&runs[*at], target).is_some_and(|own| own.squeals == Some(squeals));
            (0..runs.len()).filter(is_so).collect()
        };
        let (stable, squealing) = (of(false), of(true));
        let steady = Kind { squeals: false, branch: None };
        own.kinds.extend(stable.iter().map(|at| (*at, steady)));
        drafts.push(Draft { target, kind: steady, runs: stable });
        for (number, runs_of_branch) in branches(&squealing, runs, target).into_iter().enumerate() {
            let kind = Kind { squeals: true, branch: Some(number) };
            let has_frequency = |at: &usize| {
                outcome(&runs[*at], target).is_some_and(|own| own.values[LOG_FREQUENCY].is_some())
            };
            own.kinds.extend(
                runs_of_branch
                    .iter()
                    .map(|at| (*at, if has_frequency(at) { kind } else { Kind { branch: None, ..kind } })),
            );
            drafts.push(Draft { target, kind, runs: runs_of_branch });
        }
    }
    drafts.retain(|draft| !draft.runs.is_empty());
    // Length scales are those of the physics, so they are common to all measured points.
    let scales = |squeals: bool, quantity: usize| {
        let mut groups: Vec<Group> = Vec::new();
        for draft in drafts.iter().filter(|draft| draft.kind.squeals == squeals) {
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
        let own: &[Option<Scales>; QUANTITIES] = &scales[usize::from(draft.kind.squeals)];
        let values = std::array::from_fn(|quantity| {
            targets[draft.target].values[quantity]?;
            let (of, values) = column(draft, quantity, runs);
            let (emulator, check) = kernels.emulator(&of, &places, &values, own[quantity].as_ref()?)?;
            checks.push((quantity, check));
            Some(emulator)
        });
        let mesh = std::array::from_fn(|quantity| {
            let known = |at: &usize| Some((*at, mesh_of(draft, *at, quantity, runs)?));
            draft.runs.iter().filter_map(known).collect()
        });
        let largest_mesh = std::array::from_fn(|quantity| {
            let alike = drafts.iter().filter(|other| other.kind.squeals == draft.kind.squeals);
            let known = alike
                .flat_map(|other| other.runs.iter().filter_map(|at| mesh_of(other, *at, quantity, runs)));
            known.fold(0.0, f64::max)
        });
        let state = State { kind: draft.kind, values, mesh, largest_mesh };
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

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

impl State {
    /// The standard deviation of the error that the mesh makes at a place: the largest of those of the nearest runs, one more than there are
    /// parameters. If none of the state knows its own, that of the other measured points.
    fn mesh_at(&self, place: &[f64], quantity: usize, runs: &[Run]) -> f64 {
        let mut near: Vec<(f64, f64)> = self.mesh[quantity]
            .iter()
            .map(|(at, error)| (distance(&runs[*at].place, place), *error))
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        near.iter()
            .take(place.len() + 1)
            .map(|(_, error)| *error)
            .reduce(f64::max)
            .unwrap_or(self.largest_mesh[quantity])
    }
}

impl States {
    /// The kinds of the nearest runs of which something is known.
    fn around(&self, place: &[f64], runs: &[Run]) -> Vec<Kind> {
        let mut near: Vec<(f64, usize, Kind)> =
            self.kinds.iter().map(|(at, kind)| (distance(&runs[*at].place, place), *at, *kind)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        near.iter().take(AROUND * place.len()).map(|(_, _, kind)| *kind).collect()
    }

    /// Whether the runs around a place are of different kinds.
    pub fn is_disputed(&self, place: &[f64], runs: &[Run]) -> bool {
        let around = self.around(place, runs);
        around.iter().any(|kind| kind.squeals != around[0].squeals)
    }

    /// What a place is expected to give: of the states that were measured, or of all if that is not known, the one that fits best.
    pub fn assess(&self, place: &[f64], target: &Target, near: &[Near], runs: &[Run]) -> Assessment {
        let around = self.around(place, runs);
        let is_around =
            |wanted: &dyn Fn(&Kind) -> bool| around.len() < AROUND * place.len() || around.iter().any(wanted);
        let is_measured = |squeals: bool| target.squeals.is_none_or(|own| own == squeals);
        let of_state = |state: &State| {
            let Kind { squeals, branch } = state.kind;
            // A run whose branch is not known may be of any.
            let is_possible = is_measured(squeals)
                && is_around(&|own| own.squeals == squeals && (own.branch.is_none() || own.branch == branch));
            let mut all = Assessment::default();
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
            if !is_possible {
                (all.implausibility, all.square_sum) = (f64::INFINITY, f64::INFINITY);
                all.is_other_state = true;
            }
            all
        };
        let best = self.states.iter().filter(|state| is_measured(state.kind.squeals)).map(of_state);
        let best = best.reduce(|best, own| if own.implausibility < best.implausibility { own } else { best });
        best.unwrap_or_else(|| {
            // No run is of the state that was measured.
            let is_other_state = !is_around(&|own| is_measured(own.squeals));
            let implausibility = if is_other_state { f64::INFINITY } else { 0.0 };
            Assessment { implausibility, square_sum: implausibility, is_other_state, ..Assessment::default() }
        })
    }
}
