//! The basis in which the modes of all points of a model are found.
//!
//! It has modes of the pin with all slave nodes held in z, once free to slip and once without sideways slip, and static
//! deformations by tangential forces on the contact face. So it holds whatever friction, speed and load are. Vectors that
//! come from a coarse mesh are improved on the fine one by an inexact step of inverse iteration.

use super::coarse;
use super::separable::Separable;
use super::solve::Bilateral;
use super::space::{Contact, Elasticity, LANES, SlidingNode, Space, block_of};
use crate::solver::Model;
use crate::solver::body::pin::BlockMesh;
use faer::{Mat, Side};

/// Modes that are free to slip.
const FREE: usize = 100;
/// Modes without sideways slip.
const LOCKED: usize = 60;
/// Patterns of forces in x and in y: products of this many cosines.
const PATTERNS: [usize; 2] = [5, 6];
/// Up to this number of degrees of freedom, the basis is complete.
const COMPLETE: usize = 500;
/// Steps of conjugate gradients for one vector.
const STEPS: usize = 8;
/// Smallest share of a vector that is not in the others.
const INDEPENDENT: f64 = 1e-5;

/// The basis and the matrices of the pin in it.
#[derive(Debug)]
pub struct Basis {
    /// The vectors, one a column, orthonormal in the mass.
    pub vectors: Mat<f64>,
    /// K in the basis \[1/s²\].
    pub stiffness: Mat<f64>,
    /// Slip along the disk's velocity, slave node → vector.
    pub forward: Mat<f64>,
    /// Slip across the disk's velocity, slave node → vector.
    pub sideways: Mat<f64>,
    /// Normal contact force, slave node → vector.
    pub normal: Mat<f64>,
    /// Frequency \[Hz\] up to which the basis has the modes with all slave nodes held in z. Those with many lifted nodes it has approximately.
    pub band_hz: f64,
    /// Whether the basis has all modes of the mesh with all slave nodes held in z.
    pub is_complete: bool,
}

impl Basis {
    pub fn new(model: &Model, space: &Space, separable: &Separable) -> Self {
        let all_in_contact = vec![true; space.sliding().len()];
        let mut elasticity = Elasticity::new(model, space);
        let free = coarse::modes(model, space, false, FREE, COMPLETE);
        let highest = free.omega_squared.last().copied().unwrap_or(0.0);
        let band_hz = frequency_hz(highest);
        let mut columns = Vec::new();
        let locked = (!free.is_complete).then(|| coarse::modes(model, space, true, LOCKED, 0));
        let is_complete = free.is_complete;
        for (modes, is_locked_sideways) in [(Some(free), false), (locked, true)] {
            let Some(modes) = modes else { continue };
            let contact = Contact { in_contact: &all_in_contact, is_locked_sideways };
            let bilateral = Bilateral { space, separable, contact };
            for (vectors, squares) in modes.vectors.chunks(LANES).zip(modes.omega_squared.chunks(LANES)) {
                let views: Vec<&[f64]> = vectors.iter().map(Vec::as_slice).collect();
                let mut guess = space.gather(&views);
                space.project(contact, &mut guess);
                if !modes.is_exact {
                    let mut force = space.mass_times(&guess);
                    space.project(contact, &mut force);
                    for block in guess.blocks_mut() {
                        for row in &mut block.0 {
                            for (value, square) in row.iter_mut().zip(squares) {
                                *value /= square;
                            }
                        }
                    }
                    bilateral.solve(&mut elasticity, &force, &mut guess, STEPS);
                }
                columns.extend((0..vectors.len()).map(|lane| Space::lane(&guess, lane)));
            }
        }
        if !is_complete {
            let contact = Contact { in_contact: &all_in_contact, is_locked_sideways: false };
            let bilateral = Bilateral { space, separable, contact };
            let tangential: Vec<Vec<f64>> = patterns(block_of(model), space.sliding())
                .into_iter()
                .flat_map(|values| [0, 1].map(|c| spread(space, space.sliding(), &values, c)))
                .collect();
            for forces in tangential.chunks(LANES) {
                let views: Vec<&[f64]> = forces.iter().map(Vec::as_slice).collect();
                let mut force = space.gather(&views);
                space.project(contact, &mut force);
                let mut x = space.zeros();
                bilateral.solve(&mut elasticity, &force, &mut x, STEPS);
                columns.extend((0..forces.len()).map(|lane| Space::lane(&x, lane)));
            }
        }
        Self::spanned_by(space, &mut elasticity, &columns, band_hz, is_complete)
    }

