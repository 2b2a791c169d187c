//! Modes that are followed over the friction coefficient, or over another parameter in its place.
//!
//! The eigenvalues at one μ have no names. A branch joins those that are one mode: at the next μ a mode is looked for where
//! the line through the last points of the branch leads, and then where the last point is. Only the leading modes of each μ are known, so that a branch can
//! begin and end between other ones.

use super::mode::ComplexMode;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// The modes at one friction coefficient.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Local friction coefficient μ.
    pub mu: f64,
    /// The leading modes.
    pub modes: Vec<ComplexMode>,
}

/// A mode at one friction coefficient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BranchPoint {
    /// Local friction coefficient μ.
    pub mu: f64,
    /// The mode.
    pub mode: ComplexMode,
}

/// One mode over the friction coefficient.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// Its points, by ascending μ.
    pub points: Vec<BranchPoint>,
    /// The smallest μ at which the growth rate becomes positive, by linear interpolation between two points. None if that
    /// does not happen on this branch, also if it grows at its first point already.
    pub mu_c: Option<f64>,
}

impl Branch {
    /// The two points between which the growth rate becomes positive first.
    pub fn around_mu_c(&self) -> Option<[BranchPoint; 2]> {
        let becomes_positive = |pair: &&[BranchPoint]| !pair[0].mode.grows() && pair[1].mode.grows();
        self.points.windows(2).find(becomes_positive).map(|pair| [pair[0], pair[1]])
    }

    /// Where it grows: the pairs of points between which the growth rate becomes positive and, after that, negative. The first is none
    /// if it grows at its first point already, the second if it still grows at its last one.
    pub fn spans(&self) -> Vec<[Option<[BranchPoint; 2]>; 2]> {
        let grows = |point: &BranchPoint| point.mode.grows();
        let mut spans = Vec::new();
        let mut open = self.points.first().filter(|point| grows(point)).map(|_| None);
        for pair in self.points.windows(2) {
            match (open, grows(&pair[1])) {
                (None, true) => open = Some(Some([pair[0], pair[1]])),
                (Some(begins), false) => {
                    spans.push([begins, Some([pair[0], pair[1]])]);
                    open = None;
                }
                _ => {}
            }
        }
        spans.extend(open.map(|begins| [begins, None]));
        spans
    }

    fn of(points: Vec<BranchPoint>) -> Self {
        let mut branch = Self { points, mu_c: None };
        branch.mu_c = branch.around_mu_c().map(crossing);
        branch
    }
}

/// Where the growth rate is zero between two points, by linear interpolation.
pub fn crossing([below, above]: [BranchPoint; 2]) -> f64 {
    let (from, to) = (below.mode.growth_rate_per_s, above.mode.growth_rate_per_s);
    below.mu + (above.mu - below.mu) * from / (from - to)
}

/// Largest distance of an eigenvalue from the place where it is expected, relative to its size. A mode further away is
/// another one.
const GATE: f64 = 0.05;
/// Differences of this share of a frequency count as much as differences of [`growth_unit`].
const FREQUENCY_UNIT: f64 = 0.01;
/// A branch without a mode at so many samples in succession has ended.
const MAX_MISSED: usize = 2;

/// Follows the modes over μ. Samples and modes may have any order; several samples at one μ, between which something else changes, keep
/// theirs. The branches are sorted by the μ and the frequency of their first points.
pub fn branches(samples: &[Sample]) -> Vec<Branch> {
    let mut samples: Vec<&Sample> = samples.iter().filter(|sample| sample.mu.is_finite()).collect();
    samples.sort_by(|a, b| a.mu.total_cmp(&b.mu));
    let positions: Vec<(f64, Vec<Complex<f64>>)> = samples
        .iter()
        .map(|sample| (sample.mu, sample.modes.iter().map(eigenvalue_per_s).collect()))
        .collect();
    let point = |(sample, mode): (usize, usize)| BranchPoint {
        mu: samples[sample].mu,
        mode: samples[sample].modes[mode],
    };
    let threads = threads(&positions).into_iter();
    threads.map(|thread| Branch::of(thread.into_iter().map(point).collect())).collect()
}

/// λ \[1/s\] of a mode.
fn eigenvalue_per_s(mode: &ComplexMode) -> Complex<f64> {
    Complex::new(mode.growth_rate_per_s, TAU * mode.frequency_hz)
}

