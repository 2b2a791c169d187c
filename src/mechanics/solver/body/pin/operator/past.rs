//! What elements keep of their past, in a pass over the mesh.

use crate::solver::number::Number;

/// The history of all elements, in the order number → lane.
#[derive(Debug)]
pub enum Past<'a, R: Number> {
    /// It stays: the forces are those of an elastic change.
    Kept(&'a [R]),
    /// It follows the deformation of a time step.
    Followed {
        /// The numbers, which become those of the end of the step.
        history: &'a mut [R],
        /// The time step \[s\].
        time_step_s: f64,
    },
}

impl<R: Number> Past<'_, R> {
    /// The numbers.
    pub fn history(&self) -> &[R] {
        match self {
            Self::Kept(history) => history,
            Self::Followed { history, .. } => history,
        }
    }

    /// The same in double precision; without numbers in single precision, in which no element keeps any.
    pub(super) fn doubles(&mut self) -> Past<'_, f64> {
        match self {
            Self::Kept(history) => Past::Kept(R::as_doubles(history).unwrap_or_default()),
            Self::Followed { history, time_step_s } => {
                Past::Followed { history: R::doubles(history).unwrap_or_default(), time_step_s: *time_step_s }
            }
        }
    }
}
