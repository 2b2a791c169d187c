//! Roughness of the pin's base: from a spectrum, or measured.

use super::check::{Violations, readable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A random rough surface with a self-affine spectrum: the power of its height falls like `|k|^(−2(1 + H))` between two
/// wavelengths, and is the same in all directions. The surface depends on nothing else, so it is the same on every mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Roughness {
    /// Root mean square (m) of the height of an infinite surface. 0: smooth.
    pub rms_m: f64,
    /// Another number is another surface with the same spectrum.
    pub seed: u64,
    /// Hurst exponent H, above 0 and at most 1.
    pub hurst: f64,
    /// Longest wavelength (m).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub longest_m: Option<f64>,
    /// Shortest wavelength (m), from four elements on and at most half of the longest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shortest_m: Option<f64>,
}

impl Default for Roughness {
    fn default() -> Self {
        Self { rms_m: 0.0, seed: 0, hurst: 0.8, longest_m: None, shortest_m: None }
    }
}

/// Largest ratio of the two wavelengths.
const WIDEST: f64 = 256.0;

impl Roughness {
    /// Adds every violated limit to `found`, for a base whose shortest wavelength is `resolved_m`.
    pub(super) fn check(&self, resolved_m: f64, found: &mut Violations) {
        let field = |name: &str| format!("scene.pin.base.roughness.{name}");
        found.within(&field("rms_m"), self.rms_m);
        found.within(&field("hurst"), self.hurst);
        let (Some(longest), Some(shortest)) = (self.longest_m, self.shortest_m) else {
            for (name, length) in [("longest_m", self.longest_m), ("shortest_m", self.shortest_m)] {
                if length.is_none() {
                    found.add(&field(name), "absent", "a wavelength of the roughness");
                }
            }
            return;
        };
        let right = format!("at least {resolved_m:.3e} m, {} elements", super::base::ELEMENTS_OF_WAVE);
        found.require(&field("shortest_m"), shortest, shortest >= resolved_m, &right);
        found.limit_magnitude(&field("shortest_m"), shortest);
        let right = format!("from twice to {WIDEST} times the shortest wavelength, {} m", readable(shortest));
        let holds = longest >= 2.0 * shortest && longest <= WIDEST * shortest;
        found.require(&field("longest_m"), longest, holds, &right);
        found.limit_magnitude(&field("longest_m"), longest);
    }
}

/// Measured heights of the base on a square grid that is centred on the pin, interpolated bilinearly.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HeightMap {
    /// A file of numbers, relative to the study file: a line for each row, with commas, semicolons or spaces between the numbers.
    /// It is read with the study, and `heights_m` stands for it from then on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Distance (m) between neighbours.
    pub spacing_m: f64,
    /// Heights (m), outwards from the pin: the highest point touches first. A row runs along +x, and row follows row along +y.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub heights_m: Vec<Vec<f64>>,
}

/// Most heights of a map. Every job of a study contains them.
pub const MOST_HEIGHTS: usize = 65_536;

impl HeightMap {
    /// Whether all heights are equal.
    pub(super) fn is_flat(&self) -> bool {
        let mut heights = self.heights_m.iter().flatten();
        let first = heights.next();
        heights.all(|height| Some(height) == first)
    }

    /// Adds every violated limit to `found`, for a base with these edges.
    pub(super) fn check(&self, size_m: [f64; 2], found: &mut Violations) {
        if let Some(file) = &self.file {
            let right = "heights_m: a job has the heights themselves, which are read with its study";
            found.add("scene.pin.base.height_map.file", file, right);
            return;
        }
        let field = "scene.pin.base.height_map.heights_m";
        let columns = self.heights_m.first().map_or(0, Vec::len);
        if self.heights_m.len() < 2 || columns < 2 {
            let size = format!("{} rows of {columns}", self.heights_m.len());
            found.add(field, size, "at least 2 rows of 2 heights, or a file");
            return;
        }
        if let Some(row) = self.heights_m.iter().position(|row| row.len() != columns) {
            let size = format!("{} heights in row {}", self.heights_m[row].len(), row + 1);
            found.add(field, size, format!("{columns} heights in every row, as in the first"));
            return;
        }
        let count = self.heights_m.len() * columns;
        if count > MOST_HEIGHTS {
            found.add(field, format!("{count} heights"), format!("at most {MOST_HEIGHTS}; resample the map"));
        }
        let largest = self.heights_m.iter().flatten().fold(0.0_f64, |largest, height| {
            if height.is_finite() { largest.max(height.abs()) } else { f64::INFINITY }
        });
        found.require(field, largest, true, "numbers");
        found.limit_magnitude(field, largest);
        let field = "scene.pin.base.height_map.spacing_m";
        found.within(field, self.spacing_m);
        let least_m = (size_m[0] / (columns - 1) as f64).max(size_m[1] / (self.heights_m.len() - 1) as f64);
        if self.spacing_m > 0.0 && self.spacing_m < least_m * (1.0 - 1.0e-9) {
            let right = format!(
                "at least {} m, with which {columns} × {} heights cover the base of {} m × {} m",
                super::check::short(least_m),
                self.heights_m.len(),
                readable(size_m[0]),
                readable(size_m[1]),
            );
            found.add(field, readable(self.spacing_m), right);
        }
    }
}
