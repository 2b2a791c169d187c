//! The shape of the pin's base.

use super::check::Violations;
use super::roughness::{HeightMap, Roughness};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the pin's base differs from a plane. It is a gap between the undeformed pin and the disk, which is small beside the
/// elements. The mesh stays a block. All parts add up, and the lowest node touches the disk.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Base {
    /// Radius (m) of a spherical crown. Absent: flat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crown_radius_m: Option<f64>,
    /// Radius (m) of the rounding of all four edges. Absent: sharp.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edge_radius_m: Option<f64>,
    /// Width (m) of a chamfer on all four edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chamfer_width_m: Option<f64>,
    /// Height (m) of the chamfer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chamfer_height_m: Option<f64>,
    /// Amplitude (m) of a wave, a in a (1 + sin(2πs/λ)). Absent: no wave.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wave_height_m: Option<f64>,
    /// Wavelength λ (m).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wave_length_m: Option<f64>,
    /// Direction (°) in which the wave runs, from +x towards +y. Absent: 90, the sliding direction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wave_direction_deg: Option<f64>,
    /// Random roughness. Absent: smooth.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Roughness")]
    pub roughness: Option<Roughness>,
    /// Measured heights. Absent: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "HeightMap")]
    pub height_map: Option<HeightMap>,
}

/// Fewest elements of a wavelength: with fewer its height between nodes is lost.
pub(super) const ELEMENTS_OF_WAVE: f64 = 4.0;

impl Base {
    /// Whether the base is a plane.
    pub fn is_flat(&self) -> bool {
        let has_height = |height: Option<f64>| height.is_some_and(|height| height != 0.0);
        self.crown_radius_m.is_none()
            && self.edge_radius_m.is_none()
            && !has_height(self.chamfer_height_m)
            && !has_height(self.wave_height_m)
            && self.roughness.as_ref().is_none_or(|roughness| roughness.rms_m == 0.0)
            && self.height_map.as_ref().is_none_or(HeightMap::is_flat)
    }

    /// Adds every violated limit to `found`, for a base with these edges and elements.
    pub(super) fn check(&self, size_m: [f64; 2], [hx, hy]: [f64; 2], found: &mut Violations) {
        let [lx, ly] = size_m;
        let half_diagonal = 0.5 * libm::hypot(lx, ly);
        let half_edge = 0.5 * lx.min(ly);
        if let Some(radius) = self.crown_radius_m {
            let holds = radius >= half_diagonal;
            let right = "a radius of at least half the diagonal of the base";
            found.require("scene.pin.base.crown_radius_m", radius, holds, right);
            found.limit_magnitude("scene.pin.base.crown_radius_m", radius);
        }
        let positive = [("edge_radius_m", self.edge_radius_m), ("chamfer_width_m", self.chamfer_width_m)];
        for (name, width) in positive {
            if let Some(width) = width {
                let right = "a length > 0 m, at most half the shorter edge of the base";
                let holds = width > 0.0 && width <= half_edge;
                found.require(&format!("scene.pin.base.{name}"), width, holds, right);
            }
        }
        together(
            [("chamfer_width_m", self.chamfer_width_m), ("chamfer_height_m", self.chamfer_height_m)],
            found,
        );
        together([("wave_height_m", self.wave_height_m), ("wave_length_m", self.wave_length_m)], found);
        for (name, height) in
            [("chamfer_height_m", self.chamfer_height_m), ("wave_height_m", self.wave_height_m)]
        {
            if let Some(height) = height {
                let field = format!("scene.pin.base.{name}");
                found.within(&field, height);
            }
        }
        if let Some(roughness) = &self.roughness {
            roughness.check(ELEMENTS_OF_WAVE * hx.max(hy), found);
        }
        if let Some(map) = &self.height_map {
            map.check(size_m, found);
        }
        if let Some(length) = self.wave_length_m {
            let (sin, cos) = libm::sincos(self.wave_direction_deg.unwrap_or(90.0).to_radians());
            let shortest = ELEMENTS_OF_WAVE * (hx * cos.abs()).max(hy * sin.abs());
            let right = format!("at least {shortest:.3e} m, {ELEMENTS_OF_WAVE} elements along the wave");
            found.require("scene.pin.base.wave_length_m", length, length >= shortest, &right);
            found.limit_magnitude("scene.pin.base.wave_length_m", length);
        }
        if let Some(direction) = self.wave_direction_deg {
            if self.wave_height_m.is_none() {
                found.add("scene.pin.base.wave_height_m", "absent", "a height beside wave_direction_deg");
            }
            found.within("scene.pin.base.wave_direction_deg", direction);
        }
    }
}

/// Requires both or none.
fn together(fields: [(&str, Option<f64>); 2], found: &mut Violations) {
    for [(given, value), (other, missing)] in [fields, [fields[1], fields[0]]] {
        if value.is_some() && missing.is_none() {
            found.add(&format!("scene.pin.base.{other}"), "absent", format!("a length beside {given}"));
        }
    }
}
