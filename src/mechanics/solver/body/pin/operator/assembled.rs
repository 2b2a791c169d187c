//! A symmetric stiffness matrix of 3 × 3 blocks, one for each pair of nodes that act on each other.
//!
//! Only the blocks on and above the diagonal are stored. A pass goes through the nodes in their order. At node i it adds the
//! block (i, j) to row i and its transpose to row j. So row i is complete after node i, and each number of K is read once for
//! all lanes. The lanes of a node are one vector.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::Pass;
use super::node_scratch::NodeScratch;
use crate::solver::body::hexahedron::ElementStiffness;
use crate::solver::body::pin::BlockMesh;
use crate::solver::error::SolverError;
use crate::solver::number::{Few, LaneVector, Number};
use fearless_simd::Simd;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::OnceLock;

/// The block of a pair of nodes, row by row \[N/m\].
type Pair<R> = [R; 9];

/// K by pairs of nodes.
#[derive(Debug, Clone)]
pub struct AssembledOperator {
    /// Index of each node's first pair, which is the node with itself; one more element than nodes.
    starts: Vec<usize>,
    /// The second node of each pair, ascending for each first node, never less than it.
    others: Vec<u32>,
    pairs: Vec<Pair<f64>>,
    /// The same in single precision, for runs that need it.
    rounded: OnceLock<Vec<Pair<f32>>>,
}

impl AssembledOperator {
    /// K of `nodes` nodes from entries (row, column, value \[N/m\]). Rows and columns are 3·node + component. Entries at the
    /// same place are added.
    ///
    /// # Errors
    /// If an entry lies outside the matrix, or if K is not symmetric to the rounding of its sums.
    pub fn from_entries(
        nodes: usize,
        entries: impl IntoIterator<Item = (usize, usize, f64)>,
    ) -> Result<Self, SolverError> {
        let dofs = 3 * nodes;
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
        let mut pairs = vec![BTreeMap::<usize, Pair<f64>>::new(); nodes];
        for (row, entries) in rows.iter().enumerate() {
            for (&column, value) in entries {
                let mirrored = rows[column].get(&row).copied().unwrap_or(0.0);
                if (value - mirrored).abs() > 1e-12 * largest {
                    return Err(SolverError::Stiffness(format!(
                        "entry ({row}, {column}) is {value:e} N/m but ({column}, {row}) is {mirrored:e} N/m; \
                         a stiffness is symmetric"
                    )));
                }
                if row / 3 <= column / 3 {
                    pairs[row / 3].entry(column / 3).or_default()[3 * (row % 3) + column % 3] = *value;
                }
            }
        }
        Ok(Self::of_pairs(pairs))
    }

    /// K of elements on a mesh of `nodes` nodes.
    ///
    /// # Panics
    /// If an element has a node that does not exist.
    pub fn of_elements(
        nodes: usize,
        elements: impl IntoIterator<Item = ([usize; 8], ElementStiffness)>,
    ) -> Self {
        let mut pairs = vec![BTreeMap::<usize, Pair<f64>>::new(); nodes];
        for (corners, stiffness) in elements {
            for (a, &first) in corners.iter().enumerate() {
                for (b, &second) in corners.iter().enumerate() {
                    if first <= second {
                        let pair = pairs[first].entry(second).or_default();
                        for (place, entry) in pair.iter_mut().enumerate() {
                            *entry += stiffness[(3 * a + place / 3, 3 * b + place % 3)];
                        }
                    }
                }
            }
        }
        Self::of_pairs(pairs)
    }

    /// K of a block of equal elements.
    pub fn of_block(mesh: &BlockMesh, element: &ElementStiffness) -> Self {
        let elements = mesh.element_positions().map(|[i, j, k]| (mesh.element_nodes(i, j, k), *element));
        Self::of_elements(mesh.node_count(), elements)
    }

    fn of_pairs(mut rows: Vec<BTreeMap<usize, Pair<f64>>>) -> Self {
        let mut operator =
            Self { starts: vec![0], others: Vec::new(), pairs: Vec::new(), rounded: OnceLock::new() };
        for (node, row) in rows.iter_mut().enumerate() {
            row.entry(node).or_default();
            operator.others.extend(row.keys().map(|&other| other as u32));
            operator.pairs.extend(row.values());
            operator.starts.push(operator.pairs.len());
        }
        operator
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.starts.len() - 1
    }

