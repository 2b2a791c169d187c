//! A symmetric stiffness matrix in compressed rows.

use crate::solver::body::block::BlockMesh;
use crate::solver::body::hexahedron::ElementStiffness;
use crate::solver::error::SolverError;
use crate::solver::field::FieldOf;
use crate::solver::number::Number;
use std::collections::BTreeMap;

/// K, stored row by row with columns in ascending order.
#[derive(Debug, Clone)]
pub struct AssembledOperator {
    /// Index of each row's first entry in `columns` and `values`; one more element than rows.
    starts: Vec<usize>,
    columns: Vec<usize>,
    /// Entries \[N/m\].
    values: Vec<f64>,
}

impl AssembledOperator {
    /// K of size `dofs` × `dofs` from entries (row, column, value \[N/m\]). Entries at the same place are added.
    ///
    /// # Errors
    /// If an entry lies outside the matrix, or if K is not symmetric to the rounding of its sums.
    pub fn from_entries(
        dofs: usize,
        entries: impl IntoIterator<Item = (usize, usize, f64)>,
    ) -> Result<Self, SolverError> {
        let mut rows = vec![BTreeMap::<usize, f64>::new(); dofs];
        for (row, column, value) in entries {
            if row >= dofs || column >= dofs {
                return Err(SolverError::Stiffness(format!(
                    "entry ({row}, {column}) of a matrix with {dofs} degrees of freedom"
                )));
            }
            *rows[row].entry(column).or_default() += value;
        }
        let largest = rows.iter().flat_map(BTreeMap::values).fold(0.0, |a: f64, b| a.max(b.abs()));
        for (row, entries) in rows.iter().enumerate() {
            for (&column, value) in entries {
                let mirrored = rows[column].get(&row).copied().unwrap_or(0.0);
                if (value - mirrored).abs() > 1e-12 * largest {
                    return Err(SolverError::Stiffness(format!(
                        "entry ({row}, {column}) is {value:e} N/m but ({column}, {row}) is {mirrored:e} N/m; \
                         a stiffness is symmetric"
                    )));
                }
            }
        }
        let mut starts = vec![0];
        let (mut columns, mut values) = (Vec::new(), Vec::new());
        for entries in rows {
            columns.extend(entries.keys());
            values.extend(entries.values());
            starts.push(columns.len());
        }
        Ok(Self { starts, columns, values })
    }

    /// K of a block of equal elements.
    ///
    /// # Panics
    /// Never: the entries of a mesh lie inside the matrix, and an element's stiffness is symmetric.
    pub fn of_block(mesh: &BlockMesh, element: &ElementStiffness) -> Self {
        let entries = mesh.element_positions().flat_map(|[i, j, k]| {
            let nodes = mesh.element_nodes(i, j, k);
            let dof = move |d: usize| 3 * nodes[d / 3] + d % 3;
            (0..24).flat_map(move |r| (0..24).map(move |c| (dof(r), dof(c), element[(r, c)])))
        });
        Self::from_entries(3 * mesh.node_count(), entries).expect("a block's stiffness is symmetric")
    }

    /// Number of degrees of freedom.
    pub fn dofs(&self) -> usize {
        self.starts.len() - 1
    }

    /// The entries (column, value \[N/m\]) of one row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[row]..self.starts[row + 1];
        self.columns[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }

    /// Computes `y = K x` for `L` lanes. Rows are summed in f64.
    pub fn product<const L: usize, R: Number>(&self, x: &FieldOf<L, R>, y: &mut FieldOf<L, R>) {
        for row in 0..self.dofs() {
            let mut sum = [0.0; L];
            for (column, value) in self.row(row) {
                let x = x.at(x.place(column / 3), column % 3);
                for l in 0..L {
                    sum[l] += value * x[l].to_f64();
                }
            }
            *y.at_mut(y.place(row / 3), row % 3) = sum.map(R::from_f64);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::field::Field;

    /// Protects: entries at the same place are added, and rows are applied lane by lane.
    #[test]
    fn two_springs_in_a_row() {
        let spring = |a: usize, b: usize, k: f64| [(a, a, k), (a, b, -k), (b, a, -k), (b, b, k)];
        let mesh = BlockMesh::new([1.0; 3], [1, 1, 1]);
        let springs = [spring(0, 4, 2.0), spring(4, 23, 3.0)].concat();
        let k = AssembledOperator::from_entries(24, springs).unwrap();
        let mut x = Field::<2>::zeros(mesh.layout());
        let mut y = Field::<2>::zeros(mesh.layout());
        (x[0], x[9]) = (1.0, 1.0);
        k.product(&x, &mut y);
        let found = [0, 4, 23].map(|dof| [y[2 * dof], y[2 * dof + 1]]);
        assert_eq!(found, [[2.0, -2.0], [-2.0, 5.0], [0.0, -3.0]]);
    }

    /// Protects: a matrix that is not a stiffness matrix is refused, and the error names the entry.
    #[test]
    fn asymmetric_and_foreign_entries_are_refused() {
        let asymmetric = AssembledOperator::from_entries(2, [(0, 1, 1.0)]).unwrap_err().to_string();
        assert!(asymmetric.contains("(0, 1)"), "{asymmetric}");
        let foreign = AssembledOperator::from_entries(2, [(0, 2, 1.0)]).unwrap_err().to_string();
        assert!(foreign.contains("(0, 2)"), "{foreign}");
    }
}
