//! Heights of a rough base: a sum of waves from a seed and a spectrum, or a map between its points.

use crate::random::{SplitMix64, mix};
use crate::spec::{HeightMap, Roughness};
use std::f64::consts::{PI, TAU};

/// Bands of wavelength per octave.
const BANDS: f64 = 8.0;

/// Directions in each band.
const DIRECTIONS: u32 = 32;

/// A surface that is a sum of cosine waves. Its height \[m\] at (x, y) is `Σ a cos(k_x x + k_y y + φ)`.
///
/// Bands of |k| have equal ratios. In each band there is one wave in each of 32 sectors of direction; its |k| in the band, its
/// direction in the sector and its phase are random. All waves of a band have the same amplitude. Their
/// variances ½a² add up to that of the spectrum `|k|^(−2(1+H))` in the band, `∫ k^(−2(1+H)) k dk`.
#[derive(Debug, Clone, Default)]
pub(super) struct WaveSum {
    waves: Vec<Wave>,
}

#[derive(Debug, Clone, Copy)]
struct Wave {
    amplitude_m: f64,
    /// Wave vector \[rad/m\].
    k: [f64; 2],
    phase: f64,
}

impl WaveSum {
    /// The surface of a roughness. It has the same bits on every machine.
    pub fn new(roughness: &Roughness) -> Self {
        let (Some(longest_m), Some(shortest_m)) = (roughness.longest_m, roughness.shortest_m) else {
            return Self::default();
        };
        let octaves = libm::log2(longest_m / shortest_m);
        let bands = libm::ceil(BANDS * octaves).max(1.0) as u32;
        // |k|/k_longest at the lower end of a band, or within it.
        let ratio = |band: f64| libm::exp2(octaves * band / f64::from(bands));
        let power = |band: u32| {
            let at = |band: f64| libm::pow(ratio(band), -2.0 * roughness.hurst);
            at(f64::from(band)) - at(f64::from(band) + 1.0)
        };
        let total: f64 = (0..bands).map(power).sum();
        let mut waves = Vec::new();
        for band in 0..bands {
            let variance_m2 = roughness.rms_m * roughness.rms_m * (power(band) / total);
            let amplitude_m = (2.0 * variance_m2 / f64::from(DIRECTIONS)).sqrt();
            for sector in 0..DIRECTIONS {
                let random = |which: u64| {
                    let wave = u64::from(band * DIRECTIONS + sector);
                    uniform(roughness.seed, 4 * wave + which)
                };
                let k = TAU / longest_m * ratio(f64::from(band) + random(0));
                let (sin, cos) = libm::sincos(PI * (f64::from(sector) + random(1)) / f64::from(DIRECTIONS));
                waves.push(Wave { amplitude_m, k: [k * cos, k * sin], phase: TAU * random(2) });
            }
        }
        Self { waves }
    }

    /// The height \[m\] at a point \[m\] from the pin's axis.
    pub fn height_m(&self, [x, y]: [f64; 2]) -> f64 {
        let of = |wave: &Wave| wave.amplitude_m * libm::cos(wave.k[0] * x + wave.k[1] * y + wave.phase);
        self.waves.iter().map(of).sum()
    }
}

/// A number from 0 to 1, equally likely everywhere: number `index` of the sequence that `seed` begins.
fn uniform(seed: u64, index: u64) -> f64 {
    SplitMix64::from(mix(seed), index).unit()
}

