//! What resists the deformation of the pin.
//!
//! Others ask an [`Operator`] for the internal forces of a motion, for stored energy, for the stiffness about the undeformed pin,
//! for a bound of ω, and for the length of its history. Which form it has is decided here.
//!
//! * [`TensorOperator`] – K of a uniform elastic block as a sum of tensor products. It is the fastest form.
//! * [`AssembledOperator`] – any symmetric K, by pairs of nodes. It serves general meshes, discrete springs and masses, and the
//!   tests compare the other form with it.
//! * [`HyperelasticOperator`] – elements with large strains, which may yield.
//!
//! The first two are linear: forces are K (u + β_R p), the energy is ½u·Ku, and there is no history. They give K x block by block in one
//! pass over the mesh, which is the only product with K. With large strains the forces of damping and deformation are those of the
//! displacements u + β_R p: the damper is β_R times the stiffness of the deformed pin, to the first order in β_R p.

mod assembled;
mod elements;
mod gradient;
mod hyperelastic;
mod node_scratch;
mod past;
mod return_mapping;
mod tensor;
#[cfg(test)]
mod tests;
mod yielding;

pub use assembled::AssembledOperator;
pub use hyperelastic::HyperelasticOperator;
use node_scratch::NodeScratch;
pub use past::Past;
pub use return_mapping::PointState;
pub use tensor::TensorOperator;
use tensor::TensorScratch;
pub use yielding::Yielding;

use super::bound::{omega_max_bound, omega_max_bound_of_springs};
use super::lanczos;
use crate::solver::body::Freedom;
use crate::solver::field::{Block, Field, FieldOf, Layout, add_slots, blocks_per_line};
use crate::solver::number::Number;
use crate::solver::simd::{dispatch, load_all};
use crate::spec::MaterialLaw;
use fearless_simd::{Simd, prelude::*};

/// The forms of what resists the deformation.
#[derive(Debug, Clone)]
pub enum Operator {
    /// A uniform elastic block.
    Tensor(TensorOperator),
    /// Elastic elements, by pairs of nodes.
    Assembled(AssembledOperator),
    /// Springs between point masses, by pairs of nodes.
    Springs(AssembledOperator),
    /// Elements with large strains.
    Hyperelastic {
        /// The elements.
        elements: HyperelasticOperator,
        /// The stiffness of the undeformed pin.
        tangent: AssembledOperator,
    },
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

/// Nodes that are moved by internal forces, block by block.
pub(in crate::solver) trait Moving<S: Simd, R: Number> {
    /// Displacements u \[m\] in block `at`.
    fn u(&self, simd: S, at: usize) -> [R::Vector<S>; 3];
    /// β_R p \[m\] in block `at`, whose elastic forces are those of damping; none without damping.
    fn damped(&self, simd: S, at: usize) -> Option<[R::Vector<S>; 3]>;
    /// Takes the internal forces \[N\] on a block. The displacements of its plane and of those below are not read again, so it may
    /// overwrite them. Planes come in their order.
    fn take(&mut self, simd: S, index: BlockIndex, force: [R::Vector<S>; 3]);
}

/// The input and the output of a pass over the mesh, block by block.
trait Pass<S: Simd, R: Number> {
    /// The three components of x in block `at`.
    fn input(&self, simd: S, at: usize) -> [R::Vector<S>; 3];
    /// Takes the three components of the internal forces of x in a block; those of linear elements are K x. The inputs of its plane and of
    /// those below are not read again, so it may overwrite them. Planes come in their order.
    fn output(&mut self, simd: S, index: BlockIndex, kx: [R::Vector<S>; 3]);
    /// The input without the displacements of damping in block `at`; none if there are none of damping.
    fn undamped(&self, _simd: S, _at: usize) -> Option<[R::Vector<S>; 3]> {
        None
    }
}

/// Scratch of the passes of an operator.
#[derive(Debug, Clone)]
pub struct Scratch<R: Number = f64> {
    lanes: usize,
    form: ScratchOf<R>,
    /// x·Kx by columns of blocks.
    forms: Vec<R::Totals>,
}

#[derive(Debug, Clone)]
enum ScratchOf<R: Number> {
    Tensor(TensorScratch<R>),
    Nodes(NodeScratch<R>),
}

impl Operator {
    /// Scratch for fields with `lanes` lanes.
    pub fn scratch<R: Number>(&self, layout: Layout, lanes: usize) -> Scratch<R> {
        let form = match self {
            Self::Tensor(_) => ScratchOf::Tensor(TensorScratch::new(layout, lanes)),
            Self::Assembled(_) | Self::Springs(_) | Self::Hyperelastic { .. } => {
                ScratchOf::Nodes(NodeScratch::new(layout, lanes))
            }
        };
        Scratch {
            lanes,
            form,
            forms: vec![R::Totals::default(); blocks_per_line::<R>(layout.nodes_per_line, lanes)],
        }
    }

