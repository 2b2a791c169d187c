//! The trilinear hexahedron with full 2 × 2 × 2 integration, and the same with incompatible modes.
//!
//! ```text
//!        6────────7        z
//!       /│       /│        │  y
//!      4────────5 │        │ /
//!      │ 2──────│─3        │/
//!      │/       │/         └──── x
//!      0────────1
//! ```

use crate::solver::material::Material;
use crate::spec::Element;
use nalgebra::{Matrix3, SMatrix, Vector3};

/// The 24 × 24 stiffness matrix of one element, rows and columns `3·node + component` \[N/m\].
pub type ElementStiffness = SMatrix<f64, 24, 24>;

/// Stiffness K_e = ∫ Bᵀ D B dV \[N/m\] of a box of edge lengths `h` \[m\], by 2 × 2 × 2 Gauss points.
///
/// For a box the map to the unit cube is diagonal. So the integrand is a polynomial that two points per direction
/// integrate exactly.
pub fn stiffness(material: &Material, h: [f64; 3]) -> ElementStiffness {
    let lambda = material.lame_lambda_pa();
    let shear = material.shear_modulus_pa();
    let weight = h[0] * h[1] * h[2] / 8.0;
    let mut k = ElementStiffness::zeros();
    for point in 0..8 {
        let gradients = gradients_at(gauss_point(point), h);
        add_products(&mut k, &gradients, &gradients, [lambda, shear], weight);
    }
    // Rounding differs between (a, b) and (b, a). Energies are exact only if the operator is exactly symmetric.
    (k + k.transpose()) * 0.5
}

/// Stiffness \[N/m\] and row-sum lumped volumes \[m³\] of an isoparametric hexahedron with these corners \[m\],
/// numbered as in the figure above, by 2 × 2 × 2 Gauss points. `None` if the element is inverted at one of them.
///
/// An incompatible element has the functions 1 − ξ², 1 − η² and 1 − ζ² beside those of its corners. Their gradients are taken with the
/// Jacobian J₀ of the centre and the factor |J₀|/|J|, so that their mean over the element is zero: then the patch test holds on any mesh
/// (R. L. Taylor, P. J. Beresford and E. L. Wilson, *A non-conforming element for stress analysis*, IJNME 10, 1976). What they
/// contribute is found once, from the condition that no force acts on them, so that K keeps its 24 rows.
///
/// A selective element has the energy ½λ (tr ε)² of the mean of tr ε over the element (J. C. Nagtegaal, D. M. Parks and J. R. Rice, CMAME 4,
/// 1974), so that a nearly incompressible material does not lock.
pub fn isoparametric(
    material: &Material,
    corners: &[Vector3<f64>; 8],
    element: Element,
) -> Option<(ElementStiffness, [f64; 8])> {
    let lambda = material.lame_lambda_pa();
    let shear = material.shear_modulus_pa();
    let mut k = ElementStiffness::zeros();
    let mut volumes = [0.0; 8];
    let (mut across, mut own) = (SMatrix::<f64, 24, 9>::zeros(), SMatrix::<f64, 9, 9>::zeros());
    let (mut dilation, mut volume) = (SMatrix::<f64, 24, 1>::zeros(), 0.0);
    let lambda_of_points = if element == Element::Selective { 0.0 } else { lambda };
    let jacobian_at = |local: &[Vector3<f64>; 8]| -> Matrix3<f64> {
        local.iter().zip(corners).map(|(g, x)| g * x.transpose()).sum()
    };
    let centre = jacobian_at(&gradients_at([0.0; 3], [2.0; 3]));
    let (centre_inverse, centre_volume) = (centre.try_inverse()?, centre.determinant());
    for point in 0..8 {
        let xi = gauss_point(point);
        // Gradients on the reference cube [−1, 1]³, whose edges have the length 2.
        let local = gradients_at(xi, [2.0; 3]);
        let jacobian = jacobian_at(&local);
        let weight = jacobian.determinant();
        if weight <= 0.0 {
            return None;
        }
        let inverse = jacobian.try_inverse()?;
        let gradients = local.map(|g| inverse * g);
        for a in 0..8 {
            let shape: f64 =
                (0..3).map(|axis| if a >> axis & 1 == 0 { 1.0 - xi[axis] } else { 1.0 + xi[axis] }).product();
            volumes[a] += weight * shape / 8.0;
        }
        add_products(&mut k, &gradients, &gradients, [lambda_of_points, shear], weight);
        volume += weight;
        for (a, gradient) in gradients.iter().enumerate() {
            for c in 0..3 {
                dilation[3 * a + c] += weight * gradient[c];
            }
        }
        if element == Element::Incompatible {
            let modes: [Vector3<f64>; 3] = std::array::from_fn(|axis| {
                let mut local = Vector3::zeros();
                local[axis] = -2.0 * xi[axis];
                centre_inverse * local * (centre_volume / weight)
            });
            add_products(&mut across, &gradients, &modes, [lambda, shear], weight);
            add_products(&mut own, &modes, &modes, [lambda, shear], weight);
        }
    }
    if element == Element::Incompatible {
        k -= across * own.try_inverse()? * across.transpose();
    }
    if element == Element::Selective {
        k += dilation * dilation.transpose() * (lambda / volume);
    }
    Some(((k + k.transpose()) * 0.5, volumes))
}

