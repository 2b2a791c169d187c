//! The equilibrium of steady sliding, with the nodes that are in contact.
//!
//! All nodes in contact slip with the disk, so their friction is μN along the disk's velocity. Which nodes are in contact is
//! a complementarity problem (N ≥ 0, gap ≥ 0, one of them zero) and is solved with an active set. The problem is
//! homogeneous in the load, and on a rigid disk it does not depend on the speed.

use super::error::StabilityError;
use super::separable::Separable;
use super::solve::Bilateral;
use super::space::{Contact, Elasticity, Space, Vectors};
use crate::solver::Model;

/// Largest number of changes of the nodes in contact.
const MOST_CHANGES: usize = 60;
/// Largest number of iterations of a linear solve.
const MOST_ITERATIONS: usize = 120;
/// Residual of a linear solve, relative to the load.
const TOLERANCE: f64 = 1e-11;

/// The equilibrium under a load of 1 N.
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
    pub fn new(model: &Model, space: &Space, separable: &Separable, mu: f64) -> Result<Self, StabilityError> {
        let slaves = space.sliding();
        let mut load = vec![0.0; space.len()];
        for share in model.load() {
            load[share.dof] += share.share;
        }
        let mut in_contact = vec![true; slaves.len()];
        let mut u = space.zeros();
        for _ in 0..MOST_CHANGES {
            let contact = Contact { in_contact: &in_contact, is_locked_sideways: false };
            let mut problem = Sliding {
                bilateral: Bilateral { space, separable, contact },
                elasticity: Elasticity::new(model),
                mu,
            };
            space.project(contact, &mut u);
            let mut force = space.gather(&[&load]);
            space.project(contact, &mut force);
            problem.solve(&force, &mut u)?;
            let mut product = space.zeros();
            problem.elasticity.product(&u, &mut product);
            let of = |vectors: &Vectors, node: usize| vectors.blocks()[node].0[2][0];
            let normal: Vec<f64> = slaves.iter().map(|slave| of(&product, slave.node)).collect();
            let next: Vec<bool> = (0..slaves.len())
                .map(|i| if in_contact[i] { normal[i] >= 0.0 } else { of(&u, slaves[i].node) < 0.0 })
                .collect();
            if next == in_contact {
                let normal = (0..slaves.len()).map(|i| if in_contact[i] { normal[i] } else { 0.0 }).collect();
                return Ok(Self { u: Space::lane(&u, 0), normal, in_contact });
            }
            in_contact = next;
        }
        Err(StabilityError::NoEquilibrium { mu })
    }

    /// Macroscopic friction coefficient: friction in y over the normal force.
    pub fn mu_star(&self, space: &Space, mu: f64) -> f64 {
        let along_y: f64 =
            self.normal.iter().zip(space.sliding()).map(|(normal, slave)| normal * slave.forward[1]).sum();
        mu * along_y / self.normal.iter().sum::<f64>()
    }
}

/// K u − μ N d with the nodes in contact.
struct Sliding<'a> {
    bilateral: Bilateral<'a>,
    elasticity: Elasticity<'a>,
    mu: f64,
}

impl Sliding<'_> {
    fn apply(&mut self, u: &Vectors) -> Vectors {
        let Bilateral { space, contact, .. } = self.bilateral;
        let mut force = space.zeros();
        self.elasticity.product(u, &mut force);
        for (slave, &in_contact) in space.sliding().iter().zip(contact.in_contact) {
            if in_contact {
                let block = &mut force.blocks_mut()[slave.node].0;
                for c in 0..2 {
                    block[c][0] -= self.mu * slave.forward[c] * block[2][0];
                }
            }
        }
        space.project(contact, &mut force);
        force
    }

    /// GMRES (Saad and Schultz, 1986), preconditioned from the right, from the given u.
    fn solve(&mut self, force: &Vectors, u: &mut Vectors) -> Result<(), StabilityError> {
        let space = self.bilateral.space;
        let scale = norm(&Space::lane(force, 0));
        let product = Space::lane(&self.apply(u), 0);
        let residual: Vec<f64> = Space::lane(force, 0).iter().zip(&product).map(|(f, p)| f - p).collect();
        let beta = norm(&residual);
        if beta <= TOLERANCE * scale {
            return Ok(());
        }
        let mut basis = vec![residual.iter().map(|r| r / beta).collect::<Vec<f64>>()];
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut rotations: Vec<(f64, f64)> = Vec::new();
        let mut right = vec![beta];
        while columns.len() < MOST_ITERATIONS {
            let last = &basis[basis.len() - 1];
            let z = self.bilateral.precondition(&space.gather(&[last]));
            let mut w = Space::lane(&self.apply(&z), 0);
            let mut column = Vec::new();
            for v in &basis {
                let h: f64 = v.iter().zip(&w).map(|(a, b)| a * b).sum();
                for (w, v) in w.iter_mut().zip(v) {
                    *w -= h * v;
                }
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
            if right[at + 1].abs() <= TOLERANCE * scale {
                break;
            }
            basis.push(w.iter().map(|w| w / below).collect());
        }
        let count = columns.len();
        let mut y = right[..count].to_vec();
        for i in (0..count).rev() {
            for j in i + 1..count {
                y[i] -= columns[j][i] * y[j];
            }
            y[i] /= columns[i][i];
        }
        let mut sum = vec![0.0; space.len()];
        for (y, v) in y.iter().zip(&basis) {
            for (sum, v) in sum.iter_mut().zip(v) {
                *sum += y * v;
            }
        }
        let step = self.bilateral.precondition(&space.gather(&[&sum]));
        super::space::add(u, &[1.0; super::space::LANES], &step);
        // The residual stalls at rounding, which is larger than the tolerance on very fine meshes.
        if right[count].abs() > 1e3 * TOLERANCE * scale {
            return Err(StabilityError::NotConverged {
                what: "the equilibrium of steady sliding",
                iterations: MOST_ITERATIONS,
            });
        }
        Ok(())
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
