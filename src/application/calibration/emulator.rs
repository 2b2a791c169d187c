//! Gaussian processes: what a smooth function of a place is between the places where it is known.
//!
//! A value is a linear trend with a correction whose correlation between two places is that of Matérn with exponent 5/2, with a length for
//! each parameter (Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, equations 2.41 to 2.45, 4.17 and 5.12). Lengths and
//! the share of noise are those of the largest restricted likelihood on a fixed grid, so they are the same on every machine.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Lengths that are tried for each parameter, in units of its range.
const LENGTHS: [f64; 7] = [0.15, 0.25, 0.4, 0.7, 1.2, 2.0, 4.0];

/// Shares of noise in the variance that are tried.
const NUGGETS: [f64; 5] = [1.0e-8, 1.0e-6, 1.0e-4, 1.0e-3, 1.0e-2];

/// How often the lengths of all parameters are gone through.
const ROUNDS: usize = 2;

/// The variance of values that are all equal, as a share of the square of their size. Without it, they would have no likelihood.
const ROUNDING: f64 = 1.0e-16;

/// A correlation between places of runs.
#[derive(Debug)]
pub(super) struct Kernel {
    places: Vec<Vec<f64>>,
    scales: Scales,
    factor: Cholesky<f64, Dyn>,
    /// The trend at the places: a row for each.
    trend: DMatrix<f64>,
    /// K⁻¹ H.
    solved: DMatrix<f64>,
    /// Hᵀ K⁻¹ H.
    gram: Cholesky<f64, Dyn>,
}

/// Lengths, and the share of noise in the variance.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scales {
    pub lengths: Vec<f64>,
    pub nugget: f64,
    /// Whether there is a linear trend. Otherwise the mean is 0.
    pub has_trend: bool,
}

/// A function that is known at the places of a kernel.
#[derive(Debug)]
pub(super) struct Emulator {
    /// The number of the kernel.
    kernel: usize,
    /// K⁻¹ (y − H β).
    weights: DVector<f64>,
    coefficients: DVector<f64>,
    variance: f64,
}

/// How well values were foretold by the others.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LeaveOneOut {
    pub values: usize,
    pub within_two: usize,
    /// The sum of the squares of the errors over their variances.
    pub square_sum: f64,
}

/// A kernel seen from a place.
pub(super) struct Near {
    correlations: DVector<f64>,
    trend: DVector<f64>,
    /// The variance that is left, over that of the process.
    variance: f64,
}

/// All kernels, each once: emulators of the same runs and scales share one.
#[derive(Debug, Default)]
pub(super) struct Kernels(Vec<(Vec<usize>, Kernel)>);

fn trend(place: &[f64], has_trend: bool) -> Vec<f64> {
    if has_trend { std::iter::once(1.0).chain(place.iter().copied()).collect() } else { Vec::new() }
}

/// Matérn's correlation with exponent 5/2 (equation 4.17).
fn correlation(a: &[f64], b: &[f64], lengths: &[f64]) -> f64 {
    let square: f64 = a.iter().zip(b).zip(lengths).map(|((a, b), length)| ((a - b) / length).powi(2)).sum();
    let r = (5.0 * square).sqrt();
    (1.0 + r + r * r / 3.0) * libm::exp(-r)
}

/// The logarithm of the determinant of a factorised matrix.
fn log_determinant(factor: &Cholesky<f64, Dyn>) -> f64 {
    factor.l_dirty().diagonal().iter().map(|entry| 2.0 * libm::log(*entry)).sum()
}

impl Kernel {
    /// Returns `None` if places are so near to each other that the matrix is singular.
    fn new(places: Vec<Vec<f64>>, scales: Scales) -> Option<Self> {
        let count = places.len();
        let entry = |i: usize, j: usize| {
            let noise = if i == j { scales.nugget } else { 0.0 };
            correlation(&places[i], &places[j], &scales.lengths) + noise
        };
        let factor = DMatrix::from_fn(count, count, entry).cholesky()?;
        let rows: Vec<Vec<f64>> = places.iter().map(|place| trend(place, scales.has_trend)).collect();
        let columns = rows.first().map_or(0, Vec::len);
        let trend = DMatrix::from_fn(count, columns, |i, j| rows[i][j]);
        let solved = factor.solve(&trend);
        let gram = (trend.transpose() * &solved).cholesky()?;
        Some(Self { places, scales, factor, trend, solved, gram })
    }

    /// β, K⁻¹ (y − H β), and the sum of squares (y − H β)ᵀ K⁻¹ (y − H β).
    fn solve(&self, values: &DVector<f64>) -> (DVector<f64>, DVector<f64>, f64) {
        let coefficients = self.gram.solve(&(self.solved.transpose() * values));
        let rest = values - &self.trend * &coefficients;
        let weights = self.factor.solve(&rest);
        let sum = rest.dot(&weights).max(ROUNDING * values.norm_squared());
        (coefficients, weights, sum)
    }

