//! The windows of a run over which figures are averaged.

use super::figures::Figures;
use super::sample::Sample;
use crate::solver::energy::Energies;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The window at the end of a run that reaches its time limit.
#[derive(Serialize, Deserialize)]
pub(super) struct LateWindow {
    /// Where it starts \[s\].
    pub start_s: f64,
    /// Figures of its steps.
    pub figures: Figures,
    /// Energies at its first step; none before that step.
    pub energies: Option<Energies>,
}

impl LateWindow {
    /// A window from `start_s` to the end of the run.
    pub fn from(start_s: f64) -> Self {
        Self { start_s, figures: Figures::EMPTY, energies: None }
    }

    /// Adds a step if it lies in the window.
    pub fn push(&mut self, sample: &Sample, energies: &Energies) {
        if sample.time_s >= self.start_s {
            self.figures.add(sample, 1.0);
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
    figures: Figures,
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
            self.blocks.push_back(Block { start_s, figures: Figures::EMPTY, energies });
        }
        self.steps += 1;
        if let Some(block) = self.blocks.back_mut() {
            block.figures.add(sample, 1.0);
        }
    }

    /// The window of all blocks.
    pub fn window(&self, tapered: bool) -> Window {
        let figures = self.blocks.iter().map(|block| &block.figures);
        let first = self.blocks.front();
        Window {
            start_s: first.map_or(0.0, |block| block.start_s),
            figures: if tapered { Figures::tapered(figures) } else { Figures::merged(figures) },
            energies: first.map(|block| block.energies).unwrap_or_default(),
            mu_star_parts: self.blocks.iter().map(|block| block.figures.mu_star()).collect(),
            cycles: 0,
            frequency_hz: None,
        }
    }
}

/// The window over which the figures of a record are averaged.
pub(super) struct Window {
    /// Where it starts \[s\].
    pub start_s: f64,
    /// Figures of its steps.
    pub figures: Figures,
    /// Energies at its start.
    pub energies: Energies,
    /// T/F of the parts of the window. They give the standard error of the mean.
    pub mu_star_parts: Vec<f64>,
    /// Number of limit cycles.
    pub cycles: usize,
    /// Fundamental frequency \[Hz\] of N.
    pub frequency_hz: Option<f64>,
}
