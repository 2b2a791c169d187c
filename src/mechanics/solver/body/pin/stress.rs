//! Stress at the nodes of a pin, for output. No time step uses it.

use super::operator::Yielding;
use super::{BlockMesh, GeneralMesh, PinMesh};
use crate::solver::body::hexahedron::{corner_gradients, gauss_gradients};
use crate::solver::material::Material;
use crate::spec::{Element, MaterialLaw};
use nalgebra::{Matrix3, Vector3};

/// Names of the components of a stress, in their order.
pub const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// Stress \[Pa\] at every node, in the order of [`COMPONENTS`], from displacements \[m\] in the order node →
/// component.
///
/// On a block strains are finite differences of nodal displacements along the mesh lines. Inside they are central differences,
/// which are the mean of the strains of the two adjacent elements. On the faces they are one-sided differences of
/// second order; the strains of the elements are only of first order there. So they are exact for displacements
/// that are quadratic in the coordinates, on meshes with at least two elements in each direction.
///
/// On a general mesh the stress of a node is the mean of the stresses that its elements have there. With large strains it is Cauchy's. An
/// element that may yield has at a node the stress of the nearest Gauss point, where what it keeps of its past is known.
///
/// # Panics
/// If there are not three displacements per node.
pub(super) fn nodal_pa(
    mesh: &PinMesh,
    materials: &[Material],
    law: Option<MaterialLaw>,
    yielding: Option<(&Yielding, &[f64])>,
    u_m: &[f64],
) -> Vec<[f64; 6]> {
    assert_eq!(u_m.len(), 3 * mesh.node_count(), "three displacements per node");
    match mesh {
        PinMesh::Block(mesh) => of_block_pa(mesh, &materials[0], u_m),
        PinMesh::General(mesh) => of_elements_pa(mesh, materials, law, yielding, u_m),
    }
}

/// Stress \[Pa\] of a displacement gradient: Hooke's for small strains, and Cauchy's P Fᵀ/J. The term with λ is that of `dilation`, which is
/// tr ε or tr E, or J − 1 of the neo-Hookean law.
fn stress_pa(
    material: &Material,
    law: Option<MaterialLaw>,
    h: &Matrix3<f64>,
    plastic: &Matrix3<f64>,
    dilation: f64,
) -> Matrix3<f64> {
    let (lambda, shear) = (material.lame_lambda_pa(), material.shear_modulus_pa());
    let f = h + Matrix3::identity();
    match law {
        None => (h + h.transpose()) * shear + Matrix3::identity() * (lambda * dilation),
        Some(MaterialLaw::NeoHookean) => {
            let along = 0.5 * lambda * (1.0 + dilation - 1.0 / (1.0 + dilation));
            (f * f.transpose() - Matrix3::identity()) * (shear / f.determinant())
                + Matrix3::identity() * along
        }
        Some(MaterialLaw::J2) => {
            let volume = f.determinant();
            let elastic = f * (plastic + Matrix3::identity()) * f.transpose();
            let deviator = elastic - Matrix3::identity() * (elastic.trace() / 3.0);
            let bulk = lambda + 2.0 / 3.0 * shear;
            let along = 0.5 * bulk * (1.0 + dilation - 1.0 / (1.0 + dilation));
            deviator * (shear * libm::pow(volume, -5.0 / 3.0)) + Matrix3::identity() * along
        }
        Some(MaterialLaw::StVenantKirchhoff) => {
            let second = green_strain(h) * (2.0 * shear) + Matrix3::identity() * (lambda * dilation);
            f * second * f.transpose() / f.determinant()
        }
    }
}

/// E = ½(H + Hᵀ + HᵀH).
fn green_strain(h: &Matrix3<f64>) -> Matrix3<f64> {
    (h + h.transpose() + h.transpose() * h) * 0.5
}

/// What the term of a law with λ depends on: tr ε, tr E or J − 1.
fn dilation(law: Option<MaterialLaw>, h: &Matrix3<f64>) -> f64 {
    match law {
        None => h.trace(),
        Some(MaterialLaw::NeoHookean | MaterialLaw::J2) => (h + Matrix3::identity()).determinant() - 1.0,
        Some(MaterialLaw::StVenantKirchhoff) => green_strain(h).trace(),
    }
}