    /// The law of elements with large strains; returns `None` for linear forces.
    pub fn law(&self) -> Option<MaterialLaw> {
        match self {
            Self::Hyperelastic { elements, .. } => Some(elements.law()),
            Self::Tensor(_) | Self::Assembled(_) | Self::Springs(_) => None,
        }
    }

    /// Number of numbers that all elements together keep of their past, in each lane.
    pub fn history_len(&self) -> usize {
        match self {
            Self::Hyperelastic { elements, .. } => elements.yielding().map_or(0, Yielding::history_len),
            Self::Tensor(_) | Self::Assembled(_) | Self::Springs(_) => 0,
        }
    }

    /// The elements that yield; returns `None` if no material does.
    pub fn yielding(&self) -> Option<&Yielding> {
        let Self::Hyperelastic { elements, .. } = self else { return None };
        elements.yielding()
    }

    /// The plastic work \[J\] of a lane since its start, and its largest plastic strain; returns `None` if no material yields.
    pub fn plastic_totals<R: Number>(&self, history: &[R], lane: usize, lanes: usize) -> Option<[f64; 2]> {
        Some(self.yielding()?.totals(R::as_doubles(history)?, lane, lanes))
    }

    /// Gives the internal forces of damping and deformation to the nodes that they move, in one pass over the mesh. The history follows
    /// the deformation.
    ///
    /// # Panics
    /// If the scratch is that of another operator.
    #[expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]
    #[inline(always)]
    pub(in crate::solver) fn force<S: Simd, R: Number>(
        &self,
        simd: S,
        nodes: &mut impl Moving<S, R>,
        mut past: Past<'_, R>,
        scratch: &mut Scratch<R>,
    ) {
        self.assert_own(past.history(), scratch);
        self.pass(simd, &mut Damped(nodes), &mut past, scratch);
    }

    fn assert_own<R: Number>(&self, history: &[R], scratch: &Scratch<R>) {
        let own = self.history_len() * scratch.lanes;
        debug_assert_eq!(history.len(), own, "the history of another operator");
    }

    /// The energy \[J\] that the deformation stores, in each lane; NaN if an element is inverted. It overwrites `work`.
    ///
    /// # Panics
    /// If the scratch is that of another operator.
    pub fn stored_j<const L: usize, R: Number>(
        &self,
        u: &FieldOf<L, R>,
        history: &[R],
        work: &mut FieldOf<L, R>,
        scratch: &mut Scratch<R>,
    ) -> [f64; L] {
        self.assert_own(history, scratch);
        if let Self::Hyperelastic { elements, .. } = self {
            let (energy_j, inverted) = elements.state_of(u, history, work, scratch);
            return std::array::from_fn(
                |lane| {
                    if inverted[lane].is_some() { f64::NAN } else { energy_j[lane] }
                },
            );
        }
        self.tangent(u, work, scratch).map(|form| 0.5 * form)
    }

    /// The internal forces \[N\] of displacements at rest.
    ///
    /// # Panics
    /// If the scratch is that of another operator.
    pub fn internal_n<const L: usize, R: Number>(
        &self,
        u: &FieldOf<L, R>,
        mut past: Past<'_, R>,
        force: &mut FieldOf<L, R>,
        scratch: &mut Scratch<R>,
    ) {
        let mut forms = std::mem::take(&mut scratch.forms);
        let mut product = Product { x: u.blocks(), y: force.blocks_mut(), forms: &mut forms };
        match (self, &mut scratch.form) {
            (Self::Hyperelastic { elements, .. }, ScratchOf::Nodes(nodes)) => {
                dispatch!(simd => elements.pass(simd, &mut product, &mut past, nodes));
            }
            // The forces of linear elements are K u, for which there is compiled code already.
            _ => self.multiply(&mut product, scratch),
        }
        scratch.forms = forms;
    }

