//! Growth and decay of one signal of a linear system, line by line.
//!
//! A small amplitude proves nothing: the decaying start-up oscillation may hide a weak instability for tens
//! of milliseconds. A signal of a linear system is a sum of lines that grow or decay exponentially. The
//! signal is therefore divided into successive, overlapping stretches. Their spectra give the growth rate of
//! every line with its standard error. There are two sets of stretches:
//! * Long stretches under a Kaiser window. Its side lobes (10⁻⁸) do not hide a weak line beside a strong one.
//!   Every peak in these spectra, down to rounding, must decay by more than three standard errors.
//! * Short stretches under a Hann window, which follow a line in time. In them every strong line (within 10⁻³
//!   of the strongest) must decay steadily. Two lines that are too close for the long stretches beat. A beat
//!   falls for a while, but not exponentially.
//!
//! Lines below a floor are not judged. The floor is rounding, or the amplitude of a permanent excitation.
//!
//! This method cannot detect a line within the main lobe of one that is 10³ times stronger or more (1.4 kHz
//! at an observation of 8 ms, in inverse proportion to it). It cannot separate two lines whose beat takes
//! longer than the observation. A longer `decay_observation_s` resolves both.

use realfft::{RealFftPlanner, RealToComplex};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::f64::consts::PI;
use std::sync::Arc;

/// Hops per observation time. A new stretch of each kind begins with every hop.
const HOPS: usize = 16;
/// Hops in a long stretch and in a short stretch.
const LONG: usize = 10;
const SHORT: usize = 4;
/// Parameter of the Kaiser window. Its side lobes are 10⁻⁸, its main lobe is ±√(1 + (β/π)²) = ±6.8 lines.
const KAISER_BETA: f64 = 21.0;
/// The lowest line that is judged. It is outside the main lobe of the mean.
const FIRST_LINE: usize = 7;
/// A line that is weaker than the strongest by this factor may be a side lobe.
const LEAKAGE: f64 = 1.0e-7;
/// A line is strong if it is within this factor of the strongest.
const STRONG: f64 = 1.0e-3;
/// Amplitudes (of signals of order one) below this value are rounding.
pub const ROUNDING: f64 = 1.0e-11;
/// A rate is significant if it differs from zero by this many standard errors.
const STANDARD_ERRORS: f64 = 3.0;
/// The same for the short stretches, whose misfit is a beat rather than chance. The value corresponds to a
/// correlation of −0.875 with a straight line (a whole period of a sine has 0.78).
const STEADY_STANDARD_ERRORS: f64 = 6.0;
/// Smallest decrease of a strong line's logarithm over the observation time that counts as a decay.
const SMALLEST_FALL: f64 = 1.0e-3;

/// Detects growth and decay of one signal.
#[derive(Serialize, Deserialize)]
pub struct LineMonitor {
    floor: f64,
    hop: usize,
    hop_s: f64,
    since_hop: usize,
    samples: Vec<f64>,
    long: Stretches,
    short: Stretches,
    start_amplitude: f64,
    hops: u64,
    measured: Option<f64>,
    verdict: Option<Verdict>,
    /// The strong lines of the last verdict.
    strong: Vec<StrongLine>,
}

/// A line that is within a factor of the strongest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StrongLine {
    /// Its number in the long spectra: its frequency times their duration.
    pub line: usize,
    /// Its amplitude in the last of them.
    pub amplitude: f64,
    /// Growth rate \[1/s\].
    pub rate_per_s: f64,
}

impl StrongLine {
    /// Whether it is what the product of two stronger lines makes: it has the sum or the difference of their frequencies, and
    /// the sum of their rates. The second harmonic of a growing mode is the product of its line with itself.
    fn is_product_in(&self, lines: &[Self]) -> bool {
        let stronger = || lines.iter().filter(|other| other.amplitude > self.amplitude);
        // Each of three lines is known to half a line, and rates to some per cent.
        let is_near = |line: usize| self.line.abs_diff(line) <= 2;
        let has_rate = |rate: f64| (self.rate_per_s - rate).abs() <= 0.05 * self.rate_per_s.abs();
        stronger().any(|a| {
            stronger().any(|b| {
                has_rate(a.rate_per_s + b.rate_per_s)
                    && (is_near(a.line + b.line) || is_near(a.line.abs_diff(b.line)))
            })
        })
    }
}

