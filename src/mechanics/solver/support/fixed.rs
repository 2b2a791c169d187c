//! Degrees of freedom that never move.

use super::applied::{AppliedSupport, Supported};
use super::weights::{Weights, ones};
use crate::solver::field::Layout;
use crate::solver::number::Number;

/// Degrees of freedom that never move.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Fixed {
    /// 3·node + component.
    pub dofs: Vec<usize>,
}

/// Fixed degrees of freedom in every lane. Their inverse mass is zero, so the pin's motion does not change them.
/// Here their reactions are summed.
#[derive(Debug, Clone)]
pub(super) struct AppliedFixed<R: Number> {
    held: Vec<Weights<R>>,
}

impl<R: Number> AppliedFixed<R> {
    /// For fields with `lanes` lanes.
    pub fn new(fixed: &Fixed, layout: Layout, lanes: usize) -> Self {
        Self { held: ones(layout, lanes, &fixed.dofs) }
    }
}

impl<const L: usize, R: Number> AppliedSupport<L, R> for AppliedFixed<R> {
    fn act(&mut self, pin: &mut Supported<'_, L, R>, reaction_n: &mut [[f64; L]; 3]) {
        for held in &self.held {
            held.add_up(pin.residual.blocks(), &mut reaction_n[held.component]);
        }
    }

    fn boxed(&self) -> Box<dyn AppliedSupport<L, R>> {
        Box::new(self.clone())
    }
}
