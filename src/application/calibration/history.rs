//! Runs and measured points, with the emulators between them.

use super::emulator::{Kernels, LeaveOneOut};
use super::states::{self, States};
use super::values::{Assessment, Expected, QUANTITIES, Run, Target};

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

/// How well a run fits what was measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fit {
    /// Measured values that it can be compared with.
    pub compared: usize,
    /// Points where it squeals and steady sliding was measured, or the other way round.
    pub other_state: usize,
    /// The largest distance from a measured value, in standard deviations of measurement, discrepancy and mesh.
    pub largest: f64,
    /// The sum of the squares of these distances.
    pub square_sum: f64,
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

    /// How well a run fits what was measured.
    pub fn of_run(&self, run: &Run) -> Fit {
        let mut fit = Fit::default();
        for (target, outcome) in self.targets.iter().zip(&run.outcomes) {
            let Some(outcome) = outcome else { continue };
            if let (Some(measured), Some(own)) = (target.squeals, outcome.squeals) {
                fit.other_state += usize::from(measured != own);
            }
            for (measured, own) in target.values.iter().zip(&outcome.values) {
                let (Some(measured), Some(own)) = (measured, own) else { continue };
                let mesh = own.mesh_deviation.unwrap_or(0.0);
                let distance = Expected { mean: own.value, emulator: 0.0, mesh }.implausibility(measured);
                fit.compared += 1;
                fit.square_sum += distance.powi(2);
                fit.largest = fit.largest.max(distance);
            }
        }
        fit
    }

    /// The run that fits best, with its number: of those that have at least half as many values as the most, the one that squeals wrongly at
    /// the fewest points, and of these the one with the smallest mean square of distances.
    pub fn best_run(&self) -> Option<(usize, Fit)> {
        let key = |fit: &Fit| (fit.other_state, fit.square_sum / fit.compared.max(1) as f64);
        self.fits().reduce(|best, own| {
            let (a, b) = (key(&best.1), key(&own.1));
            if b.0 < a.0 || b.0 == a.0 && b.1 < a.1 { own } else { best }
        })
    }

    /// Runs that nothing measured rules out, of those that have at least half as many values as the most.
    pub fn runs_that_fit(&self) -> usize {
        self.fits().filter(|(_, fit)| !self.is_ruled_out(fit)).count()
    }

    /// The fits of the runs that have at least half as many values as the most, with the numbers of the runs.
    fn fits(&self) -> impl Iterator<Item = (usize, Fit)> {
        let fits: Vec<Fit> = self.runs.iter().map(|run| self.of_run(run)).collect();
        let most = fits.iter().map(|fit| fit.compared).max().unwrap_or(0);
        fits.into_iter().enumerate().filter(move |(_, fit)| 2 * fit.compared >= most)
    }

    /// Whether a run is too far from a measured value, or in another state.
    pub fn is_ruled_out(&self, fit: &Fit) -> bool {
        fit.other_state > 0 || fit.largest > self.cutoff()
    }

    /// Whether the runs around a place squeal and slide steadily where it was measured which of the two.
    pub(super) fn is_disputed(&self, place: &[f64]) -> bool {
        let is_so = |(states, target): (&States, &Target)| {
            target.squeals.is_some() && states.is_disputed(place, &self.runs)
        };
        self.states.iter().zip(&self.targets).any(is_so)
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
mod tests {
    use super::cutoff;

    /// Protects: the cutoff is Pukelsheim's for few values, and grows so that the truth is lost in 5 % of cases at most: for 1000 values the
    /// normal quantile of 1 − 0.05/2000, 4.056 (bisection of erfc in another program).
    #[test]
    fn more_values_have_a_larger_cutoff() {
        assert!((cutoff(1) - 3.0).abs() < 1.0e-9 && (cutoff(18) - 3.0).abs() < 1.0e-2);
        assert!((cutoff(1000) - 4.056).abs() < 1.0e-3, "{}", cutoff(1000));
    }
}
