//! A number per node that depends on the line's faces alone, such as the lumped mass.

use super::BlockMesh;
use crate::solver::field::{Row, WIDTH, blocks_per_line};

/// The rows of the four kinds of lines (inside, on a face in y, on a face in z, on both), zero in the padding.
#[derive(Debug, Clone)]
pub(super) struct LineTable<const L: usize> {
    rows: Vec<Row>,
    /// Where a line's rows start.
    starts: Vec<usize>,
}

impl<const L: usize> LineTable<L> {
    /// `value` is asked for one line of each kind, node by node.
    pub fn new(mesh: &BlockMesh, value: impl Fn(usize) -> f64) -> Self {
        let [mx, my, mz] = mesh.nodes_per_axis();
        let blocks = blocks_per_line::<L>(mx);
        // (1, 1) is inside unless the block is one element thick, and then no line asks for it.
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

    /// The numbers of a block.
    #[inline]
    pub fn row(&self, line: usize, along: usize) -> &[f64; WIDTH] {
        &self.rows[self.starts[line] + along].0
    }
}
