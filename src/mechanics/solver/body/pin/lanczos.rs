//! The largest frequency of a general mesh.

use crate::random::SplitMix64;
use crate::solver::body::Freedom;
use crate::solver::field::{Field, Layout};
use nalgebra::DMatrix;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// What the bound adds to the largest frequency squared, relative to it.
const MARGIN: f64 = 0.01;

/// Probability with which the bound may be too low.
const RISK: f64 = 1e-12;

/// Upper bound of the largest angular frequency \[rad/s\] of nodes with these masses. `product` multiplies by their stiffness.
pub fn omega_max_bound(
    layout: Layout,
    product: impl FnMut(&Field<1>, &mut Field<1>),
    masses_kg: &[f64],
    freedoms: &[Freedom],
) -> f64 {
    (largest_square(layout, product, masses_kg, freedoms, MARGIN) / (1.0 - MARGIN)).sqrt()
}

/// The largest angular frequency squared \[rad²/s²\]. It may be too low by the share `margin`, and is never too high.
///
/// Lanczos' method from a random start finds the largest eigenvalue λ of n degrees of freedom after k steps to (1 − ε)λ. It
/// fails with a probability below 1.648 √n exp(−√ε (2k − 1)) (Kuczyński and Woźniakowski, SIAM J. Matrix Anal. Appl. 13, 1992,
/// theorem 4.1). Here ε is the margin, and k follows from a probability of 10⁻¹². The random numbers are always the same.
pub fn largest_square(
    layout: Layout,
    mut product: impl FnMut(&Field<1>, &mut Field<1>),
    masses_kg: &[f64],
    freedoms: &[Freedom],
    margin: f64,
) -> f64 {
    let reduced = Reduced::new(masses_kg, freedoms);
    let size = reduced.size;
    if size == 0 {
        return 0.0;
    }
    let steps = (libm::log(1.648 * (size as f64).sqrt()) - libm::log(RISK)) / margin.sqrt();
    let steps = ((0.5 * (steps + 1.0)).ceil() as usize).min(size);
    let (mut u, mut force) = (Field::<1>::zeros(layout), Field::<1>::zeros(layout));
    let mut v = random(size);
    let mut before = vec![0.0; size];
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    let mut beta = 0.0;
    normalise(&mut v);
    for _ in 0..steps {
        reduced.expand(&v, &mut u);
        product(&u, &mut force);
        let mut w = reduced.collect(&force);
        let alpha: f64 = w.iter().zip(&v).map(|(w, v)| w * v).sum();
        for ((w, v), before) in w.iter_mut().zip(&v).zip(&before) {
            *w -= alpha * v + beta * before;
        }
        diagonal.push(alpha);
        beta = normalise(&mut w);
        // A space that is complete has no further direction. What is left is rounding.
        if beta <= f64::EPSILON * alpha.abs() {
            break;
        }
        beside.push(beta);
        before = std::mem::replace(&mut v, w);
    }
    let count = diagonal.len();
    let tridiagonal = DMatrix::from_fn(count, count, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => beside[i.min(j)],
        _ => 0.0,
    });
    tridiagonal.symmetric_eigenvalues().max()
}

/// Coordinates in which the mass is the unit matrix: one for each degree of freedom that moves by itself, one for each tie.
struct Reduced {
    /// The coordinate of each degree of freedom, and the displacement for a unit of it.
    of_dofs: Vec<Option<(usize, f64)>>,
    size: usize,
}

