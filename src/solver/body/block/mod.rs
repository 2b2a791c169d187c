//! The pin: a block of equal trilinear hexahedra, or point masses on its grid that are joined by springs.
//!
//! ```text
//! mesh, material ─► operator (K) ─► bound (ω_max) ─► BlockBody (immutable) ─► motion (moves the nodes, per lane)
//!                                                                     └─► audit (energies), stress
//! ```

mod audit;
mod bound;
mod line_table;
mod mesh;
mod motion;
pub mod operator;
pub mod stress;

pub(in crate::solver) use audit::{BlockAudit, Motion};
use bound::{omega_max_bound, omega_max_bound_of_springs};
pub use mesh::BlockMesh;
pub(in crate::solver) use motion::{BlockMotion, Face, move_nodes};

use super::Freedom;
use super::hexahedron;
use crate::solver::error::SolverError;
use crate::solver::field::Field;
use crate::solver::material::Material;
use operator::{AssembledOperator, Operator, Scratch, TensorOperator};

/// What resists the deformation of the block.
#[derive(Debug, Clone)]
pub enum Stiffness {
    /// Linear elasticity with the block's material.
    Elastic,
    /// The nodes are point masses joined by these springs. Only the density of the material is used.
    Springs(AssembledOperator),
}

/// The immutable part of a block.
#[derive(Debug, Clone)]
pub struct BlockBody {
    mesh: BlockMesh,
    material: Material,
    operator: Operator,
    masses_kg: Vec<f64>,
    /// How every degree of freedom may move.
    freedoms: Vec<Freedom>,
    /// Planes of nodes, from the contact face upwards, on which supports, loads or contact act.
    constrained_planes: Vec<bool>,
    omega_max_rad_s: f64,
}

impl BlockBody {
    /// A block with one entry of `freedoms` for each degree of freedom (3·node + component). Supports and loads act
    /// on the degrees of freedom `acted_on`.
    ///
    /// # Errors
    /// If the springs do not fit the mesh.
    pub fn new(
        mesh: BlockMesh,
        material: Material,
        stiffness: Stiffness,
        freedoms: Vec<Freedom>,
        acted_on: impl Iterator<Item = usize>,
    ) -> Result<Self, SolverError> {
        let masses_kg = mesh.lumped_masses_kg(material.density_kg_m3);
        let (operator, omega_max_rad_s) = match stiffness {
            Stiffness::Elastic => {
                let element = hexahedron::stiffness(&material, mesh.element_size_m());
                let bound = omega_max_bound(&mesh, &element, material.density_kg_m3, &freedoms);
                (Operator::Tensor(TensorOperator::new(&mesh, &material)), bound)
            }
            Stiffness::Springs(springs) => {
                if springs.dofs() != freedoms.len() {
                    return Err(SolverError::Stiffness(format!(
                        "it has {} degrees of freedom, the mesh {}",
                        springs.dofs(),
                        freedoms.len()
                    )));
                }
                let bound = omega_max_bound_of_springs(&springs, &masses_kg, &freedoms);
                (Operator::Assembled(springs), bound)
            }
        };
        let [_, _, planes] = mesh.nodes_per_axis();
        // The product with an assembled K is not formed plane by plane, so no plane is moved during it.
        let mut constrained_planes = vec![matches!(operator, Operator::Assembled(_)); planes];
        constrained_planes[0] = true;
        for dof in acted_on {
            constrained_planes[mesh.grid_position(dof / 3)[2]] = true;
        }
        Ok(Self { mesh, material, operator, masses_kg, freedoms, constrained_planes, omega_max_rad_s })
    }

    /// The mesh.
    pub fn mesh(&self) -> &BlockMesh {
        &self.mesh
    }

    /// The material.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// The stiffness operator.
    pub fn operator(&self) -> &Operator {
        &self.operator
    }

    /// Lumped nodal masses \[kg\].
    pub fn masses_kg(&self) -> &[f64] {
        &self.masses_kg
    }

    /// How every degree of freedom (3·node + component) may move.
    pub fn freedoms(&self) -> &[Freedom] {
        &self.freedoms
    }

    /// Upper bound of the largest angular frequency \[rad/s\] of the supported block.
    pub fn omega_max_rad_s(&self) -> f64 {
        self.omega_max_rad_s
    }

    /// K x of one lane (\[N\] for x in \[m\]), both in the order node → component. It serves inspection and tests;
    /// no time step uses it.
    ///
    /// # Panics
    /// If there are not three values per node.
    pub fn stiffness_times(&self, x: &[f64]) -> Vec<f64> {
        let layout = self.mesh.layout();
        let mut product = Field::<1>::zeros(layout);
        let scratch = &mut Scratch::new(&self.mesh, 1);
        self.operator.product(&Field::from_values(layout, x), &mut product, scratch);
        product.values().collect()
    }

    /// Energy \[J\] of a uniform compression by `force_n` on the contact face: F²h/(2EA).
    pub fn compression_energy_j(&self, force_n: f64) -> f64 {
        let [lx, ly, lz] = self.mesh.size_m();
        force_n.powi(2) * lz / (2.0 * self.material.young_modulus_pa * lx * ly)
    }

    /// Time \[s\] that a pressure wave takes from the contact face to the top.
    pub fn pressure_transit_s(&self) -> f64 {
        self.mesh.size_m()[2] / self.material.pressure_wave_speed_m_s()
    }

    /// Time \[s\] that a shear wave takes from the contact face to the top.
    pub fn shear_transit_s(&self) -> f64 {
        self.mesh.size_m()[2] / self.material.shear_wave_speed_m_s()
    }

    pub(super) fn constrained_planes(&self) -> &[bool] {
        &self.constrained_planes
    }
}
