//! The displacements that the constraints allow, and what acts on them.
//!
//! Up to eight vectors are treated together, one in each lane of a [`Field`]. All vectors have three components per node of the
//! pin. The constraints are a projection: fixed components are zero, the members of a tie have their mean. The mass, the spring
//! and the damper of a holder are spread evenly over its members, which move alike.

use crate::solver::Model;
use crate::solver::body::Freedom;
use crate::solver::body::hexahedron;
use crate::solver::body::pin::BlockMesh;
use crate::solver::body::pin::operator::Scratch;
use crate::solver::field::{Field, Layout};
use crate::solver::support::{Held, Support};

/// Number of vectors that are treated together.
pub const LANES: usize = 8;

/// Eight vectors.
pub type Vectors = Field<LANES>;

/// A slave node in steady sliding.
#[derive(Debug, Clone, Copy)]
pub struct SlidingNode {
    /// Index in the pin's mesh.
    pub node: usize,
    /// Direction of the disk's velocity.
    pub forward: [f64; 2],
    /// Disk speed per unit of the drive's rate.
    pub speed_per_rate: f64,
    /// Tributary area \[m²\].
    pub area_m2: f64,
    /// Diagonal entry of K in z \[N/m\], with which a lifted node is preconditioned.
    pub stiffness_n_m: f64,
}

/// The mesh of the pin, which [`Structure::new`](super::Structure::new) has found to be a block.
///
/// # Panics
/// If it is not.
pub fn block_of(model: &Model) -> &BlockMesh {
    model.mesh().block().expect("the pin is a block")
}

/// The part of the constraints that does not depend on the contact.
#[derive(Debug)]
pub struct Space {
    layout: Layout,
    /// Mass \[kg\] of every component of every node.
    masses_kg: Vec<f64>,
    /// Stiffness \[N/m\] to the frame of the components that holders hold.
    springs: Vec<(usize, f64)>,
    fixed: Vec<usize>,
    ties: Vec<(usize, Vec<usize>)>,
    sliding: Vec<SlidingNode>,
}

/// The contact as constraints of small vibrations.
#[derive(Debug, Clone, Copy)]
pub struct Contact<'a> {
    /// Whether each slave node is in contact, which holds it in z.
    pub in_contact: &'a [bool],
    /// Whether nodes in contact cannot slip sideways.
    pub is_locked_sideways: bool,
}

impl Space {
    pub fn new(model: &Model) -> Self {
        let pin = model.pin();
        let freedoms = pin.freedoms();
        let ties = model.supports().iter().filter_map(|support| {
            let tied = support.tie()?;
            Some((tied.component, tied.nodes.clone()))
        });
        let size_m = block_of(model).element_size_m();
        let element = hexahedron::stiffness(pin.material(), size_m);
        let [hx, hy, _] = size_m;
        let sliding = model.slaves().iter().map(|slave| {
            let [x, y] = slave.surface_motion;
            let speed = libm::hypot(x, y);
            SlidingNode {
                node: slave.node,
                forward: [x / speed, y / speed],
                speed_per_rate: speed,
                area_m2: slave.area_m2,
                stiffness_n_m: element[(2, 2)] * slave.area_m2 / (hx * hy / 4.0),
            }
        });
        let mut masses_kg: Vec<f64> = pin.masses_kg().iter().flat_map(|mass| [*mass; 3]).collect();
        let mut springs = Vec::new();
        for held in holders(model) {
            let share = 1.0 / held.tied.nodes.len() as f64;
            for dof in held.tied.dofs() {
                masses_kg[dof] += share * held.mass_kg;
                springs.push((dof, share * held.stiffness_n_m));
            }
        }
        Self {
            layout: pin.mesh().layout(),
            masses_kg,
            springs,
            fixed: (0..freedoms.len()).filter(|&dof| freedoms[dof] == Freedom::Fixed).collect(),
            ties: ties.collect(),
            sliding: sliding.collect(),
        }
    }

    /// Number of components of a vector: three per node.
    pub fn len(&self) -> usize {
        self.masses_kg.len()
    }

    pub fn sliding(&self) -> &[SlidingNode] {
        &self.sliding
    }

    /// Speed of the disk under each slave node per unit of the drive's rate.
    pub fn speeds_per_rate(&self) -> Vec<f64> {
        self.sliding.iter().map(|slave| slave.speed_per_rate).collect()
    }

    /// Mass \[kg\] of every component of every node.
    pub fn masses_kg(&self) -> &[f64] {
        &self.masses_kg
    }

    pub fn zeros<const L: usize>(&self) -> Field<L> {
        Field::zeros(self.layout)
    }

