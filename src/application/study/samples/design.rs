//! Designs: points of the unit cube. They are the same on every machine.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How points are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(in crate::study) enum Design {
    /// Independent random points.
    Random,
    /// A Latin hypercube: in each parameter, one point in each of `count` parts of equal share.
    LatinHypercube,
    /// Sobol's sequence with Owen's scrambling. More points keep the first ones.
    Sobol,
    /// Trajectories of Morris (1991) on four levels: `count` of them, each with one point more than parameters. From point to point one
    /// parameter changes by two thirds of its range.
    Morris,
}

/// Largest number of points of Sobol's sequence that its scrambling is made for.
pub(super) const MOST_SOBOL: usize = 1 << 16;

/// Largest number of parameters of Sobol's sequence.
pub(super) const MOST_SOBOL_PARAMETERS: usize = 256;

/// Levels of a design of Morris.
const LEVELS: usize = 4;

impl Design {
    /// Number of points.
    pub fn points(self, count: usize, parameters: usize) -> usize {
        match self {
            Self::Random | Self::LatinHypercube | Self::Sobol => count,
            Self::Morris => count.saturating_mul(parameters + 1),
        }
    }

    /// The points, with `parameters` coordinates from 0 to 1 each. Those of a Morris design may be 0 and 1.
    pub fn unit_points(self, count: usize, parameters: usize, seed: u64) -> Vec<Vec<f64>> {
        match self {
            Self::Random => {
                let mut streams: Vec<Stream> =
                    (0..parameters).map(|k| Stream::new(seed, k, "value")).collect();
                (0..count).map(|_| streams.iter_mut().map(Stream::unit).collect()).collect()
            }
            Self::LatinHypercube => latin_hypercube(count, parameters, seed),
            Self::Sobol => {
                let coordinate = |i: usize, k: usize| {
                    let low = (seed ^ (seed >> 32)) as u32;
                    // A coordinate is a multiple of 2⁻²⁴. The middle of that cell is neither 0 nor 1.
                    f64::from(sobol_burley::sample(i as u32, k as u32, low)) + 0.5 / f64::from(1 << 24)
                };
                (0..count).map(|i| (0..parameters).map(|k| coordinate(i, k)).collect()).collect()
            }
            Self::Morris => (0..count).flat_map(|number| trajectory(number, parameters, seed)).collect(),
        }
    }
}

fn latin_hypercube(count: usize, parameters: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut points = vec![Vec::with_capacity(parameters); count];
    for k in 0..parameters {
        let (mut order, mut inside) = (Stream::new(seed, k, "order"), Stream::new(seed, k, "value"));
        for (point, part) in points.iter_mut().zip(order.permutation(count)) {
            point.push((part as f64 + inside.unit()) / count as f64);
        }
    }
    points
}

/// A trajectory: a random point of the levels, from which each parameter changes once, in random order.
fn trajectory(number: usize, parameters: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut stream = Stream::new(seed, number, "trajectory");
    let half = LEVELS / 2;
    let top = (LEVELS - 1) as f64;
    let starts: Vec<(usize, bool)> =
        (0..parameters).map(|_| (stream.below(half), stream.below(2) == 1)).collect();
    let mut levels: Vec<usize> =
        starts.iter().map(|(low, is_up)| if *is_up { *low } else { low + half }).collect();
    let mut points = vec![levels.clone()];
    for k in stream.permutation(parameters) {
        let (low, is_up) = starts[k];
        levels[k] = if is_up { low + half } else { low };
        points.push(levels.clone());
    }
    points.into_iter().map(|levels| levels.into_iter().map(|level| level as f64 / top).collect()).collect()
}

/// Random numbers from the output of BLAKE3 for a seed, a number and a purpose.
struct Stream(blake3::OutputReader);

impl Stream {
    fn new(seed: u64, number: usize, purpose: &str) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&seed.to_le_bytes());
        hasher.update(&(number as u64).to_le_bytes());
        hasher.update(purpose.as_bytes());
        Self(hasher.finalize_xof())
    }

    fn word(&mut self) -> u64 {
        let mut bytes = [0; 8];
        self.0.fill(&mut bytes);
        u64::from_le_bytes(bytes)
    }

    /// A number between 0 and 1, neither of which it is.
    fn unit(&mut self) -> f64 {
        ((self.word() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// A whole number below `count`. Its bias, count/2⁶⁴, does not matter.
    fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.word()) * count as u128) >> 64) as usize
    }

    /// The numbers below `count` in random order (Fisher and Yates).
    fn permutation(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            let other = self.below(last + 1);
            order.swap(last, other);
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: each part of each parameter has one point, and another seed gives other points.
    #[test]
    fn a_latin_hypercube_has_a_point_in_each_part() {
        let points = Design::LatinHypercube.unit_points(50, 3, 7);
        for k in 0..3 {
            let mut parts: Vec<usize> = points.iter().map(|point| (point[k] * 50.0) as usize).collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..50).collect::<Vec<_>>());
        }
        assert_ne!(points, Design::LatinHypercube.unit_points(50, 3, 8));
    }

    /// Protects: Sobol's sequence is extendable, and its first 2^m points have one point in each of 2^m parts of each parameter.
    #[test]
    fn sobol_points_are_kept_and_even() {
        let points = Design::Sobol.unit_points(64, 5, 3);
        assert_eq!(points[..], Design::Sobol.unit_points(128, 5, 3)[..64]);
        for k in 0..5 {
            let mut parts: Vec<usize> = points.iter().map(|point| (point[k] * 64.0) as usize).collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..64).collect::<Vec<_>>());
        }
    }

    /// Protects: in a trajectory each parameter changes once, by two thirds.
    #[test]
    fn a_trajectory_changes_each_parameter_once() {
        let points = Design::Morris.unit_points(20, 4, 1);
        assert_eq!(points.len(), Design::Morris.points(20, 4));
        for trajectory in points.chunks(5) {
            let mut changed = [0; 4];
            for pair in trajectory.windows(2) {
                let differences: Vec<usize> = (0..4).filter(|&k| pair[0][k] != pair[1][k]).collect();
                let &[k] = differences.as_slice() else { panic!("{differences:?}") };
                assert!(((pair[1][k] - pair[0][k]).abs() - 2.0 / 3.0).abs() < 1e-12);
                changed[k] += 1;
            }
            assert_eq!(changed, [1; 4]);
        }
    }
}
