//! Vectors that are added to the basis for one equilibrium, or for some modes of one point.

use super::basis::{Basis, patterns, spread, sum_of};
use super::dashpots::Dashpots;
use super::pencil::{Pencil, Sampling};
use super::space::{Elasticity, LANES, SlidingNode, Space, Vectors, block_of};
use super::vibration::Vibration;
use faer::Mat;

/// Smallest share (of squares) of a vector that is not in the others.
const INDEPENDENT: f64 = 1e-10;

/// Up to this number of lifted nodes, each has a force of its own.
const SINGLE: usize = 30;
/// Smallest share (of squares) of a pattern of forces on lifted nodes that is not in the others.
const INDEPENDENT_FORCE: f64 = 1e-6;
/// Steps of conjugate gradients for the response to forces on lifted nodes.
const STEPS: usize = 8;

/// Vectors that were added to the basis for one equilibrium, or for some modes of one point.
#[derive(Debug, Clone)]
pub struct Extension {
    /// Orthogonal to each other in the mass.
    pub vectors: Vec<Vec<f64>>,
    /// Slip along the disk's velocity times the share of μ, slip across it, and normal forces: vector → slave node.
    forward: Vec<Vec<f64>>,
    sideways: Vec<Vec<f64>>,
    normal: Vec<Vec<f64>>,
}

impl Extension {
    pub fn none() -> Self {
        Self { vectors: Vec::new(), forward: Vec::new(), sideways: Vec::new(), normal: Vec::new() }
    }

    /// Adds the responses of the pin to normal forces on the nodes that are lifted at this equilibrium, which the basis holds in z. Without
    /// them the basis lacks their motion, and modes in which they move. Gives P(λ) in the larger basis. A complete basis stays complete if every
    /// lifted node adds a vector.
    pub fn add_lifted(
        &mut self,
        basis: &Basis,
        vibration: &Vibration<'_>,
        elasticity: &mut Elasticity<'_>,
        mut pencil: Pencil,
    ) -> Pencil {
        let bilateral = &vibration.bilateral;
        let space = bilateral.space;
        for forces in forces_on_lifted(basis, space, elasticity, bilateral.contact.in_contact).chunks(LANES) {
            let views: Vec<&[f64]> = forces.iter().map(Vec::as_slice).collect();
            let mut force = space.gather(&views);
            space.project(bilateral.contact, &mut force);
            let mut response = space.zeros();
            bilateral.solve(elasticity, &force, &mut response, STEPS);
            pencil = self.extend(basis, vibration, elasticity, &pencil, &[response], forces.len());
        }
        pencil
    }

    /// Adds the first `lanes` vectors, made orthogonal in the mass to the basis and to those that were added before.
    fn add_independent(&mut self, space: &Space, basis: &Basis, response: &Vectors, lanes: usize) {
        let masses = space.masses_kg();
        let mut given = Mat::from_fn(space.len(), lanes, |i, lane| response.blocks()[i / 3].0[i % 3][lane]);
        let own: Vec<f64> = (0..lanes).map(|lane| column_dot(masses, &given, lane)).collect();
        for _ in 0..2 {
            let weighted = Mat::from_fn(space.len(), lanes, |i, lane| masses[i] * given[(i, lane)]);
            let shares = basis.vectors.transpose() * &weighted;
            given -= &basis.vectors * &shares;
        }
        for lane in 0..lanes {
            let mut x: Vec<f64> = given.col(lane).iter().copied().collect();
            for _ in 0..2 {
                for v in &self.vectors {
                    let share = mass_dot(masses, v, &x);
                    for (x, v) in x.iter_mut().zip(v) {
                        *x -= share * v;
                    }
                }
            }
            let left = mass_dot(masses, &x, &x);
            if left > INDEPENDENT * own[lane] && left > 0.0 {
                let norm = left.sqrt();
                self.vectors.push(x.iter().map(|x| x / norm).collect());
            }
        }
    }

