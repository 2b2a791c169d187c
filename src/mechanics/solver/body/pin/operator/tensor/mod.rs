//! K of a uniform block as a sum of tensor products of one-dimensional matrices.
//!
//! On a uniform block of trilinear, fully integrated hexahedra every term of the elastic energy is a product of
//! one-dimensional integrals, boundaries included. With the mass M = ∫NᵢNⱼ, the stiffness S = ∫Nᵢ′Nⱼ′ and the
//! derivative D = ∫Nᵢ′Nⱼ of linear elements in each direction,
//!
//! ```text
//! K_xx = (λ+2G) Sx My Mz + G Mx Sy Mz + G Mx My Sz          (and cyclic)
//! K_xy = λ Dx Dyᵀ Mz + G Dxᵀ Dy Mz                          (and so on)
//! ```
//!
//! M = h/6 M̂ and S = Ŝ/h have the rows M̂ = (1, 4, 1), Ŝ = (−1, 2, −1), with 2 and 1 in the centre at the two
//! ends. D = (Â + B̂)/2 and Dᵀ = (−Â + B̂)/2 with Â = (1, 0, −1) and B̂ = −1, 0, …, 0, 1 on the diagonal, so
//!
//! ```text
//! K_xy = Mz/4 { Ây [−(λ+G)Âx − (λ−G)B̂x] + B̂y [(λ−G)Âx + (λ+G)B̂x] }
//! ```
//!
//! This form needs about 100 operations per node; the assembled rows need 486. The module `pass` does them in one
//! sweep over the mesh.

mod pass;

pub(super) use pass::TensorScratch;

use crate::solver::body::hexahedron::{self, ElementStiffness};
use crate::solver::body::pin::BlockMesh;
use crate::solver::material::Material;

/// K of a block of equal elements.
#[derive(Debug, Clone)]
pub struct TensorOperator {
    mesh: BlockMesh,
    material: Material,
    nodes: [usize; 3],
    /// Coefficients of K_cc: \[Sx My Mz, Mx Sy Mz, Mx My Sz\] for each component c.
    own: [[f64; 3]; 3],
    /// −(λ+G) of the couplings xy, xz, yz, times the scale of the third direction.
    skew: [f64; 3],
    /// (λ−G) of the same couplings, times the same scale.
    edge: [f64; 3],
    /// (λ−G)/(λ+G). The second bracket of a coupling is minus this times the first bracket, plus 4λG/(λ+G) B̂.
    share: f64,
    /// 4λG/(λ+G) of the same couplings, times the same scale. It acts where two faces meet (B̂B̂).
    corner: [f64; 3],
    /// 1, 2 and 4, the factors of the centre. They are not constants, because the compiler would turn constants
    /// into additions (2x = x + x), and the product is limited by additions.
    powers: [f64; 3],
}

impl TensorOperator {
    /// K of `mesh` for a material.
    pub fn new(mesh: &BlockMesh, material: &Material) -> Self {
        let [hx, hy, hz] = mesh.element_size_m();
        let (lambda, g) = (material.lame_lambda_pa(), material.shear_modulus_pa());
        let directions = [hy * hz / (36.0 * hx), hx * hz / (36.0 * hy), hx * hy / (36.0 * hz)];
        let across = [hz / 24.0, hy / 24.0, hx / 24.0];
        Self {
            mesh: mesh.clone(),
            material: *material,
            nodes: mesh.nodes_per_axis(),
            own: std::array::from_fn(|c| {
                std::array::from_fn(|d| directions[d] * if c == d { lambda + 2.0 * g } else { g })
            }),
            skew: across.map(|scale| -(lambda + g) * scale),
            edge: across.map(|scale| (lambda - g) * scale),
            share: (lambda - g) / (lambda + g),
            corner: across.map(|scale| 4.0 * lambda * g / (lambda + g) * scale),
            powers: [1.0, 2.0, 4.0],
        }
    }

    /// The block.
    pub fn mesh(&self) -> &BlockMesh {
        &self.mesh
    }

    /// Its material.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// K of one element.
    pub fn element(&self) -> ElementStiffness {
        hexahedron::stiffness(&self.material, self.mesh.element_size_m())
    }
}