/// The inverse of the Jacobian, ∂ξ_a/∂x_j \[1/m\] in row j and column a for the unit cube, and the volume \[m³\] of each Gauss point of a
/// hexahedron with these corners \[m\]. `None` if the element is inverted at one of them.
pub fn gauss_jacobians(corners: &[Vector3<f64>; 8]) -> Option<[(Matrix3<f64>, f64); 8]> {
    let mut points = [(Matrix3::zeros(), 0.0); 8];
    for (point, found) in points.iter_mut().enumerate() {
        let local = gradients_at(gauss_point(point), [1.0; 3]);
        let jacobian: Matrix3<f64> = local.iter().zip(corners).map(|(g, x)| g * x.transpose()).sum();
        let volume = jacobian.determinant();
        if volume <= 0.0 {
            return None;
        }
        *found = (jacobian.try_inverse()?, volume / 8.0);
    }
    Some(points)
}

/// Gradients ∂N_a/∂x \[1/m\] of the eight shape functions, and the volume \[m³\], of each Gauss point of a hexahedron with these corners \[m\].
/// `None` if the element is inverted at one of them.
pub fn gauss_gradients(corners: &[Vector3<f64>; 8]) -> Option<[([Vector3<f64>; 8], f64); 8]> {
    let points = gauss_jacobians(corners)?;
    Some(std::array::from_fn(|point| {
        let (inverse, volume) = points[point];
        (gradients_at(gauss_point(point), [1.0; 3]).map(|g| inverse * g), volume)
    }))
}

/// Adds weight·∫ of σ(a)·ε(b) for all functions with these gradients: σ = λ tr ε 1 + 2G ε in index form.
fn add_products<const ROWS: usize, const COLUMNS: usize>(
    sums: &mut SMatrix<f64, ROWS, COLUMNS>,
    rows: &[Vector3<f64>],
    columns: &[Vector3<f64>],
    [lambda, shear]: [f64; 2],
    weight: f64,
) {
    for (a, ga) in rows.iter().enumerate() {
        for (b, gb) in columns.iter().enumerate() {
            for i in 0..3 {
                for j in 0..3 {
                    let mut value = lambda * ga[i] * gb[j] + shear * ga[j] * gb[i];
                    if i == j {
                        value += shear * ga.dot(gb);
                    }
                    sums[(3 * a + i, 3 * b + j)] += weight * value;
                }
            }
        }
    }
}

/// The Jacobian at each corner of a hexahedron with these corners \[m\], over the product of the lengths of the edges that meet
/// there. It is 1 for boxes, and 0 or less for elements that are inverted or flat.
pub fn corner_jacobians(corners: &[Vector3<f64>; 8]) -> [f64; 8] {
    std::array::from_fn(|a| {
        let edges: [Vector3<f64>; 3] = std::array::from_fn(|axis| {
            let edge = corners[a ^ (1 << axis)] - corners[a];
            if a >> axis & 1 == 0 { edge } else { -edge }
        });
        let [x, y, z] = edges;
        x.cross(&y).dot(&z) / (x.norm() * y.norm() * z.norm())
    })
}

