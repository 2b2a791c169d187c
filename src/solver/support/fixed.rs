//! Degrees of freedom that never move.

use super::applied::{AppliedSupport, Supported};
use super::weights::{Weights, ones};
use crate::solver::body::block::BlockMesh;
use crate::solver::simd::dispatch;

/// Degrees of freedom that never move.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Fixed {
    /// 3·node + component.
    pub dofs: Vec<usize>,
}

/// Fixed degrees of freedom in every lane. Their inverse mass is zero, so the pin's motion does not change them.
/// Here their reactions are summed.
#[derive(Debug, Clone)]
pub(super) struct AppliedFixed<const L: usize> {
    held: Vec<Weights>,
}

impl<const L: usize> AppliedFixed<L> {
    pub fn new(fixed: &Fixed, mesh: &BlockMesh) -> Self {
        Self { held: ones::<L>(mesh, &fixed.dofs) }
    }
}

impl<const L: usize> AppliedSupport<L> for AppliedFixed<L> {
    fn act(&mut self, pin: &mut Supported<'_, L>, reaction_n: &mut [[f64; L]; 3]) {
        for held in &self.held {
            let total = &mut reaction_n[held.component];
            dispatch!(simd => held.add_up(simd, pin.residual, total));
        }
    }

    fn boxed(&self) -> Box<dyn AppliedSupport<L>> {
        Box::new(self.clone())
    }
}
