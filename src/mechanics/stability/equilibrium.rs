//! The equilibrium of steady sliding, with the nodes that are in contact.
//!
//! All nodes in contact slip with the disk, so their friction is μN along the disk's velocity. Which nodes are in contact is
//! a complementarity problem (N ≥ 0, gap ≥ 0, one of them zero) and is solved with an active set. On a flat base the problem is
//! homogeneous in the load. On a rigid disk it depends on the speed only through the friction coefficient.

use super::error::StabilityError;
use super::friction::SlidingFriction;
use super::separable::Separable;
use super::solve::Bilateral;
use super::space::{Contact, Elasticity, Space};
use crate::solver::Model;
use crate::solver::field::{Field, LaneSlot};

/// Largest number of changes of the nodes in contact.
const MOST_CHANGES: usize = 60;
/// Largest number of iterations of a linear solve.
const MOST_ITERATIONS: usize = 120;
/// Residual of a linear solve, relative to the load.
const TOLERANCE: f64 = 1e-11;
/// Residual while the nodes in contact still change.
const SEARCH_TOLERANCE: f64 = 1e-5;

/// The equilibrium over the load. On a flat base it is the same under any load.
#[derive(Debug, Clone)]
pub struct UnitEquilibrium {
    /// Displacements over the load \[m/N\], three per node.
    pub u: Vec<f64>,
    /// Normal contact force over the load of each slave node.
    pub normal: Vec<f64>,
    /// Whether each slave node is in contact.
    pub in_contact: Vec<bool>,
}

impl UnitEquilibrium {
    /// The equilibrium under a load, which matters only for a base that is not flat.
    pub fn new(
        model: &Model,
        space: &Space,
        separable: &Separable,
        friction: &SlidingFriction,
        force_n: f64,
    ) -> Result<Self, StabilityError> {
        let gaps: Vec<f64> = model.slaves().iter().map(|slave| slave.initial_gap_m / force_n).collect();
        let has_gaps = gaps.iter().any(|gap| *gap != 0.0);
        let slaves = space.sliding();
        let mut load = vec![0.0; space.len()];
        for share in model.load() {
            load[share.dof] += share.share;
        }
        let mut in_contact = vec![true; slaves.len()];
        let mut u: Field<1> = space.zeros();
        let mut tolerance = SEARCH_TOLERANCE;
        for _ in 0..MOST_CHANGES {
            let contact = Contact { in_contact: &in_contact, is_locked_sideways: false };
            let mut problem = Sliding {
                bilateral: Bilateral { space, separable, contact },
                elasticity: Elasticity::new(model, space),
                friction,
            };
            space.project(contact, &mut u);
            let mut force = space.one(&load);
            space.project(contact, &mut force);
            if has_gaps {
                // The nodes in contact have moved down by their gaps. The rest of the displacement satisfies the constraints.
                let mut closed: Field<1> = space.zeros();
                for (i, slave) in slaves.iter().enumerate().filter(|(i, _)| in_contact[*i]) {
                    closed.at_mut(closed.place(slave.node), 2)[0] = -gaps[i];
                }
                add(&mut force, -1.0, &problem.apply(&closed));
                problem.solve(&force, &mut u, tolerance)?;
                add(&mut u, 1.0, &closed);
            } else {
                problem.solve(&force, &mut u, tolerance)?;
            }
            let mut product = space.zeros();
            problem.elasticity.product(&u, &mut product);
            let of = |field: &Field<1>, node: usize| field.at(field.place(node), 2)[0];
            let normal: Vec<f64> = slaves.iter().map(|slave| of(&product, slave.node)).collect();
            let next: Vec<bool> = (0..slaves.len())
                .map(
                    |i| if in_contact[i] { normal[i] >= 0.0 } else { gaps[i] + of(&u, slaves[i].node) < 0.0 },
                )
                .collect();
            if next != in_contact {
                in_contact = next;
            } else if tolerance > TOLERANCE {
                tolerance = TOLERANCE;
            } else {
                let normal = (0..slaves.len()).map(|i| if in_contact[i] { normal[i] } else { 0.0 }).collect();
                return Ok(Self { u: u.values().collect(), normal, in_contact });
            }
        }
        Err(StabilityError::NoEquilibrium { mu: friction.mu })
    }