/// The growth rate \[1/s\] of the fastest growing of the strong `lines` of all signals that is not the product of others; none without
/// lines.
///
/// N is not linear where a node's slip turns, and not where friction depends on the slip speed. There a growing mode has
/// harmonics, which grow twice as fast.
pub fn fastest_of_modes(lines: &[StrongLine]) -> Option<f64> {
    let of_modes = lines.iter().filter(|line| !line.is_product_in(lines)).map(|line| line.rate_per_s);
    of_modes.reduce(f64::max)
}

/// The result for a signal over the last observation time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Growth rate \[1/s\] of the fastest growing (or slowest decaying) strong line. After all lines have
    /// decayed to the floor, it is the last measured rate. It is none if the signal was never above the
    /// floor.
    pub growth_rate_per_s: Option<f64>,
    /// Whether all lines decay.
    pub decays: bool,
}

/// Successive spectra of one kind.
#[derive(Serialize, Deserialize)]
struct Stretches {
    taper: Taper,
    kept: usize,
    #[serde(skip)]
    plan: Option<Plan>,
    spectra: VecDeque<Vec<f64>>,
}

/// The window of a stretch, a function over −1 … 1.
#[derive(Clone, Copy, Serialize, Deserialize)]
enum Taper {
    Hann,
    Kaiser,
}

/// The plan of a transform and the weights of its window. It is created when the first stretch is complete.
struct Plan {
    transform: Arc<dyn RealToComplex<f64>>,
    weights: Vec<f64>,
    weight: f64,
}

impl Stretches {
    fn new(hops: usize, taper: Taper) -> Self {
        Self { taper, kept: HOPS - hops + 1, plan: None, spectra: VecDeque::new() }
    }

    /// Adds the stretch `samples`. All stretches have the same length.
    fn push(&mut self, samples: &[f64]) {
        let plan = self.plan.get_or_insert_with(|| {
            let length = samples.len();
            let weights: Vec<f64> =
                (0..length).map(|i| self.taper.at((2.0 * i as f64 + 1.0) / length as f64 - 1.0)).collect();
            let weight = weights.iter().sum();
            Plan { transform: RealFftPlanner::new().plan_fft_forward(length), weights, weight }
        });
        // Subtracting the weighted mean removes the line 0, which could leak into others.
        let mean = samples.iter().zip(&plan.weights).map(|(x, w)| x * w).sum::<f64>() / plan.weight;
        let mut input: Vec<f64> = samples.iter().zip(&plan.weights).map(|(x, w)| (x - mean) * w).collect();
        let mut output = plan.transform.make_output_vec();
        plan.transform.process(&mut input, &mut output).expect("buffers have the planned lengths");
        if self.spectra.len() == self.kept {
            self.spectra.pop_front();
        }
        self.spectra.push_back(output.iter().map(|c| libm::hypot(c.re, c.im) * 2.0 / plan.weight).collect());
    }

    /// Whether there are enough stretches for an observation.
    fn is_complete(&self) -> bool {
        self.spectra.len() == self.kept
    }

    /// Slope per hop of the logarithm of a line's amplitude, and its standard error.
    fn growth_per_hop(&self, line: usize) -> (f64, f64) {
        let n = self.spectra.len() as f64;
        let logs: Vec<f64> = self.spectra.iter().map(|s| libm::log(s[line].max(f64::MIN_POSITIVE))).collect();
        let mean = logs.iter().sum::<f64>() / n;
        let centre = (n - 1.0) / 2.0;
        let (mut spread, mut product) = (0.0, 0.0);
        for (i, log) in logs.iter().enumerate() {
            let x = i as f64 - centre;
            spread += x * x;
            product += x * (log - mean);
        }
        let slope = product / spread;
        let residual: f64 =
            logs.iter().enumerate().map(|(i, log)| (log - mean - slope * (i as f64 - centre)).powi(2)).sum();
        (slope, (residual / (n - 2.0) / spread).sqrt())
    }
}

impl Taper {
    fn at(self, x: f64) -> f64 {
        match self {
            Self::Hann => 0.5 + 0.5 * libm::cos(PI * x),
            Self::Kaiser => bessel_i0(KAISER_BETA * (1.0 - x * x).sqrt()) / bessel_i0(KAISER_BETA),
        }
    }
}

/// Modified Bessel function of the first kind and order 0, by its series.
fn bessel_i0(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    let mut k = 0.0;
    while term > 1.0e-17 * sum {
        k += 1.0;
        term *= (x / (2.0 * k)).powi(2);
        sum += term;
    }
    sum
}

