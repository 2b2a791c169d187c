//! Eigenvalues of P(λ) = λ²M + (1 + βλ)K + λD near a point σ, by shift-and-invert Arnoldi iteration on q and λq.
//!
//! With p = λq and C = βK + D the problem is linear. One step of the iteration solves
//!
//! ```text
//! P(σ) x = −(M b + (C + σM) a)        y = a + σx        (a, b) ↦ (x, y)
//! ```
//!
//! whose eigenvalues are 1/(λ − σ) (Tisseur and Meerbergen, *SIAM Review* 43, 2001, section 4). Without restarts the eigenvalues
//! next to σ converge first, so those within the radius of the first one that has not converged are complete.

use super::system::Matrices;
use crate::stability::error::StabilityError;
use faer::{Mat, c64};

/// Largest residual ‖P(λ)q‖ over the sum of the sizes of its parts.
const RESIDUAL: f64 = 1.0e-7;
/// Smallest share of a vector that is not in the others.
const INDEPENDENT: f64 = 1.0e-12;

/// An eigenvalue \[1/s\] with its vector of independent displacements, and its relative residual.
#[derive(Debug, Clone)]
pub struct Found {
    pub value: c64,
    pub q: Vec<c64>,
    pub residual: f64,
}

/// Eigenvalues near a point.
#[derive(Debug)]
pub struct Near {
    pub found: Vec<Found>,
    /// No eigenvalue is missing at less than this distance \[1/s\] from the point.
    pub radius_per_s: f64,
}

/// The eigenvalues that `steps` steps find near σ \[1/s\], with a damping β \[s\].
pub fn near(matrices: &Matrices, damping_s: f64, sigma: c64, steps: usize) -> Result<Near, StabilityError> {
    let n = matrices.size();
    let one = c64::new(1.0, 0.0);
    let of = |value: c64| [value * value, one + value * damping_s, value];
    let [inertia, elastic, viscous] = of(sigma);
    let factors = matrices.factored(|[m, k, d]| inertia * *m + elastic * *k + viscous * *d)?;
    // Velocities are measured in units of |σ|, so that both halves have the same size.
    let unit = sigma.norm();
    let apply = |v: &[c64]| -> Vec<c64> {
        let (a, b) = v.split_at(n);
        let zero = c64::new(0.0, 0.0);
        let mut right = matrices.times([c64::new(-unit, 0.0), zero, zero], b);
        for (right, more) in
            right.iter_mut().zip(matrices.times([-sigma, c64::new(-damping_s, 0.0), -one], a))
        {
            *right += more;
        }
        let mut x = factors.solve(&right);
        let y: Vec<c64> = a.iter().zip(&x).map(|(a, x)| (*a + sigma * *x) / unit).collect();
        x.extend(y);
        x
    };
    let steps = steps.min(2 * n);
    let mut hessenberg = Mat::<c64>::zeros(steps, steps);
    let mut start: Vec<c64> = (0..2 * n).map(|i| c64::new(pseudo_random(i), 0.0)).collect();
    scale(&mut start, 1.0);
    // The first application removes what no slow mode has.
    let mut start = apply(&start);
    scale(&mut start, 1.0);
    let mut basis = vec![start];
    let mut last = 0.0;
    let mut count = 0;
    while count < steps {
        let mut w = apply(&basis[count]);
        let before = norm(&w);
        for _ in 0..2 {
            for (i, v) in basis.iter().enumerate() {
                let share = dot(v, &w);
                for (w, v) in w.iter_mut().zip(v) {
                    *w -= share * *v;
                }
                hessenberg[(i, count)] += share;
            }
        }
        count += 1;
        last = norm(&w);
        if last <= INDEPENDENT * before {
            last = 0.0;
            break;
        }
        if count < steps {
            hessenberg[(count, count - 1)] = c64::new(last, 0.0);
            scale(&mut w, 1.0);
            basis.push(w);
        }
    }
    let small = hessenberg.submatrix(0, 0, count, count).to_owned();
    let failed =
        StabilityError::NotConverged { what: "the eigenvalues of steady sliding", iterations: steps };
    let eigen = small.eigen().map_err(|_| failed)?;
    let mut order: Vec<usize> = (0..count).filter(|&j| eigen.S()[j].norm() > 0.0).collect();
    order.sort_by(|&a, &b| eigen.S()[b].norm().total_cmp(&eigen.S()[a].norm()));
    let mut near = Near { found: Vec::new(), radius_per_s: 0.0 };
    let mut is_complete = true;
    for j in order {
        let theta = eigen.S()[j];
        let distance = 1.0 / theta.norm();
        let vector: Vec<c64> = (0..count).map(|i| eigen.U()[(i, j)]).collect();
        let size = norm(&vector);
        // The residual of the iteration shows early which values cannot have converged.
        if last * vector[count - 1].norm() / size > 1.0e-4 * theta.norm() {
            is_complete = false;
            continue;
        }
        let value = sigma + one / theta;
        let q: Vec<c64> = (0..n).map(|i| basis.iter().zip(&vector).map(|(v, c)| v[i] * *c).sum()).collect();
        let residual = residual(matrices, of(value), &q);
        if residual > RESIDUAL {
            is_complete = false;
            continue;
        }
        if is_complete {
            near.radius_per_s = distance;
        }
        near.found.push(Found { value, q, residual });
    }
    if is_complete && last == 0.0 {
        near.radius_per_s = f64::INFINITY;
    }
    Ok(near)
}

fn residual(matrices: &Matrices, factors: [c64; 3], q: &[c64]) -> f64 {
    let zero = c64::new(0.0, 0.0);
    let size: f64 = (0..3)
        .map(|part| {
            norm(&matrices.times(std::array::from_fn(|m| if m == part { factors[m] } else { zero }), q))
        })
        .sum();
    norm(&matrices.times(factors, q)) / size
}

/// xᴴy.
fn dot(x: &[c64], y: &[c64]) -> c64 {
    x.iter().zip(y).map(|(x, y)| x.conj() * *y).sum()
}

fn norm(x: &[c64]) -> f64 {
    x.iter().map(c64::norm_sqr).sum::<f64>().sqrt()
}

fn scale(x: &mut [c64], to: f64) {
    let factor = to / norm(x);
    for x in x {
        *x *= factor;
    }
}

/// A number between −1 and 1 that depends on nothing but `i`.
pub fn pseudo_random(i: usize) -> f64 {
    let mixed = (i as u64).wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}
