//! The windows of a run over which figures are averaged.

use super::plastic;
use super::sample::Sample;
use super::sums::Sums;
use crate::solver::energy::Energies;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The window at the end of a run that reaches its time limit.
#[derive(Serialize, Deserialize)]
pub(super) struct LateWindow {
    /// Where it starts \[s\].
    pub start_s: f64,
    /// Sums of its steps.
    pub sums: Sums,
    /// Energies at its first step; none before that step.
    pub energies: Option<Energies>,
}

impl LateWindow {
    /// A window from `start_s` to the end of the run.
    pub fn from(start_s: f64) -> Self {
        Self { start_s, sums: Sums::EMPTY, energies: None }
    }

    /// Adds a step if it lies in the window.
    pub fn push(&mut self, sample: &Sample, energies: &Energies) {
        if sample.time_s >= self.start_s {
            self.sums.add(sample, 1.0);
            self.energies.get_or_insert(*energies);
        }
    }
}

/// The last observation time, divided into equal blocks of steps.
#[derive(Serialize, Deserialize)]
pub(super) struct Trailing {
    steps_per_block: u64,
    steps: u64,
    blocks: VecDeque<Block>,
}

/// A block of consecutive steps.
#[derive(Serialize, Deserialize)]
struct Block {
    start_s: f64,
    sums: Sums,
    /// Energies at the start.
    energies: Energies,
}

impl Trailing {
    /// Blocks per observation time. There are so many of them that a Hann taper over them is smooth.
    const BLOCKS: usize = 64;

    pub fn new(observation_s: f64, time_step_s: f64) -> Self {
        let steps_per_block = (observation_s / (Self::BLOCKS as f64 * time_step_s)).max(1.0) as u64;
        Self { steps_per_block, steps: 0, blocks: VecDeque::with_capacity(Self::BLOCKS) }
    }

    /// Adds one step.
    pub fn push(&mut self, sample: &Sample, energies: &Energies) {
        if self.steps.is_multiple_of(self.steps_per_block) {
            if self.blocks.len() == Self::BLOCKS {
                self.blocks.pop_front();
            }
            let (start_s, energies) = (sample.time_s, *energies);
            self.blocks.push_back(Block { start_s, sums: Sums::EMPTY, energies });
        }
        self.steps += 1;
        if let Some(block) = self.blocks.back_mut() {
            block.sums.add(sample, 1.0);
        }
    }

    /// Whether a block has just begun.
    pub fn begins_block(&self) -> bool {
        self.steps.is_multiple_of(self.steps_per_block)
    }

    /// How far the means of decaying sliding are from their ends. In steady sliding nodes have the coefficient `steady_mu` where the mean normal
    /// force acts ([`Sums::centre`]); none if the law does not say.
    pub fn settling(&self, steady_mu: impl FnOnce([f64; 2]) -> Option<f64>) -> Settling {
        let all = || self.blocks.iter().map(|block| &block.sums);
        let whole = Sums::tapered(all());
        let [clamp, contact] = [Sums::mu_star, Sums::mu_star_contact].map(|of| {
            let values: Vec<f64> = all().map(of).collect();
            let quarter = self.blocks.len() / 4;
            let means = [0, 1, 2].map(|first| {
                let part = self.blocks.range(first * quarter..(first + 2) * quarter);
                of(&Sums::tapered(part.map(|block| &block.sums)))
            });
            let noise = LEAK * scatter(&values);
            (still_to_come(&means, noise), noise)
        });
        let steady_mu = steady_mu(whole.centre());
        let creep = steady_mu.map_or(contact.0, |mu| (whole.mu_of_nodes() - mu).abs());
        Settling {
            imbalance: whole.imbalance().abs(),
            still_to_come: clamp.0.max(creep),
            oscillation: clamp.1.max(contact.1),
            steady_mu,
        }
    }

    /// The share of the plastic work in what plastic flow and friction dissipate, from the first block on.
    pub fn flow_share(&self, now: &Energies) -> f64 {
        self.blocks.front().map_or(0.0, |first| plastic::share(&first.energies, now))
    }

    /// The window of all blocks.
    pub fn window(&self, tapered: bool, holder_moves: bool) -> Window {
        let sums = self.blocks.iter().map(|block| &block.sums);
        let first = self.blocks.front();
        Window {
            start_s: first.map_or(0.0, |block| block.start_s),
            sums: if tapered { Sums::tapered(sums) } else { Sums::merged(sums) },
            energies: first.map(|block| block.energies).unwrap_or_default(),
            mu_star_parts: self
                .blocks
                .iter()
                .map(|block| block.sums.mu_star_without_momentum(holder_moves))
                .collect(),
            cycles: 0,
            frequency_hz: None,
        }
    }
}

