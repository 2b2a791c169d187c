//! The stiffness operator: y = K x.
//!
//! * [`TensorOperator`] – K of a uniform elastic block as a sum of tensor products. Simulations use this form.
//! * [`AssembledOperator`] – any symmetric K, row by row. It serves discrete springs and masses, and the tests
//!   compare the other form with it.

mod assembled;
mod tensor;

pub use assembled::AssembledOperator;
pub(in crate::solver) use tensor::{BlockIndex, Pass};
pub use tensor::{Scratch, TensorOperator};

use crate::solver::field::FieldOf;
use crate::solver::number::Number;

/// K in one of its forms.
#[derive(Debug, Clone)]
pub enum Operator {
    /// K of a uniform elastic block.
    Tensor(TensorOperator),
    /// K given row by row.
    Assembled(AssembledOperator),
}

impl Operator {
    /// Computes `y = K x` for `L` lanes and returns x·y.
    pub fn product<const L: usize, R: Number>(
        &self,
        x: &FieldOf<L, R>,
        y: &mut FieldOf<L, R>,
        scratch: &mut Scratch<R>,
    ) -> [f64; L] {
        match self {
            Self::Tensor(operator) => operator.product(x, y, scratch),
            Self::Assembled(operator) => {
                operator.product(x, y);
                x.dot(y)
            }
        }
    }
}