/// Joins complex numbers λ \[1/s\] at ascending positions to threads: lists of indices of a position and of a number at this
/// position. Numbers that are not finite are in no thread.
pub fn threads(positions: &[(f64, Vec<Complex<f64>>)]) -> Vec<Vec<(usize, usize)>> {
    let growth_unit = growth_unit(positions);
    let mut found: Vec<Thread> = Vec::new();
    for (index, (at, values)) in positions.iter().enumerate() {
        let mut is_taken = vec![false; values.len()];
        // Where the line does not lead to a number, it is looked for where it was.
        let places: [fn(&Thread, f64) -> Complex<f64>; 2] =
            [Thread::expected, |thread, _| thread.last().lambda];
        for place in places {
            let mut pairs = Vec::new();
            for (number, thread) in found.iter().enumerate() {
                // All positions between the thread's last point and this one are missed.
                if index - thread.last().index > MAX_MISSED + 1 {
                    continue;
                }
                let expected = place(thread, *at);
                let costs = values.iter().map(|value| cost(expected, *value, growth_unit)).enumerate();
                pairs.extend(costs.filter_map(|(value, cost)| Some((cost?, number, value))));
            }
            // The best match of all comes first, so that a mode does not lose its branch to a worse match.
            pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
            for (_, number, value) in pairs {
                if !is_taken[value] && found[number].last().index < index {
                    is_taken[value] = true;
                    found[number].0.push(Knot { index, value, at: *at, lambda: values[value] });
                }
            }
        }
        let mut new: Vec<usize> =
            (0..values.len()).filter(|&n| !is_taken[n] && is_finite(values[n])).collect();
        new.sort_by(|&a, &b| values[a].im.total_cmp(&values[b].im));
        let begin = |value: usize| Thread(vec![Knot { index, value, at: *at, lambda: values[value] }]);
        found.extend(new.into_iter().map(begin));
    }
    found.into_iter().map(|thread| thread.0.iter().map(|knot| (knot.index, knot.value)).collect()).collect()
}

/// A number of a thread.
#[derive(Clone, Copy)]
struct Knot {
    index: usize,
    value: usize,
    at: f64,
    lambda: Complex<f64>,
}

/// A thread in the making; it is never empty.
struct Thread(Vec<Knot>);

impl Thread {
    fn last(&self) -> Knot {
        self.0[self.0.len() - 1]
    }

    /// Where its number is expected at a position, on the line through its last and an earlier point.
    ///
    /// The earlier point is at least half as far back as the position is ahead, if there is one. The slope between points
    /// that are much closer, as a search for a threshold leaves them, says nothing over a longer distance.
    fn expected(&self, at: f64) -> Complex<f64> {
        let last = self.last();
        let ahead = at - last.at;
        let is_far = |knot: &&Knot| last.at - knot.at >= ahead / 2.0;
        let earlier = self.0.iter().rev().skip(1).find(is_far).unwrap_or(&self.0[0]);
        let back = last.at - earlier.at;
        if back <= 0.0 {
            return last.lambda;
        }
        last.lambda + (last.lambda - earlier.lambda) * (ahead.min(2.0 * back) / back)
    }
}

/// The distance of a number from its expected place, in units of 1 % of the frequency and of the growth rate's unit; none
/// if it is too far away.
fn cost(expected: Complex<f64>, value: Complex<f64>, growth_unit: f64) -> Option<f64> {
    let difference = value - expected;
    let size = (expected.norm() + value.norm()) / 2.0;
    if !is_finite(difference) || difference.norm() > GATE * size {
        return None;
    }
    // Two equal numbers may be zero.
    let unit = (FREQUENCY_UNIT * size).max(f64::MIN_POSITIVE);
    // Growth rates are much smaller than angular frequencies. On the scale of frequencies they would say nothing.
    Some(libm::hypot(difference.im / unit, difference.re / growth_unit.min(unit).max(f64::MIN_POSITIVE)))
}

fn is_finite(value: Complex<f64>) -> bool {
    value.re.is_finite() && value.im.is_finite()
}