fn of_elements_pa(
    mesh: &GeneralMesh,
    materials: &[Material],
    law: Option<MaterialLaw>,
    yielding: Option<(&Yielding, &[f64])>,
    u_m: &[f64],
) -> Vec<[f64; 6]> {
    nodal_means(mesh, |number| {
        let element = &mesh.elements()[number];
        let material = &materials[element.material];
        let corners = mesh.corners_m(element);
        let points = || gauss_gradients(&corners).map(|points| points.map(|(gradients, _)| gradients));
        let places = if yielding.is_some() { points() } else { corner_gradients(&corners) };
        let Some(places) = places else { return [[0.0; 6]; 8] };
        let plastic = yielding.map(|(yielding, history)| yielding.points(history, number));
        // ∂u_i/∂x_j
        let gradient = |gradients: &[Vector3<f64>; 8]| {
            Matrix3::<f64>::from_fn(|i, j| {
                element.nodes.iter().zip(gradients).map(|(&other, g)| u_m[3 * other + i] * g[j]).sum::<f64>()
            })
        };
        // A selective element has one for all its points.
        let mean =
            (mesh.element == Element::Selective).then(|| gauss_gradients(&corners)).flatten().map(|points| {
                let volume: f64 = points.iter().map(|(_, volume)| volume).sum();
                let part = |(gradients, volume): &([Vector3<f64>; 8], f64)| {
                    volume * dilation(law, &gradient(gradients))
                };
                points.iter().map(part).sum::<f64>() / volume
            });
        std::array::from_fn(|corner| {
            let h = gradient(&places[corner]);
            let plastic = plastic.map_or_else(Matrix3::zeros, |points| points[corner].plastic);
            let found = stress_pa(material, law, &h, &plastic, mean.unwrap_or_else(|| dilation(law, &h)));
            let stress = |i: usize, j: usize| found[(i, j)];
            [stress(0, 0), stress(1, 1), stress(2, 2), stress(0, 1), stress(1, 2), stress(0, 2)]
        })
    })
}

/// The means over the elements at every node of what they have there. An element has eight values, one for each corner.
pub(super) fn nodal_means<const N: usize>(
    mesh: &GeneralMesh,
    of_element: impl Fn(usize) -> [[f64; N]; 8],
) -> Vec<[f64; N]> {
    let mut sums = vec![([0.0; N], 0.0); mesh.node_count()];
    for (number, element) in mesh.elements().iter().enumerate() {
        for (&node, values) in element.nodes.iter().zip(of_element(number)) {
            let (sum, count) = &mut sums[node];
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum += value;
            }
            *count += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| sum.map(|sum| sum / f64::max(count, 1.0))).collect()
}

fn of_block_pa(mesh: &BlockMesh, material: &Material, u_m: &[f64]) -> Vec<[f64; 6]> {
    let (lambda, shear) = (material.lame_lambda_pa(), material.shear_modulus_pa());
    let h = mesh.element_size_m();
    let elements = mesh.elements();
    let stress_at = |node: usize| {
        let at = mesh.grid_position(node);
        // ∂u_c/∂x_axis
        let derivative = |c: usize, axis: usize| {
            let value = |offset: isize| {
                let mut there = at;
                there[axis] = there[axis].wrapping_add_signed(offset);
                u_m[3 * mesh.node(there[0], there[1], there[2]) + c]
            };
            let difference = match (at[axis], elements[axis]) {
                (0, 1) => value(1) - value(0),
                (_, 1) => value(0) - value(-1),
                (0, _) => -1.5 * value(0) + 2.0 * value(1) - 0.5 * value(2),
                (i, n) if i == n => 1.5 * value(0) - 2.0 * value(-1) + 0.5 * value(-2),
                _ => 0.5 * (value(1) - value(-1)),
            };
            difference / h[axis]
        };
        let normal: [f64; 3] = std::array::from_fn(|axis| derivative(axis, axis));
        let dilation = lambda * normal.iter().sum::<f64>();
        let sheared = |a: usize, b: usize| shear * (derivative(a, b) + derivative(b, a));
        let [xx, yy, zz] = normal.map(|strain| dilation + 2.0 * shear * strain);
        [xx, yy, zz, sheared(0, 1), sheared(1, 2), sheared(0, 2)]
    };
    (0..mesh.node_count()).map(stress_at).collect()
}

