//! The full problem of small vibrations about steady sliding, and the corrections of approximate modes.
//!
//! ```text
//! M q̈ + [β K_μ + D + C] q̇ + K_μ q = 0        K_μ = K − μ d ⊗ K_z        D = μ N₀/|v| (1 − d ⊗ d)
//! ```
//!
//! with the direction d of the disk's velocity v at each node in contact. K_z q is the change of the normal contact forces.
//! Friction follows it, so K_μ is not symmetric. D comes from the turn of the friction's direction by sideways slip. C are other
//! dampers: those of holders, and the slope of friction that depends on the slip speed.

use super::bound::{self, Coupling};
use super::dashpots::Dashpots;
use super::friction::SlidingFriction;
use super::solve::Bilateral;
use super::space::{Elasticity, LANES, Space, Vectors, add};
use crate::solver::Model;
use faer::c64;

/// Number of complex vectors in eight lanes: real and imaginary parts beside each other.
pub const PAIRS: usize = LANES / 2;

/// Small vibrations about steady sliding.
pub struct Vibration<'a> {
    pub bilateral: Bilateral<'a>,
    pub friction: &'a SlidingFriction,
    /// μN₀/|v| \[N·s/m\] of each slave node.
    pub sideways_n_s_m: &'a [f64],
    /// C.
    pub viscous: &'a [Dashpots],
    /// β \[s\].
    pub damping_s: f64,
    /// α \[1/s\].
    pub alpha_r_per_s: f64,
}

/// An approximate eigenvector in the full space, and its residual.
pub struct Residuals {
    /// P(λ) q, projected on the space of the constraints.
    pub force: Vectors,
    /// qᴴ K q \[N·m\] of each vector.
    pub energy: [f64; PAIRS],
}

impl Vibration<'_> {
    /// Residuals of right eigenvectors, or of left ones.
    pub fn residuals(
        &self,
        elasticity: &mut Elasticity<'_>,
        values: &[c64; PAIRS],
        q: &Vectors,
        is_left: bool,
    ) -> Residuals {
        let Bilateral { space, contact, .. } = self.bilateral;
        let values = if is_left { values.map(|value| value.conj()) } else { *values };
        let elastic = values.map(|value| c64::new(1.0, 0.0) + value * self.damping_s);
        let nodes = || space.sliding().iter().zip(contact.in_contact).enumerate().filter(|(_, (_, on))| **on);
        let mut moved = q.clone();
        if is_left {
            // A virtual displacement along d comes with −μ times itself in z, through friction.
            for (i, (slave, _)) in nodes() {
                let mu = self.friction.mu_of(i);
                let block = &mut moved.blocks_mut()[slave.node].0;
                let [dx, dy] = slave.forward;
                block[2] = std::array::from_fn(|l| -mu * (dx * block[0][l] + dy * block[1][l]));
            }
        }
        let mut product = space.zeros();
        elasticity.product(&moved, &mut product);
        let mut elastic_force = product.clone();
        space.project(contact, &mut elastic_force);
        let energies = q.dot(&elastic_force);
        let mut force = space.zeros();
        add_complex(&mut force, &elastic, &product);
        let inertia = space.mass_times(q);
        add_complex(&mut force, &values.map(|value| value * value + value * self.alpha_r_per_s), &inertia);
        for (i, (slave, _)) in nodes() {
            let [dx, dy] = slave.forward;
            let mu = self.friction.mu_of(i);
            let block = &mut force.blocks_mut()[slave.node].0;
            if !is_left {
                for lane in 0..LANES {
                    let friction = mu * block[2][lane];
                    block[0][lane] -= dx * friction;
                    block[1][lane] -= dy * friction;
                }
            }
            let x = &q.blocks()[slave.node].0;
            for (pair, value) in values.iter().enumerate() {
                let across = |lane: usize| dx * x[1][lane] - dy * x[0][lane];
                let damping =
                    *value * c64::new(across(2 * pair), across(2 * pair + 1)) * self.sideways_n_s_m[i];
                for (lane, part) in [(2 * pair, damping.re), (2 * pair + 1, damping.im)] {
                    block[0][lane] -= dy * part;
                    block[1][lane] += dx * part;
                }
            }
        }
        for dashpots in self.viscous {
            dashpots.add_forces(&values, q, &mut force);
        }
        space.project(contact, &mut force);
        let energy = std::array::from_fn(|pair| energies[2 * pair] + energies[2 * pair + 1]);
        Residuals { force, energy }
    }

    /// The residuals relative to the elastic forces. Both are measured by the energy that they have in the
    /// preconditioner and in K. And sᴴ B r, with the preconditioner B and the residuals s of left eigenvectors.
    pub fn measure(&self, residuals: &Residuals, left: &Vectors) -> ([f64; PAIRS], [c64; PAIRS]) {
        let responses = self.bilateral.precondition(&residuals.force);
        let energies = residuals.force.dot(&responses);
        let relative = std::array::from_fn(|pair| {
            let error = energies[2 * pair] + energies[2 * pair + 1];
            // An empty lane has no energy.
            if residuals.energy[pair] > 0.0 { (error / residuals.energy[pair]).sqrt() } else { 0.0 }
        });
        let straight = left.dot(&responses);
        let crossed = with_parts_exchanged(left).dot(&responses);
        let product = |pair: usize| {
            let [re, im] = [2 * pair, 2 * pair + 1];
            c64::new(straight[re] + straight[im], crossed[im] - crossed[re])
        };
        (relative, std::array::from_fn(product))
    }
}