/// The unit of differences between growth rates: the median of their sizes.
fn growth_unit(positions: &[(f64, Vec<Complex<f64>>)]) -> f64 {
    let rates = positions.iter().flat_map(|(_, values)| values).map(|value| value.re.abs());
    let mut rates: Vec<f64> = rates.filter(|rate| rate.is_finite() && *rate > 0.0).collect();
    rates.sort_by(f64::total_cmp);
    rates.get(rates.len() / 2).copied().unwrap_or(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(frequency_hz: f64, growth_rate_per_s: f64) -> ComplexMode {
        ComplexMode::of(frequency_hz, growth_rate_per_s)
    }

    /// Half the difference of the stiffnesses of the two-mode model, and their mean \[1/s²\].
    const HALF: f64 = 4e8;
    const MEAN: f64 = 8e9;
    /// The stiffness-proportional damping \[s\].
    const BETA_S: f64 = 2e-8;
    /// The coupling \[1/s²\] at μ = 1: lock-in at μ = 0.4.
    const COUPLING: f64 = 1e9;

    /// The modes of K = [[k₁, −μc], [μc, k₂]] with unit masses and the damping β K. Its complex stiffnesses are
    /// κ = k̄ ± √(((k₂ − k₁)/2)² − μ²c²), and λ² + β κ λ + κ = 0.
    fn two_modes(mu: f64) -> Vec<ComplexMode> {
        let root = Complex::new(HALF * HALF - (mu * COUPLING).powi(2), 0.0).sqrt();
        let of = |stiffness: Complex<f64>| {
            let damping = stiffness * BETA_S;
            let roots = (damping * damping - stiffness * 4.0).sqrt();
            let pair = [(roots - damping) / 2.0, (-roots - damping) / 2.0];
            let upper = if pair[0].im > 0.0 { pair[0] } else { pair[1] };
            mode(upper.im / TAU, upper.re)
        };
        vec![of(Complex::new(MEAN, 0.0) + root), of(Complex::new(MEAN, 0.0) - root)]
    }

    /// Protects: a number that turns back is still the same one, where the line through the last two leads away from it.
    #[test]
    fn a_number_that_turns_back_is_followed() {
        let at = |x: f64, im: f64| (x, vec![Complex::new(0.0, im)]);
        assert_eq!(threads(&[at(0.0, 100.0), at(1.0, 104.0), at(2.0, 102.0)]).len(), 1);
        // From 104 to 98 is more than the gate.
        assert_eq!(threads(&[at(0.0, 100.0), at(1.0, 104.0), at(2.0, 98.0)]).len(), 2);
    }

    fn samples(mus: impl Iterator<Item = f64>, modes: impl Fn(f64) -> Vec<ComplexMode>) -> Vec<Sample> {
        mus.map(|mu| Sample { mu, modes: modes(mu) }).collect()
    }

    /// The μ at which the larger growth rate of the two-mode model is zero.
    fn threshold() -> f64 {
        let leading = |mu: f64| {
            two_modes(mu).iter().map(|mode| mode.growth_rate_per_s).fold(f64::NEG_INFINITY, f64::max)
        };
        let (mut low, mut high) = (0.3, 0.5);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if leading(middle) < 0.0 { low = middle } else { high = middle }
        }
        low
    }

    /// Protects: two modes that lock in are two branches from the first to the last μ. Their frequencies approach each other
    /// without a jump, then one grows and the other decays. The threshold is that of the model, and more samples near it
    /// give more of its digits.
    #[test]
    fn modes_that_lock_in_are_followed() {
        for count in [15, 40, 300] {
            let found =
                branches(&samples((0..=count).map(|k| 0.8 * f64::from(k) / f64::from(count)), two_modes));
            assert_eq!(found.len(), 2, "{count}");
            for branch in &found {
                assert_eq!(branch.points.len() as i32, count + 1);
                let frequencies = branch.points.iter().map(|point| point.mode.frequency_hz);
                let rising: Vec<f64> =
                    frequencies.clone().zip(frequencies.skip(1)).map(|(a, b)| b - a).collect();
                let limit_hz = 14_000.0 * 0.03;
                assert!(rising.iter().all(|step| step.abs() < limit_hz), "{rising:?}");
            }
            let (low, high) = (&found[0].points, &found[1].points);
            for (low, high) in low.iter().zip(high).filter(|(low, _)| low.mu < 0.39) {
                assert!(low.mode.frequency_hz < high.mode.frequency_hz, "{}", low.mu);
            }
            let ends = [low, high].map(|points| points[points.len() - 1].mode.growth_rate_per_s);
            assert!(ends[0] * ends[1] < 0.0, "{ends:?}");
            let thresholds: Vec<f64> = found.iter().filter_map(|branch| branch.mu_c).collect();
            assert_eq!(thresholds.len(), 1);
            assert!((thresholds[0] - threshold()).abs() < 0.8 / f64::from(count), "{thresholds:?}");
        }
        let near = [-1e-5, 1e-5].map(|distance| threshold() + distance);
        let coarse = (0..=8).map(|k| 0.1 * f64::from(k));
        let found = branches(&samples(coarse.chain(near), two_modes));
        let mu_c = found.iter().find_map(|branch| branch.mu_c).unwrap();
        assert!((mu_c - threshold()).abs() < 1e-6, "{mu_c} {}", threshold());
    }

    /// Protects: modes whose frequencies cross keep their own growth rates, in whatever order samples and modes come.
    #[test]
    fn modes_may_cross() {
        let crossing = |mu: f64| vec![mode(10_000.0 + 2_000.0 * mu, -50.0), mode(11_000.0, -400.0)];
        let mut all = samples((0..=20).map(|k| 0.05 * f64::from(k)), crossing);
        let expected = branches(&all);
        assert_eq!(expected.len(), 2);
        for (branch, rate) in expected.iter().zip([-50.0, -400.0]) {
            assert!(branch.points.len() == 21 && branch.mu_c.is_none());
            assert!(branch.points.iter().all(|point| point.mode.growth_rate_per_s == rate));
        }
        all.reverse();
        for sample in all.iter_mut().step_by(2) {
            sample.modes.reverse();
        }
        assert_eq!(branches(&all), expected);
    }

    /// Protects: the threshold is the first crossing upwards, interpolated linearly. A mode that grows from the first μ on,
    /// or comes down to zero, has none there.
    #[test]
    fn the_threshold_is_the_first_crossing_upwards() {
        let rates = |rates: &[f64]| {
            let one = |(k, rate): (usize, &f64)| Sample { mu: 0.1 * k as f64, modes: vec![mode(1e4, *rate)] };
            let found = branches(&rates.iter().enumerate().map(one).collect::<Vec<_>>());
            assert_eq!(found.len(), 1);
            found[0].mu_c
        };
        let near = |found: Option<f64>, expected: f64| (found.unwrap() - expected).abs() < 1e-12;
        assert!(near(rates(&[-10.0, -10.0, 30.0, -5.0, 5.0]), 0.125));
        assert!(near(rates(&[10.0, -10.0, 10.0]), 0.15));
        assert!(near(rates(&[-10.0, 0.0, 10.0]), 0.1));
        assert_eq!((rates(&[10.0, 20.0]), rates(&[10.0, -1.0]), rates(&[-2.0, -1.0])), (None, None, None));
    }

    /// Protects: every range in which a mode grows is found: one that has begun at the first point, one between two crossings, and one
    /// that has not ended at the last point.
    #[test]
    fn a_mode_can_grow_in_several_ranges() {
        let rates = [10.0, -10.0, -10.0, 30.0, -30.0, 10.0];
        let one = |(k, rate): (usize, &f64)| Sample { mu: 0.1 * k as f64, modes: vec![mode(1e4, *rate)] };
        let found = branches(&rates.iter().enumerate().map(one).collect::<Vec<_>>());
        let at = |pair: Option<[BranchPoint; 2]>| pair.map(|pair| (1.0e6 * crossing(pair)).round() / 1.0e6);
        let spans: Vec<_> = found[0].spans().into_iter().map(|span| span.map(at)).collect();
        assert_eq!(spans, [[None, Some(0.05)], [Some(0.225), Some(0.35)], [Some(0.475), None]]);
    }

    /// Protects: a mode that is missing at a few μ stays one branch. After a longer pause, and at a place where no branch
    /// leads, a new one begins. Numbers that are not finite are left out. A second sample at the same μ is one more point.
    #[test]
    fn modes_appear_and_disappear() {
        let known = |mu: f64| {
            let k = (10.0 * mu).round() as i32;
            let mut modes = vec![mode(5_000.0, -20.0), mode(f64::NAN, 1.0)];
            modes.extend((![3, 4].contains(&k)).then(|| mode(9_000.0 + 500.0 * mu, -100.0)));
            modes.extend((![3, 4, 5].contains(&k)).then(|| mode(20_000.0, -30.0)));
            modes.extend((k >= 6).then(|| mode(7_000.0, 10.0)));
            modes
        };
        let mut all = samples((0..=9).map(|k| 0.1 * f64::from(k)), known);
        all.push(Sample { mu: all[2].mu, modes: known(all[2].mu) });
        let found = branches(&all);
        let shape: Vec<(f64, usize)> =
            found.iter().map(|branch| (branch.points[0].mode.frequency_hz, branch.points.len())).collect();
        assert_eq!(shape, [(5e3, 11), (9e3, 9), (2e4, 4), (7e3, 4), (2e4, 4)]);
        assert_eq!(branches(&[]), []);
    }
}
