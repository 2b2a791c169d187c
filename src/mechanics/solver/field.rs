//! Nodal vector fields, laid out for SIMD vectors of 64 bytes: eight numbers in double precision, sixteen in single.
//!
//! A mesh line (nodes along x, or along θ in a ring) with `L` lanes is one row of numbers per component, ordered
//! node → lane and padded with zeros to whole [`Block`]s of one vector. A block holds the three components one after
//! the other. Neighbours on a line are `L` numbers apart, and neighbours across lines are whole lines apart. So every
//! operation on lines is the same for any lane count, and its results have the same bits.

use super::lane::{LaneState, next};
use super::number::Number;
use std::ops::{Index, IndexMut};

/// Number of f64 values in a SIMD vector of a field in double precision.
pub const WIDTH: usize = 8;

/// Consecutive numbers of each component of a line, one vector each.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub struct Block<R: Number = f64>(pub [R::Row; 3]);

/// Consecutive numbers of a line, one vector.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub struct Row<R: Number = f64>(pub R::Row);

/// Nodes in lines, and lines in planes. The last line may have fewer nodes than the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Number of nodes per line.
    pub nodes_per_line: usize,
    /// Number of lines per plane.
    pub lines_per_plane: usize,
    /// Number of nodes.
    pub nodes: usize,
}

impl Layout {
    /// Number of lines.
    pub fn lines(&self) -> usize {
        self.nodes.div_ceil(self.nodes_per_line)
    }

    /// Number of planes.
    pub fn planes(&self) -> usize {
        self.lines().div_ceil(self.lines_per_plane)
    }

    /// The plane of a node.
    pub fn plane_of(&self, node: usize) -> usize {
        node / (self.nodes_per_line * self.lines_per_plane)
    }

