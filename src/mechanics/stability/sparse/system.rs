//! The equations of steady sliding and of small vibrations about it, without the displacements that constraints fix.
//!
//! Let u = T q + u₀ be the displacements, with the independent ones q. A node in contact has the height of the surface under it.
//! Its row of K u + M ü is the normal contact force N on the pin. N acts with the opposite sign on the surface, and friction μN d
//! acts on both. So the equations of q are Lᵀ (K u + M ü) = Lᵀ F, where L differs from T by friction alone.

use super::bodies::{Bodies, Form};
use crate::solver::body::Freedom;
use crate::stability::error::StabilityError;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use faer::traits::ComplexField;
use faer::{Mat, c64};
use std::collections::BTreeMap;

/// Matrices on a common pattern in compressed columns.
#[derive(Debug)]
pub struct Matrices {
    size: usize,
    starts: Vec<usize>,
    rows: Vec<usize>,
    /// M \[kg\], K \[N/m\] and D \[N s/m\].
    values: Vec<[f64; 3]>,
}

/// The equations for one set of nodes in contact.
#[derive(Debug)]
pub struct System {
    /// Displacement → independent displacements with their shares: T.
    right: Vec<Form>,
    /// Equation of a displacement → independent equations with their shares: L.
    left: Vec<Form>,
    pub matrices: Matrices,
}

impl System {
    /// The equations with these nodes in contact, friction coefficients `mu`, and dampers (coefficient \[N s/m\], form of the
    /// displacements).
    pub fn new(bodies: &Bodies, in_contact: &[bool], mu: &[f64], dampers: &[(f64, Form)]) -> Self {
        let touching = || bodies.meetings.iter().enumerate().filter(|(i, _)| in_contact[*i]);
        let mut size = 0;
        let mut groups = BTreeMap::new();
        let follows: std::collections::BTreeSet<usize> =
            touching().map(|(_, meeting)| 3 * meeting.node + 2).collect();
        let mut right: Vec<Form> = vec![Form::new(); bodies.freedoms.len()];
        let mut ways = BTreeMap::new();
        for (dof, freedom) in bodies.freedoms.iter().enumerate() {
            let index = match freedom {
                Freedom::Fixed => continue,
                Freedom::Carried => {
                    for (way, share) in &bodies.carried[&dof] {
                        let index = *ways.entry(*way).or_insert(size);
                        size = size.max(index + 1);
                        right[dof].push((index, *share));
                    }
                    continue;
                }
                _ if follows.contains(&dof) => continue,
                Freedom::Free => size,
                Freedom::Tied(group) => *groups.entry(*group).or_insert(size),
            };
            size = size.max(index + 1);
            right[dof] = vec![(index, 1.0)];
        }
        let moved = |right: &[Form], form: &[(usize, f64)], factor: f64| -> Form {
            let shares = form.iter().flat_map(|(dof, share)| {
                right[*dof].iter().map(move |(index, own)| (*index, factor * share * own))
            });
            shares.collect()
        };
        for (_, meeting) in touching() {
            right[3 * meeting.node + 2] = moved(&right, &meeting.surface[2], 1.0);
        }
        let mut left = right.clone();
        for (i, meeting) in touching() {
            let row = &mut left[3 * meeting.node + 2];
            for (c, along) in meeting.forward.into_iter().enumerate() {
                row.extend(moved(&right, &[(3 * meeting.node + c, 1.0)], -mu[i] * along));
                row.extend(moved(&right, &meeting.surface[c], mu[i] * along));
            }
        }
        let mut entries: Vec<(usize, usize, [f64; 3])> = Vec::new();
        let mut add = |rows: &[(usize, f64)], columns: &[(usize, f64)], value: [f64; 3]| {
            for (i, a) in rows {
                entries.extend(columns.iter().map(|(j, b)| (*j, *i, value.map(|value| a * b * value))));
            }
        };
        for (row, columns) in bodies.rows.iter().enumerate() {
            for (column, value) in columns {
                add(&left[row], &right[*column], [0.0, *value, 0.0]);
            }
            add(
                &left[row],
                &right[row],
                [bodies.masses_kg[row], 0.0, bodies.alpha_r_per_s * bodies.masses_kg[row]],
            );
        }
        for (form, [mass, stiffness, _]) in &bodies.holders {
            let form = moved(&right, form, 1.0);
            add(&form, &form, [*mass, *stiffness, 0.0]);
        }
        for (coefficient_n_s_m, form) in dampers {
            let form = moved(&right, form, 1.0);
            add(&form, &form, [0.0, 0.0, *coefficient_n_s_m]);
        }
        Self { matrices: Matrices::new(size, entries), right, left }
    }

