//! Nodal vector fields, laid out for vectors of eight numbers.
//!
//! A mesh line (nodes along x) of `L` lanes is one row of numbers per component, node → lane, padded
//! with zeros to whole [`Block`]s of eight. A block holds the three components one after the other.
//! Neighbours in x are `L` numbers away, neighbours in y and z whole lines, so every operation on
//! lines is the same for any lane count and its results have the same bits.

use super::lane::{LaneState, next};
use std::ops::{Index, IndexMut};

/// Numbers in a vector.
pub const WIDTH: usize = 8;

/// Eight consecutive numbers of each component of a line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub struct Block(pub [[f64; WIDTH]; 3]);

/// Eight consecutive numbers of a line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub struct Row(pub [f64; WIDTH]);

/// How many lines a field has, and how many nodes a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Nodes of a line.
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

/// Where the lanes of a node are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LaneSlot {
    block: usize,
    slot: usize,
}

/// A vector per node and lane. Indexed by (3·node + component)·L + lane, whatever the storage.
///
/// The padding of displacements and velocities is zero: it is a neighbour of the last node in a product. A
/// product leaves numbers in the padding of its result, which nothing may read; so fields are not compared.
#[derive(Debug, Clone)]
pub struct Field<const L: usize> {
    nodes_per_line: usize,
    blocks_per_line: usize,
    blocks: Vec<Block>,
}

/// The same numbers for every node: the lanes' values, slot by slot.
pub fn in_slots<const L: usize>(lanes: &[f64; L]) -> [f64; WIDTH] {
    std::array::from_fn(|slot| lanes[slot % L])
}

/// Adds the numbers of a block to those of their lanes, node after node.
///
/// All sums over nodes are made like this: first across the lines of a column of blocks, slot by slot, then
/// along the line. So their order, and with it their bits, is the same for any lane count.
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

    /// All zero.
    pub fn zeros(layout: Layout) -> Self {
        let () = Self::LANES_FILL_BLOCKS;
        let Layout { nodes_per_line, lines } = layout;
        let blocks_per_line = blocks_per_line::<L>(nodes_per_line);
        Self { nodes_per_line, blocks_per_line, blocks: vec![Block::default(); blocks_per_line * lines] }
    }

    /// From values in the order node → component → lane.
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

    /// Whether there is no value; a mesh has nodes, so never.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Σ over all nodes and components of this times another field of the same nodes.
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

    /// All blocks, line after line: y faster than z.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// All blocks. What a product will read must keep its padding zero.
    pub fn blocks_mut(&mut self) -> &mut [Block] {
        &mut self.blocks
    }

    /// Where a node is.
    pub fn place(&self, node: usize) -> LaneSlot {
        let along = node % self.nodes_per_line * L;
        let line = node / self.nodes_per_line;
        LaneSlot { block: line * self.blocks_per_line + along / WIDTH, slot: along % WIDTH }
    }

    /// The lanes of one component at a place.
    ///
    /// # Panics
    /// Never for a place of this field: lanes do not straddle blocks.
    pub fn at(&self, place: LaneSlot, component: usize) -> &[f64; L] {
        self.blocks[place.block].0[component][place.slot..]
            .first_chunk()
            .expect("lanes do not straddle blocks")
    }

    /// The lanes of one component at a place.
    ///
    /// # Panics
    /// Never for a place of this field: lanes do not straddle blocks.
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

    /// The padding of the lane becomes zero: a lane that has overflowed has left its mark there, too.
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
