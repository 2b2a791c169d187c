//! A table of nodal values, such as the lumped mass, that are the same on all lines of a kind.

use super::BlockMesh;
use crate::solver::field::{Row, blocks_per_line};
use crate::solver::number::Number;

/// The values of the four kinds of lines: inside, on a face in y, on a face in z, on both. The padding is zero.
#[derive(Debug, Clone)]
pub(super) struct LineTable<R: Number> {
    rows: Vec<Row<R>>,
    /// Where a line's rows start.
    starts: Vec<usize>,
}

impl<R: Number> LineTable<R> {
    /// Evaluates `value` at the nodes of one line of each kind, for fields with `lanes` lanes.
    pub fn new(mesh: &BlockMesh, lanes: usize, value: impl Fn(usize) -> f64) -> Self {
        let [mx, my, mz] = mesh.nodes_per_axis();
        let blocks = blocks_per_line::<R>(mx, lanes);
        // Line (1, 1) is inside, unless the block is one element thick. Then no line is of this kind.
        let kinds = [[1, 1], [0, 1], [1, 0], [0, 0]];
        let mut rows = vec![Row::<R>::default(); kinds.len() * blocks];
        for (kind, [j, k]) in kinds.into_iter().enumerate() {
            for along in 0..mx * lanes {
                let row = &mut rows[kind * blocks + along / R::WIDTH].0;
                row[along % R::WIDTH] = R::from_f64(value(mesh.node(along / lanes, j, k)));
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
    pub fn row(&self, line: usize, along: usize) -> &R::Row {
        &self.rows[self.starts[line] + along].0
    }
}
