//! Why there are no modes.

use thiserror::Error;

/// Why there are no modes.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StabilityError {
    /// Somebody asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The contact of the pin with the disk has no equilibrium that was found.
    #[error("steady sliding has no equilibrium at mu = {mu}")]
    NoEquilibrium {
        /// The local friction coefficient.
        mu: f64,
    },
    /// The meshes are too fine for sparse factors, which elastic disks and all pins but plain blocks need.
    #[error(
        "eigenvalues of steady sliding are for at most {most} displacements of this pin and its disk, which have {unknowns}: give \
         coarser elements (scene.pin.elements or another mesh; scene.disk.ring.element_size_m and coarse_element_size_m of an \
         elastic disk) or simulate this job"
    )]
    TooLarge {
        /// Displacements of pin and disk.
        unknowns: usize,
        /// The largest number.
        most: usize,
    },
    /// A sparse matrix has no factors.
    #[error("the equations of steady sliding with {unknowns} unknowns are singular, or memory is short")]
    NotFactored {
        /// Number of unknowns.
        unknowns: usize,
    },
    /// The friction law has a state.
    #[error(
        "eigenvalues of steady sliding are not for friction with a state (scene.contact.law = {law}): \
         simulate this job"
    )]
    FrictionLaw {
        /// Its name in a study.
        law: &'static str,
    },
    /// A holder has no spring along the disk, which friction would push away.
    #[error(
        "steady sliding has no equilibrium on a holder without a spring (scene.holder.stiffness_x_n_m, \
         stiffness_y_n_m = 0): give a stiffness > 0 or simulate this job"
    )]
    Holder,
    /// An iteration did not converge.
    #[error("{what} did not converge within {iterations} iterations")]
    NotConverged {
        /// What did not converge.
        what: &'static str,
        /// Number of iterations.
        iterations: usize,
    },
}
