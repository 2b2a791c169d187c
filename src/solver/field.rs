//! Nodal vector fields, laid out for SIMD vectors of eight numbers.
//!
//! A mesh line (nodes along x, or along θ in a ring) with `L` lanes is one row of numbers per component, ordered
//! node → lane and padded with zeros to whole [`Block`]s of eight. A block holds the three components one after the
//! other. Neighbours on a line are `L` numbers apart, and neighbours across lines are whole lines apart. So every
//! operation on lines is the same for any lane count, and its results have the same bits.

use super::lane::{LaneState, next};
use std::ops::{Index, IndexMut};

/// Number of f64 values in a SIMD vector.
pub const WIDTH: usize = 8;

/// Eight consecutive numbers of each component of a line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub struct Block(pub [[f64; WIDTH]; 3]);

/// Eight consecutive numbers of a line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub struct Row(pub [f64; WIDTH]);

/// Number of lines of a field, and number of nodes per line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Number of nodes per line.
    pub nodes_per_line: usize,
    /// Number of lines.
    pub lines: usize,
}

impl Layout {
    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes_per_line * self.lines
    }
}

/// Position of a node's lanes in a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LaneSlot {
    block: usize,
    slot: usize,
}

/// A vector per node and lane. It is indexed by (3·node + component)·L + lane, whatever the storage.
///
/// The padding of displacements and velocities is zero, because products read it as a neighbour of the last node. A
/// product leaves arbitrary numbers in the padding of its result. Nothing may read them, so fields are not
/// comparable.
#[derive(Debug, Clone)]
pub struct Field<const L: usize> {
    nodes_per_line: usize,
    blocks_per_line: usize,
    blocks: Vec<Block>,
}

/// Repeats the values of the lanes over the slots of a block, so that every node has the same values.
pub fn in_slots<const L: usize>(lanes: &[f64; L]) -> [f64; WIDTH] {
    std::array::from_fn(|slot| lanes[slot % L])
}

/// Adds the numbers of a block to the totals of their lanes, node after node.
///
/// All sums over nodes have this order: first across the lines of a column of blocks, slot by slot, then along the
/// line. So the order, and with it the bits, is the same for any lane count.
pub fn add_slots<const L: usize>(totals: &mut [f64; L], slots: &[f64; WIDTH]) {
    for nodes in slots.chunks_exact(L) {
        for (total, value) in totals.iter_mut().zip(nodes) {
            *total += value;
        }
    }
}

/// Number of blocks that hold a line of `nodes` nodes with `L` lanes.
pub fn blocks_per_line<const L: usize>(nodes: usize) -> usize {
    (nodes * L).div_ceil(WIDTH)
}

impl<const L: usize> Field<L> {
    const LANES_FILL_BLOCKS: () = assert!(L == 1 || L == 2 || L == 4 || L == 8, "1, 2, 4 or 8 lanes");

    /// A field of zeros.
    pub fn zeros(layout: Layout) -> Self {
        let () = Self::LANES_FILL_BLOCKS;
        let Layout { nodes_per_line, lines } = layout;
        let blocks_per_line = blocks_per_line::<L>(nodes_per_line);
        Self { nodes_per_line, blocks_per_line, blocks: vec![Block::default(); blocks_per_line * lines] }
    }

    /// A field of `values` in the order node → component → lane.
    ///
    /// # Panics
    /// If there is not one value per node, component and lane.
    pub fn from_values(layout: Layout, values: &[f64]) -> Self {
        assert_eq!(values.len(), 3 * L * layout.nodes(), "3 components of {L} lanes per node");
        let mut field = Self::zeros(layout);
        for (index, value) in values.iter().enumerate() {
            field[index] = *value;
        }
        field
    }

    /// The values in the order node → component → lane.
    pub fn values(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.len()).map(|index| self[index])
    }

    /// Number of values: three components of `L` lanes per node.
    pub fn len(&self) -> usize {
        3 * L * self.nodes_per_line * (self.blocks.len() / self.blocks_per_line)
    }

    /// Whether the field has no values. This is never true, because a mesh has nodes.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// The scalar product with another field of the same nodes, lane by lane: Σ over all nodes and components.
    pub fn dot(&self, other: &Self) -> [f64; L] {
        let mut columns = vec![Row::default(); self.blocks_per_line];
        for (at, (a, b)) in self.blocks.iter().zip(&other.blocks).enumerate() {
            let column = &mut columns[at % self.blocks_per_line].0;
            for i in 0..WIDTH {
                column[i] += a.0[0][i] * b.0[0][i] + a.0[1][i] * b.0[1][i] + a.0[2][i] * b.0[2][i];
            }
        }
        let mut total = [0.0; L];
        for column in &columns {
            add_slots(&mut total, &column.0);
        }
        total
    }

    /// Number of blocks that hold a line.
    pub fn blocks_per_line(&self) -> usize {
        self.blocks_per_line
    }

    /// All blocks, line after line in the order of the nodes.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// All blocks, mutable. The padding of a field that goes into a product must stay zero.
    pub fn blocks_mut(&mut self) -> &mut [Block] {
        &mut self.blocks
    }

    /// Sets the padding to zero, which a product leaves arbitrary.
    pub fn clear_padding(&mut self) {
        let numbers = self.nodes_per_line * L;
        for line in self.blocks.chunks_exact_mut(self.blocks_per_line) {
            for row in line[numbers / WIDTH..].iter_mut().take(1).flat_map(|block| &mut block.0) {
                row[numbers % WIDTH..].fill(0.0);
            }
        }
    }

    /// Position of a node's lanes.
    pub fn place(&self, node: usize) -> LaneSlot {
        let along = node % self.nodes_per_line * L;
        let line = node / self.nodes_per_line;
        LaneSlot { block: line * self.blocks_per_line + along / WIDTH, slot: along % WIDTH }
    }

    /// The values of all lanes for one component at `place`.
    ///
    /// # Panics
    /// Never for a place of this field: the lanes of a node are in one block.
    pub fn at(&self, place: LaneSlot, component: usize) -> &[f64; L] {
        self.blocks[place.block].0[component][place.slot..]
            .first_chunk()
            .expect("lanes do not straddle blocks")
    }

    /// The values of all lanes for one component at `place`, mutable.
    ///
    /// # Panics
    /// Never for a place of this field: the lanes of a node are in one block.
    pub fn at_mut(&mut self, place: LaneSlot, component: usize) -> &mut [f64; L] {
        self.blocks[place.block].0[component][place.slot..]
            .first_chunk_mut()
            .expect("lanes do not straddle blocks")
    }
}

impl<const L: usize> LaneState for Field<L> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        saved.extend((0..self.len() / L).map(|dof| self[dof * L + lane]));
    }

    /// Sets the lane's padding to zero as well, because a lane that overflowed leaves non-finite numbers there.
    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        for row in self.blocks.iter_mut().flat_map(|block| &mut block.0) {
            for value in row.iter_mut().skip(lane).step_by(L) {
                *value = 0.0;
            }
        }
        for dof in 0..self.len() / L {
            [self[dof * L + lane]] = next(saved);
        }
    }
}

impl<const L: usize> Index<usize> for Field<L> {
    type Output = f64;

    fn index(&self, index: usize) -> &f64 {
        let (dof, lane) = (index / L, index % L);
        &self.at(self.place(dof / 3), dof % 3)[lane]
    }
}

impl<const L: usize> IndexMut<usize> for Field<L> {
    fn index_mut(&mut self, index: usize) -> &mut f64 {
        let (dof, lane) = (index / L, index % L);
        &mut self.at_mut(self.place(dof / 3), dof % 3)[lane]
    }
}
