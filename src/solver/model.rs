//! The immutable part of a run, shared by all lanes: mesh, operator, masses, constraints, target.

use super::boundary::{self, LoadShare};
use super::constraints::{Constraints, Freedom};
use super::disk::body::Unclocked;
use super::disk::{self, DiskBody, DiskDefinition, SurfaceMotion};
use super::element;
use super::error::SolverError;
use super::field::Field;
use super::material::Material;
use super::mesh::BlockMesh;
use super::operator::{AssembledOperator, Operator, Scratch, TensorOperator};
use super::stability;
use crate::spec::{DiskKind, Numerics, Scene};

/// How the time step is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeStep {
    /// A fraction of the stability limit.
    FractionOfLimit(f64),
    /// A step [s], refused when it is above the limit.
    Given(f64),
    /// A step [s] that is taken without a check, to study what happens above the limit.
    Unchecked(f64),
}

/// What resists the deformation.
#[derive(Debug, Clone)]
pub enum Stiffness {
    /// The block is elastic, of the model's material.
    Elastic,
    /// Its nodes are point masses joined by these springs; of the material only the density is used.
    Springs(AssembledOperator),
}

/// What a model is made of.
#[derive(Debug, Clone)]
pub struct ModelDefinition {
    /// The block's mesh.
    pub mesh: BlockMesh,
    /// Its material.
    pub material: Material,
    /// What resists its deformation.
    pub stiffness: Stiffness,
    /// What holds it.
    pub constraints: Constraints,
    /// Nodal forces per unit of the total load.
    pub load: Vec<LoadShare>,
    /// Velocity of the target under each contact-face node per unit of the drive's rate.
    pub surface_motion: SurfaceMotion,
    /// β₂ of the scheme.
    pub beta2: f64,
    /// Stiffness-proportional damping `β_R` [s].
    pub beta_r_s: f64,
    /// The time step.
    pub time_step: TimeStep,
}

/// A node of the contact face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlaveNode {
    /// Its index in the mesh.
    pub node: usize,
    /// Lumped mass [kg].
    pub mass_kg: f64,
    /// Tributary area [m²].
    pub area_m2: f64,
    /// Velocity of the target under it per unit of the drive's rate, x and y.
    pub surface_motion: [f64; 2],
    /// Which components are not fixed.
    pub mobile: [bool; 3],
}

/// Degrees of freedom that move as one.
#[derive(Debug, Clone)]
pub(super) struct TiedGroup {
    pub dofs: Vec<usize>,
    pub inverse_mass: f64,
}

/// The immutable part of a run.
#[derive(Debug, Clone)]
pub struct Model {
    mesh: BlockMesh,
    material: Material,
    operator: Operator,
    masses_kg: Vec<f64>,
    /// 1/m per degree of freedom, 0 where fixed.
    inverse_mass: Vec<f64>,
    fixed: Vec<usize>,
    ties: Vec<TiedGroup>,
    load: Vec<LoadShare>,
    slaves: Vec<SlaveNode>,
    /// Planes of nodes, from the contact face upwards, with more to do than to follow their forces.
    constrained_planes: Vec<bool>,
    beta2: f64,
    beta_r_s: f64,
    time_step_s: f64,
    time_step_limit_s: f64,
    clamp_width_m: f64,
    disk: Option<Box<DiskBody>>,
}

impl Model {
    /// The model of a scene.
    ///
    /// # Errors
    /// If the mesh has no node row near the clamp's width, or the time step is above the limit.
    pub fn from_scene(scene: &Scene, numerics: &Numerics) -> Result<Self, SolverError> {
        let mesh = BlockMesh::new(scene.pin.size_m, scene.pin.elements);
        let strip = boundary::clamped_strip(&mesh, &scene.clamp)?;
        let definition = ModelDefinition {
            material: Material::of_pin(&scene.pin),
            stiffness: Stiffness::Elastic,
            constraints: boundary::constraints(&mesh, &strip, scene.top),
            load: boundary::normal_load(&mesh),
            surface_motion: disk::rotating_disk(&mesh, scene.disk.track_radius_m),
            beta2: numerics.beta2,
            beta_r_s: numerics.beta_r_s,
            time_step: numerics
                .time_step_s
                .map_or(TimeStep::FractionOfLimit(numerics.safety_factor), TimeStep::Given),
            mesh,
        };
        let model = match scene.disk.kind {
            DiskKind::Rigid => Self::new(definition)?,
            DiskKind::Elastic => Self::on_elastic_disk(definition, DiskDefinition::of_scene(scene))?,
        };
        Ok(Self { clamp_width_m: strip.width_m, ..model })
    }