    /// Values that are more than the trend has coefficients.
    fn freedom(&self) -> f64 {
        self.places.len() as f64 - self.trend.ncols() as f64
    }

    /// The logarithm of the restricted likelihood at the best variance, up to a constant.
    fn log_likelihood(&self, all: &[DVector<f64>]) -> f64 {
        let determinants = log_determinant(&self.factor) + log_determinant(&self.gram);
        let of_values = |values| {
            let (_, _, sum) = self.solve(values);
            -0.5 * (self.freedom() * libm::log(sum / self.freedom()) + determinants)
        };
        all.iter().map(of_values).sum()
    }

    fn at(&self, place: &[f64]) -> Near {
        let correlations = self.places.iter().map(|own| correlation(own, place, &self.scales.lengths));
        let correlations = DVector::from_iterator(self.places.len(), correlations);
        let trend = DVector::from_vec(trend(place, self.scales.has_trend));
        let half = self.factor.l_dirty().solve_lower_triangular(&correlations);
        let explained = half.map_or(0.0, |half| half.norm_squared());
        let rest = &trend - self.solved.transpose() * &correlations;
        let of_trend = rest.dot(&self.gram.solve(&rest));
        // The noise is a part of what a run gives.
        let variance = (1.0 + self.scales.nugget - explained).max(self.scales.nugget) + of_trend;
        Near { correlations, trend, variance }
    }

    /// The variance of each value that the others leave, over that of the process, inverted: the diagonal of
    /// K⁻¹ − K⁻¹ H (Hᵀ K⁻¹ H)⁻¹ Hᵀ K⁻¹.
    fn precisions(&self) -> Vec<f64> {
        let inverse = self.factor.inverse();
        let of_trend = &self.solved * self.gram.solve(&self.solved.transpose());
        (0..self.places.len()).map(|i| inverse[(i, i)] - of_trend[(i, i)]).collect()
    }
}

impl Kernels {
    /// The number of the kernel of some runs; none if its matrix is singular.
    fn number(&mut self, of: &[usize], places: &[Vec<f64>], scales: &Scales) -> Option<usize> {
        let is_own = |(own, kernel): &(Vec<usize>, Kernel)| own == of && kernel.scales == *scales;
        if let Some(number) = self.0.iter().position(is_own) {
            return Some(number);
        }
        let kernel = Kernel::new(of.iter().map(|at| places[*at].clone()).collect(), scales.clone())?;
        self.0.push((of.to_vec(), kernel));
        Some(self.0.len() - 1)
    }

    /// An emulator of the values of some runs, with its check. Its variance is increased if it was too small for values that were left out.
    /// None if there are too few runs.
    pub fn emulator(
        &mut self,
        of: &[usize],
        places: &[Vec<f64>],
        values: &[f64],
        scales: &Scales,
    ) -> Option<(Emulator, LeaveOneOut)> {
        if !is_enough(of.len(), scales.lengths.len()) {
            return None;
        }
        let number = self.number(of, places, scales)?;
        let kernel = &self.0[number].1;
        let (coefficients, weights, sum) = kernel.solve(&DVector::from_column_slice(values));
        let variance = sum / kernel.freedom();
        let mut check = LeaveOneOut { values: values.len(), ..LeaveOneOut::default() };
        for (weight, precision) in weights.iter().zip(kernel.precisions()) {
            let square = weight * weight / (precision * variance);
            check.square_sum += square;
            check.within_two += usize::from(square <= 4.0);
        }
        let mean = check.square_sum / values.len() as f64;
        let variance = variance * mean.max(1.0);
        Some((Emulator { kernel: number, weights, coefficients, variance }, check))
    }

    /// All kernels seen from a place.
    pub fn at(&self, place: &[f64]) -> Vec<Near> {
        self.0.iter().map(|(_, kernel)| kernel.at(place)).collect()
    }
}

/// Fewest values beyond the coefficients of the trend.
const FEWEST_SPARE: f64 = 3.0;

impl Emulator {
    /// Mean and standard deviation at a place.
    pub fn at(&self, near: &[Near]) -> (f64, f64) {
        let near = &near[self.kernel];
        let mean = near.trend.dot(&self.coefficients) + near.correlations.dot(&self.weights);
        (mean, (self.variance * near.variance).sqrt())
    }
}

/// Values of some runs: the numbers of the runs, and columns of values.
pub(super) type Group = (Vec<usize>, Vec<DVector<f64>>);

