//! Friction coefficients near those at which sliding becomes unstable.
//!
//! Only the lowest threshold of a series is narrowed down. Where other modes begin to grow at a larger μ, the branches are
//! interpolated between the points of the ladder.

use super::ladder::rounded;
use super::points::{Series, by_series};
use crate::report::StabilityPoint;

/// The largest number of waves.
pub const WAVES: usize = 4;

/// The relative width of the range of μ within which a crossing is known.
const TOLERANCE: f64 = 0.002;

/// In a range of up to so many widths of tolerance the secant is likely to find the crossing.
const NARROW: f64 = 16.0;

/// Friction coefficients that are nearer to each other than this are the same.
const SAME: f64 = 1.0e-7;

/// For each series the friction coefficients of the next wave; series that need none are left out.
pub(super) fn next_wave(points: &[StabilityPoint]) -> Vec<(Series, Vec<f64>)> {
    let of_series = by_series(points).into_iter().map(|(series, points)| {
        let mut leading: Vec<(f64, f64)> = points
            .iter()
            .filter_map(|point| Some((point.mu, point.stability.modes.first()?.growth_rate_per_s)))
            .collect();
        leading.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let crossing = leading.windows(2).find(|pair| pair[0].1 < 0.0 && pair[1].1 >= 0.0);
        let mut wave = crossing.map_or_else(Vec::new, |pair| between(pair[0], pair[1]));
        wave.retain(|mu| points.iter().all(|other| (other.mu - mu).abs() > SAME));
        wave.sort_by(f64::total_cmp);
        (series, wave)
    });
    of_series.filter(|(_, wave)| !wave.is_empty()).collect()
}

/// The friction coefficients that narrow down the crossing between two points (μ, growth rate); none if it is known well
/// enough.
fn between(low: (f64, f64), high: (f64, f64)) -> Vec<f64> {
    let width = high.0 - low.0;
    let wanted = TOLERANCE * high.0;
    // Rounding must not make another wave of a range that has the wanted width.
    if width <= wanted * (1.0 + 1.0e-6) {
        return Vec::new();
    }
    // Four waves of quarters are enough for a step of 0.05, also where the growth rate bends.
    let mut wave = [0.25, 0.5, 0.75].map(|share| low.0 + share * width).to_vec();
    if width <= NARROW * wanted {
        let secant = low.0 + width * low.1 / (low.1 - high.1);
        let reach = 0.45 * wanted;
        let inside = low.0 + 0.1 * width..=high.0 - 0.1 * width;
        wave.extend([secant - reach, secant + reach].into_iter().filter(|mu| inside.contains(mu)));
    }
    wave.into_iter().map(rounded).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::{ComplexMode, SlidingStability, AboveBand};

    fn point(mu: f64, rate: f64) -> StabilityPoint {
        let mode = ComplexMode {
            frequency_hz: 15.0e3,
            growth_rate_per_s: rate,
            damping_ratio: -rate / 1.0e5,
            residual: 1.0e-10,
            is_converged: true,
        };
        let stability = SlidingStability {
            decided: true,
            contact_nodes: 20,
            lifted_nodes: 0,
            mu_star: mu,
            band_hz: 5.0e4,
            above_band: AboveBand::NotLookedAt,
            damped_above_hz: None,
            modes: vec![mode],
        };
        StabilityPoint { omega_rpm: 7.0, mu, parameters: Vec::new(), on_grid: true, stability }
    }

    /// Protects: within four waves a crossing is known to 0.2 %, also where the growth rate bends at it as that of two
    /// modes that become one, and a crossing that is known gets no more points.
    #[test]
    fn four_waves_find_a_threshold() {
        for threshold in [0.100_3, 0.123_4, 0.271, 0.299_9, 0.549_9] {
            let rate = |mu: f64| {
                let beyond = (mu - threshold + 0.001).max(0.0).sqrt();
                -800.0 + 800.0 * beyond / 0.001_f64.sqrt()
            };
            let mut points: Vec<_> =
                (1..=14).map(|i| 0.05 * f64::from(i)).map(|mu| point(mu, rate(mu))).collect();
            for _ in 0..WAVES {
                for (series, wave) in next_wave(&points) {
                    assert_eq!(series.omega_rpm, 7.0);
                    assert!(wave.len() <= 6, "{wave:?}");
                    points.extend(wave.into_iter().map(|mu| point(mu, rate(mu))));
                }
            }
            let below = points.iter().filter(|p| p.mu <= threshold).map(|p| p.mu).fold(0.0, f64::max);
            let above = points.iter().filter(|p| p.mu > threshold).map(|p| p.mu).fold(1.0, f64::min);
            assert!(above - below <= 1.01 * TOLERANCE * above, "{threshold}: {below} to {above}");
            assert_eq!(next_wave(&points), Vec::new(), "{threshold}");
        }
        assert_eq!(next_wave(&[point(0.1, -1.0), point(0.2, -2.0)]), Vec::new());
    }
}
