//! Point masses on springs above the moving plane: the discrete systems of the friction cases.
//!
//! A system is a block mesh of which only some degrees of freedom are released. All others are fixed. The
//! nodes carry lumped masses (ρV/8 at a corner of one element), and springs join the released ones. A node of
//! the contact face whose z is released is a contact node.

use std::collections::BTreeSet;
use tribosweep_mechanics::solver::body::pin::BlockMesh;
use tribosweep_mechanics::solver::body::pin::Stiffness;
use tribosweep_mechanics::solver::body::pin::operator::AssembledOperator;
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::target;
use tribosweep_mechanics::solver::interface::target::TargetDefinition;
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::support::Support;
use tribosweep_mechanics::solver::support::load::LoadShare;
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, State, TimeStep, step};

/// Components of a node.
pub const X: usize = 0;
pub const Y: usize = 1;
pub const Z: usize = 2;

/// A system under construction.
pub struct Particles {
    mesh: BlockMesh,
    density_kg_m3: f64,
    released: BTreeSet<usize>,
    entries: Vec<(usize, usize, f64)>,
    load: Vec<LoadShare>,
}

impl Particles {
    /// A system without released degrees of freedom and without springs.
    pub fn new(mesh: BlockMesh, density_kg_m3: f64) -> Self {
        Self { mesh, density_kg_m3, released: BTreeSet::new(), entries: Vec::new(), load: Vec::new() }
    }

    /// Eight nodes of `mass_kg` each: the corners of one element. Node 0 is on the contact face, node 4
    /// above it.
    pub fn corners(mass_kg: f64) -> Self {
        Self::new(BlockMesh::new([2.0, 2.0, 2.0], [1, 1, 1]), mass_kg)
    }

    /// Lets a component of a node move.
    pub fn release(&mut self, node: usize, component: usize) -> &mut Self {
        self.released.insert(3 * node + component);
        self
    }

    /// A linear spring between two nodes that resists the difference of their displacements along
    /// `direction` (a unit vector).
    pub fn spring(&mut self, from: usize, to: usize, direction: [f64; 3], stiffness_n_m: f64) -> &mut Self {
        for (a, b, sign) in [(from, from, 1.0), (from, to, -1.0), (to, from, -1.0), (to, to, 1.0)] {
            for r in 0..3 {
                for c in 0..3 {
                    let value = sign * stiffness_n_m * direction[r] * direction[c];
                    if value != 0.0 {
                        self.entries.push((3 * a + r, 3 * b + c, value));
                    }
                }
            }
        }
        self
    }

    /// A dead load of `share` times the drive's force on a component of a node.
    pub fn load(&mut self, node: usize, component: usize, share: f64) -> &mut Self {
        self.load.push(LoadShare { dof: 3 * node + component, share });
        self
    }

    /// The model, with the central difference.
    pub fn model(&self, beta_r_s: f64, time_step: TimeStep) -> Model {
        Model::new(self.definition(beta_r_s, time_step)).unwrap()
    }

    /// The definition of the model, with the central difference.
    pub fn definition(&self, beta_r_s: f64, time_step: TimeStep) -> ModelDefinition {
        let dofs = 3 * self.mesh.node_count();
        let springs = AssembledOperator::from_entries(dofs / 3, self.entries.iter().copied()).unwrap();
        let fixed = (0..dofs).filter(|dof| !self.released.contains(dof));
        ModelDefinition {
            target: TargetDefinition::Rigid(target::straight_plane(&self.mesh.clone().into())),
            mesh: self.mesh.clone().into(),
            materials: vec![Material {
                young_modulus_pa: 1.0,
                poisson_ratio: 0.0,
                density_kg_m3: self.density_kg_m3,
            }],
            stiffness: Stiffness::Springs(springs),
            supports: vec![Support::fixed(fixed)],
            load: self.load.clone(),
            beta2: 0.5,
            beta_r_s,
            alpha_r_per_s: 0.0,
            time_step,
        }
    }
}

/// Does one step and balances its energies.
#[expect(clippy::large_types_passed_by_value, reason = "a test makes one, whose size does not matter")]
pub fn audited_step(model: &Model, drive: Drive, state: &mut State<1>, ledger: &mut EnergyLedger<1>) {
    ledger.before_step(model, state);
    step(model, &[drive], state);
    ledger.after_step(model, &[drive], state);
}
