//! Conjugate gradients for K x = b on the space of the constraints.

use super::separable::Separable;
use super::space::{Contact, Elasticity, LANES, Space, Vectors, add};
use crate::solver::field::Field;

/// The pin with the nodes in contact held in z.
pub struct Bilateral<'a> {
    pub space: &'a Space,
    pub separable: &'a Separable,
    pub contact: Contact<'a>,
}

impl Bilateral<'_> {
    /// Improves x by `iterations` steps towards K x = b, in all lanes. b and x satisfy the constraints.
    pub fn solve(&self, elasticity: &mut Elasticity<'_>, b: &Vectors, x: &mut Vectors, iterations: usize) {
        let mut product = self.space.zeros();
        elasticity.product(x, &mut product);
        let mut residual = b.clone();
        add(&mut residual, &[-1.0; LANES], &product);
        self.space.project(self.contact, &mut residual);
        let mut z = self.precondition(&residual);
        let mut direction = z.clone();
        let mut weight = residual.dot(&z);
        for _ in 0..iterations {
            elasticity.product(&direction, &mut product);
            self.space.project(self.contact, &mut product);
            let curvature = direction.dot(&product);
            let step = ratio(&weight, &curvature);
            add(x, &step, &direction);
            add(&mut residual, &step.map(|step| -step), &product);
            z = self.precondition(&residual);
            let next = residual.dot(&z);
            let growth = ratio(&next, &weight);
            for (direction, z) in direction.blocks_mut().iter_mut().zip(z.blocks()) {
                for c in 0..3 {
                    for lane in 0..LANES {
                        direction.0[c][lane] = z.0[c][lane] + growth[lane] * direction.0[c][lane];
                    }
                }
            }
            weight = next;
        }
    }

    /// The preconditioner on the space of the constraints.
    pub fn precondition<const L: usize>(&self, residual: &Field<L>) -> Field<L> {
        let mut z = self.space.zeros();
        self.separable.solve(residual, &mut z);
        // The separable operator holds all slave nodes in z.
        for (slave, &in_contact) in self.space.sliding().iter().zip(self.contact.in_contact) {
            if !in_contact {
                let place = z.place(slave.node);
                *z.at_mut(place, 2) = residual.at(place, 2).map(|force| force / slave.stiffness_n_m);
            }
        }
        self.space.project(self.contact, &mut z);
        z
    }
}

/// a/b in each lane; 0 for an empty lane.
fn ratio(a: &[f64; LANES], b: &[f64; LANES]) -> [f64; LANES] {
    std::array::from_fn(|lane| if b[lane] > 0.0 { a[lane] / b[lane] } else { 0.0 })
}
