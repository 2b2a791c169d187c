//! The modes of one point: found in the basis, then corrected in the full space.

use super::basis::Basis;
use super::equilibrium::UnitEquilibrium;
use super::extension::Extension;
use super::pencil::{Clock, Pair, Pencil};
use super::solve::Bilateral;
use super::space::{Contact, Elasticity, Space, Vectors};
use super::vibration::{PAIRS, Residuals, Vibration};
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Steps of conjugate gradients for one correction.
const CORRECTION_STEPS: usize = 8;

/// Smallest number of modes of the basis whose residuals are known: one that is far behind may lead after its correction.
const CANDIDATES: usize = 12;

/// What the points of one friction coefficient share.
#[derive(Debug)]
pub struct Friction {
    pub mu: f64,
    pub equilibrium: UnitEquilibrium,
    /// K − μ AᵀB in the basis.
    stiffness: Mat<f64>,
    /// D in the basis, for a load of 1 N and a drive's rate of 1.
    sideways: Mat<f64>,
    /// μN₀/|v| of each slave node, for a load of 1 N and a drive's rate of 1.
    sideways_of_nodes: Vec<f64>,
}

/// An approximate mode in the full space.
#[derive(Debug, Clone)]
pub struct FullMode {
    pub value: c64,
    /// λ of a run with its time step.
    pub value_in_steps: c64,
    pub residual: f64,
    /// Whether it went through the corrections.
    pub is_corrected: bool,
    pub shape: Vec<c64>,
}

impl Friction {
    pub fn new(space: &Space, basis: &Basis, mu: f64, equilibrium: UnitEquilibrium) -> Self {
        let on: Vec<usize> =
            (0..equilibrium.in_contact.len()).filter(|&i| equilibrium.in_contact[i]).collect();
        let rows = |of: &Mat<f64>, factor: &dyn Fn(usize) -> f64| {
            Mat::from_fn(on.len(), basis.len(), |i, j| factor(on[i]) * of[(on[i], j)])
        };
        let sideways_of_nodes: Vec<f64> = (0..equilibrium.normal.len())
            .map(|i| mu * equilibrium.normal[i] / space.sliding()[i].speed_per_rate)
            .collect();
        let follow = rows(&basis.forward, &|_| mu).transpose() * rows(&basis.normal, &|_| 1.0);
        let stiffness =
            Mat::from_fn(basis.len(), basis.len(), |i, j| basis.stiffness[(i, j)] - follow[(i, j)]);
        let sideways =
            rows(&basis.sideways, &|i| sideways_of_nodes[i]).transpose() * rows(&basis.sideways, &|_| 1.0);
        Self { mu, equilibrium, stiffness, sideways, sideways_of_nodes }
    }
}

/// One point: a friction coefficient, a speed and a load.
pub struct Point<'a> {
    pub space: &'a Space,
    pub basis: &'a Basis,
    pub friction: &'a Friction,
    pub bilateral: Bilateral<'a>,
    /// Load over the drive's rate.
    pub load_over_rate: f64,
    pub damping_s: f64,
    /// How time passes in a run.
    pub steps: Clock,
}

/// What the corrections are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aim {
    /// The modes that grow fastest: others are corrected too if they may belong to them.
    Leading,
    /// The signs of all growth rates.
    Signs,
}

/// What the corrections aim at.
#[derive(Debug, Clone, Copy)]
pub struct Accuracy {
    /// Number of leading modes that are corrected.
    pub corrected: usize,
    /// What the corrections are for.
    pub aim: Aim,
    /// Largest number of groups of four modes that are corrected: a correction can show that another mode leads.
    pub groups: usize,
    /// Largest relative residual.
    pub residual: f64,
    /// Largest number of rounds of corrections.
    pub rounds: usize,
}

impl Default for Accuracy {
    fn default() -> Self {
        Self { corrected: 4, aim: Aim::Leading, groups: 2, residual: 5e-3, rounds: 4 }
    }
}