/// Gradients ∂N_a/∂x \[1/m\] of the eight shape functions at each corner of a hexahedron with these corners \[m\]. `None` if the
/// element is flat at one of them.
pub fn corner_gradients(corners: &[Vector3<f64>; 8]) -> Option<[[Vector3<f64>; 8]; 8]> {
    let mut gradients = [[Vector3::zeros(); 8]; 8];
    for (corner, gradients) in gradients.iter_mut().enumerate() {
        let xi = std::array::from_fn(|axis| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 });
        let local = gradients_at(xi, [2.0; 3]);
        let jacobian: Matrix3<f64> = local.iter().zip(corners).map(|(g, x)| g * x.transpose()).sum();
        let inverse = jacobian.try_inverse()?;
        *gradients = local.map(|g| inverse * g);
    }
    Some(gradients)
}

/// Position of a Gauss point in \[−1, 1\]³.
fn gauss_point(index: usize) -> [f64; 3] {
    let g = 1.0 / 3.0_f64.sqrt();
    std::array::from_fn(|axis| if index >> axis & 1 == 0 { -g } else { g })
}

/// Gradients ∂N_a/∂x \[1/m\] of the eight shape functions of a box of edge lengths `h` at ξ ∈ \[−1, 1\]³.
fn gradients_at(xi: [f64; 3], h: [f64; 3]) -> [Vector3<f64>; 8] {
    std::array::from_fn(|a| {
        let sign: [f64; 3] = std::array::from_fn(|axis| if a >> axis & 1 == 0 { -1.0 } else { 1.0 });
        let factor: [f64; 3] = std::array::from_fn(|axis| (1.0 + sign[axis] * xi[axis]) / 2.0);
        Vector3::new(
            sign[0] / h[0] * factor[1] * factor[2],
            sign[1] / h[1] * factor[0] * factor[2],
            sign[2] / h[2] * factor[0] * factor[1],
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATERIAL: Material = Material { young_modulus_pa: 1e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 };
    const H: [f64; 3] = [1.0e-3, 1.5e-3, 0.7e-3];

    /// Protects: rigid motions cause no force and store no energy.
    #[test]
    fn rigid_motions_are_free() {
        let k = stiffness(&MATERIAL, H);
        let scale = k.amax();
        for mode in 0..6 {
            let u = SMatrix::<f64, 24, 1>::from_fn(|row, _| {
                let (a, c) = (row / 3, row % 3);
                let x = Vector3::from_fn(|axis, _| if a >> axis & 1 == 0 { 0.0 } else { H[axis] / H[0] });
                let mut axis = Vector3::zeros();
                axis[mode % 3] = 1.0;
                if mode < 3 { axis[c] } else { axis.cross(&x)[c] }
            });
            // There are 24 products of the size `scale`, each rounded once.
            assert!((k * u).amax() < 24.0 * 4.0 * f64::EPSILON * scale, "rigid mode {mode} causes a force");
        }
    }

    /// Protects: the patch test. A uniform strain gives the exact stress, hence the exact strain energy.
    #[test]
    fn uniform_strain_has_the_exact_energy() {
        let k = stiffness(&MATERIAL, H);
        let strain = 1e-3;
        let u = SMatrix::<f64, 24, 1>::from_fn(|row, _| {
            let (a, c) = (row / 3, row % 3);
            if c == 2 && a >> 2 == 1 { strain * H[2] } else { 0.0 }
        });
        let energy = 0.5 * (u.transpose() * k * u)[0];
        let modulus = MATERIAL.lame_lambda_pa() + 2.0 * MATERIAL.shear_modulus_pa();
        let exact = 0.5 * modulus * strain * strain * H[0] * H[1] * H[2];
        assert!((energy / exact - 1.0).abs() < 1e-13, "{energy} J instead of {exact} J");
    }
}
