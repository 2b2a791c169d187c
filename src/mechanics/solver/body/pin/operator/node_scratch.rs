//! Numbers of nodes in the order node → component → lane, for operators that take nodes from anywhere.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::{BlockIndex, Pass};
use crate::solver::field::{Layout, blocks_per_line};
use crate::solver::number::Number;
use crate::solver::simd::load_all;
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;

/// Number of bytes of a cache line. Vectors begin at its boundaries.
const ALIGNMENT: usize = 64;

/// Scratch of a pass: displacements and forces.
#[derive(Debug)]
pub(super) struct NodeScratch<R: Number> {
    /// Number of lanes. It is no constant of the code, which is compiled once for all lane counts.
    pub(super) lanes: usize,
    pub(super) layout: Layout,
    /// Blocks per line.
    blocks: usize,
    x: Vec<R>,
    y: Vec<R>,
    /// The displacements without those of damping; empty if nothing asks for them, or if there is no damping.
    undamped: Vec<R>,
}

impl<R: Number> NodeScratch<R> {
    pub fn new(layout: Layout, lanes: usize) -> Self {
        let numbers = || vec![R::default(); 3 * lanes * layout.nodes + R::WIDTH];
        Self {
            lanes,
            layout,
            blocks: blocks_per_line::<R>(layout.nodes_per_line, lanes),
            x: numbers(),
            y: numbers(),
            undamped: Vec::new(),
        }
    }

    /// Displacements and forces.
    #[inline(always)]
    pub(super) fn fields(&mut self) -> [&mut [R]; 2] {
        self.all_fields().0
    }

    /// Displacements and forces, and the displacements without those of damping.
    #[inline(always)]
    pub(super) fn all_fields(&mut self) -> ([&mut [R]; 2], &[R]) {
        let first = [&self.x, &self.y].map(|field| field.as_ptr().align_offset(ALIGNMENT));
        ([&mut self.x[first[0]..], &mut self.y[first[1]..]], &self.undamped)
    }

    /// Sets all forces to zero.
    pub(super) fn clear(&mut self) {
        self.y.fill(R::default());
    }

    /// The nodes of a line.
    #[inline(always)]
    pub(super) fn nodes_of(&self, line: usize) -> Range<usize> {
        let Layout { nodes_per_line, nodes, .. } = self.layout;
        line * nodes_per_line..((line + 1) * nodes_per_line).min(nodes)
    }

    /// The nodes of a block.
    #[inline(always)]
    fn in_block(&self, line: usize, along: usize) -> Range<usize> {
        let nodes = self.nodes_of(line);
        let per_block = R::WIDTH / self.lanes;
        let start = (nodes.start + along * per_block).min(nodes.end);
        start..(start + per_block).min(nodes.end)
    }

    /// Reads the input of a pass.
    #[inline(always)]
    pub(super) fn read<S: Simd>(&mut self, simd: S, pass: &impl Pass<S, R>) {
        let lanes = self.lanes;
        for line in 0..self.layout.lines() {
            for along in 0..self.blocks {
                let input = pass.input(simd, line * self.blocks + along);
                let nodes = self.in_block(line, along);
                let [x, _] = self.fields();
                put::<S, R>(x, lanes, nodes, &input);
            }
        }
    }

    /// Reads the displacements of a pass without those of damping, if there is damping.
    #[inline(always)]
    pub(super) fn read_undamped<S: Simd>(&mut self, simd: S, pass: &impl Pass<S, R>) {
        for line in 0..self.layout.lines() {
            for along in 0..self.blocks {
                let Some(undamped) = pass.undamped(simd, line * self.blocks + along) else {
                    self.undamped.clear();
                    return;
                };
                self.undamped.resize(3 * self.lanes * self.layout.nodes, R::default());
                let nodes = self.in_block(line, along);
                put::<S, R>(&mut self.undamped, self.lanes, nodes, &undamped);
            }
        }
    }

    /// Gives the forces on a line to a pass.
    #[inline(always)]
    pub(super) fn give<S: Simd>(&mut self, simd: S, line: usize, pass: &mut impl Pass<S, R>) {
        let lanes = self.lanes;
        for along in 0..self.blocks {
            let nodes = self.in_block(line, along);
            let index = BlockIndex {
                plane: line / self.layout.lines_per_plane,
                line,
                along,
                at: line * self.blocks + along,
            };
            let [_, y] = self.fields();
            let mut rows = [R::Row::default(); 3];
            for (slot, node) in nodes.enumerate() {
                for (c, row) in rows.iter_mut().enumerate() {
                    row.as_mut()[slot * lanes..][..lanes]
                        .copy_from_slice(&y[(3 * node + c) * lanes..][..lanes]);
                }
            }
            pass.output(simd, index, load_all::<R, S>(simd, &rows));
        }
    }
}

/// Puts the numbers of a block to its nodes.
#[inline(always)]
fn put<S: Simd, R: Number>(x: &mut [R], lanes: usize, nodes: Range<usize>, block: &[R::Vector<S>; 3]) {
    for c in 0..3 {
        let row: R::Row = block[c].to_array();
        for (slot, node) in nodes.clone().enumerate() {
            x[(3 * node + c) * lanes..][..lanes].copy_from_slice(&row.as_ref()[slot * lanes..][..lanes]);
        }
    }
}

impl<R: Number> Clone for NodeScratch<R> {
    /// Makes fresh scratch.
    fn clone(&self) -> Self {
        Self::new(self.layout, self.lanes)
    }
}