impl Reduced {
    fn new(masses_kg: &[f64], freedoms: &[Freedom]) -> Self {
        let mut groups: BTreeMap<usize, (usize, f64)> = BTreeMap::new();
        let mut size = 0;
        let mut numbers = Vec::with_capacity(freedoms.len());
        for (dof, freedom) in freedoms.iter().enumerate() {
            let mut next = || {
                size += 1;
                size - 1
            };
            numbers.push(match *freedom {
                Freedom::Fixed => None,
                // A constraint can only lower the largest frequency.
                Freedom::Free | Freedom::Carried => Some(next()),
                Freedom::Tied(group) => {
                    let entry = groups.entry(group).or_insert_with(|| (next(), 0.0));
                    entry.1 += masses_kg[dof / 3];
                    Some(entry.0)
                }
            });
        }
        let of_dofs = freedoms.iter().zip(numbers).enumerate().map(|(dof, (freedom, number))| {
            let mass_kg = match freedom {
                Freedom::Tied(group) => groups[group].1,
                _ => masses_kg[dof / 3],
            };
            Some((number?, 1.0 / mass_kg.sqrt()))
        });
        Self { of_dofs: of_dofs.collect(), size }
    }

    fn expand(&self, v: &[f64], u: &mut Field<1>) {
        for (dof, of_dof) in self.of_dofs.iter().enumerate() {
            u[dof] = of_dof.map_or(0.0, |(number, share)| share * v[number]);
        }
    }

    fn collect(&self, force: &Field<1>) -> Vec<f64> {
        let mut v = vec![0.0; self.size];
        for (dof, of_dof) in self.of_dofs.iter().enumerate() {
            if let Some((number, share)) = *of_dof {
                v[number] += share * force[dof];
            }
        }
        v
    }
}

/// Divides a vector by its length, and returns the length.
fn normalise(v: &mut [f64]) -> f64 {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    for x in v {
        *x /= length;
    }
    length
}

/// Numbers with a normal distribution, so that every direction is equally likely (Box and Muller, 1958).
fn random(count: usize) -> Vec<f64> {
    let mut random = SplitMix64::new(0);
    let mut uniform = move || random.unit();
    (0..count).map(|_| (-2.0 * libm::log(1.0 - uniform())).sqrt() * libm::cos(TAU * uniform())).collect()
}

#[cfg(test)]
mod tests {
    use super::super::operator::Operator;
    use super::super::{GeneralMesh, Tilt, assembled, cylinder};
    use super::*;
    use crate::solver::material::Material;

    /// Protects: the bound is above the largest frequency of a dense eigenvalue problem, and by no more than its margin, with
    /// fixed, tied and free nodes.
    #[test]
    fn bounds_the_dense_problem_from_above() {
        let material = Material { young_modulus_pa: 1e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 };
        let mesh = GeneralMesh::new(&cylinder([0.008, 0.009, 0.005], 5, 3), Tilt::default()).unwrap();
        let (operator, masses_kg) = assembled(&mesh, &[material]).unwrap();
        let operator = Operator::Assembled(operator);
        let dofs = 3 * mesh.node_count();
        let mut freedoms = vec![Freedom::Free; dofs];
        let check = |freedoms: &[Freedom]| {
            let reduced = Reduced::new(&masses_kg, freedoms);
            let layout = mesh.layout();
            let mut scratch = operator.scratch(layout, 1);
            let (mut u, mut force) = (Field::<1>::zeros(layout), Field::<1>::zeros(layout));
            let mut dense = DMatrix::zeros(reduced.size, reduced.size);
            for column in 0..reduced.size {
                let mut unit = vec![0.0; reduced.size];
                unit[column] = 1.0;
                reduced.expand(&unit, &mut u);
                operator.tangent(&u, &mut force, &mut scratch);
                dense.set_column(column, &nalgebra::DVector::from_vec(reduced.collect(&force)));
            }
            let exact = ((&dense + dense.transpose()) * 0.5).symmetric_eigenvalues().max().sqrt();
            let ratio = operator.omega_max_bound(layout, &masses_kg, freedoms) / exact;
            assert!((1.0..=1.0 / (1.0 - MARGIN)).contains(&ratio), "{ratio}");
        };
        check(&freedoms);
        for node in mesh.top_nodes() {
            freedoms[3 * node] = Freedom::Fixed;
            freedoms[3 * node + 1] = Freedom::Fixed;
            freedoms[3 * node + 2] = Freedom::Tied(0);
        }
        check(&freedoms);
    }
}
