//! The standard error of correlated figures.

use crate::random::Random;
use tribosweep_mechanics::analysis::steady::{standard_error, standard_error_with_drift};

/// Protects: the standard error of an AR(1) sequence's mean is right. With ρ = 0.5 and unit innovations the
/// variance of a mean of n values is s²(n) = [1 − 2ρ(1 − ρⁿ)/(n(1 − ρ²))]/(n(1 − ρ)²). The means of ⌊√n⌋ = 20
/// batches of 20 values estimate (s²(20) − s²(400))/20·20/19. Over 400 sequences the mean of the estimated
/// variance has the relative standard deviation √(2/19/400) = 1.6 %. Five of these are allowed.
#[test]
fn ar1_sequences() {
    let (rho, n, sequences) = (0.5_f64, 400_usize, 400);
    let variance = |n: f64| {
        (1.0 - 2.0 * rho * (1.0 - rho.powf(n)) / (n * (1.0 - rho * rho))) / (n * (1.0 - rho).powi(2))
    };
    let mut random = Random::new(21);
    let mut mean_square = 0.0;
    for _ in 0..sequences {
        let mut x = random.normal() / (1.0 - rho * rho).sqrt();
        let values: Vec<f64> = (0..n)
            .map(|_| {
                x = rho * x + random.normal();
                x
            })
            .collect();
        mean_square += standard_error(&values).powi(2) / f64::from(sequences);
    }
    let expected = (variance(20.0) - variance(400.0)) / 19.0;
    assert!((mean_square / expected - 1.0).abs() < 5.0 * 0.0162, "{mean_square} instead of {expected}");
    // The naive error, for independent values, would be too small by a factor of three in variance.
    let naive = 1.0 / (1.0 - rho * rho) / 400.0;
    assert!(mean_square > 2.0 * naive);
}

/// Protects: equal values have no error, two different values are enough for an error, a single value gives
/// zero, and NaN never occurs.
#[test]
fn constant_and_short_sequences() {
    for n in [0, 1, 2, 3, 4, 5, 17, 400] {
        assert_eq!(standard_error(&vec![0.25; n]), 0.0, "{n} equal values");
    }
    // There are two batches of one value, the last two: variance 1/2, error of the mean 1/2.
    assert!((standard_error(&[1.0, 2.0, 3.0]) - 0.5).abs() < 1e-15);
    // There are two batches of two values: means 1.5 and 3.5, variance 2, error of the mean 1.
    assert!((standard_error(&[1.0, 2.0, 3.0, 4.0]) - 1.0).abs() < 1e-15);
}

/// Protects: a drift is in the error. Values that rise by D from one half to the next have a mean that may be off by as much; the batches alone
/// would give 0.3 D. Of chance alone less is added than chance itself is: 16 s² is four times the mean square of D, and the mean square of a normal
/// value beyond twice its deviation is 0.13 of its own, so that about 0.5 s² is added, and more for the few batches of 20 values.
#[test]
fn a_drift_is_part_of_the_error() {
    let rising: Vec<f64> = (0..20).map(|n| 0.3 + 1.0e-4 * f64::from(n)).collect();
    let drift = 1.0e-3;
    assert!(standard_error(&rising) < 0.35 * drift);
    assert!((0.7..1.0).contains(&(standard_error_with_drift(&rising) / drift)));
    let mut random = Random::new(22);
    let [mut plain, mut with_drift] = [0.0; 2];
    for _ in 0..2000 {
        let values: Vec<f64> = (0..20).map(|_| random.normal()).collect();
        plain += standard_error(&values).powi(2);
        with_drift += standard_error_with_drift(&values).powi(2);
    }
    assert!((1.0..2.0).contains(&(with_drift / plain)), "{}", with_drift / plain);
    assert_eq!(standard_error_with_drift(&[1.0]), 0.0);
}