/// Von Mises stress \[Pa\] of a stress in the order of [`COMPONENTS`].
pub fn von_mises_pa([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> f64 {
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (normal / 2.0 + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
}

/// Principal stresses \[Pa\], largest first, of a stress in the order of [`COMPONENTS`].
pub fn principal_pa([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> [f64; 3] {
    let tensor = nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let mut principal: [f64; 3] = tensor.symmetric_eigenvalues().into();
    principal.sort_by(|a, b| b.total_cmp(a));
    principal
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATERIAL: Material = Material { young_modulus_pa: 1e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 };

    /// Protects: Hooke's law, the order of the components, and the faces. A displacement that is quadratic in the
    /// coordinates has its exact stress at every node.
    #[test]
    fn quadratic_displacements_have_their_exact_stress() {
        let mesh = BlockMesh::new([0.012, 0.015, 0.010], [2, 5, 3]);
        let field = |[x, y, z]: [f64; 3]| [x * x + 2.0 * y * z, 3.0 * y - x * z, z * z + 0.5 * x * y];
        let u: Vec<f64> = (0..mesh.node_count()).flat_map(|node| field(mesh.coordinates_m(node))).collect();
        let (lambda, shear) = (MATERIAL.lame_lambda_pa(), MATERIAL.shear_modulus_pa());
        for (node, found) in
            nodal_pa(&mesh.clone().into(), &[MATERIAL], None, None, &u).into_iter().enumerate()
        {
            let [x, y, z] = mesh.coordinates_m(node);
            let dilation = lambda * (2.0 * x + 3.0 + 2.0 * z);
            let exact = [
                dilation + 2.0 * shear * 2.0 * x,
                dilation + 2.0 * shear * 3.0,
                dilation + 2.0 * shear * 2.0 * z,
                shear * (2.0 * z - z),
                shear * (-x + 0.5 * x),
                shear * (2.0 * y + 0.5 * y),
            ];
            for (f, e) in found.iter().zip(exact) {
                // A stress is a sum of differences of numbers up to 0.05 over edges of 3 mm, times a modulus. The
                // bound allows some roundings of each.
                let rounding = 16.0 * f64::EPSILON * 0.05 / 0.003 * (lambda + 2.0 * shear);
                assert!((f - e).abs() <= rounding, "node {node}: {found:?} instead of {exact:?}");
            }
        }
    }

    /// Protects: the measures of a stress are those of tension, of pure shear, and of a pressure, in any axes.
    #[test]
    fn measures_of_a_stress_are_those_of_known_states() {
        let root = 3f64.sqrt();
        let cases = [
            ([5.0, 0.0, 0.0, 0.0, 0.0, 0.0], 5.0, [5.0, 0.0, 0.0]),
            ([0.0, 0.0, 0.0, 2.0, 0.0, 0.0], 2.0 * root, [2.0, 0.0, -2.0]),
            ([0.0, 0.0, 0.0, 0.0, -2.0, 0.0], 2.0 * root, [2.0, 0.0, -2.0]),
            ([-3.0, -3.0, -3.0, 0.0, 0.0, 0.0], 0.0, [-3.0, -3.0, -3.0]),
            // Tension of 4 along the diagonal of x and z.
            ([2.0, 0.0, 2.0, 0.0, 0.0, 2.0], 4.0, [4.0, 0.0, 0.0]),
        ];
        for (stress, von_mises, principal) in cases {
            assert!((von_mises_pa(stress) - von_mises).abs() < 1e-14, "{stress:?}");
            // The eigenvalues are found to some roundings of the largest stress.
            let found = principal_pa(stress);
            assert!(found.iter().zip(principal).all(|(f, e)| (f - e).abs() < 1e-14), "{stress:?}: {found:?}");
        }
    }
}
