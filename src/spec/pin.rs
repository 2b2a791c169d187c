//! The pin.

use super::base::Base;
use super::check::Violations;
use super::elasticity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest number of elements per direction: more are taken for a typing error.
const MAX_ELEMENTS: usize = 1000;

/// Largest number of elements in all: about a gigabyte of fields, and days of run time.
const MAX_TOTAL_ELEMENTS: f64 = 2.0e6;

/// The pin: a linear elastic block meshed with nx × ny × nz trilinear hexahedra.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Pin {
    /// Edge lengths (m) in x (radial), y (sliding direction) and z.
    pub size_m: [f64; 3],
    /// Number of elements in x, y and z.
    pub elements: [usize; 3],
    /// Young's modulus (Pa).
    pub young_modulus_pa: f64,
    /// Poisson's ratio, −1 < ν < 0.5.
    pub poisson_ratio: f64,
    /// Density [kg/m³].
    pub density_kg_m3: f64,
    /// How its base differs from a plane.
    pub base: Base,
}

impl Default for Pin {
    fn default() -> Self {
        Self {
            size_m: [0.012, 0.015, 0.010],
            elements: [12, 15, 10],
            young_modulus_pa: 1.0e9,
            poisson_ratio: 0.3,
            density_kg_m3: 2500.0,
            base: Base::default(),
        }
    }
}

impl Pin {
    /// Time \[s\] in which a shear wave crosses the pin's height; NaN for an unphysical material.
    pub fn shear_transit_s(&self) -> f64 {
        self.size_m[2]
            / elasticity::shear_wave_speed_m_s(self.young_modulus_pa, self.poisson_ratio, self.density_kg_m3)
    }

    /// Adds every violated limit to `found`.
    pub(super) fn check(&self, found: &mut Violations) {
        for (axis, size) in self.size_m.iter().enumerate() {
            found.require_magnitude(&format!("scene.pin.size_m[{axis}]"), *size, "a length > 0 m");
        }
        for (axis, &count) in self.elements.iter().enumerate() {
            if !(1..=MAX_ELEMENTS).contains(&count) {
                found.add(
                    &format!("scene.pin.elements[{axis}]"),
                    count,
                    format!("a number of elements from 1 to {MAX_ELEMENTS}"),
                );
            }
        }
        let total = self.elements.iter().map(|&count| count as f64).product::<f64>();
        if total > MAX_TOTAL_ELEMENTS {
            found.add(
                "scene.pin.elements",
                format!("{:?} ({total:e} elements)", self.elements),
                format!("at most {MAX_TOTAL_ELEMENTS:e} elements in all"),
            );
        }
        let [lx, ly, _] = self.size_m;
        self.base.check([lx, ly], [self.elements[0], self.elements[1]], found);
        let e = self.young_modulus_pa;
        found.require_magnitude("scene.pin.young_modulus_pa", e, "a modulus > 0 Pa");
        let nu = self.poisson_ratio;
        found.require(
            "scene.pin.poisson_ratio",
            nu,
            nu > -1.0 && nu < 0.5,
            "a Poisson's ratio with -1 < ν < 0.5 (0.5 is incompressible: no finite wave speed)",
        );
        let rho = self.density_kg_m3;
        found.require_magnitude("scene.pin.density_kg_m3", rho, "a density > 0 kg/m³");
    }
}
