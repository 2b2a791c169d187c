//! The stiffness operator: y = K x.
//!
//! * [`StencilOperator`] – K of a uniform elastic block, the form that runs.
//! * [`AssembledOperator`] – any symmetric K, row by row: discrete springs and masses, and the
//!   reference that the other form is tested against.

mod assembled;
mod stencil;

pub use assembled::AssembledOperator;
pub use stencil::StencilOperator;

/// K in one of its forms.
#[derive(Debug, Clone)]
pub enum Operator {
    /// Of a uniform elastic block.
    Stencil(StencilOperator),
    /// Given row by row.
    Assembled(AssembledOperator),
}

impl Operator {
    /// Computes `y = K x` for `L` lanes; both arrays are node → component → lane.
    ///
    /// # Panics
    /// If an array's length is not 3 · nodes · L.
    pub fn apply<const L: usize>(&self, x: &[f64], y: &mut [f64]) {
        match self {
            Self::Stencil(operator) => operator.apply::<L>(x, y),
            Self::Assembled(operator) => operator.apply::<L>(x, y),
        }
    }
}