    /// The displacements of independent ones.
    pub fn displacements<T: Copy + std::ops::Mul<f64, Output = T> + std::iter::Sum>(
        &self,
        q: &[T],
    ) -> Vec<T> {
        self.right.iter().map(|form| form.iter().map(|(index, share)| q[*index] * *share).sum()).collect()
    }

    /// The independent equations of forces on displacements.
    pub fn equations(&self, forces: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.matrices.size];
        for (force, form) in forces.iter().zip(&self.left) {
            for (index, share) in form {
                sums[*index] += share * force;
            }
        }
        sums
    }
}

impl Matrices {
    fn new(size: usize, mut entries: Vec<(usize, usize, [f64; 3])>) -> Self {
        // A stable sort keeps the order of sums.
        entries.sort_by_key(|(column, row, _)| (*column, *row));
        let (mut starts, mut rows, mut values): (Vec<usize>, Vec<usize>, Vec<[f64; 3]>) =
            (vec![0; size + 1], Vec::new(), Vec::new());
        let mut last = None;
        for (column, row, value) in entries {
            if last == Some((column, row)) {
                let sum = values.last_mut().expect("an entry at this place");
                *sum = std::array::from_fn(|m| sum[m] + value[m]);
            } else {
                rows.push(row);
                values.push(value);
                starts[column + 1] = rows.len();
                last = Some((column, row));
            }
        }
        for column in 0..size {
            starts[column + 1] = starts[column + 1].max(starts[column]);
        }
        Self { size, starts, rows, values }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The factors of Σ factor·matrix.
    ///
    /// # Errors
    /// If the sum is singular, or if memory is short.
    pub fn factored<T: ComplexField>(
        &self,
        sum: impl Fn(&[f64; 3]) -> T,
    ) -> Result<Factors<T>, StabilityError> {
        let pattern = SymbolicSparseColMat::new_checked(
            self.size,
            self.size,
            self.starts.clone(),
            None,
            self.rows.clone(),
        );
        let failed = || StabilityError::NotFactored { unknowns: self.size };
        let symbolic = SymbolicLu::try_new(pattern.as_ref()).map_err(|_| failed())?;
        let matrix = SparseColMat::new(pattern, self.values.iter().map(sum).collect());
        let lu = Lu::try_new_with_symbolic(symbolic, matrix.as_ref()).map_err(|_| failed())?;
        Ok(Factors(lu))
    }

    /// K or its transpose times x.
    pub fn stiffness_times(&self, x: &[f64], is_transposed: bool) -> Vec<f64> {
        let mut product = vec![0.0; self.size];
        for column in 0..self.size {
            for at in self.starts[column]..self.starts[column + 1] {
                let (row, [_, stiffness, _]) = (self.rows[at], self.values[at]);
                let (to, from) = if is_transposed { (column, row) } else { (row, column) };
                product[to] += stiffness * x[from];
            }
        }
        product
    }

    /// Σ factor·matrix times x.
    pub fn times(&self, factors: [c64; 3], x: &[c64]) -> Vec<c64> {
        let mut product = vec![c64::new(0.0, 0.0); self.size];
        for (column, x) in x.iter().enumerate() {
            let scaled = factors.map(|factor| factor * x);
            for at in self.starts[column]..self.starts[column + 1] {
                let [m, k, d] = self.values[at];
                product[self.rows[at]] += scaled[0] * m + scaled[1] * k + scaled[2] * d;
            }
        }
        product
    }
}

/// Factors of a matrix.
pub struct Factors<T: ComplexField>(Lu<usize, T>);

impl<T: ComplexField + Copy> Factors<T> {
    pub fn solve(&self, b: &[T]) -> Vec<T> {
        let mut x = Mat::from_fn(b.len(), 1, |i, _| b[i]);
        self.0.solve_in_place(&mut x);
        (0..b.len()).map(|i| x[(i, 0)]).collect()
    }
}
