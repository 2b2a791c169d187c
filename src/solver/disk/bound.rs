//! A rigorous bound of the ring's largest frequency.

use super::operator::Elements;
use nalgebra::DMatrix;

/// Upper bound of ω_max² [rad²/s²] of the lumped ring: the largest of its single elements (Rayleigh's quotient of a
/// sum is at most that of a part; what is held can only lower it).
pub(super) fn omega_max_squared(elements: &Elements) -> f64 {
    let of_element = |element: &super::sector::SectorElement| {
        let scaled = DMatrix::from_fn(24, 24, |row, col| {
            element.stiffness[(row, col)] / (element.masses_kg[row / 3] * element.masses_kg[col / 3]).sqrt()
        });
        scaled.symmetric_eigenvalues().max()
    };
    elements.all().iter().map(of_element).fold(0.0, f64::max)
}