/// How far the means of decaying sliding are from their ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Settling {
    /// Difference of T/F of the clamp and T/N of the contact.
    pub imbalance: f64,
    /// What the means over the observation will still change.
    pub still_to_come: f64,
    /// What an oscillation leaves in them.
    pub oscillation: f64,
    /// The coefficient of steady sliding, if the law says it.
    pub steady_mu: Option<f64>,
}

impl Settling {
    /// Whether both are within `tolerance`, and what is still to come within half a per cent of the coefficient of steady sliding.
    pub fn is_done(&self, tolerance: f64) -> bool {
        let of_friction = self.steady_mu.map_or(f64::INFINITY, |mu| 0.005 * mu);
        self.imbalance <= tolerance && self.still_to_come <= tolerance.min(of_friction)
    }

    /// The error of the means.
    pub fn error(&self) -> f64 {
        libm::hypot(self.still_to_come, self.oscillation)
    }
}

/// What an oscillation with 6 periods or more in half of an observation leaves in a mean under a Hann taper, over its amplitude: for n
/// periods it is 1/(n² − 1)/(πn) or less.
const LEAK: f64 = 2.0e-3;

/// Differences below this part of the tolerance are no creep that matters during a run.
const NEGLIGIBLE: f64 = 0.05;

/// What the mean over an observation will still change, from the means of its first, middle and last half, which are a quarter
/// apart. Differences of up to `noise` may come from oscillations.
///
/// The slowest real mode falls as exp(−ct). So the differences d₁ and d₂ of successive means have the ratio exp(−cτ), and what comes
/// after the mean in the middle is d₂ + d₂ exp(−cτ) + … = d₂/(1 − d₂/d₁). Differences that do not fall have no end.
fn still_to_come(&[first, middle, last]: &[f64; 3], noise: f64) -> f64 {
    let (before, after) = (middle - first, last - middle);
    let largest = before.abs().max(after.abs());
    if largest <= noise {
        // Chance decides the ratio.
        return largest / NEGLIGIBLE;
    }
    let ratio = after / before;
    let has_end = (0.0..1.0).contains(&ratio);
    if has_end { after.abs() / (1.0 - ratio) } else { largest / NEGLIGIBLE }
}

/// Root mean square of the differences of successive values, over √2: their scatter without a trend.
fn scatter(values: &[f64]) -> f64 {
    let squares: f64 = values.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
    (squares / (2.0 * values.len().max(2) as f64 - 2.0)).sqrt()
}

/// The window over which the figures of a record are averaged.
pub(super) struct Window {
    /// Where it starts \[s\].
    pub start_s: f64,
    /// Sums of its steps.
    pub sums: Sums,
    /// Energies at its start.
    pub energies: Energies,
    /// T/F of the parts of the window. They give the standard error of the mean.
    pub mu_star_parts: Vec<f64>,
    /// Number of limit cycles.
    pub cycles: usize,
    /// Fundamental frequency \[Hz\] of N.
    pub frequency_hz: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: what is still to come of a mean that falls as exp(−ct), for real modes that take from a fifth to thirty observations. It is
    /// the mean over the middle half, less the end.
    #[test]
    fn an_exponential_creep_has_an_end() {
        for c in [0.03, 0.3, 1.0, 5.0] {
            // Means over halves of an observation of length 1 are A exp(−ct) with the same factor A.
            let means = [0.25_f64, 0.5, 0.75].map(|t| 0.2 + 0.01 * libm::exp(-c * t));
            let found = still_to_come(&means, 0.0);
            let exact = means[1] - 0.2;
            assert!((found / exact - 1.0).abs() < 1.0e-9, "c = {c}: {found} instead of {exact}");
        }
    }

    /// Protects: a mean that does not settle has not settled: one that grows, turns or rises at a constant rate counts with twenty times its change. A mean
    /// that stands still has nothing to come.
    #[test]
    fn a_creep_without_an_end_is_not_done() {
        for means in [[0.0, 0.001, 0.003], [0.0, 0.001, 0.0], [0.0, 0.001, 0.002]] {
            assert!(still_to_come(&means, 0.0) > 0.02 * 0.99, "{means:?}");
        }
        assert_eq!(still_to_come(&[0.3; 3], 0.0), 0.0);
        // Below the noise the ratio is chance, and only the size counts.
        assert!((still_to_come(&[0.0, 1.0e-5, 1.5e-5], 1.0e-4) / 2.0e-4 - 1.0).abs() < 1.0e-9);
    }

    /// Protects: the scatter of a signal is that of its values, and a trend is none.
    #[test]
    fn a_trend_is_no_scatter() {
        let alternating: Vec<f64> = (0..64).map(|n| if n % 2 == 0 { 0.1 } else { -0.1 }).collect();
        assert!((scatter(&alternating) / (0.1 * 2.0_f64.sqrt()) - 1.0).abs() < 1.0e-12);
        let rising: Vec<f64> = (0..64).map(f64::from).collect();
        assert!((scatter(&rising) / 0.5_f64.sqrt() - 1.0).abs() < 1.0e-12);
    }
}