/// Complex vectors in pairs of lanes with their real and imaginary parts exchanged.
fn with_parts_exchanged(x: &Vectors) -> Vectors {
    let mut exchanged = x.clone();
    for row in exchanged.blocks_mut().iter_mut().flat_map(|block| &mut block.0) {
        for pair in row.as_chunks_mut::<2>().0 {
            pair.swap(0, 1);
        }
    }
    exchanged
}

/// y += factor·x with complex numbers in pairs of lanes.
fn add_complex(y: &mut Vectors, factor: &[c64; PAIRS], x: &Vectors) {
    let real = std::array::from_fn(|lane| factor[lane / 2].re);
    add(y, &real, x);
    for (y, x) in y.blocks_mut().iter_mut().zip(x.blocks()) {
        for c in 0..3 {
            for pair in 0..PAIRS {
                y.0[c][2 * pair] -= factor[pair].im * x.0[c][2 * pair + 1];
                y.0[c][2 * pair + 1] += factor[pair].im * x.0[c][2 * pair];
            }
        }
    }
}

/// Steps of conjugate gradients for one displacement of [`sector`].
const SECTOR_STEPS: usize = 40;

/// γ of [`bound`](super::bound) for nodes in contact with these friction coefficients.
pub fn sector(model: &Model, bilateral: &Bilateral<'_>, friction: &SlidingFriction) -> Option<f64> {
    let Bilateral { space, contact, .. } = *bilateral;
    let nodes = || space.sliding().iter().enumerate().filter(|(i, _)| contact.in_contact[*i]);
    let projected = |values: &[f64]| {
        let mut field = space.gather(&[values]);
        space.project(contact, &mut field);
        field
    };
    let product = |x: &Vectors| {
        let mut y = space.zeros();
        Elasticity::new(model, space).product(x, &mut y);
        y
    };
    let mut b = |x: &[f64]| {
        let forces = Space::lane(&product(&projected(x)), 0);
        let mut friction_n = vec![0.0; x.len()];
        for (i, slave) in nodes() {
            for c in 0..2 {
                friction_n[3 * slave.node + c] =
                    friction.mu_of(i) * slave.forward[c] * forces[3 * slave.node + 2];
            }
        }
        Space::lane(&projected(&friction_n), 0)
    };
    let mut transposed = |x: &[f64]| {
        let x = Space::lane(&projected(x), 0);
        let mut moved = vec![0.0; x.len()];
        for (i, slave) in nodes() {
            let [dx, dy] = slave.forward;
            moved[3 * slave.node + 2] =
                friction.mu_of(i) * (dx * x[3 * slave.node] + dy * x[3 * slave.node + 1]);
        }
        let mut force = product(&space.gather(&[&moved]));
        space.project(contact, &mut force);
        Space::lane(&force, 0)
    };
    let mut solve = |force: &[f64]| {
        let mut x = space.zeros();
        let mut elasticity = Elasticity::new(model, space);
        bilateral.solve(&mut elasticity, &projected(force), &mut x, SECTOR_STEPS);
        Space::lane(&x, 0)
    };
    // A force on all nodes in contact that has no symmetry.
    let mut start = vec![0.0; space.len()];
    for (i, slave) in nodes() {
        start[3 * slave.node] = libm::sin(1.0 + i as f64);
        start[3 * slave.node + 1] = libm::cos(0.3 * i as f64);
    }
    let start = Space::lane(&projected(&start), 0);
    bound::sector(&mut Coupling { b: &mut b, transposed: &mut transposed, solve: &mut solve }, &start)
}