    /// Computes the forces of the damper over β_R, and their product with p. Those of linear elements are K p.
    ///
    /// # Panics
    /// If the scratch is that of another operator.
    pub fn damper<const L: usize, R: Number>(
        &self,
        u: &FieldOf<L, R>,
        p: &FieldOf<L, R>,
        history: &[R],
        beta_r_s: f64,
        force: &mut FieldOf<L, R>,
        scratch: &mut Scratch<R>,
    ) -> [f64; L] {
        if !matches!(self, Self::Hyperelastic { .. }) {
            return self.tangent(p, force, scratch);
        }
        if beta_r_s == 0.0 {
            force.blocks_mut().fill(Block::default());
            return [0.0; L];
        }
        let mut unmoved = force.clone();
        self.internal_n(u, Past::Kept(history), &mut unmoved, scratch);
        self.internal_n(&moved(u, beta_r_s, p), Past::Kept(history), force, scratch);
        change_over(beta_r_s, force, &unmoved);
        force.clear_padding();
        p.dot(force)
    }

    /// The number of the first element that these displacements invert; returns `None` if there is none, and for linear elements.
    pub fn inverted_element(&self, layout: Layout, u: &Field<1>) -> Option<usize> {
        let Self::Hyperelastic { elements, .. } = self else { return None };
        // What has yielded does not change the volume.
        let history = vec![0.0; self.history_len()];
        elements.state_of(u, &history, &mut Field::zeros(layout), &mut self.scratch(layout, 1)).1[0]
    }

    /// The largest angular frequency \[rad/s\] of the pin with these displacements, at most 2.5 % too low and never too high; returns `None`
    /// if the displacements do not change it.
    pub fn deformed_omega_max(
        &self,
        layout: Layout,
        masses_kg: &[f64],
        freedoms: &[Freedom],
        u: &Field<1>,
        history: &[f64],
    ) -> Option<f64> {
        let largest = |field: &Field<1>| field.values().fold(0.0, |a: f64, b| a.max(b.abs()));
        let size_m = largest(u);
        if !matches!(self, Self::Hyperelastic { .. }) || size_m == 0.0 || !size_m.is_finite() {
            return None;
        }
        let mut scratch = self.scratch(layout, 1);
        let mut unmoved = Field::zeros(layout);
        self.internal_n(u, Past::Kept(history), &mut unmoved, &mut scratch);
        // The displacements of the two states differ by 10⁻⁷ of the largest one, which changes the stiffness by as little. Their forces are
        // known to rounding in proportion to the displacements, so that the difference has eight digits.
        let product = |x: &Field<1>, y: &mut Field<1>| {
            let factor = 1.0e-7 * size_m / largest(x);
            self.internal_n(&moved(u, factor, x), Past::Kept(history), y, &mut scratch);
            change_over(factor, y, &unmoved);
        };
        Some(lanczos::largest_square(layout, product, masses_kg, freedoms, CHECK_MARGIN).sqrt())
    }

    /// Upper bound of the largest angular frequency \[rad/s\] of nodes with these masses. A run has one time step. Where large strains
    /// change the bound, it is that of the undeformed pin, and runs check it.
    pub fn omega_max_bound(&self, layout: Layout, masses_kg: &[f64], freedoms: &[Freedom]) -> f64 {
        match self {
            Self::Tensor(block) => {
                omega_max_bound(block.mesh(), &block.element(), block.material().density_kg_m3, freedoms)
            }
            Self::Assembled(_) | Self::Hyperelastic { .. } => {
                let mut scratch = self.scratch(layout, 1);
                let product = |x: &Field<1>, y: &mut Field<1>| _ = self.tangent(x, y, &mut scratch);
                lanczos::omega_max_bound(layout, product, masses_kg, freedoms)
            }
            Self::Springs(springs) => omega_max_bound_of_springs(springs.entries(), masses_kg, freedoms),
        }
    }

