//! The pin: hexahedra, or point masses on their nodes that are joined by springs.
//!
//! ```text
//! mesh, materials ─► operator (forces, energy, bound of ω) ─► PinBody (immutable) ─► motion (moves the nodes, per lane)
//!                                                                             └─► audit (energies), stress
//! ```

mod audit;
mod bound;
mod history;
mod lanczos;
mod line_table;
mod mesh;
mod motion;
pub mod operator;
pub mod stress;

pub(in crate::solver) use audit::{Motion, PinAudit};
pub use history::History;
pub use mesh::{BlockMesh, GeneralMesh, Hexahedron, MeshParts, PinMesh, Tilt, cylinder};
pub(in crate::solver) use motion::{Face, NodeMotion, move_nodes};

use super::Freedom;
use super::hexahedron;
use crate::solver::error::SolverError;
use crate::solver::field::Field;
use crate::solver::material::Material;
use operator::{AssembledOperator, Operator, TensorOperator};

/// What resists the deformation of the pin.
#[derive(Debug, Clone)]
pub enum Stiffness {
    /// Linear elasticity with the materials of the pin.
    Elastic,
    /// The nodes are point masses joined by these springs. Only the density of the first material is used.
    Springs(AssembledOperator),
}

/// The immutable part of a pin.
#[derive(Debug, Clone)]
pub struct PinBody {
    mesh: PinMesh,
    materials: Vec<Material>,
    operator: Operator,
    masses_kg: Vec<f64>,
    /// How every degree of freedom may move.
    freedoms: Vec<Freedom>,
    /// Planes of nodes, from the contact face upwards, on which supports, loads or contact act.
    constrained_planes: Vec<bool>,
    omega_max_rad_s: f64,
}

impl PinBody {
    /// A pin with one entry of `freedoms` for each degree of freedom (3·node + component). Supports and loads act
    /// on the degrees of freedom `acted_on`.
    ///
    /// # Errors
    /// If an element is inverted or has no material, or if the springs do not fit the mesh.
    pub fn new(
        mesh: PinMesh,
        materials: Vec<Material>,
        stiffness: Stiffness,
        freedoms: Vec<Freedom>,
        acted_on: impl Iterator<Item = usize>,
    ) -> Result<Self, SolverError> {
        let Some(&first) = materials.first() else {
            return Err(SolverError::Mesh("the pin has no material".to_owned()));
        };
        let (operator, masses_kg) = match (stiffness, &mesh) {
            (Stiffness::Elastic, PinMesh::Block(block)) => {
                let operator = Operator::Tensor(TensorOperator::new(block, &first));
                (operator, block.lumped_masses_kg(first.density_kg_m3))
            }
            (Stiffness::Elastic, PinMesh::General(general)) => assembled(general, &materials)?,
            (Stiffness::Springs(springs), _) => {
                if springs.nodes() != mesh.node_count() {
                    return Err(SolverError::Stiffness(format!(
                        "it has {} nodes, the mesh {}",
                        springs.nodes(),
                        mesh.node_count()
                    )));
                }
                let masses_kg = match &mesh {
                    PinMesh::Block(block) => block.lumped_masses_kg(first.density_kg_m3),
                    PinMesh::General(general) => assembled(general, &materials)?.1,
                };
                (Operator::Springs(springs), masses_kg)
            }
        };
        let layout = mesh.layout();
        let omega_max_rad_s = operator.omega_max_bound(layout, &masses_kg, &freedoms);
        let mut constrained_planes = vec![false; layout.planes()];
        constrained_planes[0] = true;
        for dof in acted_on {
            constrained_planes[layout.plane_of(dof / 3)] = true;
        }
        Ok(Self { mesh, materials, operator, masses_kg, freedoms, constrained_planes, omega_max_rad_s })
    }

    /// The mesh.
    pub fn mesh(&self) -> &PinMesh {
        &self.mesh
    }

    /// The first material, which a pin of one material consists of.
    pub fn material(&self) -> &Material {
        &self.materials[0]
    }

    /// All materials.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// What resists its deformation.
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

    /// Upper bound of the largest angular frequency \[rad/s\] of the supported pin.
    pub fn omega_max_rad_s(&self) -> f64 {
        self.omega_max_rad_s
    }

    /// Stress \[Pa\] at every node, in the order of [`stress::COMPONENTS`], from displacements \[m\] in the order node → component.
    ///
    /// # Panics
    /// If there are not three displacements per node.
    pub fn nodal_stress_pa(&self, u_m: &[f64]) -> Vec<[f64; 6]> {
        stress::nodal_pa(&self.mesh, &self.materials, u_m)
    }

    /// K x of one lane (\[N\] for x in \[m\]), both in the order node → component. It serves inspection and tests;
    /// no time step uses it.
    ///
    /// # Panics
    /// If there are not three values per node.
    pub fn stiffness_times(&self, x: &[f64]) -> Vec<f64> {
        let layout = self.mesh.layout();
        let mut product = Field::<1>::zeros(layout);
        let scratch = &mut self.operator.scratch(layout, 1);
        self.operator.tangent(&Field::from_values(layout, x), &mut product, scratch);
        product.values().collect()
    }

    /// Energy \[J\] of a uniform compression by `force_n` on the contact face: F²h/(2EA).
    pub fn compression_energy_j(&self, force_n: f64) -> f64 {
        let [_, _, lz] = self.mesh.size_m();
        force_n.powi(2) * lz / (2.0 * self.material().young_modulus_pa * self.mesh.top_area_m2())
    }

    /// Time \[s\] that a pressure wave takes from the contact face to the top.
    pub fn pressure_transit_s(&self) -> f64 {
        self.mesh.size_m()[2] / self.material().pressure_wave_speed_m_s()
    }

    /// Time \[s\] that a shear wave takes from the contact face to the top.
    pub fn shear_transit_s(&self) -> f64 {
        self.mesh.size_m()[2] / self.material().shear_wave_speed_m_s()
    }

    pub(super) fn constrained_planes(&self) -> &[bool] {
        &self.constrained_planes
    }
}

/// K and the lumped masses \[kg\] of a general mesh.
fn assembled(mesh: &GeneralMesh, materials: &[Material]) -> Result<(Operator, Vec<f64>), SolverError> {
    let mut masses_kg = vec![0.0; mesh.node_count()];
    let mut elements = Vec::with_capacity(mesh.elements().len());
    for (index, element) in mesh.elements().iter().enumerate() {
        let number = mesh.name(index);
        let material = materials
            .get(element.material)
            .ok_or_else(|| SolverError::Mesh(format!("element {number} has no material")))?;
        let (stiffness, volumes) =
            hexahedron::isoparametric(material, &mesh.corners_m(element), mesh.element)
                .ok_or_else(|| SolverError::Mesh(format!("element {number} is inverted")))?;
        for (&node, volume) in element.nodes.iter().zip(volumes) {
            masses_kg[node] += material.density_kg_m3 * volume;
        }
        elements.push((element.nodes, stiffness));
    }
    Ok((Operator::Assembled(AssembledOperator::of_elements(mesh.node_count(), elements)), masses_kg))
}
