//! Whether steady sliding decays: measured growth rates, line by line.
//!
//! A small amplitude says nothing: a weak instability may hide for tens of milliseconds under the
//! decaying start-up oscillation. While every contact node slips the system is linear, so the spectrum
//! of N/F − 1 is a sum of lines that grow or decay exponentially. Hann-windowed spectra of successive,
//! half-overlapping stretches give every line's growth rate with its standard error. Sliding counts as
//! decaying when
//! * every strong line (within 10⁻³ of the strongest) decays by more than three standard errors, and
//! * no line at all, down to rounding, grows by more than three standard errors.

use super::sample::Sample;
use crate::spec::Detection;
use realfft::{RealFftPlanner, RealToComplex};
use std::collections::VecDeque;
use std::f64::consts::PI;
use std::sync::Arc;

/// Stretches per observation time; each overlaps the next by half.
const STRETCHES: usize = 7;
/// A line is strong within this factor of the strongest.
const STRONG: f64 = 1.0e-3;
/// Amplitudes of N/F below this are rounding.
const ROUNDING: f64 = 1.0e-11;
/// A rate is believed when it differs from zero by this many standard errors.
const STANDARD_ERRORS: f64 = 3.0;
/// The Hann window spreads the mean over the lowest lines.
const FIRST_LINE: usize = 3;

/// Watches sliding for growth and decay.
pub struct DecayMonitor {
    ramp_s: f64,
    hop: usize,
    hop_s: f64,
    transform: Arc<dyn RealToComplex<f64>>,
    window: Vec<f64>,
    samples: Vec<f64>,
    spectra: VecDeque<Vec<f64>>,
    start_amplitude: f64,
    fastest: Option<f64>,
    decays: bool,
}

impl DecayMonitor {
    /// A monitor that starts after the load's ramp.
    pub fn new(time_step_s: f64, ramp_s: f64, detection: &Detection) -> Self {
        let hops = STRETCHES + 1;
        let hop = (detection.decay_observation_s / (hops as f64 * time_step_s)).ceil().max(8.0) as usize;
        let length = 2 * hop;
        let window = (0..length).map(|i| 0.5 - 0.5 * (2.0 * PI * i as f64 / length as f64).cos()).collect();
        Self {
            ramp_s,
            hop,
            hop_s: hop as f64 * time_step_s,
            transform: RealFftPlanner::new().plan_fft_forward(length),
            window,
            samples: Vec::with_capacity(length),
            spectra: VecDeque::with_capacity(STRETCHES),
            start_amplitude: 0.0,
            fastest: None,
            decays: false,
        }
    }

    /// Growth rate [1/s] of the fastest growing (or slowest decaying) strong line over the last
    /// observation time; none unless all of it was sliding.
    pub fn growth_rate_per_s(&self) -> Option<f64> {
        self.fastest
    }

    /// Adds one step; returns whether sliding has been measured to decay and has not ended since.
    pub fn push(&mut self, sample: &Sample) -> bool {
        if sample.time_s < self.ramp_s {
            return false;
        }
        if sample.stick + sample.separated > 0 {
            self.samples.clear();
            self.spectra.clear();
            self.fastest = None;
            self.decays = false;
            return false;
        }
        self.samples.push(sample.normal_n / sample.load_n - 1.0);
        if self.samples.len() == 2 * self.hop {
            let spectrum = self.spectrum();
            self.samples.drain(..self.hop);
            if self.spectra.len() == STRETCHES {
                self.spectra.pop_front();
            }
            if self.spectra.is_empty() {
                self.start_amplitude = strongest(&spectrum);
            }
            self.spectra.push_back(spectrum);
            if self.spectra.len() == STRETCHES {
                let (fastest, decays) = self.judge();
                (self.fastest, self.decays) = (Some(fastest), decays);
            }
        }
        self.decays
    }

    /// Amplitudes of the lines of the last stretch.
    fn spectrum(&mut self) -> Vec<f64> {
        let length = 2 * self.hop;
        let mean = self.samples.iter().sum::<f64>() / length as f64;
        let mut input: Vec<f64> =
            self.samples.iter().zip(&self.window).map(|(x, w)| (x - mean) * w).collect();
        let mut output = self.transform.make_output_vec();
        self.transform.process(&mut input, &mut output).expect("buffers have the planned lengths");
        // A unit sinusoid in the middle of a line has the Hann-windowed sum length/4.
        output.iter().skip(FIRST_LINE).map(|c| c.norm() * 4.0 / length as f64).collect()
    }

    /// The largest growth rate [1/s] of a strong line, and whether all lines decay.
    fn judge(&self) -> (f64, bool) {
        let last = &self.spectra[STRETCHES - 1];
        let highest = strongest(last);
        if highest < ROUNDING {
            // Everything has decayed to rounding since the sliding began: a measured decay, too.
            let elapsed_s = self.hop_s * (STRETCHES - 1) as f64;
            let rate = (ROUNDING / self.start_amplitude.max(ROUNDING)).ln() / elapsed_s;
            return (rate, true);
        }
        let mut fastest = f64::NEG_INFINITY;
        let mut decays = true;
        for line in (0..last.len()).filter(|&line| last[line] >= ROUNDING) {
            let (rate, error) = self.growth_rate(line);
            decays &= rate - STANDARD_ERRORS * error <= 0.0;
            if last[line] >= STRONG * highest {
                decays &= rate + STANDARD_ERRORS * error < 0.0;
                fastest = fastest.max(rate);
            }
        }
        (fastest, decays)
    }

    /// Slope [1/s] of the logarithm of a line's amplitude, and its standard error.
    fn growth_rate(&self, line: usize) -> (f64, f64) {
        let n = self.spectra.len() as f64;
        let logs: Vec<f64> = self.spectra.iter().map(|s| s[line].max(f64::MIN_POSITIVE).ln()).collect();
        let mean_log = logs.iter().sum::<f64>() / n;
        let mean_time = (n - 1.0) / 2.0 * self.hop_s;
        let (mut spread, mut product) = (0.0, 0.0);
        for (i, log) in logs.iter().enumerate() {
            let t = i as f64 * self.hop_s - mean_time;
            spread += t * t;
            product += t * (log - mean_log);
        }
        let rate = product / spread;
        let residual: f64 = logs
            .iter()
            .enumerate()
            .map(|(i, log)| (log - mean_log - rate * (i as f64 * self.hop_s - mean_time)).powi(2))
            .sum();
        (rate, (residual / (n - 2.0) / spread).sqrt())
    }
}

fn strongest(spectrum: &[f64]) -> f64 {
    spectrum.iter().copied().fold(0.0, f64::max)
}