impl LineMonitor {
    /// A monitor that judges lines above the amplitude `floor` over `observation_s`.
    pub fn new(time_step_s: f64, observation_s: f64, floor: f64) -> Self {
        // This limits the number of steps in a stretch, however long the observation is.
        let longest = (u32::MAX as usize / HOPS) as f64;
        let hop = (observation_s / (HOPS as f64 * time_step_s)).ceil().clamp(8.0, longest);
        Self {
            floor,
            hop: hop as usize,
            hop_s: hop * time_step_s,
            since_hop: 0,
            samples: Vec::new(),
            long: Stretches::new(LONG, Taper::Kaiser),
            short: Stretches::new(SHORT, Taper::Hann),
            start_amplitude: 0.0,
            hops: 0,
            measured: None,
            verdict: None,
            strong: Vec::new(),
        }
    }

    /// The strong lines of the last complete observation; none after all have decayed to the floor.
    pub fn strong_lines(&self) -> &[StrongLine] {
        &self.strong
    }

    /// The result of the last complete observation; none before there is one.
    pub fn verdict(&self) -> Option<Verdict> {
        self.verdict
    }

    /// Adds one step's value.
    pub fn push(&mut self, value: f64) {
        self.samples.push(value);
        self.since_hop += 1;
        if self.since_hop == self.hop {
            self.since_hop = 0;
            self.finish_hop();
        }
    }

    /// Starts the observation anew.
    pub fn start_anew(&mut self) {
        self.since_hop = 0;
        self.samples.clear();
        self.long.spectra.clear();
        self.short.spectra.clear();
        self.start_amplitude = 0.0;
        self.hops = 0;
        self.measured = None;
        self.verdict = None;
        self.strong.clear();
    }

    fn finish_hop(&mut self) {
        self.hops += 1;
        let count = self.samples.len();
        if count >= SHORT * self.hop {
            self.short.push(&self.samples[count - SHORT * self.hop..]);
            if self.short.spectra.len() == 1 {
                self.start_amplitude = self.short.spectra[0].iter().copied().fold(0.0, f64::max);
            }
        }
        if count == LONG * self.hop {
            self.long.push(&self.samples);
            self.samples.drain(..self.hop);
        }
        if self.long.is_complete() && self.short.is_complete() {
            self.verdict = Some(self.judge());
        }
    }

    fn judge(&mut self) -> Verdict {
        self.strong.clear();
        let last = &self.long.spectra[self.long.spectra.len() - 1];
        let highest = last.iter().skip(FIRST_LINE).copied().fold(0.0, f64::max);
        if highest < self.floor {
            // All lines have decayed to the floor since the signal began. This is a measured decay, too.
            let elapsed_s = self.hop_s * (self.hops - SHORT as u64) as f64;
            let at_least = (self.start_amplitude > self.floor)
                .then(|| libm::log(self.floor / self.start_amplitude) / elapsed_s);
            return Verdict { growth_rate_per_s: self.measured.or(at_least), decays: true };
        }
        let faintest = self.floor.max(LEAKAGE * highest);
        let smallest = SMALLEST_FALL / HOPS as f64;
        let mut fastest = f64::NEG_INFINITY;
        let mut decays = true;
        for line in (FIRST_LINE..last.len()).filter(|&line| last[line] >= faintest && is_peak(last, line)) {
            let (rate, error) = self.long.growth_per_hop(line);
            decays &= rate + STANDARD_ERRORS * error < 0.0;
            if last[line] >= STRONG * highest {
                let short_line = (line * SHORT + LONG / 2) / LONG;
                let (short_rate, short_error) = self.short.growth_per_hop(short_line);
                decays &= rate < -smallest && short_rate + STEADY_STANDARD_ERRORS * short_error < 0.0;
                let rate_per_s = rate / self.hop_s;
                fastest = fastest.max(rate_per_s);
                self.strong.push(StrongLine { line, amplitude: last[line], rate_per_s });
            }
        }
        self.measured = Some(fastest);
        Verdict { growth_rate_per_s: self.measured, decays }
    }
}

/// Whether a line is a local maximum. Lines below [`FIRST_LINE`] do not count as neighbours.
fn is_peak(spectrum: &[f64], line: usize) -> bool {
    (line == FIRST_LINE || spectrum[line - 1] < spectrum[line])
        && spectrum.get(line + 1).is_none_or(|&next| next <= spectrum[line])
}