    /// Whether [`Model::from_scene`] would accept the scene; cheap unless a time step is given.
    ///
    /// # Errors
    /// As [`Model::from_scene`].
    pub fn preflight(scene: &Scene, numerics: &Numerics) -> Result<(), SolverError> {
        let mesh = BlockMesh::new(scene.pin.size_m, scene.pin.elements);
        boundary::clamped_strip(&mesh, &scene.clamp)?;
        if numerics.time_step_s.is_some() {
            Self::from_scene(scene, numerics)?;
        }
        Ok(())
    }

    /// A model from its parts on an elastic disk, which the pin's surface motion says to be a rotating one.
    ///
    /// # Errors
    /// As [`Model::new`], and if a node of the contact face is held or tied, or β₂ is not ½: these are solved on a
    /// rigid target only.
    ///
    /// # Panics
    /// As [`Model::new`].
    pub fn on_elastic_disk(definition: ModelDefinition, disk: DiskDefinition) -> Result<Self, SolverError> {
        let on_face = |node: &usize| definition.mesh.bottom_nodes().contains(node);
        let tied = definition.constraints.ties.iter().flat_map(|tie| tie.nodes.iter());
        if tied
            .chain(definition.constraints.fixed.iter().map(|dof| dof / 3).collect::<Vec<_>>().iter())
            .any(on_face)
        {
            return Err(SolverError::Constraints(
                "on an elastic disk no node of the contact face may be held or tied".to_owned(),
            ));
        }
        if definition.beta2 != 0.5 {
            return Err(SolverError::Constraints("an elastic disk is for β₂ = ½ only".to_owned()));
        }
        Self::build(definition, Some(Unclocked::new(disk)))
    }

    /// A model from its parts.
    ///
    /// # Errors
    /// If the constraints are inconsistent, the springs do not fit the mesh, or the time step is above the limit.
    ///
    /// # Panics
    /// If there is not one surface velocity per contact-face node.
    pub fn new(definition: ModelDefinition) -> Result<Self, SolverError> {
        Self::build(definition, None)
    }