    /// The entries (column, value \[N/m\]) of every row of K, the stiffness of the undeformed pin.
    pub fn tangent_rows(&self) -> Vec<Vec<(usize, f64)>> {
        match self {
            Self::Tensor(block) => AssembledOperator::of_block(block.mesh(), &block.element()).rows(),
            Self::Assembled(operator) | Self::Springs(operator) => operator.rows(),
            Self::Hyperelastic { tangent, .. } => tangent.rows(),
        }
    }

    /// Computes `y = K x` for `L` lanes with the stiffness K of the undeformed pin, and returns x·y. β_R K is the damper of the pin.
    ///
    /// # Panics
    /// If the scratch is that of another operator.
    pub fn tangent<const L: usize, R: Number>(
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
        dispatch!(simd => self.pass_tangent(simd, product, scratch));
    }

    /// The internal forces of x in one pass over the mesh.
    ///
    /// # Panics
    /// If the scratch is that of another operator.
    #[expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]
    #[inline(always)]
    fn pass<S: Simd, R: Number>(
        &self,
        simd: S,
        pass: &mut impl Pass<S, R>,
        past: &mut Past<'_, R>,
        scratch: &mut Scratch<R>,
    ) {
        match (self, &mut scratch.form) {
            (Self::Hyperelastic { elements, .. }, ScratchOf::Nodes(nodes)) => {
                elements.pass(simd, pass, past, nodes);
            }
            _ => self.pass_tangent(simd, pass, scratch),
        }
    }

    /// K x in one pass over the mesh.
    ///
    /// # Panics
    /// If the scratch is that of another operator.
    #[expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]
    #[inline(always)]
    fn pass_tangent<S: Simd, R: Number>(
        &self,
        simd: S,
        pass: &mut impl Pass<S, R>,
        scratch: &mut Scratch<R>,
    ) {
        match (self, &mut scratch.form) {
            (Self::Tensor(operator), ScratchOf::Tensor(scratch)) => operator.pass(simd, pass, scratch),
            (
                Self::Assembled(operator)
                | Self::Springs(operator)
                | Self::Hyperelastic { tangent: operator, .. },
                ScratchOf::Nodes(scratch),
            ) => operator.pass(simd, pass, scratch),
            _ => panic!("the scratch of another operator"),
        }
    }
}

/// Share by which the largest frequency squared of a deformed pin may be too low. A check of the time step takes some 70 passes with it.
const CHECK_MARGIN: f64 = 0.05;

/// u + a x.
fn moved<const L: usize, R: Number>(u: &FieldOf<L, R>, a: f64, x: &FieldOf<L, R>) -> FieldOf<L, R> {
    let (a, mut moved) = (R::from_f64(a), u.clone());
    for (moved, x) in moved.blocks_mut().iter_mut().zip(x.blocks()) {
        for c in 0..3 {
            for i in 0..R::WIDTH {
                moved.0[c][i] += a * x.0[c][i];
            }
        }
    }
    moved
}

/// Makes a force its change over a.
fn change_over<const L: usize, R: Number>(a: f64, force: &mut FieldOf<L, R>, before: &FieldOf<L, R>) {
    let scale = R::from_f64(1.0 / a);
    for (force, before) in force.blocks_mut().iter_mut().zip(before.blocks()) {
        for c in 0..3 {
            for i in 0..R::WIDTH {
                force.0[c][i] = scale * (force.0[c][i] - before.0[c][i]);
            }
        }
    }
}

/// The forces of the displacements u + β_R p on nodes.
struct Damped<'a, M>(&'a mut M);

#[expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]
impl<S: Simd, R: Number, M: Moving<S, R>> Pass<S, R> for Damped<'_, M> {
    #[inline(always)]
    fn input(&self, simd: S, at: usize) -> [R::Vector<S>; 3] {
        let mut strained = self.0.u(simd, at);
        if let Some(damped) = self.0.damped(simd, at) {
            for c in 0..3 {
                strained[c] += damped[c];
            }
        }
        strained
    }

    #[inline(always)]
    fn output(&mut self, simd: S, index: BlockIndex, kx: [R::Vector<S>; 3]) {
        self.0.take(simd, index, kx);
    }

    #[inline(always)]
    fn undamped(&self, simd: S, at: usize) -> Option<[R::Vector<S>; 3]> {
        self.0.damped(simd, at).map(|_| self.0.u(simd, at))
    }
}

/// Fields of a pass.
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