/// The height \[m\] of a map at a point \[m\] from the pin's axis, bilinear between the four points around it.
pub(super) fn map_height_m(map: &HeightMap, [x, y]: [f64; 2]) -> f64 {
    let heights = &map.heights_m;
    let [columns, rows] = [heights[0].len(), heights.len()];
    // The cell and the place in it, from 0 to 1. Rounding can put an edge of the base beyond that of the map.
    let cell = |position_m: f64, points: usize| {
        let last = (points - 1) as f64;
        let at = (position_m / map.spacing_m + 0.5 * last).clamp(0.0, last);
        let cell = (at as usize).min(points - 2);
        (cell, at - cell as f64)
    };
    let ((column, right), (row, up)) = (cell(x, columns), cell(y, rows));
    let along = |row: usize| heights[row][column] * (1.0 - right) + heights[row][column + 1] * right;
    along(row) * (1.0 - up) + along(row + 1) * up
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rough(seed: u64) -> Roughness {
        let (longest_m, shortest_m) = (Some(0.004), Some(0.0005));
        Roughness { rms_m: 1.0e-6, seed, hurst: 0.7, longest_m, shortest_m }
    }

    /// Protects: a surface has the same bits on every machine, and every seed has another one. The reference bits are those of
    /// libm and of IEEE arithmetic.
    #[test]
    fn a_seed_is_a_surface() {
        let height = |seed, at| WaveSum::new(&rough(seed)).height_m(at);
        let found = [[0.0, 0.0], [0.001, -0.002], [0.0123, 0.0045]].map(|at| height(7, at));
        assert_eq!(found.map(f64::to_bits), REFERENCE, "{found:?} {:x?}", found.map(f64::to_bits));
        assert_ne!(height(7, [0.0; 2]), height(8, [0.0; 2]));
        assert_eq!(uniform(7, 3), uniform(7, 3));
    }

    const REFERENCE: [u64; 3] = [0xbe9d_3749_c555_85c6, 0xbe6b_931d_827f_39c8, 0xbe9b_eb71_7b77_d7e2];

    /// Protects: the RMS height and the spectrum. Over a square of 50 longest wavelengths some 2500 patches are independent, so the
    /// mean of h² has an error of √(2/2500) = 3 %, and its root half of that. The variance of an octave of wavelength
    /// falls by 2^(2H) from octave to octave, exactly.
    #[test]
    fn the_spectrum_is_self_affine() {
        let surface = WaveSum::new(&rough(3));
        let edge_m = 0.2;
        let points = 150;
        let mut sum = 0.0;
        for i in 0..points {
            for j in 0..points {
                let at = [i, j].map(|n| edge_m * (f64::from(n) / f64::from(points) - 0.5));
                let height = surface.height_m(at) / 1.0e-6;
                sum += height * height;
            }
        }
        let rms = (sum / f64::from(points * points)).sqrt();
        assert!((rms - 1.0).abs() < 0.03, "{rms}");
        let variance = |from_m: f64| -> f64 {
            let in_octave = |wave: &&Wave| {
                let length_m = TAU / libm::hypot(wave.k[0], wave.k[1]);
                length_m <= from_m && length_m > from_m / 2.0
            };
            surface.waves.iter().filter(in_octave).map(|wave| 0.5 * wave.amplitude_m * wave.amplitude_m).sum()
        };
        let ratio = variance(0.004) / variance(0.001);
        let exact = libm::pow(4.0, 2.0 * 0.7);
        assert!((ratio / exact - 1.0).abs() < 1.0e-9, "{ratio}, not {exact}");
        let total: f64 = [0.004, 0.002, 0.001].map(variance).iter().sum();
        assert!((total / 1.0e-12 - 1.0).abs() < 1.0e-9, "{total:e}");
    }

    /// Protects: a map is centred, runs along +x and +y, and is exact for a bilinear surface, up to its edges.
    #[test]
    fn a_map_is_bilinear() {
        let exact = |x: f64, y: f64| 1.0e-6 + 2.0e-4 * x - 3.0e-4 * y + 0.05 * x * y;
        let spacing_m = 0.001;
        let row = |y: f64| (0..7).map(|i| exact((f64::from(i) - 3.0) * spacing_m, y)).collect();
        let heights_m = (0..5).map(|j| row((f64::from(j) - 2.0) * spacing_m)).collect();
        let map = HeightMap { file: None, spacing_m, heights_m };
        for [x, y] in [[0.0, 0.0], [0.0013, -0.0007], [-0.003, 0.002], [0.003, -0.002], [0.0001, 0.0019]] {
            let found = map_height_m(&map, [x, y]);
            assert!((found - exact(x, y)).abs() < 1.0e-20, "({x}, {y}): {found:e}, not {:e}", exact(x, y));
        }
    }
}
