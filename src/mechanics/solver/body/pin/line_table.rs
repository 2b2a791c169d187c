//! A table of nodal values, such as the lumped mass, that are the same on all lines of a kind.

use super::PinMesh;
use crate::solver::field::{Row, blocks_per_line};
use crate::solver::number::Number;

/// The values of each kind of lines. A block has four kinds: inside, on a face in y, on a face in z, on both. On a general mesh
/// every line is of its own kind. The padding is zero.
#[derive(Debug, Clone)]
pub(super) struct LineTable<R: Number> {
    rows: Vec<Row<R>>,
    /// Where a line's rows start.
    starts: Vec<usize>,
}

impl<R: Number> LineTable<R> {
    /// Evaluates `value` at the nodes of one line of each kind, for fields with `lanes` lanes.
    pub fn new(mesh: &PinMesh, lanes: usize, value: impl Fn(usize) -> f64) -> Self {
        let layout = mesh.layout();
        let blocks = blocks_per_line::<R>(layout.nodes_per_line, lanes);
        // A line of each kind, and the kind of each line.
        let (examples, kinds): (Vec<usize>, Vec<usize>) = match mesh.block() {
            None => ((0..layout.lines()).collect(), (0..layout.lines()).collect()),
            Some(mesh) => {
                let [_, my, mz] = mesh.nodes_per_axis();
                let on_face = |index: usize, nodes: usize| usize::from(index == 0 || index + 1 == nodes);
                let kind = |line: usize| on_face(line % my, my) + 2 * on_face(line / my, mz);
                // Line (1, 1) is inside, unless the block is one element thick. Then no line is of this kind.
                let examples = [[1, 1], [0, 1], [1, 0], [0, 0]].map(|[j, k]| j + my * k);
                (examples.to_vec(), (0..layout.lines()).map(kind).collect())
            }
        };
        let mut rows = vec![Row::<R>::default(); examples.len() * blocks];
        for (kind, line) in examples.into_iter().enumerate() {
            let first = line * layout.nodes_per_line;
            for along in 0..layout.nodes_per_line.min(layout.nodes - first) * lanes {
                let row = &mut rows[kind * blocks + along / R::WIDTH].0;
                row[along % R::WIDTH] = R::from_f64(value(first + along / lanes));
            }
        }
        Self { rows, starts: kinds.into_iter().map(|kind| kind * blocks).collect() }
    }

    /// The values of block `along` of a line.
    #[inline]
    pub fn row(&self, line: usize, along: usize) -> &R::Row {
        &self.rows[self.starts[line] + along].0
    }
}
