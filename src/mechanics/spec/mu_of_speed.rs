//! A friction coefficient as a table over the slip speed.

use super::check::{Violations, readable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pairs [slip speed (m/s), friction coefficient], from rest on: the first speed is 0, and each is higher than the one before. A study may
/// name a CSV file instead, whose two columns they are.
///
/// Between the pairs the coefficient follows cubic polynomials with a continuous slope, which never leave the range of their two ends
/// (F. N. Fritsch and J. Butland, *SIAM J. Sci. Stat. Comput.* 5, 1984, 300–304). It is constant beyond the last speed, and its slope is zero
/// there.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
// The name of a file stands for its pairs.
#[schemars(extend("type" = ["array", "string"]))]
pub struct MuOfSpeed(pub Vec<[f64; 2]>);

/// Most pairs of a table. Every node evaluates all of them in every step.
pub const MOST_PAIRS: usize = 16;

/// Least distance of two speeds of a table \[m/s\]. No instrument resolves less, and the reciprocals of much smaller ones overflow.
const LEAST_STEP_M_S: f64 = 1.0e-12;

/// The coefficient between two speeds: the cubic polynomial Σ `powers[k]` tᵏ⁺¹ of t = (v − `from_m_s`)/`width_m_s` from 0 to 1, added to
/// the value at `from_m_s`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Where it begins \[m/s\].
    pub from_m_s: f64,
    /// Its width \[m/s\].
    pub width_m_s: f64,
    /// The factors of t, t² and t³.
    pub powers: [f64; 3],
}

impl Segment {
    /// What it adds to the coefficient at a speed \[m/s\], and the slope of that \[s/m\].
    pub fn at(&self, speed_m_s: f64) -> [f64; 2] {
        let t = (speed_m_s - self.from_m_s) / self.width_m_s;
        let [a, b, c] = self.powers;
        let is_inside = (0.0..1.0).contains(&t);
        let slope = if is_inside { (a + t * (2.0 * b + t * 3.0 * c)) / self.width_m_s } else { 0.0 };
        let t = t.clamp(0.0, 1.0);
        [t * (a + t * (b + t * c)), slope]
    }

    /// Its steepest rise \[s/m\]; negative if it falls everywhere.
    fn steepest_rise_s_m(&self) -> f64 {
        let [a, b, c] = self.powers;
        let turn = if c == 0.0 { 0.0 } else { (-b / (3.0 * c)).clamp(0.0, 1.0) };
        let at = |t: f64| (a + t * (2.0 * b + t * 3.0 * c)) / self.width_m_s;
        at(0.0).max(at(turn)).max(at(1.0))
    }
}

impl MuOfSpeed {
    /// Whether there are no pairs.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The coefficient beyond the last speed; `None` without pairs.
    pub fn fast(&self) -> Option<f64> {
        self.0.last().map(|[_, mu]| *mu)
    }

    /// The parts between the pairs.
    pub fn segments(&self) -> Vec<Segment> {
        let slopes = self.slopes_s_m();
        let segment = |(at, pair): (usize, &[[f64; 2]])| {
            let [[from_m_s, below], [to_m_s, above]] = [pair[0], pair[1]];
            let width_m_s = to_m_s - from_m_s;
            let [first, last] = [slopes[at], slopes[at + 1]].map(|slope_s_m| slope_s_m * width_m_s);
            let rise = above - below;
            let powers = [first, 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise];
            Segment { from_m_s, width_m_s, powers }
        };
        self.0.windows(2).enumerate().map(segment).collect()
    }

    /// The slope at each pair.
    fn slopes_s_m(&self) -> Vec<f64> {
        let widths: Vec<f64> = self.0.windows(2).map(|pair| pair[1][0] - pair[0][0]).collect();
        let means: Vec<f64> =
            self.0.windows(2).zip(&widths).map(|(pair, width)| (pair[1][1] - pair[0][1]) / width).collect();
        let inner = |at: usize| {
            let [(before, h), (after, k)] = [at - 1, at].map(|part| (means[part], widths[part]));
            // At an extreme the slope is zero. Elsewhere it is the harmonic mean, by which no polynomial overshoots.
            let [w, u] = [h + 2.0 * k, 2.0 * h + k];
            if before * after <= 0.0 { 0.0 } else { (w + u) / (w / before + u / after) }
        };
        let at_rest = match (&means[..], &widths[..]) {
            ([first, second, ..], [h, k, ..]) => {
                let slope = ((2.0 * h + k) * first - h * second) / (h + k);
                // The end follows the parabola through three pairs, as far as it neither turns nor overshoots.
                if slope * first <= 0.0 {
                    0.0
                } else if first * second <= 0.0 && slope.abs() > 3.0 * first.abs() {
                    3.0 * first
                } else {
                    slope
                }
            }
            ([only], _) => *only,
            _ => 0.0,
        };
        let beyond = (self.0.len() > 1).then_some(0.0);
        std::iter::once(at_rest).chain((1..means.len()).map(inner)).chain(beyond).collect()
    }

