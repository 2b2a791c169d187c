//! Limit cycles from section crossings: of the total normal force, and, with a holder that moves, of the force that it carries.

use super::sample::{Sample, Smoother, smoothing_gain};
use super::sums::Sums;
use crate::solver::Model;
use crate::solver::energy::Energies;
use serde::{Deserialize, Serialize};

/// The part of a run from one upward crossing of the section to the next. The section is N = F, or T = its mean.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Start \[s\], interpolated between two steps.
    pub start_s: f64,
    /// End \[s\], interpolated between two steps.
    pub end_s: f64,
    /// Sums of the steps of the cycle.
    pub sums: Sums,
    /// Energies at the start.
    pub energies: Energies,
    /// Half the range \[N\] of the filtered force of the section.
    pub amplitude_n: f64,
    /// Largest and smallest difference \[N\] of that force from the section.
    pub extremes_n: [f64; 2],
    /// Plastic work \[J\] within it, between the last audits before its ends.
    pub plastic_j: f64,
    /// Work of friction \[J\] within it, likewise.
    pub friction_j: f64,
}

impl Cycle {
    /// Duration \[s\].
    pub fn period_s(&self) -> f64 {
        self.end_s - self.start_s
    }
}

/// Time constant of each of the two section filters, over the shear-wave transit time of the pin's height. It
/// is 6.4 µs (25 kHz) in the reference scene. The filters prevent crossings by impact spikes and high modes.
/// Their constant delay does not change the period.
const SECTION_SMOOTHING: f64 = 0.25;

/// A crossing counts only if the force has been below the section by more than this fraction of the last cycle's amplitude
/// since the previous crossing.
const HYSTERESIS: f64 = 0.25;

/// Time constant with which the last cycle's amplitude is forgotten, over the same transit time. It is about
/// six cycles of the reference scene. Without it, a violent start would hide a small cycle for ever.
const AMPLITUDE_MEMORY: f64 = 16.0;

/// Time constant of each of the two filters of T, over the longest period of a swing. It removes the squeal and leaves the swing.
const SWING_SMOOTHING: f64 = 0.01;

/// Time constants of the mean of T and of the memory of its amplitude, over the same period. A cycle in which the holder sticks
/// takes longer than a swing.
const SWING_MEAN: f64 = 10.0;
const SWING_MEMORY: f64 = 6.0;

/// Where cycles begin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
enum Section {
    /// N rises through the load.
    Normal,
    /// The force T that the holder carries rises through its mean. A holder that sticks and slips below the squeal has a cycle that N,
    /// which shows the squeal, does not show.
    Holder { mean: Smoother, gain: f64, steps: f64 },
}

impl Section {
    /// The force \[N\] whose sign is looked at.
    fn force_n(&mut self, sample: &Sample) -> f64 {
        match self {
            Self::Normal => sample.normal_n,
            Self::Holder { mean, gain, steps } => {
                // The first steps are averaged with equal weights, so that the mean does not come from zero.
                *steps += 1.0;
                sample.clamp_tangential_n - mean.push(sample.clamp_tangential_n, gain.max(1.0 / *steps))
            }
        }
    }

    /// Its level \[N\].
    fn level_n(&self, sample: &Sample) -> f64 {
        if *self == Self::Normal { sample.load_n } else { 0.0 }
    }
}

/// Divides a run into cycles, step by step.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct CycleCutter {
    section: Section,
    gain: f64,
    /// Fraction of the remembered amplitude that remains after a step.
    memory: f64,
    filters: [Smoother; 2],
    ramp_s: f64,
    time_step_s: f64,
    previous: f64,
    lowest: f64,
    highest: f64,
    remembered: f64,
    open: Option<(f64, Energies)>,
    sums: Sums,
}

impl CycleCutter {
    /// A cutter at N = F that starts after the load's ramp.
    pub fn new(model: &Model, ramp_s: f64) -> Self {
        let transit_s = model.pin().shear_transit_s();
        let taus_s = [SECTION_SMOOTHING * transit_s, AMPLITUDE_MEMORY * transit_s];
        Self::at(Section::Normal, model.time_step_s(), taus_s, ramp_s)
    }

    /// A cutter at the mean of T that starts after the load's ramp, for a holder that swings with periods of up to `swing_s`.
    pub fn of_holder(time_step_s: f64, ramp_s: f64, swing_s: f64) -> Self {
        let gain = smoothing_gain(time_step_s, SWING_MEAN * swing_s);
        let section = Section::Holder { mean: Smoother::default(), gain, steps: 0.0 };
        Self::at(section, time_step_s, [SWING_SMOOTHING * swing_s, SWING_MEMORY * swing_s], ramp_s)
    }

    fn at(section: Section, time_step_s: f64, [filter_s, memory_s]: [f64; 2], ramp_s: f64) -> Self {
        Self {
            section,
            gain: smoothing_gain(time_step_s, filter_s),
            memory: 1.0 - smoothing_gain(time_step_s, memory_s),
            filters: [Smoother::default(); 2],
            ramp_s,
            time_step_s,
            previous: 0.0,
            lowest: 0.0,
            highest: 0.0,
            remembered: 0.0,
            open: None,
            sums: Sums::EMPTY,
        }
    }

    /// Adds one step; returns the cycle that it completes, if any.
    pub fn push(&mut self, sample: &Sample, energies: &Energies) -> Option<Cycle> {
        let force_n = self.section.force_n(sample);
        let once = self.filters[0].push(force_n, self.gain);
        let above = self.filters[1].push(once, self.gain) - self.section.level_n(sample);
        if sample.time_s < self.ramp_s {
            self.previous = above;
            return None;
        }
        self.lowest = self.lowest.min(above);
        self.highest = self.highest.max(above);
        let crosses = self.previous < 0.0 && above >= 0.0 && -self.lowest > HYSTERESIS * self.remembered;
        self.remembered *= self.memory;
        let mut finished = None;
        let mut next_weight = 1.0;
        if crosses {
            // The step that ends at this sample is shared between the two cycles.
            let fraction = self.previous / (self.previous - above);
            let time_s = sample.time_s - (1.0 - fraction) * self.time_step_s;
            self.sums.add(sample, fraction);
            next_weight = 1.0 - fraction;
            self.remembered = (self.highest - self.lowest) / 2.0;
            finished = self.open.map(|(start_s, at_start)| Cycle {
                start_s,
                end_s: time_s,
                sums: self.sums,
                energies: at_start,
                amplitude_n: self.remembered,
                extremes_n: [self.highest, self.lowest],
                plastic_j: energies.plastic_j - at_start.plastic_j,
                friction_j: energies.friction_j - at_start.friction_j,
            });
            self.open = Some((time_s, *energies));
            self.sums = Sums::EMPTY;
            (self.lowest, self.highest) = (0.0, 0.0);
        }
        self.previous = above;
        self.sums.add(sample, next_weight);
        finished
    }
}
