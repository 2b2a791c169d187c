//! Linear isotropic elasticity.

use crate::spec::{Pin, Region, elasticity};

/// A linear elastic isotropic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Young's modulus E \[Pa\].
    pub young_modulus_pa: f64,
    /// Poisson's ratio ν.
    pub poisson_ratio: f64,
    /// Density ρ \[kg/m³\].
    pub density_kg_m3: f64,
}

impl Material {
    /// The material of a pin.
    pub fn of_pin(pin: &Pin) -> Self {
        Self {
            young_modulus_pa: pin.young_modulus_pa,
            poisson_ratio: pin.poisson_ratio,
            density_kg_m3: pin.density_kg_m3,
        }
    }

    /// The material of a region.
    pub fn of_region(region: &Region) -> Self {
        Self {
            young_modulus_pa: region.young_modulus_pa,
            poisson_ratio: region.poisson_ratio,
            density_kg_m3: region.density_kg_m3,
        }
    }

    /// Lamé's first parameter λ = Eν / ((1+ν)(1−2ν)) \[Pa\].
    pub fn lame_lambda_pa(&self) -> f64 {
        elasticity::lame_lambda_pa(self.young_modulus_pa, self.poisson_ratio)
    }

    /// Shear modulus G = E / (2(1+ν)) \[Pa\].
    pub fn shear_modulus_pa(&self) -> f64 {
        elasticity::shear_modulus_pa(self.young_modulus_pa, self.poisson_ratio)
    }

    /// Speed c_p = √((λ+2G)/ρ) of pressure waves \[m/s\].
    pub fn pressure_wave_speed_m_s(&self) -> f64 {
        elasticity::pressure_wave_speed_m_s(self.young_modulus_pa, self.poisson_ratio, self.density_kg_m3)
    }

    /// Speed c_s = √(G/ρ) of shear waves \[m/s\].
    pub fn shear_wave_speed_m_s(&self) -> f64 {
        elasticity::shear_wave_speed_m_s(self.young_modulus_pa, self.poisson_ratio, self.density_kg_m3)
    }
}
