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
use crate::solver::number::Number;
use crate::spec::{MaterialLaw, Plasticity};
use operator::{AssembledOperator, HyperelasticOperator, Operator, Past, TensorOperator};

/// What resists the deformation of the pin.
#[derive(Debug, Clone)]
pub enum Stiffness {
    /// Linear elasticity with the materials of the pin.
    Elastic,
    /// Large strains, with the materials of the pin.
    Hyperelastic {
        /// The law of the materials.
        law: MaterialLaw,
        /// When each material yields; those without stay elastic.
        plasticity: Vec<Option<Plasticity>>,
    },
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
            (Stiffness::Elastic, PinMesh::General(general)) => {
                let (stiffness, masses_kg) = assembled(general, &materials)?;
                (Operator::Assembled(stiffness), masses_kg)
            }
            (Stiffness::Hyperelastic { .. }, PinMesh::Block(_)) => {
                return Err(SolverError::Mesh("large strains need a general mesh".to_owned()));
            }
            (Stiffness::Hyperelastic { law, plasticity }, PinMesh::General(general)) => {
                let (tangent, masses_kg) = assembled(general, &materials)?;
                let elements = HyperelasticOperator::new(general, &materials, law, &plasticity)
                    .map_err(|index| inverted(general.name(index)))?;
                (Operator::Hyperelastic { elements, tangent }, masses_kg)
            }
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

    /// The name of the first element that these displacements invert; returns `None` if there is none, and for linear elements.
    pub fn inverted_element(&self, u: &Field<1>) -> Option<u64> {
        let index = self.operator.inverted_element(self.mesh.layout(), u)?;
        match &self.mesh {
            PinMesh::Block(_) => Some(index as u64),
            PinMesh::General(mesh) => Some(mesh.name(index)),
        }
    }

    /// The largest angular frequency \[rad/s\] with these displacements, at most 2.5 % too low and never too high; returns `None` if the
    /// displacements do not change it.
    pub fn deformed_omega_max_rad_s(&self, u: &Field<1>, history: &History<1, f64>) -> Option<f64> {
        let layout = self.mesh.layout();
        self.operator.deformed_omega_max(layout, &self.masses_kg, &self.freedoms, u, history.numbers())
    }

    /// Upper bound of the largest angular frequency \[rad/s\] of the supported pin.
    pub fn omega_max_rad_s(&self) -> f64 {
        self.omega_max_rad_s
    }

    /// Stress \[Pa\] at every node, in the order of [`stress::COMPONENTS`], from displacements \[m\] in the order node → component.
    ///
    /// # Panics
    /// If there are not three displacements per node.
    pub fn nodal_stress_pa(&self, u_m: &[f64], history: &History<1, f64>) -> Vec<[f64; 6]> {
        let yielding = self.operator.yielding().map(|yielding| (yielding, history.numbers()));
        stress::nodal_pa(&self.mesh, &self.materials, self.operator.law(), yielding, u_m)
    }

    /// Plastic strain at every node; returns `None` if no material yields.
    pub fn nodal_plastic_strain(&self, history: &History<1, f64>) -> Option<Vec<f64>> {
        let (yielding, PinMesh::General(mesh)) = (self.operator.yielding()?, &self.mesh) else { return None };
        let of_element =
            |element: usize| yielding.points(history.numbers(), element).map(|point| [point.strain]);
        Some(stress::nodal_means(mesh, of_element).into_iter().map(|[strain]| strain).collect())
    }

    /// What the elements of an undeformed pin keep of their past.
    pub fn new_history<const L: usize, R: Number>(&self) -> History<L, R> {
        History::new(&self.operator)
    }

    /// The internal forces \[N\] of displacements \[m\] in the order node → component at the end of a time step, which the history follows.
    /// It serves tests.
    ///
    /// # Panics
    /// If there are not three values per node.
    pub fn followed_n(&self, u_m: &[f64], history: &mut History<1, f64>, time_step_s: f64) -> Vec<f64> {
        self.internal_of_n(u_m, Past::Followed { history: history.numbers_mut(), time_step_s })
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

    /// The internal forces \[N\] of displacements \[m\], both in the order node → component. It serves inspection and tests.
    ///
    /// # Panics
    /// If there are not three values per node.
    pub fn internal_n(&self, u_m: &[f64]) -> Vec<f64> {
        self.internal_after_n(u_m, &self.new_history())
    }

    /// The same with what the elements keep of their past, for an elastic change.
    ///
    /// # Panics
    /// If there are not three values per node.
    pub fn internal_after_n(&self, u_m: &[f64], history: &History<1, f64>) -> Vec<f64> {
        self.internal_of_n(u_m, Past::Kept(history.numbers()))
    }

    fn internal_of_n(&self, u_m: &[f64], past: Past<'_, f64>) -> Vec<f64> {
        let layout = self.mesh.layout();
        let mut force = Field::<1>::zeros(layout);
        self.operator.internal_n(
            &Field::from_values(layout, u_m),
            past,
            &mut force,
            &mut self.operator.scratch(layout, 1),
        );
        force.values().collect()
    }

    /// The energy \[J\] that displacements \[m\] in the order node → component store; NaN if an element is inverted.
    ///
    /// # Panics
    /// If there are not three values per node.
    pub fn stored_j(&self, u_m: &[f64]) -> f64 {
        self.stored_after_j(u_m, &self.new_history())
    }

    /// The same with what the elements keep of their past.
    ///
    /// # Panics
    /// If there are not three values per node.
    pub fn stored_after_j(&self, u_m: &[f64], history: &History<1, f64>) -> f64 {
        let layout = self.mesh.layout();
        let u = Field::<1>::from_values(layout, u_m);
        let scratch = &mut self.operator.scratch(layout, 1);
        let [energy_j] = self.operator.stored_j(&u, history.numbers(), &mut Field::zeros(layout), scratch);
        energy_j
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
fn assembled(
    mesh: &GeneralMesh,
    materials: &[Material],
) -> Result<(AssembledOperator, Vec<f64>), SolverError> {
    let mut masses_kg = vec![0.0; mesh.node_count()];
    let mut elements = Vec::with_capacity(mesh.elements().len());
    for (index, element) in mesh.elements().iter().enumerate() {
        let number = mesh.name(index);
        let material = materials
            .get(element.material)
            .ok_or_else(|| SolverError::Mesh(format!("element {number} has no material")))?;
        let (stiffness, volumes) =
            hexahedron::isoparametric(material, &mesh.corners_m(element), mesh.element)
                .ok_or_else(|| inverted(number))?;
        for (&node, volume) in element.nodes.iter().zip(volumes) {
            masses_kg[node] += material.density_kg_m3 * volume;
        }
        elements.push((element.nodes, stiffness));
    }
    Ok((AssembledOperator::of_elements(mesh.node_count(), elements), masses_kg))
}

fn inverted(element: u64) -> SolverError {
    SolverError::Mesh(format!("element {element} is inverted"))
}
