//! Formulas of linear isotropic elasticity. They give NaN for an unphysical material.

/// Poisson's ratio from which on the elements are noticeably too stiff; `tests/verification/locking.rs` has measured it.
pub const LOCKING_POISSON_RATIO: f64 = 0.48;

/// Lamé's first parameter λ = Eν / ((1+ν)(1−2ν)) (Pa).
pub fn lame_lambda_pa(young_modulus_pa: f64, poisson_ratio: f64) -> f64 {
    young_modulus_pa * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio))
}

/// Shear modulus G = E / (2(1+ν)) (Pa).
pub fn shear_modulus_pa(young_modulus_pa: f64, poisson_ratio: f64) -> f64 {
    young_modulus_pa / (2.0 * (1.0 + poisson_ratio))
}

/// Speed c_p = √((λ+2G)/ρ) of pressure waves [m/s].
pub fn pressure_wave_speed_m_s(young_modulus_pa: f64, poisson_ratio: f64, density_kg_m3: f64) -> f64 {
    let lambda_pa = lame_lambda_pa(young_modulus_pa, poisson_ratio);
    ((lambda_pa + 2.0 * shear_modulus_pa(young_modulus_pa, poisson_ratio)) / density_kg_m3).sqrt()
}

/// Speed c_s = √(G/ρ) of shear waves [m/s].
pub fn shear_wave_speed_m_s(young_modulus_pa: f64, poisson_ratio: f64, density_kg_m3: f64) -> f64 {
    (shear_modulus_pa(young_modulus_pa, poisson_ratio) / density_kg_m3).sqrt()
}