    fn build(definition: ModelDefinition, disk: Option<Unclocked>) -> Result<Self, SolverError> {
        let ModelDefinition {
            mesh,
            material,
            stiffness,
            constraints,
            load,
            surface_motion,
            beta2,
            beta_r_s,
            time_step,
        } = definition;
        let freedoms = constraints.freedoms(&mesh)?;
        let masses_kg = mesh.lumped_masses_kg(material.density_kg_m3);
        let (operator, omega_max) = match stiffness {
            Stiffness::Elastic => {
                let element = element::stiffness(&material, mesh.element_size_m());
                let bound = stability::omega_max_bound(&mesh, &element, material.density_kg_m3, &freedoms);
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
                let bound = stability::omega_max_bound_of_springs(&springs, &masses_kg, &freedoms);
                (Operator::Assembled(springs), bound)
            }
        };
        let pin_limit = stability::time_step_limit_s(omega_max, beta2, beta_r_s);
        let disk_limit = disk.as_ref().map_or(f64::INFINITY, |disk| disk.longest_step_s(beta_r_s));
        let limit = pin_limit.min(disk_limit);
        let omega_max =
            disk.as_ref().filter(|_| disk_limit < pin_limit).map_or(omega_max, Unclocked::omega_max);
        let time_step_s = match time_step {
            // The disk's limit has its margin.
            TimeStep::FractionOfLimit(fraction) => (fraction * pin_limit).min(disk_limit),
            // The limit itself is a legal step; computing it rounds.
            TimeStep::Given(dt) if dt <= limit * (1.0 + 1e-12) => dt,
            TimeStep::Given(dt) => {
                return Err(SolverError::TimeStepTooLarge {
                    time_step_s: dt,
                    limit_s: limit,
                    omega_max_rad_s: omega_max,
                });
            }
            TimeStep::Unchecked(dt) => dt,
        };
        let disk = match disk {
            None => None,
            Some(disk) => Some(Box::new(disk.with_step(time_step_s, beta_r_s).ok_or(
                SolverError::TimeStepTooLarge { time_step_s, limit_s: limit, omega_max_rad_s: omega_max },
            )?)),
        };

        let inverse_mass = freedoms
            .iter()
            .enumerate()
            .map(|(dof, freedom)| if *freedom == Freedom::Fixed { 0.0 } else { 1.0 / masses_kg[dof / 3] })
            .collect();
        let ties: Vec<TiedGroup> = constraints
            .ties
            .iter()
            .map(|tie| TiedGroup {
                dofs: tie.nodes.iter().map(|node| 3 * node + tie.component).collect(),
                inverse_mass: 1.0 / tie.nodes.iter().map(|&node| masses_kg[node]).sum::<f64>(),
            })
            .collect();
        assert_eq!(surface_motion.len(), mesh.bottom_nodes().len(), "one surface velocity per slave node");
        let slaves = mesh
            .bottom_nodes()
            .zip(surface_motion)
            .map(|(node, surface_motion)| SlaveNode {
                node,
                mass_kg: masses_kg[node],
                area_m2: mesh.tributary_area_m2(node),
                surface_motion,
                mobile: std::array::from_fn(|c| freedoms[3 * node + c] != Freedom::Fixed),
            })
            .collect();
        let constrained_planes =
            constrained_planes(&mesh, &constraints, &load, matches!(operator, Operator::Assembled(_)));
        Ok(Self {
            operator,
            constrained_planes,
            material,
            masses_kg,
            inverse_mass,
            fixed: constraints.fixed,
            ties,
            load,
            slaves,
            beta2,
            beta_r_s,
            time_step_s,
            time_step_limit_s: limit,
            clamp_width_m: 0.0,
            disk,
            mesh,
        })
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

    /// K x of one lane, both in the order node → component: for looking at the operator, not for stepping.
    ///
    /// # Panics
    /// If there are not three values per node.
    pub fn stiffness_times(&self, x: &[f64]) -> Vec<f64> {
        let mut product = Field::<1>::zeros(&self.mesh);
        self.operator.product(
            &Field::from_values(&self.mesh, x),
            &mut product,
            &mut Scratch::new(&self.mesh),
        );
        product.values().collect()
    }

    /// Lumped nodal masses [kg].
    pub fn masses_kg(&self) -> &[f64] {
        &self.masses_kg
    }

    /// Nodes of the contact face.
    pub fn slaves(&self) -> &[SlaveNode] {
        &self.slaves
    }

    /// Three numbers of every slave node, the same in all lanes, on the contact face.
    pub fn on_slaves<const L: usize>(&self, values: impl Fn(&SlaveNode) -> [f64; 3]) -> Field<L> {
        let mut field = Field::on_face(&self.mesh);
        for (slave, node) in self.slaves.iter().enumerate() {
            let place = field.place(slave);
            for (component, value) in values(node).into_iter().enumerate() {
                *field.at_mut(place, component) = [value; L];
            }
        }
        field
    }

    /// β₂ of the scheme.
    pub fn beta2(&self) -> f64 {
        self.beta2
    }

    /// Stiffness-proportional damping `β_R` [s].
    pub fn beta_r_s(&self) -> f64 {
        self.beta_r_s
    }

    /// The time step [s].
    pub fn time_step_s(&self) -> f64 {
        self.time_step_s
    }

    /// The stability limit [s] of the time step.
    pub fn time_step_limit_s(&self) -> f64 {
        self.time_step_limit_s
    }

    /// The clamp's width [m] that the mesh gives.
    pub fn clamp_width_m(&self) -> f64 {
        self.clamp_width_m
    }

    /// The elastic disk, if there is one.
    pub fn disk(&self) -> Option<&DiskBody> {
        self.disk.as_deref()
    }

    pub(super) fn constrained_planes(&self) -> &[bool] {
        &self.constrained_planes
    }

    pub(super) fn inverse_mass(&self) -> &[f64] {
        &self.inverse_mass
    }

    pub(super) fn fixed(&self) -> &[usize] {
        &self.fixed
    }

    pub(super) fn ties(&self) -> &[TiedGroup] {
        &self.ties
    }

    pub(super) fn load(&self) -> &[LoadShare] {
        &self.load
    }
}

/// Which planes of nodes have more to do than to follow their forces.
fn constrained_planes(
    mesh: &BlockMesh,
    constraints: &Constraints,
    load: &[LoadShare],
    assembled: bool,
) -> Vec<bool> {
    let [_, _, planes] = mesh.nodes_per_axis();
    // Springs are not advanced plane by plane.
    let mut constrained = vec![assembled; planes];
    constrained[0] = true;
    let loaded = load.iter().map(|share| share.dof);
    let tied = constraints.ties.iter().flat_map(|tie| tie.nodes.iter().map(|node| 3 * node + tie.component));
    for dof in constraints.fixed.iter().copied().chain(loaded).chain(tied) {
        constrained[mesh.grid_position(dof / 3)[2]] = true;
    }
    constrained
}
