//! A table of nodal values, such as the lumped mass, that are the same on all lines of a kind.

use super::BlockMesh;
use crate::solver::field::{Row, WIDTH, blocks_per_line};

/// The values of the four kinds of lines: inside, on a face in y, on a face in z, on both. The padding is zero.
#[derive(Debug, Clone)]
pub(super) struct LineTable<const L: usize> {
    rows: Vec<Row>,
    /// Where a line's rows start.
    starts: Vec<usize>,
}

impl<const L: usize> LineTable<L> {
    /// Evaluates `value` at the nodes of one line of each kind.
    pub fn new(mesh: &BlockMesh, value: impl Fn(usize) -> f64) -> Self {
        let [mx, my, mz] = mesh.nodes_per_axis();
        let blocks = blocks_per_line::<L>(mx);
        // Line (1, 1) is inside, unless the block is one element thick. Then no line is of this kind.
        let kinds = [[1, 1], [0, 1], [1, 0], [0, 0]];
        let mut rows = vec![Row::default(); kinds.len() * blocks];
        for (kind, [j, k]) in kinds.into_iter().enumerate() {
            for along in 0..mx * L {
                rows[kind * blocks + along / WIDTH].0[along % WIDTH] = value(mesh.node(along / L, j, k));
            }
        }
        let on_face = |index: usize, nodes: usize| usize::from(index == 0 || index + 1 == nodes);
        let starts = (0..mz)
            .flat_map(|k| (0..my).map(move |j| (on_face(j, my) + 2 * on_face(k, mz)) * blocks))
            .collect();
        Self { rows, starts }
    }

    /// The values of block `along` of a line.
    #[inline]
    pub fn row(&self, line: usize, along: usize) -> &[f64; WIDTH] {
        &self.rows[self.starts[line] + along].0
    }
}
