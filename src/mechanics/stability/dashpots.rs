//! Dampers besides those of the material and of sideways slip: those of holders, and friction that depends on the slip speed.

use super::basis::Basis;
use super::pencil::Sampling;
use super::space::Vectors;
use faer::{Mat, c64};

/// Dampers that take their velocities at the same moment of a step.
#[derive(Debug, Clone)]
pub struct Dashpots {
    pub sampling: Sampling,
    pub all: Vec<Dashpot>,
}

/// A damper: a force of the size −c (w·q̇) in the direction w.
#[derive(Debug, Clone)]
pub struct Dashpot {
    /// c \[N s/m\]. It may be negative.
    pub coefficient_n_s_m: f64,
    /// The components of w that are not zero, by 3·node + component.
    pub direction: Vec<(usize, f64)>,
}

impl Dashpot {
    /// w·x.
    fn of(&self, x: impl Fn(usize) -> f64) -> f64 {
        self.direction.iter().map(|(dof, weight)| weight * x(*dof)).sum()
    }
}

impl Dashpots {
    /// Σ c w wᵀ in the basis with `added` vectors.
    pub fn in_basis(&self, basis: &Basis, added: &[Vec<f64>]) -> Mat<f64> {
        let (count, r) = (self.all.len(), basis.len());
        let velocity = |i: usize, j: usize| match j.checked_sub(r) {
            None => self.all[i].of(|dof| basis.vectors[(dof, j)]),
            Some(own) => self.all[i].of(|dof| added[own][dof]),
        };
        let rows = Mat::from_fn(count, r + added.len(), velocity);
        let weighted =
            Mat::from_fn(count, r + added.len(), |i, j| self.all[i].coefficient_n_s_m * rows[(i, j)]);
        weighted.transpose() * &rows
    }

    /// w·x of every damper.
    pub fn velocities(&self, x: &[f64]) -> Vec<f64> {
        self.all.iter().map(|dashpot| dashpot.of(|dof| x[dof])).collect()
    }

    /// w·x of every damper for a vector of the basis.
    pub fn velocities_of_basis(&self, basis: &Basis, vector: usize) -> Vec<f64> {
        self.all.iter().map(|dashpot| dashpot.of(|dof| basis.vectors[(dof, vector)])).collect()
    }

    /// Σ c (w·a)(w·b) from w·a and w·b.
    pub fn form(&self, a: &[f64], b: &[f64]) -> f64 {
        self.all.iter().zip(a.iter().zip(b)).map(|(dashpot, (a, b))| dashpot.coefficient_n_s_m * a * b).sum()
    }

    /// Adds λ Σ c w (w·q) to forces, with complex vectors in pairs of lanes.
    pub fn add_forces(&self, values: &[c64], q: &Vectors, force: &mut Vectors) {
        for dashpot in &self.all {
            for (pair, value) in values.iter().enumerate() {
                let part = |lane: usize| dashpot.of(|dof| q.blocks()[dof / 3].0[dof % 3][lane]);
                let velocity = *value * c64::new(part(2 * pair), part(2 * pair + 1));
                let force_n = velocity * dashpot.coefficient_n_s_m;
                for &(dof, weight) in &dashpot.direction {
                    let row = &mut force.blocks_mut()[dof / 3].0[dof % 3];
                    row[2 * pair] += weight * force_n.re;
                    row[2 * pair + 1] += weight * force_n.im;
                }
            }
        }
    }
}