    /// The entries (column, value \[N/m\]) of every row, columns ascending.
    pub fn rows(&self) -> Vec<Vec<(usize, f64)>> {
        let mut rows = vec![Vec::new(); 3 * self.nodes()];
        for (row, column, value) in self.entries() {
            rows[row].push((column, value));
        }
        for row in &mut rows {
            row.sort_unstable_by_key(|&(column, _)| column);
        }
        rows
    }

    /// All entries (row, column, value \[N/m\]) of the whole matrix.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        (0..self.nodes()).flat_map(move |node| self.range(node).map(move |at| (node, at))).flat_map(
            move |(node, at)| {
                let other = self.others[at] as usize;
                (0..9).flat_map(move |place| {
                    let (row, column) = (3 * node + place / 3, 3 * other + place % 3);
                    let value = self.pairs[at][place];
                    let mirrored = (node != other).then_some((column, row, value));
                    std::iter::once((row, column, value)).chain(mirrored)
                })
            },
        )
    }

    fn range(&self, node: usize) -> Range<usize> {
        self.starts[node]..self.starts[node + 1]
    }

    /// One pass over the mesh.
    #[inline(always)]
    pub(super) fn pass<S: Simd, R: Number>(
        &self,
        simd: S,
        pass: &mut impl Pass<S, R>,
        scratch: &mut NodeScratch<R>,
    ) {
        match scratch.lanes {
            8 => self.pass_in::<S, R, R::Eight<S>>(simd, pass, scratch),
            4 => self.pass_in::<S, R, R::Four<S>>(simd, pass, scratch),
            2 => self.pass_in::<S, R, R::Two<S>>(simd, pass, scratch),
            _ => self.pass_in::<S, R, Few<R, 1>>(simd, pass, scratch),
        }
    }

    #[inline(always)]
    fn pass_in<S: Simd, R: Number, V: LaneVector<S, R>>(
        &self,
        simd: S,
        pass: &mut impl Pass<S, R>,
        scratch: &mut NodeScratch<R>,
    ) {
        let pairs = R::of_both(&self.pairs, || {
            self.rounded.get_or_init(|| self.pairs.iter().map(|pair| pair.map(|k| k as f32)).collect())
        });
        scratch.read(simd, pass);
        scratch.clear();
        for line in 0..scratch.layout.lines() {
            let nodes = scratch.nodes_of(line);
            let [x, y] = scratch.fields();
            self.complete::<S, R, V>(simd, pairs, x, y, nodes);
            scratch.give(simd, line, pass);
        }
    }

    /// Completes the rows of some nodes.
    #[inline(always)]
    fn complete<S: Simd, R: Number, V: LaneVector<S, R>>(
        &self,
        simd: S,
        pairs: &[Pair<R>],
        x: &[R],
        y: &mut [R],
        nodes: Range<usize>,
    ) {
        let size = 3 * V::LANES;
        let all = |value: R| V::all(simd, value);
        let read = |from: &[R]| -> [V; 3] {
            let (a, rest) = from.split_at(V::LANES);
            let (b, c) = rest.split_at(V::LANES);
            [V::read(simd, a), V::read(simd, b), V::read(simd, c)]
        };
        for node in nodes {
            let own_x = read(&x[size * node..][..size]);
            let mut own_y = read(&y[size * node..][..size]);
            let range = self.range(node);
            let (others, pairs) = (&self.others[range.clone()], &pairs[range]);
            for (number, (&other, k)) in others.iter().zip(pairs).enumerate() {
                let other = other as usize;
                let other_x = read(&x[size * other..][..size]);
                let k: [V; 9] = [
                    all(k[0]),
                    all(k[1]),
                    all(k[2]),
                    all(k[3]),
                    all(k[4]),
                    all(k[5]),
                    all(k[6]),
                    all(k[7]),
                    all(k[8]),
                ];
                for c in 0..3 {
                    own_y[c] = own_y[c]
                        + (k[3 * c] * other_x[0] + k[3 * c + 1] * other_x[1] + k[3 * c + 2] * other_x[2]);
                }
                // The first pair is the node with itself.
                if number > 0 {
                    let target = &mut y[size * other..][..size];
                    let mut other_y = read(target);
                    for c in 0..3 {
                        other_y[c] =
                            other_y[c] + (k[c] * own_x[0] + k[3 + c] * own_x[1] + k[6 + c] * own_x[2]);
                        other_y[c].write(&mut target[c * V::LANES..][..V::LANES]);
                    }
                }
            }
            let target = &mut y[size * node..][..size];
            for c in 0..3 {
                own_y[c].write(&mut target[c * V::LANES..][..V::LANES]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Operator, Scratch};
    use super::*;
    use crate::solver::field::{Field, FieldOf, Layout};

    /// Protects: entries at the same place are added, and rows are applied lane by lane.
    #[test]
    fn two_springs_in_a_row() {
        let spring = |a: usize, b: usize, k: f64| [(a, a, k), (a, b, -k), (b, a, -k), (b, b, k)];
        let layout = BlockMesh::new([1.0; 3], [1, 1, 1]).layout();
        let springs = [spring(0, 4, 2.0), spring(4, 23, 3.0)].concat();
        let k = Operator::Assembled(AssembledOperator::from_entries(8, springs).unwrap());
        let mut x = Field::<2>::zeros(layout);
        let mut y = Field::<2>::zeros(layout);
        (x[0], x[9]) = (1.0, 1.0);
        k.tangent(&x, &mut y, &mut k.scratch(layout, 2));
        let found = [0, 4, 23].map(|dof| [y[2 * dof], y[2 * dof + 1]]);
        assert_eq!(found, [[2.0, -2.0], [-2.0, 5.0], [0.0, -3.0]]);
    }

    /// Protects: a matrix that is not a stiffness matrix is refused, and the error names the entry.
    #[test]
    fn asymmetric_and_foreign_entries_are_refused() {
        let asymmetric = AssembledOperator::from_entries(1, [(0, 1, 1.0)]).unwrap_err().to_string();
        assert!(asymmetric.contains("(0, 1)"), "{asymmetric}");
        let foreign = AssembledOperator::from_entries(1, [(0, 3, 1.0)]).unwrap_err().to_string();
        assert!(foreign.contains("(0, 3)"), "{foreign}");
    }

    /// Sums of a matrix with dense rows, for lanes of which each is a multiple of the first.
    fn products<const L: usize, R: Number>(layout: Layout, k: &Operator) -> Vec<Vec<f64>> {
        let mut x = FieldOf::<L, R>::zeros(layout);
        for dof in 0..3 * layout.nodes {
            for lane in 0..L {
                x[dof * L + lane] = R::from_f64(((dof * 7919) % 101) as f64 - 50.0 + (lane % 2) as f64);
            }
        }
        let mut y = FieldOf::zeros(layout);
        let mut scratch: Scratch<R> = k.scratch(layout, L);
        k.tangent(&x, &mut y, &mut scratch);
        (0..L).map(|lane| (0..3 * layout.nodes).map(|dof| y[dof * L + lane].to_f64()).collect()).collect()
    }

    /// Protects: a lane has the same bits for every number of lanes, on lines that do not fill their vectors and with a last
    /// line that is short.
    #[test]
    fn lanes_have_the_same_bits_whatever_their_number() {
        let nodes = 23;
        let layout = Layout { nodes_per_line: 5, lines_per_plane: 1, nodes };
        let entries = (0..3 * nodes).flat_map(|i| {
            (0..3 * nodes)
                .map(move |j| (i, j, 1.0 / (1.0 + (i as f64 - j as f64).powi(2)) + 0.1 * (i * j) as f64))
        });
        let k = Operator::Assembled(AssembledOperator::from_entries(nodes, entries).unwrap());
        let single =
            [products::<8, f32>(layout, &k), products::<4, f32>(layout, &k), products::<2, f32>(layout, &k)];
        let double =
            [products::<8, f64>(layout, &k), products::<4, f64>(layout, &k), products::<2, f64>(layout, &k)];
        for found in [single, double] {
            for few in &found[1..] {
                assert_eq!(few[..], found[0][..few.len()]);
            }
        }
        assert_eq!(products::<1, f64>(layout, &k)[0], products::<8, f64>(layout, &k)[0]);
        assert_eq!(products::<1, f32>(layout, &k)[0], products::<8, f32>(layout, &k)[0]);
    }
}
