//! Why there are no modes.

use thiserror::Error;

/// Why there are no modes.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StabilityError {
    /// The contact of the pin with the disk has no equilibrium that was found.
    #[error("steady sliding has no equilibrium at mu = {mu}")]
    NoEquilibrium {
        /// The local friction coefficient.
        mu: f64,
    },
    /// The disk is elastic.
    #[error(
        "eigenvalues of steady sliding are for a rigid disk, and scene.disk.kind is elastic: simulate this job"
    )]
    ElasticDisk,
    /// The friction law is not Coulomb's.
    #[error("eigenvalues of steady sliding are for Coulomb's law (scene.contact.law): simulate this job")]
    FrictionLaw,
    /// The holder moves.
    #[error("eigenvalues of steady sliding are for an ideal clamp (scene.holder): simulate this job")]
    Holder,
    /// The pin is not an upright block of one material.
    #[error(
        "eigenvalues of steady sliding are for an upright block of one material (scene.pin): simulate this job"
    )]
    Shape,
    /// The base is not a plane.
    #[error("eigenvalues of steady sliding are for a flat base (scene.pin.base): simulate this job")]
    Base,
    /// An iteration did not converge.
    #[error("{what} did not converge within {iterations} iterations")]
    NotConverged {
        /// What did not converge.
        what: &'static str,
        /// Number of iterations.
        iterations: usize,
    },
}