    /// The steepest rise \[s/m\], and the number of the pair after which it is; `None` if the coefficient rises nowhere.
    pub(super) fn steepest_rise(&self) -> Option<(usize, f64)> {
        let rises = self.segments().iter().map(Segment::steepest_rise_s_m).enumerate().collect::<Vec<_>>();
        rises.into_iter().filter(|(_, rise)| *rise > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The coefficient at a speed \[m/s\], and its slope \[s/m\]. NaN without pairs.
    pub fn at(&self, speed_m_s: f64) -> [f64; 2] {
        let at_rest = [self.0.first().map_or(f64::NAN, |[_, mu]| *mu), 0.0];
        self.segments().iter().fold(at_rest, |[mu, slope], segment| {
            let [more, steeper] = segment.at(speed_m_s);
            [mu + more, slope + steeper]
        })
    }

    /// Adds every violated limit that several pairs have to `found`.
    pub(super) fn check(&self, found: &mut Violations) {
        const FIELD: &str = "scene.contact.mu_of_speed";
        let pairs = &self.0;
        if pairs.len() == 1 || pairs.len() > MOST_PAIRS {
            let right = format!(
                "from 2 to {MOST_PAIRS} pairs [speed in m/s, friction coefficient]; of more, keep the mean of each part"
            );
            found.add(FIELD, format!("{} pairs", pairs.len()), right);
            return;
        }
        for (index, &[speed_m_s, mu]) in pairs.iter().enumerate() {
            let field = format!("{FIELD}[{index}]");
            let are_numbers =
                found.within(&format!("{field}[0]"), speed_m_s) && found.within(&format!("{field}[1]"), mu);
            if !are_numbers {
                continue;
            }
            let before = index.checked_sub(1).map(|before| pairs[before][0]);
            match before {
                None if speed_m_s > 0.0 => {
                    found.add(&field, readable(speed_m_s), "the speed 0, with the coefficient at rest");
                }
                Some(before) if speed_m_s == before => {
                    found.add(&field, readable(speed_m_s), "one coefficient for each speed");
                }
                Some(before) if speed_m_s > before && speed_m_s - before < LEAST_STEP_M_S => {
                    let right = format!("a speed at least {LEAST_STEP_M_S:e} m/s above the one before");
                    found.add(&field, readable(speed_m_s), right);
                }
                Some(before) if speed_m_s < before => {
                    found.add(&field, readable(speed_m_s), "speeds that ascend");
                }
                _ => {}
            }
        }
        if self.fast() == Some(0.0) {
            let field = format!("{FIELD}[{}]", pairs.len() - 1);
            found.add(
                &field,
                0,
                "a coefficient > 0 at the last speed, in proportion to which mu scales the table",
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A Stribeck curve with uneven speeds, which falls, turns and rises.
    fn stribeck() -> MuOfSpeed {
        MuOfSpeed(vec![[0.0, 0.5], [0.01, 0.46], [0.05, 0.31], [0.3, 0.28], [1.0, 0.3], [4.0, 0.42]])
    }

    /// Protects: the curve passes its pairs, stays between the two ends of a part and has no corner, and is constant beyond the last speed.
    #[test]
    fn the_curve_is_monotone_between_pairs_and_smooth() {
        let table = stribeck();
        for pair in table.0.windows(2) {
            let [[from, below], [to, above]] = [pair[0], pair[1]];
            let mut last = below;
            for part in 0..=1000 {
                let [mu, _] = table.at(from + (to - from) * f64::from(part) / 1000.0);
                let moved = (mu - last) * (above - below).signum();
                assert!(moved >= -4.0 * f64::EPSILON, "{from} to {to} m/s, part {part}: back by {moved:e}");
                last = mu;
            }
            assert!((last - above).abs() < 4.0 * f64::EPSILON, "{last} at {to} m/s");
        }
        for [speed_m_s, _] in &table.0[1..] {
            // A slope that changes by its curvature over 2ε has no corner.
            let [below, above] = [-1.0e-9, 1.0e-9].map(|step| table.at(speed_m_s * (1.0 + step))[1]);
            assert!((below - above).abs() < 1.0e-6, "{below} and {above} s/m about {speed_m_s} m/s");
        }
        assert_eq!(table.at(100.0), [table.at(4.0)[0], 0.0]);
    }

    /// Protects: the slope that eigenvalues and limits use is that of the curve, and nothing rises more steeply than the steepest rise.
    #[test]
    fn the_slope_is_the_derivative() {
        let table = stribeck();
        let (pair, steepest) = table.steepest_rise().unwrap();
        let mut largest = 0.0_f64;
        for step in 1..4000 {
            let (v, h) = (f64::from(step) * 1.0e-3 + 3.0e-4, 1.0e-6);
            let difference = (table.at(v + h)[0] - table.at(v - h)[0]) / (2.0 * h);
            // The third derivative of the sharpest part bounds the error by h² 6c/(6 w³), and rounding by ε/h.
            let c = table
                .segments()
                .iter()
                .map(|own| own.powers[2].abs() / own.width_m_s.powi(3))
                .fold(0.0, f64::max);
            assert!((difference - table.at(v)[1]).abs() < h * h * c + f64::EPSILON / h, "at {v} m/s");
        }
        for step in 0..=5000 {
            largest = largest.max(table.at(f64::from(step) * 1.0e-3)[1]);
        }
        assert_eq!(pair, 4);
        assert!(
            largest <= steepest * (1.0 + 1.0e-12) && largest > 0.999 * steepest,
            "{largest} of {steepest} s/m"
        );
    }

    /// Protects: a table of two pairs begins with their mean slope, and one that turns after its first part does not overshoot.
    #[test]
    fn the_slope_at_rest_does_not_overshoot() {
        assert_eq!(MuOfSpeed(vec![[0.0, 0.5], [2.0, 0.3]]).at(0.0), [0.5, -0.1]);
        let turning = MuOfSpeed(vec![[0.0, 0.5], [1.0, 0.4], [1.1, 0.9], [2.0, 0.9]]);
        // Three times the mean slope of the first part is the most with which the curve stays between its ends.
        assert!((turning.at(0.0)[1] + 0.3).abs() < 1.0e-15);
    }
}