    /// Adds the first `lanes` vectors of each of `responses`, and gives P(λ) in the larger basis.
    pub fn extend(
        &mut self,
        basis: &Basis,
        vibration: &Vibration<'_>,
        elasticity: &mut Elasticity<'_>,
        before: &Pencil,
        responses: &[Vectors],
        lanes: usize,
    ) -> Pencil {
        let space = vibration.bilateral.space;
        let on = vibration.bilateral.contact.in_contact;
        let r = basis.len();
        let old = before.stiffness.nrows();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let first = self.vectors.len();
        for response in responses {
            self.add_independent(space, basis, response, lanes);
        }
        let added = self.vectors.len() - first;
        let size = old + added;
        let enlarged = |of: &Mat<f64>| {
            Mat::from_fn(size, size, |i, j| if i < old && j < old { of[(i, j)] } else { 0.0 })
        };
        let (mut stiffness, mut sideways) = (enlarged(&before.stiffness), enlarged(&before.sideways));
        for at in (first..self.vectors.len()).step_by(LANES) {
            let lanes = LANES.min(self.vectors.len() - at);
            let views: Vec<&[f64]> = self.vectors[at..at + lanes].iter().map(Vec::as_slice).collect();
            let x = space.gather(&views);
            let mut product = space.zeros();
            elasticity.product(&x, &mut product);
            let kx = Mat::from_fn(space.len(), lanes, |i, lane| product.blocks()[i / 3].0[i % 3][lane]);
            let with_basis = basis.vectors.transpose() * &kx;
            for lane in 0..lanes {
                let column = old + (at - first) + lane;
                for i in 0..r {
                    stiffness[(i, column)] = with_basis[(i, lane)];
                    stiffness[(column, i)] = with_basis[(i, lane)];
                }
                let kx: Vec<f64> = kx.col(lane).iter().copied().collect();
                for (k, v) in self.vectors.iter().enumerate().take(at + lane + 1) {
                    let value = dot(v, &kx);
                    stiffness[(r + k, column)] = value;
                    stiffness[(column, r + k)] = value;
                }
                let of_nodes = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
                    (0..on.len()).map(|i| if on[i] { value(i) } else { 0.0 }).collect()
                };
                let slave = |i: usize| &space.sliding()[i];
                let v = views[lane];
                self.forward.push(of_nodes(&|i| {
                    let [dx, dy] = slave(i).forward;
                    (dx * v[3 * slave(i).node] + dy * v[3 * slave(i).node + 1]) * vibration.friction.share[i]
                }));
                self.sideways.push(of_nodes(&|i| {
                    let [dx, dy] = slave(i).forward;
                    dx * v[3 * slave(i).node + 1] - dy * v[3 * slave(i).node]
                }));
                self.normal.push(of_nodes(&|i| kx[3 * slave(i).node + 2]));
            }
        }
        // The unsymmetric part and the damping of the new rows and columns.
        let column_of = |of: &Mat<f64>, j: usize| -> Vec<f64> {
            (0..on.len()).map(|i| if on[i] { of[(i, j)] } else { 0.0 }).collect()
        };
        let get = |of: &Mat<f64>, own: &[Vec<f64>], j: usize| {
            if j < r { column_of(of, j) } else { own[j - r].clone() }
        };
        let weighted: Vec<Vec<f64>> = (old..size)
            .map(|j| self.sideways[j - r].iter().zip(vibration.sideways_n_s_m).map(|(a, b)| a * b).collect())
            .collect();
        for i in 0..size {
            let mut forward = get(&basis.forward, &self.forward, i);
            if i < r {
                for (slip, share) in forward.iter_mut().zip(&vibration.friction.share) {
                    *slip *= share;
                }
            }
            let normal = get(&basis.normal, &self.normal, i);
            let across = get(&basis.sideways, &self.sideways, i);
            for j in old..size {
                stiffness[(i, j)] -= vibration.friction.mu * dot(&forward, &self.normal[j - r]);
                if i < old {
                    stiffness[(j, i)] -= vibration.friction.mu * dot(&self.forward[j - r], &normal);
                }
                let damping = dot(&across, &weighted[j - old]);
                sideways[(i, j)] = damping;
                sideways[(j, i)] = damping;
            }
        }
        let viscous = self.with_dashpots(basis, vibration, before, old);
        Pencil {
            viscous,
            stiffness,
            sideways,
            damping_s: before.damping_s,
            alpha_r_per_s: before.alpha_r_per_s,
        }
    }

    /// The matrices of other dampers in the larger basis, of which `old` vectors had been there before.
    fn with_dashpots(
        &self,
        basis: &Basis,
        vibration: &Vibration<'_>,
        before: &Pencil,
        old: usize,
    ) -> Vec<(Sampling, Mat<f64>)> {
        let r = basis.len();
        let size = r + self.vectors.len();
        let enlarge = |(dashpots, (sampling, before)): (&Dashpots, &(Sampling, Mat<f64>))| {
            let velocities: Vec<Vec<f64>> = (0..size)
                .map(|i| match i.checked_sub(r) {
                    None => dashpots.velocities_of_basis(basis, i),
                    Some(own) => dashpots.velocities(&self.vectors[own]),
                })
                .collect();
            let form = |i: usize, j: usize| {
                if i < old && j < old {
                    before[(i, j)]
                } else {
                    dashpots.form(&velocities[i], &velocities[j])
                }
            };
            (*sampling, Mat::from_fn(size, size, form))
        };
        vibration.viscous.iter().zip(&before.viscous).map(enlarge).collect()
    }
}

/// Normal forces on the lifted nodes: on each alone, or in independent patterns.
fn forces_on_lifted(
    basis: &Basis,
    space: &Space,
    elasticity: &Elasticity<'_>,
    in_contact: &[bool],
) -> Vec<Vec<f64>> {
    let all = space.sliding().iter().zip(in_contact);
    let lifted: Vec<SlidingNode> = all.filter(|(_, on)| !**on).map(|(slave, _)| *slave).collect();
    let own: Vec<Vec<f64>> = if basis.is_complete || lifted.len() <= SINGLE {
        (0..lifted.len()).map(|i| (0..lifted.len()).map(|j| f64::from(u8::from(i == j))).collect()).collect()
    } else {
        independent(patterns(block_of(elasticity.model()), &lifted))
    };
    own.iter().map(|values| spread(space, &lifted, values, 2)).collect()
}

/// Orthonormal combinations of vectors, without those that hold almost nothing of their own.
fn independent(vectors: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut kept: Vec<Vec<f64>> = Vec::new();
    for mut x in vectors {
        let whole = dot(&x, &x);
        for _ in 0..2 {
            for v in &kept {
                let share = dot(v, &x);
                for (x, v) in x.iter_mut().zip(v) {
                    *x -= share * v;
                }
            }
        }
        let left = dot(&x, &x);
        if left > INDEPENDENT_FORCE * whole {
            let norm = left.sqrt();
            kept.push(x.into_iter().map(|x| x / norm).collect());
        }
    }
    kept
}

fn column_dot(masses: &[f64], x: &Mat<f64>, column: usize) -> f64 {
    x.col(column).iter().enumerate().map(|(i, x)| masses[i] * x * x).sum()
}

fn mass_dot(masses: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let [a, b, masses] = [a, b, masses].map(|x| x.as_chunks::<3>().0);
    a.iter().zip(b).zip(masses).map(|((a, b), m)| sum_of(a, b, m)).sum()
}