    /// Projects displacements or forces on what the constraints allow.
    pub fn project<const L: usize>(&self, contact: Contact<'_>, field: &mut Field<L>) {
        for &dof in &self.fixed {
            *field.at_mut(field.place(dof / 3), dof % 3) = [0.0; L];
        }
        for (slave, &in_contact) in self.sliding.iter().zip(contact.in_contact) {
            if !in_contact {
                continue;
            }
            let place = field.place(slave.node);
            *field.at_mut(place, 2) = [0.0; L];
            if contact.is_locked_sideways {
                let [dx, dy] = slave.forward;
                let [x, y] = [0, 1].map(|c| *field.at(place, c));
                let along: [f64; L] = std::array::from_fn(|lane| dx * x[lane] + dy * y[lane]);
                *field.at_mut(place, 0) = along.map(|along| dx * along);
                *field.at_mut(place, 1) = along.map(|along| dy * along);
            }
        }
        for (component, nodes) in &self.ties {
            let mut mean = [0.0; L];
            for &node in nodes {
                for (mean, value) in mean.iter_mut().zip(field.at(field.place(node), *component)) {
                    *mean += value;
                }
            }
            let mean = mean.map(|sum| sum / nodes.len() as f64);
            for &node in nodes {
                *field.at_mut(field.place(node), *component) = mean;
            }
        }
    }

    /// M x.
    pub fn mass_times(&self, x: &Vectors) -> Vectors {
        let mut product = x.clone();
        for (block, masses) in product.blocks_mut().iter_mut().zip(self.masses_kg.as_chunks::<3>().0) {
            for (row, mass) in block.0.iter_mut().zip(masses) {
                for value in row {
                    *value *= mass;
                }
            }
        }
        product
    }

    /// Up to eight vectors of numbers in the order node → component. Missing ones are zero.
    pub fn gather(&self, columns: &[&[f64]]) -> Vectors {
        let mut x = self.zeros();
        for (lane, column) in columns.iter().enumerate() {
            for (block, values) in x.blocks_mut().iter_mut().zip(column.as_chunks::<3>().0) {
                for c in 0..3 {
                    block.0[c][lane] = values[c];
                }
            }
        }
        x
    }

    /// One vector of numbers in the order node → component.
    pub fn one(&self, values: &[f64]) -> Field<1> {
        Field::from_values(self.layout, values)
    }

    /// One lane as numbers in the order node → component.
    pub fn lane(x: &Vectors, lane: usize) -> Vec<f64> {
        x.blocks().iter().flat_map(|block| block.0.map(|row| row[lane])).collect()
    }
}

/// The holders of a model.
pub fn holders(model: &Model) -> impl Iterator<Item = &Held> {
    model.supports().iter().filter_map(|support| match support {
        Support::Held(held) => Some(held),
        Support::Fixed(_) | Support::Tied(_) | Support::Rocking(_) => None,
    })
}

/// The stiffness of the pin and of the springs of its holders, with its scratch memory.
pub struct Elasticity<'a, const L: usize = LANES> {
    model: &'a Model,
    space: &'a Space,
    scratch: Scratch,
}

impl<'a, const L: usize> Elasticity<'a, L> {
    pub fn new(model: &'a Model, space: &'a Space) -> Self {
        Self { model, space, scratch: model.pin().operator().scratch(model.mesh().layout(), L) }
    }

    /// The model.
    pub fn model(&self) -> &'a Model {
        self.model
    }

    /// y = K x, reactions of constraints included.
    pub fn product(&mut self, x: &Field<L>, y: &mut Field<L>) {
        self.model.pin().operator().tangent(x, y, &mut self.scratch);
        for &(dof, stiffness_n_m) in &self.space.springs {
            let place = y.place(dof / 3);
            for (force, u) in y.at_mut(place, dof % 3).iter_mut().zip(x.at(place, dof % 3)) {
                *force += stiffness_n_m * u;
            }
        }
    }
}

/// Copies `count` lanes of x from the lane `from` on to those of y from the lane `to` on.
pub fn copy_lanes(x: &Vectors, from: usize, y: &mut Vectors, to: usize, count: usize) {
    for (y, x) in y.blocks_mut().iter_mut().zip(x.blocks()) {
        for (y, x) in y.0.iter_mut().zip(&x.0) {
            y[to..to + count].copy_from_slice(&x[from..from + count]);
        }
    }
}

/// y += factor·x, with a factor for each lane.
pub fn add(y: &mut Vectors, factor: &[f64; LANES], x: &Vectors) {
    for (y, x) in y.blocks_mut().iter_mut().zip(x.blocks()) {
        for c in 0..3 {
            for lane in 0..LANES {
                y.0[c][lane] += factor[lane] * x.0[c][lane];
            }
        }
    }
}