    /// The layout of the first plane.
    #[must_use]
    pub fn first_plane(&self) -> Self {
        Self { nodes: self.nodes_per_line * self.lines_per_plane, ..*self }
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
pub struct FieldOf<const L: usize, R: Number> {
    nodes_per_line: usize,
    nodes: usize,
    blocks_per_line: usize,
    blocks: Vec<Block<R>>,
}

/// A field in double precision.
pub type Field<const L: usize> = FieldOf<L, f64>;

/// Repeats the values of the lanes over the slots of a block, so that every node has the same values.
pub fn in_slots<const L: usize>(lanes: &[f64; L]) -> [f64; WIDTH] {
    std::array::from_fn(|slot| lanes[slot % L])
}

/// As [`in_slots`], in the precision of a field.
pub fn in_slots_of<R: Number>(lanes: &[f64]) -> R::Row {
    let mut row = R::Row::default();
    for (slot, value) in row.as_mut().iter_mut().enumerate() {
        *value = R::from_f64(lanes[slot % lanes.len()]);
    }
    row
}

/// Adds the numbers of a block to the totals of their lanes, node after node.
///
/// All sums over nodes have this order: first across the lines of a column of blocks, slot by slot, then along the
/// line. So the order, and with it the bits, is the same for any lane count. In single precision the sum across lines is
/// in f32 for at most one plane of nodes or one face. All other sums are in f64.
///
/// # Panics
/// If there are not 1, 2, 4 or 8 lanes.
pub fn add_slots<R: Number>(totals: &mut [f64], slots: &[R]) {
    fold_slots(totals, slots, |total, value| total + value);
}

/// Combines the numbers of a block with the totals of their lanes, in the order of [`add_slots`].
///
/// # Panics
/// If there are not 1, 2, 4 or 8 lanes.
#[inline]
pub fn fold_slots<R: Number>(totals: &mut [f64], slots: &[R], fold: impl Fn(f64, f64) -> f64) {
    fn fold_lanes<const L: usize, R: Number>(
        totals: &mut [f64],
        slots: &[R],
        fold: impl Fn(f64, f64) -> f64,
    ) {
        for nodes in slots.chunks_exact(L) {
            for lane in 0..L {
                totals[lane] = fold(totals[lane], nodes[lane].to_f64());
            }
        }
    }
    // A loop over a number of lanes that the compiler knows is several times as fast.
    match totals.len() {
        1 => fold_lanes::<1, R>(totals, slots, fold),
        2 => fold_lanes::<2, R>(totals, slots, fold),
        4 => fold_lanes::<4, R>(totals, slots, fold),
        8 => fold_lanes::<8, R>(totals, slots, fold),
        lanes => panic!("{lanes} lanes"),
    }
}

/// Number of blocks that hold a line of `nodes` nodes with `lanes` lanes.
pub fn blocks_per_line<R: Number>(nodes: usize, lanes: usize) -> usize {
    (nodes * lanes).div_ceil(R::WIDTH)
}

impl<const L: usize, R: Number> FieldOf<L, R> {
    const LANES_FILL_BLOCKS: () = assert!(L == 1 || L == 2 || L == 4 || L == 8, "1, 2, 4 or 8 lanes");

    /// A field of zeros.
    pub fn zeros(layout: Layout) -> Self {
        let () = Self::LANES_FILL_BLOCKS;
        let Layout { nodes_per_line, nodes, .. } = layout;
        let blocks_per_line = blocks_per_line::<R>(nodes_per_line, L);
        let blocks = vec![Block::default(); blocks_per_line * layout.lines()];
        Self { nodes_per_line, nodes, blocks_per_line, blocks }
    }

    /// A field of `values` in the order node → component → lane.
    ///
    /// # Panics
    /// If there is not one value per node, component and lane.
    pub fn from_values(layout: Layout, values: &[f64]) -> Self {
        assert_eq!(values.len(), 3 * L * layout.nodes, "3 components of {L} lanes per node");
        let mut field = Self::zeros(layout);
        for (index, value) in values.iter().enumerate() {
            field[index] = R::from_f64(*value);
        }
        field
    }

    /// The values in the order node → component → lane.
    pub fn values(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.len()).map(|index| self[index].to_f64())
    }

    /// Number of values: three components of `L` lanes per node.
    pub fn len(&self) -> usize {
        3 * L * self.nodes
    }

    /// Whether the field has no values. This is never true, because a mesh has nodes.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// The scalar product with another field of the same nodes, lane by lane: Σ over all nodes and components.
    pub fn dot(&self, other: &Self) -> [f64; L] {
        let mut columns = vec![R::Totals::default(); self.blocks_per_line];
        for (at, (a, b)) in self.blocks.iter().zip(&other.blocks).enumerate() {
            let column = columns[at % self.blocks_per_line].as_mut();
            for i in 0..R::WIDTH {
                let form = a.0[0][i] * b.0[0][i] + a.0[1][i] * b.0[1][i] + a.0[2][i] * b.0[2][i];
                column[i] += form.to_f64();
            }
        }
        let mut total = [0.0; L];
        for column in &columns {
            add_slots(&mut total, column.as_ref());
        }
        total
    }

    /// Number of blocks that hold a line.
    pub fn blocks_per_line(&self) -> usize {
        self.blocks_per_line
    }

    /// All blocks, line after line in the order of the nodes.
    pub fn blocks(&self) -> &[Block<R>] {
        &self.blocks
    }

    /// All blocks, mutable. The padding of a field that goes into a product must stay zero.
    pub fn blocks_mut(&mut self) -> &mut [Block<R>] {
        &mut self.blocks
    }

    /// Sets the padding to zero, which a product leaves arbitrary.
    pub fn clear_padding(&mut self) {
        for (number, line) in self.blocks.chunks_exact_mut(self.blocks_per_line).enumerate() {
            let numbers = L * self.nodes_per_line.min(self.nodes - number * self.nodes_per_line);
            let mut from = numbers % R::WIDTH;
            for block in &mut line[numbers / R::WIDTH..] {
                for row in &mut block.0 {
                    row.as_mut()[from..].fill(R::default());
                }
                from = 0;
            }
        }
    }

    /// Position of a node's lanes.
    pub fn place(&self, node: usize) -> LaneSlot {
        let along = node % self.nodes_per_line * L;
        let line = node / self.nodes_per_line;
        LaneSlot { block: line * self.blocks_per_line + along / R::WIDTH, slot: along % R::WIDTH }
    }

    /// The values of all lanes for one component at `place`.
    ///
    /// # Panics
    /// Never for a place of this field: the lanes of a node are in one block.
    pub fn at(&self, place: LaneSlot, component: usize) -> &[R; L] {
        self.blocks[place.block].0[component].as_ref()[place.slot..]
            .first_chunk()
            .expect("lanes do not straddle blocks")
    }

    /// The values of all lanes for one component at `place`, mutable.
    ///
    /// # Panics
    /// Never for a place of this field: the lanes of a node are in one block.
    pub fn at_mut(&mut self, place: LaneSlot, component: usize) -> &mut [R; L] {
        self.blocks[place.block].0[component].as_mut()[place.slot..]
            .first_chunk_mut()
            .expect("lanes do not straddle blocks")
    }
}

impl<const L: usize, R: Number> LaneState for FieldOf<L, R> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        saved.extend((0..self.len() / L).map(|dof| self[dof * L + lane].to_f64()));
    }

    /// Sets the lane's padding to zero as well, because a lane that overflowed leaves non-finite numbers there.
    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        for row in self.blocks.iter_mut().flat_map(|block| &mut block.0) {
            for value in row.as_mut().iter_mut().skip(lane).step_by(L) {
                *value = R::default();
            }
        }
        for dof in 0..self.len() / L {
            let [value] = next(saved);
            self[dof * L + lane] = R::from_f64(value);
        }
    }
}

impl<const L: usize, R: Number> Index<usize> for FieldOf<L, R> {
    type Output = R;

    fn index(&self, index: usize) -> &R {
        let (dof, lane) = (index / L, index % L);
        &self.at(self.place(dof / 3), dof % 3)[lane]
    }
}

impl<const L: usize, R: Number> IndexMut<usize> for FieldOf<L, R> {
    fn index_mut(&mut self, index: usize) -> &mut R {
        let (dof, lane) = (index / L, index % L);
        &mut self.at_mut(self.place(dof / 3), dof % 3)[lane]
    }
}