    /// The space of `columns` with the matrices of the pin in it.
    fn spanned_by(
        space: &Space,
        elasticity: &mut Elasticity<'_>,
        columns: &[Vec<f64>],
        band_hz: f64,
        is_complete: bool,
    ) -> Self {
        let masses = space.masses_kg();
        let norms: Vec<f64> = columns.iter().map(|x| mass_norm(masses, x)).collect();
        let mut given = Mat::from_fn(space.len(), columns.len(), |i, j| columns[j][i] / norms[j]);
        // The second pass removes the rounding that dependent columns cause in the first.
        for _ in 0..2 {
            given = orthonormal(masses, &given);
        }
        let vectors = given;
        let (stiffness, normal) = stiffness_in(space, elasticity, &vectors);
        let count = vectors.ncols();
        let stiffness = Mat::from_fn(count, count, |i, j| 0.5 * (stiffness[(i, j)] + stiffness[(j, i)]));
        let sliding = space.sliding();
        let slip = |turn: fn([f64; 2]) -> [f64; 2]| {
            Mat::from_fn(sliding.len(), vectors.ncols(), |i, j| {
                let [x, y] = turn(sliding[i].forward);
                x * vectors[(3 * sliding[i].node, j)] + y * vectors[(3 * sliding[i].node + 1, j)]
            })
        };
        Self {
            stiffness,
            forward: slip(|d| d),
            sideways: slip(|[x, y]| [-y, x]),
            normal,
            vectors,
            band_hz,
            is_complete,
        }
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.vectors.ncols()
    }
}

/// Independent combinations of the columns, orthonormal in the mass.
fn orthonormal(masses: &[f64], columns: &Mat<f64>) -> Mat<f64> {
    let weighted = Mat::from_fn(columns.nrows(), columns.ncols(), |i, j| masses[i] * columns[(i, j)]);
    let gram = columns.transpose() * &weighted;
    drop(weighted);
    let eigen = gram.self_adjoint_eigen(Side::Lower).expect("a symmetric matrix of finite numbers");
    let kept: Vec<usize> =
        (0..columns.ncols()).filter(|&j| eigen.S()[j] > INDEPENDENT * INDEPENDENT).collect();
    columns
        * Mat::from_fn(columns.ncols(), kept.len(), |i, j| {
            eigen.U()[(i, kept[j])] / eigen.S()[kept[j]].sqrt()
        })
}

/// VᵀKV, and the normal contact forces (slave node → vector).
fn stiffness_in(space: &Space, elasticity: &mut Elasticity<'_>, vectors: &Mat<f64>) -> (Mat<f64>, Mat<f64>) {
    let count = vectors.ncols();
    let mut stiffness = Mat::zeros(count, count);
    let mut normal = Mat::zeros(space.sliding().len(), count);
    let mut product = space.zeros();
    for first in (0..count).step_by(LANES) {
        let lanes = LANES.min(count - first);
        let views: Vec<Vec<f64>> =
            (first..first + lanes).map(|j| vectors.col(j).iter().copied().collect()).collect();
        let views: Vec<&[f64]> = views.iter().map(Vec::as_slice).collect();
        elasticity.product(&space.gather(&views), &mut product);
        for (i, slave) in space.sliding().iter().enumerate() {
            for lane in 0..lanes {
                normal[(i, first + lane)] = product.blocks()[slave.node].0[2][lane];
            }
        }
        let forces = Mat::from_fn(space.len(), lanes, |i, lane| product.blocks()[i / 3].0[i % 3][lane]);
        let part = vectors.transpose() * &forces;
        for lane in 0..lanes {
            for i in 0..count {
                stiffness[(i, first + lane)] = part[(i, lane)];
            }
        }
    }
    (stiffness, normal)
}

fn mass_norm(masses: &[f64], x: &[f64]) -> f64 {
    let squares = x.as_chunks::<3>().0.iter().zip(masses.as_chunks::<3>().0);
    squares.map(|(x, m)| sum_of(x, x, m)).sum::<f64>().sqrt()
}

/// Σ m a b over the components of a node. Only holders make their masses differ.
pub fn sum_of(a: &[f64; 3], b: &[f64; 3], masses: &[f64; 3]) -> f64 {
    let [x, y, z] = *masses;
    if x == y && y == z {
        return x * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    }
    x * a[0] * b[0] + y * a[1] * b[1] + z * a[2] * b[2]
}

/// Forces on slave nodes, as pressures on the contact face: products of cosines over x and y.
pub fn patterns(mesh: &BlockMesh, slaves: &[SlidingNode]) -> Vec<Vec<f64>> {
    let [lx, ly, _] = mesh.size_m();
    let wave = |n: usize, at: f64| libm::cos(n as f64 * std::f64::consts::PI * (at + 0.5));
    let pattern = |i: usize, j: usize| {
        let force = |slave: &SlidingNode| {
            let [x, y, _] = mesh.coordinates_m(slave.node);
            slave.area_m2 * wave(i, x / lx) * wave(j, y / ly)
        };
        slaves.iter().map(force).collect()
    };
    (0..PATTERNS[0]).flat_map(|i| (0..PATTERNS[1]).map(move |j| (i, j))).map(|(i, j)| pattern(i, j)).collect()
}

/// A component of some slave nodes as a vector of the pin.
pub fn spread(space: &Space, slaves: &[SlidingNode], values: &[f64], component: usize) -> Vec<f64> {
    let mut vector = vec![0.0; space.len()];
    for (slave, value) in slaves.iter().zip(values) {
        vector[3 * slave.node + component] = *value;
    }
    vector
}

/// The frequency \[Hz\] of a vibration.
fn frequency_hz(omega_squared: f64) -> f64 {
    omega_squared.max(0.0).sqrt() / std::f64::consts::TAU
}
