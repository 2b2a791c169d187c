//! History matching: which values of free parameters do measured values not rule out?
//!
//! ```text
//! runs at points of the unit cube ──► states at each measured point ──► emulators of each state ──► implausibility ──► region
//! ```
//!
//! Everything here is numbers: a point is a place in the unit cube, a quantity is a position in a list. What they mean is known to
//! [`sweep`](crate::sweep).
//!
//! The implausibility of a place is the distance of a measured value from that which the emulator expects, over the standard deviation of
//! this distance: that of the measurement with the discrepancy of the model, that of the emulator, and that of the mesh (Craig, Goldstein,
//! Seheult and Smith 1997; Vernon, Goldstein and Bower, Bayesian Anal. 5, 2010). A place is ruled out if the implausibility of one measured
//! value is larger than [`History::cutoff`].

mod emulator;
mod region;
mod states;

pub use region::{Candidate, Region};

use emulator::{Kernels, LeaveOneOut};
use states::States;

/// The number of quantities of a measured point.
pub const QUANTITIES: usize = 2;

/// The quantity whose jumps divide limit cycles into branches: the logarithm of the frequency.
pub const LOG_FREQUENCY: usize = 1;

/// What was measured at a point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Target {
    /// Whether it squeals, if that is known.
    pub squeals: Option<bool>,
    /// The quantities that were measured.
    pub values: [Option<Measured>; QUANTITIES],
}

/// A measured value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// The standard deviation of the measurement and of the model's discrepancy together.
    pub deviation: f64,
}

/// What a run gave where something was measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outcome {
    /// Whether it squeals, if that is known.
    pub squeals: Option<bool>,
    /// The quantities that it has.
    pub values: [Option<Computed>; QUANTITIES],
}

/// A value of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Computed {
    /// The value.
    pub value: f64,
    /// The standard deviation of the error that the mesh makes, if it is known.
    pub mesh_deviation: Option<f64>,
}

/// A run: its place in the unit cube, and what it gave at each measured point; none where it has no result.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The place: a number from 0 to 1 for each free parameter.
    pub place: Vec<f64>,
    /// In the order of the measured points.
    pub outcomes: Vec<Option<Outcome>>,
}

/// An expected value at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// The mean.
    pub mean: f64,
    /// The standard deviation of the emulator.
    pub emulator: f64,
    /// The standard deviation of the mesh; 0 where it is not known.
    pub mesh: f64,
}

impl Expected {
    /// How far a measured value is away, in standard deviations.
    pub fn implausibility(&self, measured: &Measured) -> f64 {
        (measured.value - self.mean).abs() / self.deviation(measured)
    }

    fn deviation(&self, measured: &Measured) -> f64 {
        (self.emulator.powi(2) + self.mesh.powi(2) + measured.deviation.powi(2)).sqrt()
    }
}

/// What a place is expected to give at a measured point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Assessment {
    /// The largest implausibility.
    pub implausibility: f64,
    /// The sum of the squares of the implausibilities.
    pub square_sum: f64,
    /// The expected values of the measured quantities, where there is an emulator.
    pub values: [Option<Expected>; QUANTITIES],
}

/// How well the emulators of a quantity have foretold runs that were left out.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Check {
    /// Values that were left out, one at a time.
    pub values: usize,
    /// Those that were foretold within two standard deviations.
    pub within_two: usize,
    /// The root mean square of the errors, in standard deviations.
    pub root_mean_square: f64,
}

/// All runs, the measured points, and the emulators between them.
#[derive(Debug)]
pub struct History {
    runs: Vec<Run>,
    targets: Vec<Target>,
    kernels: Kernels,
    states: Vec<States>,
    checks: [Check; QUANTITIES],
    cutoff: f64,
}

/// The usual cutoff: at most 5 % of any distribution with one mode is further from its mean than three standard deviations (Pukelsheim,
/// Am. Stat. 48, 1994).
const CUTOFF: f64 = 3.0;

/// The probability with which the true place may be ruled out by chance, if errors are normal and independent.
const LOST: f64 = 0.05;

impl History {
    /// The emulators of some runs.
    pub fn new(runs: Vec<Run>, targets: Vec<Target>) -> Self {
        let mut kernels = Kernels::default();
        let mut found = Vec::new();
        let states = states::all(&runs, &targets, &mut kernels, &mut found);
        let mut checks = [Check::default(); QUANTITIES];
        for (quantity, LeaveOneOut { values, within_two, square_sum }) in found {
            let check: &mut Check = &mut checks[quantity];
            let sum = check.root_mean_square.powi(2) * check.values as f64 + square_sum;
            check.values += values;
            check.within_two += within_two;
            check.root_mean_square = (sum / check.values as f64).sqrt();
        }
        let values: usize = targets.iter().map(|target| target.values.iter().flatten().count()).sum();
        Self { runs, targets, kernels, states, checks, cutoff: cutoff(values) }
    }

    /// The implausibility above which a place is ruled out: 3, and more if so many values were measured that the true place would be lost
    /// with a probability of more than 5 %.
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// How well the emulators have foretold runs that were left out, for each quantity.
    pub fn checks(&self) -> [Check; QUANTITIES] {
        self.checks
    }

    /// The runs.
    pub fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// The measured points.
    pub fn targets(&self) -> &[Target] {
        &self.targets
    }

    /// What a place is expected to give at each measured point.
    pub fn at(&self, place: &[f64]) -> Vec<Assessment> {
        let near = self.kernels.at(place);
        let assess = |(states, target): (&States, &Target)| states.assess(place, target, &near, &self.runs);
        self.states.iter().zip(&self.targets).map(assess).collect()
    }

    /// What a run gave, as an assessment without emulators: the number of its measured values that can be compared, the sum of the squares of
    /// their implausibilities, and the largest one. A run that squeals where steady sliding was measured, or the other way round, has an
    /// infinite one.
    pub fn of_run(&self, run: &Run) -> (usize, Assessment) {
        let mut all = Assessment::default();
        let mut compared = 0;
        for (target, outcome) in self.targets.iter().zip(&run.outcomes) {
            let Some(outcome) = outcome else { continue };
            if let (Some(measured), Some(own)) = (target.squeals, outcome.squeals)
                && measured != own
            {
                (all.implausibility, all.square_sum) = (f64::INFINITY, f64::INFINITY);
            }
            for (measured, own) in target.values.iter().zip(&outcome.values) {
                let (Some(measured), Some(own)) = (measured, own) else { continue };
                let mesh = own.mesh_deviation.unwrap_or(0.0);
                let implausibility =
                    Expected { mean: own.value, emulator: 0.0, mesh }.implausibility(measured);
                compared += 1;
                all.square_sum += implausibility.powi(2);
                all.implausibility = all.implausibility.max(implausibility);
            }
        }
        (compared, all)
    }
}

/// The cutoff for so many measured values: two-sided, with the probability of [`LOST`] shared among them (Bonferroni).
fn cutoff(values: usize) -> f64 {
    let share = LOST / values.max(1) as f64;
    let (mut low, mut high) = (CUTOFF, 40.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if libm::erfc(middle / std::f64::consts::SQRT_2) > share { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests;