impl Accuracy {
    /// Moves up to four modes that are to be corrected to the front. Returns their number.
    fn choose(&self, modes: &mut [(FullMode, Vec<c64>)]) -> usize {
        modes.sort_by(|(a, _), (b, _)| b.value.re.total_cmp(&a.value.re));
        let error = |mode: &FullMode| error_per_s(mode.value, mode.residual);
        let last = self.corrected.min(modes.len());
        let (limit, weight) = match self.aim {
            // The usual error is a third of the bound.
            Aim::Leading => {
                (modes.get(last.wrapping_sub(1)).map_or(0.0, |(mode, _)| mode.value.re), 1.0 / 3.0)
            }
            Aim::Signs => (0.0, 1.0),
        };
        let is_open = |mode: &FullMode| {
            !mode.is_corrected
                && mode.residual > self.residual
                && mode.value.re + weight * error(mode) >= limit
        };
        if self.rounds == 0 {
            return 0;
        }
        // A stable sort: of the open modes, the first.
        modes.sort_by_key(|(mode, _)| !is_open(mode));
        modes.iter().take_while(|(mode, _)| is_open(mode)).count().min(PAIRS)
    }
}

impl Point<'_> {
    /// The leading modes.
    pub fn modes(&self, elasticity: &mut Elasticity<'_>, count: usize, accuracy: Accuracy) -> Vec<FullMode> {
        let r = self.basis.len();
        let sideways = Mat::from_fn(r, r, |i, j| self.load_over_rate * self.friction.sideways[(i, j)]);
        let pencil =
            Pencil { stiffness: self.friction.stiffness.clone(), sideways, damping_s: self.damping_s };
        let mut found = pencil.eigenpairs();
        found.truncate(count.max(CANDIDATES));
        let sideways_of_nodes: Vec<f64> =
            self.friction.sideways_of_nodes.iter().map(|d| d * self.load_over_rate).collect();
        let Bilateral { space, separable, contact } = self.bilateral;
        let vibration = Vibration {
            bilateral: Bilateral { space, separable, contact },
            mu: self.friction.mu,
            sideways_n_s_m: &sideways_of_nodes,
            damping_s: self.damping_s,
        };
        let mut modes: Vec<(FullMode, Vec<c64>)> = Vec::new();
        for group in found.chunks(PAIRS) {
            let pairs: Vec<Pair> = group
                .iter()
                .map(|(value, right)| Pair { value: *value, right: right.clone(), left: Vec::new() })
                .collect();
            let full = self.full(&vibration, elasticity, &pencil, &pairs);
            modes.extend(full.into_iter().zip(group.iter().map(|(_, right)| right.clone())));
        }
        for _ in 0..accuracy.groups {
            let chosen = accuracy.choose(&mut modes);
            if chosen == 0 {
                break;
            }
            let group: Vec<(c64, Vec<c64>)> =
                modes[..chosen].iter().map(|(mode, right)| (mode.value, right.clone())).collect();
            let corrected = self.correct(&vibration, elasticity, &pencil, &group, accuracy);
            for ((mode, _), corrected) in modes.iter_mut().zip(corrected) {
                *mode = FullMode { is_corrected: true, ..corrected };
            }
        }
        let mut modes: Vec<FullMode> = modes.into_iter().map(|(mode, _)| mode).collect();
        modes.sort_by(|a, b| b.value.re.total_cmp(&a.value.re));
        // Beyond the band the basis lacks modes, and what it has there need not be one.
        let is_reliable = |mode: &FullMode| {
            self.basis.is_complete
                || mode.value.im <= TAU * self.basis.band_hz
                || mode.residual <= accuracy.residual
        };
        modes.retain(is_reliable);
        modes.truncate(count);
        modes
    }

    /// Corrects up to four modes in the full space. Each round adds the responses of the pin to the residuals of right and
    /// left eigenvectors to the basis, so the error of an eigenvalue falls with the product of both.
    fn correct(
        &self,
        vibration: &Vibration<'_>,
        elasticity: &mut Elasticity<'_>,
        pencil: &Pencil,
        group: &[(c64, Vec<c64>)],
        accuracy: Accuracy,
    ) -> Vec<FullMode> {
        let mut extension = Extension::none();
        let mut pencil = pencil.clone();
        let mut pairs: Vec<Pair> =
            group.iter().map(|(value, right)| pencil.polish(Clock::Continuous, *value, right)).collect();
        for round in 0..=accuracy.rounds {
            let values = values_of(&pairs);
            let right = self.expand(&extension, &pairs, |pair| &pair.right);
            let residuals = vibration.residuals(elasticity, &values, &right, false);
            let relative = vibration.relative(&residuals);
            if round == accuracy.rounds || relative.iter().all(|residual| *residual <= accuracy.residual) {
                return self.report(&pencil, &pairs, &right, &relative);
            }
            let left = self.expand(&extension, &pairs, |pair| &pair.left);
            let left_residuals = vibration.residuals(elasticity, &values, &left, true);
            let responses = [residuals, left_residuals].map(|Residuals { force, .. }| {
                let mut response = self.space.zeros();
                vibration.bilateral.solve(elasticity, &force, &mut response, CORRECTION_STEPS);
                response
            });
            pencil = extension.extend(self.basis, vibration, elasticity, &pencil, &responses, pairs.len());
            pairs = pencil
                .followed(&pairs)
                .into_iter()
                .map(|(value, right)| pencil.polish(Clock::Continuous, value, &right))
                .collect();
        }
        unreachable!("the last round returns")
    }

    fn full(
        &self,
        vibration: &Vibration<'_>,
        elasticity: &mut Elasticity<'_>,
        pencil: &Pencil,
        pairs: &[Pair],
    ) -> Vec<FullMode> {
        let right = self.expand(&Extension::none(), pairs, |pair| &pair.right);
        let residuals = vibration.residuals(elasticity, &values_of(pairs), &right, false);
        let relative = vibration.relative(&residuals);
        self.report(pencil, pairs, &right, &relative)
    }

    fn report(
        &self,
        pencil: &Pencil,
        pairs: &[Pair],
        right: &Vectors,
        relative: &[f64; PAIRS],
    ) -> Vec<FullMode> {
        let mode = |(at, pair): (usize, &Pair)| {
            let (real, imaginary) = (Space::lane(right, 2 * at), Space::lane(right, 2 * at + 1));
            let mut shape: Vec<c64> =
                real.into_iter().zip(imaginary).map(|(re, im)| c64::new(re, im)).collect();
            let largest = shape
                .iter()
                .fold(c64::new(0.0, 0.0), |a, b| if b.norm_sqr() > a.norm_sqr() { *b } else { a });
            for value in &mut shape {
                *value /= largest;
            }
            let value_in_steps = pencil.polish(self.steps, pair.value, &pair.right).value;
            FullMode { value: pair.value, value_in_steps, residual: relative[at], is_corrected: false, shape }
        };
        pairs.iter().enumerate().map(mode).collect()
    }

    /// Vectors of the basis and its extension from their coordinates: real and imaginary parts in pairs of lanes.
    fn expand<'p>(
        &self,
        extension: &Extension,
        pairs: &'p [Pair],
        of: impl Fn(&'p Pair) -> &'p Vec<c64>,
    ) -> Vectors {
        let r = self.basis.len();
        let coordinate = |i: usize, lane: usize| {
            let value = of(&pairs[lane / 2])[i];
            if lane.is_multiple_of(2) { value.re } else { value.im }
        };
        let lanes = 2 * pairs.len();
        let own = Mat::from_fn(r, lanes, coordinate);
        let mut sum = &self.basis.vectors * &own;
        if !extension.vectors.is_empty() {
            let added = Mat::from_fn(extension.vectors.len(), lanes, |i, lane| coordinate(r + i, lane));
            let vectors =
                Mat::from_fn(self.space.len(), extension.vectors.len(), |i, j| extension.vectors[j][i]);
            sum += &vectors * &added;
        }
        let columns: Vec<Vec<f64>> = (0..lanes).map(|lane| sum.col(lane).iter().copied().collect()).collect();
        let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        self.space.gather(&views)
    }
}

/// Error of an eigenvalue whose eigenvector has the relative residual η: the residuals of the right and the left
/// eigenvector multiply. Errors that corrections removed were at most half of that.
pub fn error_per_s(value: c64, residual: f64) -> f64 {
    3.0 * value.norm() * residual * residual
}

fn values_of(pairs: &[Pair]) -> [c64; PAIRS] {
    std::array::from_fn(|at| pairs.get(at).map_or(c64::new(0.0, 0.0), |pair| pair.value))
}

/// The contact of an equilibrium, as constraints of small vibrations.
pub fn contact(equilibrium: &UnitEquilibrium) -> Contact<'_> {
    Contact { in_contact: &equilibrium.in_contact, is_locked_sideways: false }
}
