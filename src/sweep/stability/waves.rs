//! Places near those at which sliding becomes unstable, or stable.
//!
//! Every change of sign of the leading growth rate is narrowed down. Where other modes begin or cease to grow while sliding is
//! unstable anyway, the branches are interpolated between the points there are.

use super::ladder::rounded;
use super::points::{Series, by_series};
use crate::report::{Along, StabilityPoint};

/// The largest number of waves.
pub const WAVES: usize = 4;

/// The relative width of the range within which a crossing is known.
const TOLERANCE: f64 = 0.002;

/// In a range of up to so many widths of tolerance the secant is likely to find the crossing.
const NARROW: f64 = 16.0;

/// Places that are nearer to each other than this share of them are the same.
const SAME: f64 = 1.0e-7;

/// For each series the places of the next wave along it; series that need none are left out.
pub(super) fn next_wave(along: &Along, points: &[StabilityPoint]) -> Vec<(Series, Vec<f64>)> {
    let of_series = by_series(along, points).into_iter().map(|(series, points)| {
        let leading: Vec<(f64, f64)> = points
            .iter()
            .filter_map(|(at, point)| Some((*at, point.stability.modes.first()?.growth_rate_per_s)))
            .collect();
        let is_crossing = |pair: &&[(f64, f64)]| (pair[0].1 < 0.0) != (pair[1].1 < 0.0);
        let crossings = leading.windows(2).filter(is_crossing);
        let mut wave: Vec<f64> =
            crossings.flat_map(|pair| between(pair[0], pair[1], along.is_mu())).collect();
        wave.retain(|at| points.iter().all(|(other, _)| (other - at).abs() > SAME * at.abs()));
        wave.sort_by(f64::total_cmp);
        (series, wave)
    });
    of_series.filter(|(_, wave)| !wave.is_empty()).collect()
}

/// The places that narrow down the crossing between two points (place, growth rate); none if it is known well enough.
fn between(low: (f64, f64), high: (f64, f64), is_mu: bool) -> Vec<f64> {
    let width = high.0 - low.0;
    let wanted = TOLERANCE * high.0.abs().max(low.0.abs());
    // Rounding must not make another wave of a range that has the wanted width.
    if width <= wanted * (1.0 + 1.0e-6) {
        return Vec::new();
    }
    // Four waves of quarters are enough for a step of 0.05 of μ or a factor of two, also where the growth rate bends.
    let mut wave = [0.25, 0.5, 0.75].map(|share| low.0 + share * width).to_vec();
    if width <= NARROW * wanted {
        let secant = low.0 + width * low.1 / (low.1 - high.1);
        let reach = 0.45 * wanted;
        let inside = low.0 + 0.1 * width..=high.0 - 0.1 * width;
        wave.extend([secant - reach, secant + reach].into_iter().filter(|mu| inside.contains(mu)));
    }
    // Other parameters than μ may be tiny numbers, whose digits must stay.
    wave.into_iter().map(|at| if is_mu { rounded(at) } else { at }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::SlidingStability;
    use crate::report::Parameters;

    fn point(mu: f64, rate: f64) -> StabilityPoint {
        let mut stability = SlidingStability { mu_star: mu, ..SlidingStability::example() };
        let mode = &mut stability.modes[0];
        (mode.growth_rate_per_s, mode.damping_ratio) = (rate, -rate / 1.0e5);
        StabilityPoint { parameters: Parameters::new(7.0, mu, Vec::new()), on_grid: true, stability }
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
                for (series, wave) in next_wave(&Along::mu(), &points) {
                    assert_eq!(series, [("omega_rpm".to_owned(), 7.0.into())]);
                    assert!(wave.len() <= 6, "{wave:?}");
                    points.extend(wave.into_iter().map(|mu| point(mu, rate(mu))));
                }
            }
            let mus = || points.iter().map(|point| point.parameters.mu());
            let below = mus().filter(|mu| *mu <= threshold).fold(0.0, f64::max);
            let above = mus().filter(|mu| *mu > threshold).fold(1.0, f64::min);
            assert!(above - below <= 1.01 * TOLERANCE * above, "{threshold}: {below} to {above}");
            assert_eq!(next_wave(&Along::mu(), &points), Vec::new(), "{threshold}");
        }
        assert_eq!(next_wave(&Along::mu(), &[point(0.1, -1.0), point(0.2, -2.0)]), Vec::new());
    }

    /// Protects: where sliding becomes stable again is narrowed down as well, along any parameter, and tiny numbers keep their digits.
    #[test]
    fn a_threshold_downwards_is_found_too() {
        let along = Along { parameter: "beta_r_s".to_owned(), with: Vec::new() };
        let at = |beta_r_s: f64| {
            let mut point = point(0.3, 500.0 * (3.3e-8 - beta_r_s) / 1.0e-8);
            point.parameters = Parameters::new(7.0, 0.3, vec![("beta_r_s".to_owned(), beta_r_s.into())]);
            point
        };
        let mut points = vec![at(2.0e-8), at(4.0e-8), at(8.0e-8)];
        for _ in 0..WAVES {
            for (_, wave) in next_wave(&along, &points) {
                points.extend(wave.into_iter().map(at));
            }
        }
        let places = || points.iter().map(|p| p.parameter("beta_r_s").as_f64().unwrap());
        let below = places().filter(|x| *x <= 3.3e-8).fold(0.0, f64::max);
        let above = places().filter(|x| *x > 3.3e-8).fold(1.0, f64::min);
        assert!(above - below <= 1.01 * TOLERANCE * above, "{below} to {above}");
    }
}
