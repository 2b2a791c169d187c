//! The stiffness operator: y = K x.
//!
//! * [`TensorOperator`] – K of a uniform elastic block as a sum of tensor products. It is the fastest form.
//! * [`AssembledOperator`] – any symmetric K, by pairs of nodes. It serves general meshes, discrete springs and masses, and the
//!   tests compare the other form with it.
//!
//! Both give K x block by block in one pass over the mesh.

mod assembled;
mod tensor;
#[cfg(test)]
mod tests;

pub use assembled::AssembledOperator;
use assembled::AssembledScratch;
pub use tensor::TensorOperator;
use tensor::TensorScratch;

use crate::solver::field::{Block, FieldOf, Layout, add_slots, blocks_per_line};
use crate::solver::number::Number;
use crate::solver::simd::{dispatch, load_all};
use fearless_simd::{Simd, prelude::*};

/// K in one of its forms.
#[derive(Debug, Clone)]
pub enum Operator {
    /// K of a uniform elastic block.
    Tensor(TensorOperator),
    /// K by pairs of nodes.
    Assembled(AssembledOperator),
}

/// Position of a block.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct BlockIndex {
    /// Plane of nodes, from the contact face upwards.
    pub plane: usize,
    /// Line of nodes.
    pub line: usize,
    /// Block along the line.
    pub along: usize,
    /// Index of the block in its field.
    pub at: usize,
}

/// The input and the output of a product, block by block.
pub(in crate::solver) trait Pass<S: Simd, R: Number> {
    /// The three components of x in block `at`.
    fn input(&self, simd: S, at: usize) -> [R::Vector<S>; 3];
    /// Takes the three components of K x in a block. The inputs of its plane and of those below are not read again,
    /// so it may overwrite them. Planes come in their order.
    fn output(&mut self, simd: S, index: BlockIndex, kx: [R::Vector<S>; 3]);
}

/// Scratch of products with an operator.
#[derive(Debug, Clone)]
pub struct Scratch<R: Number = f64> {
    form: ScratchOf<R>,
    /// x·Kx by columns of blocks.
    forms: Vec<R::Totals>,
}

#[derive(Debug, Clone)]
enum ScratchOf<R: Number> {
    Tensor(TensorScratch<R>),
    Assembled(AssembledScratch<R>),
}

impl Operator {
    /// Scratch for products of fields with `lanes` lanes.
    pub fn scratch<R: Number>(&self, layout: Layout, lanes: usize) -> Scratch<R> {
        let form = match self {
            Self::Tensor(_) => ScratchOf::Tensor(TensorScratch::new(layout, lanes)),
            Self::Assembled(_) => ScratchOf::Assembled(AssembledScratch::new(layout, lanes)),
        };
        Scratch {
            form,
            forms: vec![R::Totals::default(); blocks_per_line::<R>(layout.nodes_per_line, lanes)],
        }
    }

    /// Computes `y = K x` for `L` lanes and returns x·y.
    ///
    /// # Panics
    /// If the scratch is that of another operator.
    pub fn product<const L: usize, R: Number>(
        &self,
        x: &FieldOf<L, R>,
        y: &mut FieldOf<L, R>,
        scratch: &mut Scratch<R>,
    ) -> [f64; L] {
        let mut forms = std::mem::take(&mut scratch.forms);
        forms.fill(R::Totals::default());
        let mut product = Product { x: x.blocks(), y: y.blocks_mut(), forms: &mut forms };
        self.multiply(&mut product, scratch);
        let mut total = [0.0; L];
        for slots in &forms {
            add_slots(&mut total, slots.as_ref());
        }
        scratch.forms = forms;
        total
    }

    fn multiply<R: Number>(&self, product: &mut Product<'_, R>, scratch: &mut Scratch<R>) {
        dispatch!(simd => self.pass(simd, product, scratch));
    }

    /// One pass over the mesh.
    ///
    /// # Panics
    /// If the scratch is that of another operator.
    #[expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]
    #[inline(always)]
    pub(in crate::solver) fn pass<S: Simd, R: Number>(
        &self,
        simd: S,
        pass: &mut impl Pass<S, R>,
        scratch: &mut Scratch<R>,
    ) {
        match (self, &mut scratch.form) {
            (Self::Tensor(operator), ScratchOf::Tensor(scratch)) => operator.pass(simd, pass, scratch),
            (Self::Assembled(operator), ScratchOf::Assembled(scratch)) => operator.pass(simd, pass, scratch),
            _ => panic!("the scratch of another operator"),
        }
    }
}

struct Product<'a, R: Number> {
    x: &'a [Block<R>],
    y: &'a mut [Block<R>],
    /// x·y, summed by columns of blocks.
    forms: &'a mut [R::Totals],
}

#[expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]
impl<S: Simd, R: Number> Pass<S, R> for Product<'_, R> {
    #[inline(always)]
    fn input(&self, simd: S, at: usize) -> [R::Vector<S>; 3] {
        load_all::<R, S>(simd, &self.x[at].0)
    }

    #[inline(always)]
    fn output(&mut self, simd: S, index: BlockIndex, kx: [R::Vector<S>; 3]) {
        let x = load_all::<R, S>(simd, &self.x[index.at].0);
        let form = x[0] * kx[0] + x[1] * kx[1] + x[2] * kx[2];
        R::add_to_totals::<S>(&mut self.forms[index.along], form);
        for c in 0..3 {
            kx[c].store_array(&mut self.y[index.at].0[c]);
        }
    }
}