/// The scales of the largest likelihood of all groups together.
pub(super) fn best_scales(groups: &[Group], places: &[Vec<f64>], parameters: usize) -> Scales {
    let mut best = Scales { lengths: vec![1.2; parameters], nugget: 1.0e-6, has_trend: true };
    let likelihood = |scales: &Scales| -> f64 {
        let of_group = |(of, columns): &Group| {
            let places = of.iter().map(|at| places[*at].clone()).collect();
            let kernel = Kernel::new(places, scales.clone());
            kernel.map_or(f64::NEG_INFINITY, |kernel| kernel.log_likelihood(columns))
        };
        groups.iter().map(of_group).sum()
    };
    let mut most = likelihood(&best);
    for _ in 0..ROUNDS {
        for at in 0..=parameters {
            let own = if at < parameters { &LENGTHS[..] } else { &NUGGETS[..] };
            for value in own {
                let mut scales = best.clone();
                match scales.lengths.get_mut(at) {
                    Some(length) => *length = *value,
                    None => scales.nugget = *value,
                }
                let found = likelihood(&scales);
                if found > most {
                    (most, best) = (found, scales);
                }
            }
        }
    }
    best
}

/// Whether so many runs are enough for an emulator of a function of so many parameters.
pub(super) fn is_enough(runs: usize, parameters: usize) -> bool {
    runs as f64 >= 1.0 + parameters as f64 + FEWEST_SPARE
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: usize = 12;

    fn places() -> Vec<Vec<f64>> {
        // Multiples of irrational numbers fill the square evenly.
        (1..=COUNT).map(|n| [0.754_877_67, 0.569_840_29].map(|x| (n as f64 * x).fract()).to_vec()).collect()
    }

    fn scales() -> Scales {
        Scales { lengths: vec![0.7, 1.2], nugget: 1.0e-6, has_trend: true }
    }

    /// Protects: the mean passes through known values, where the deviation is that of the noise, and a linear function is foretold
    /// everywhere.
    #[test]
    fn known_values_are_kept() {
        let (places, all): (_, Vec<usize>) = (places(), (0..COUNT).collect());
        let bent: Vec<f64> =
            places.iter().map(|x| 1.0 + x[0] - 2.0 * x[1] + (3.0 * x[0] * x[1]).sin()).collect();
        let mut kernels = Kernels::default();
        let (emulator, _) = kernels.emulator(&all, &places, &bent, &scales()).unwrap();
        for (place, value) in places.iter().zip(&bent) {
            let (mean, deviation) = emulator.at(&kernels.at(place));
            assert!((mean - value).abs() < 1.0e-4, "{mean} {value}");
            assert!(deviation <= 1.01 * (2.0 * scales().nugget * emulator.variance).sqrt(), "{deviation}");
        }
        let linear: Vec<f64> = places.iter().map(|x| 3.0 - x[0] + 4.0 * x[1]).collect();
        let (emulator, _) = kernels.emulator(&all, &places, &linear, &scales()).unwrap();
        let (mean, _) = emulator.at(&kernels.at(&[0.9, 0.05]));
        assert!((mean - 2.3).abs() < 1.0e-6, "{mean}");
    }

    /// Protects: the closed form of the check is what the emulators give that know all values but one, with the variance of all.
    #[test]
    fn the_check_is_that_of_refitting() {
        let (places, all): (_, Vec<usize>) = (places(), (0..COUNT).collect());
        let bent: Vec<f64> = places.iter().map(|x| (4.0 * x[0]).sin() * x[1]).collect();
        let mut kernels = Kernels::default();
        let (_, check) = kernels.emulator(&all, &places, &bent, &scales()).unwrap();
        let kernel = &kernels.0[0].1;
        let (_, _, sum) = kernel.solve(&DVector::from_vec(bent.clone()));
        let variance = sum / kernel.freedom();
        let mut square_sum = 0.0;
        for left_out in 0..COUNT {
            let rest: Vec<usize> = all.iter().copied().filter(|at| *at != left_out).collect();
            let values: Vec<f64> = rest.iter().map(|at| bent[*at]).collect();
            let mut own = Kernels::default();
            let (emulator, _) = own.emulator(&rest, &places, &values, &scales()).unwrap();
            let near = own.at(&places[left_out]);
            let (mean, _) = emulator.at(&near);
            square_sum += (mean - bent[left_out]).powi(2) / (variance * near[0].variance);
        }
        assert!((check.square_sum / square_sum - 1.0).abs() < 1.0e-6, "{} {square_sum}", check.square_sum);
    }

    /// Protects: lengths are found that belong to a function: it varies along its first parameter, and not along the second.
    #[test]
    fn lengths_follow_the_function() {
        let places: Vec<Vec<f64>> = (1..=40)
            .map(|n| [0.754_877_67, 0.569_840_29].map(|x| (f64::from(n) * x).fract()).to_vec())
            .collect();
        let values = DVector::from_iterator(40, places.iter().map(|x| (9.0 * x[0]).sin()));
        let scales = best_scales(&[((0..40).collect(), vec![values])], &places, 2);
        assert!(scales.lengths[0] < 0.3 * scales.lengths[1], "{scales:?}");
    }
}