    /// Macroscopic friction coefficient: friction in y over the normal force.
    pub fn mu_star(&self, space: &Space, friction: &SlidingFriction) -> f64 {
        let nodes = self.normal.iter().zip(&friction.share).zip(space.sliding());
        let along_y: f64 = nodes.map(|((normal, share), slave)| normal * share * slave.forward[1]).sum();
        friction.mu * along_y / self.normal.iter().sum::<f64>()
    }
}

/// K u − μ N d with the nodes in contact.
struct Sliding<'a> {
    bilateral: Bilateral<'a>,
    elasticity: Elasticity<'a, 1>,
    friction: &'a SlidingFriction,
}

impl Sliding<'_> {
    fn apply(&mut self, u: &Field<1>) -> Field<1> {
        let Bilateral { space, contact, .. } = self.bilateral;
        let mut force = space.zeros();
        self.elasticity.product(u, &mut force);
        force.clear_padding();
        for (i, (slave, &in_contact)) in space.sliding().iter().zip(contact.in_contact).enumerate() {
            if in_contact {
                let mu = self.friction.mu_of(i);
                let place: LaneSlot = force.place(slave.node);
                let [normal] = *force.at(place, 2);
                for c in 0..2 {
                    force.at_mut(place, c)[0] -= mu * slave.forward[c] * normal;
                }
            }
        }
        space.project(contact, &mut force);
        force
    }

    /// GMRES (Saad and Schultz, 1986), preconditioned from the right, from the given u.
    fn solve(&mut self, force: &Field<1>, u: &mut Field<1>, tolerance: f64) -> Result<(), StabilityError> {
        let space = self.bilateral.space;
        let scale = norm(force);
        let mut residual = force.clone();
        add(&mut residual, -1.0, &self.apply(u));
        let beta = norm(&residual);
        if beta <= tolerance * scale {
            return Ok(());
        }
        divide(&mut residual, beta);
        let mut basis = vec![residual];
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut right = vec![beta];
        while columns.len() < MOST_ITERATIONS {
            let z = self.bilateral.precondition(&basis[basis.len() - 1]);
            let mut w = self.apply(&z);
            let mut column = Vec::new();
            for v in &basis {
                let [h] = v.dot(&w);
                add(&mut w, -h, v);
                column.push(h);
            }
            let below = norm(&w);
            for (i, (cos, sin)) in rotations.iter().enumerate() {
                let (a, b) = (column[i], column[i + 1]);
                (column[i], column[i + 1]) = (cos * a + sin * b, cos * b - sin * a);
            }
            let at = column.len() - 1;
            let length = libm::hypot(column[at], below);
            let (cos, sin) = (column[at] / length, below / length);
            column[at] = length;
            rotations.push((cos, sin));
            right.push(-sin * right[at]);
            right[at] *= cos;
            columns.push(column);
            if right[at + 1].abs() <= tolerance * scale {
                break;
            }
            divide(&mut w, below);
            basis.push(w);
        }
        let count = columns.len();
        let mut y = right[..count].to_vec();
        for i in (0..count).rev() {
            for j in i + 1..count {
                y[i] -= columns[j][i] * y[j];
            }
            y[i] /= columns[i][i];
        }
        let mut sum = space.zeros();
        for (y, v) in y.iter().zip(&basis) {
            add(&mut sum, *y, v);
        }
        add(u, 1.0, &self.bilateral.precondition(&sum));
        // The residual stalls at rounding, which is larger than the tolerance on very fine meshes.
        if right[count].abs() > 1e3 * tolerance * scale {
            return Err(StabilityError::NotConverged {
                what: "the equilibrium of steady sliding",
                iterations: MOST_ITERATIONS,
            });
        }
        Ok(())
    }
}

fn norm(x: &Field<1>) -> f64 {
    x.dot(x)[0].sqrt()
}

/// y += factor·x.
fn add(y: &mut Field<1>, factor: f64, x: &Field<1>) {
    for (y, x) in y.blocks_mut().iter_mut().zip(x.blocks()) {
        for (y, x) in y.0.as_flattened_mut().iter_mut().zip(x.0.as_flattened()) {
            *y += factor * x;
        }
    }
}

fn divide(x: &mut Field<1>, divisor: f64) {
    for block in x.blocks_mut() {
        for value in block.0.as_flattened_mut() {
            *value /= divisor;
        }
    }
}
