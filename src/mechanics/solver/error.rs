//! Errors of the solver: models that it refuses, and runs that fail.

use crate::spec::short;
use thiserror::Error;

/// A model that is refused before the first step, or a run that fails.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SolverError {
    /// The time step of the study is above the stability limit.
    #[error(
        "numerics.time_step_s = {time_step_s:e} s is above the stability limit {limit_s:e} s of this mesh, \
         damping and β₂ (ω_max ≤ {omega_max_rad_s:.6e} rad/s); give a smaller one or leave it out"
    )]
    TimeStepTooLarge {
        /// The requested step \[s\].
        time_step_s: f64,
        /// The stability limit \[s\].
        limit_s: f64,
        /// Upper bound of the largest angular frequency \[rad/s\].
        omega_max_rad_s: f64,
    },
    /// The numbers of a step do not fit into single precision.
    #[error(
        "numerics.precision = single: {what} = {value:e} is outside of the range of single precision; give \
         numerics.precision = double"
    )]
    BeyondSinglePrecision {
        /// The number, with its unit.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// The mesh has no node row near the clamp's width.
    #[error(
        "scene.clamp.width_m = {width_m} m has no node row near it: with {elements} elements over \
         {length_m} m {}; choose a width of the mesh or a finer mesh",
        nearest_widths(*.below_m, *.above_m)
    )]
    ClampOffMesh {
        /// The requested width \[m\].
        width_m: f64,
        /// Number of elements over `length_m`.
        elements: usize,
        /// Length \[m\] of the top face in the direction of the width.
        length_m: f64,
        /// Nearest width below \[m\].
        below_m: f64,
        /// Nearest width above \[m\].
        above_m: f64,
    },
    /// The mesh of the pin cannot be used.
    #[error("scene.pin: the mesh is not usable: {0}")]
    Mesh(String),
    /// The supports contradict each other, or the target does not allow them.
    #[error("inconsistent constraints: {0}")]
    Constraints(String),
    /// The given matrix is not a stiffness matrix of the mesh.
    #[error("not a stiffness matrix: {0}")]
    Stiffness(String),
    /// The contact solve on an elastic disk did not converge.
    #[error(
        "the contact solve of step {step} (t = {time_s:.6e} s) did not converge: after {sweeps} sweeps the forces \
         are off by {residual:.1e} of the largest, more than {tolerance:.0e}; sweeps converge slowly where many slave \
         nodes share target nodes that are lighter than they: look for a very light disk, or a very high friction \
         coefficient, with which there may be no solution"
    )]
    ContactNotSolved {
        /// The step, counted from 1.
        step: u64,
        /// Its time \[s\].
        time_s: f64,
        /// Number of sweeps done.
        sweeps: u32,
        /// Residual of the forces, relative to the largest force.
        residual: f64,
        /// The convergence tolerance, relative to the largest force.
        tolerance: f64,
    },
    /// An element of a pin with large strains is turned inside out; there is no result.
    #[error(
        "element {element} is inverted at t = {time_s:.6e} s (step {step}): the strains are larger than this mesh can have; \
         look for an edge that is squeezed or folded, and give a lower load, a coarser mesh there, a stiffer material or a smaller \
         time step"
    )]
    Inverted {
        /// The name of the element.
        element: u64,
        /// Step at which it was found.
        step: u64,
        /// Its time \[s\].
        time_s: f64,
    },
    /// The pin has deformed so much that the time step is above the stability limit.
    #[error(
        "at t = {time_s:.6e} s the pin has deformed so that the stability limit is {limit_s:.3e} s, below the time step of \
         {time_step_s:.3e} s; give numerics.time_step_s = {advised_s:.2e} or less, or numerics.safety_factor = {} or less",
        short(*safety_factor)
    )]
    StepOutgrown {
        /// The time at which it was found \[s\].
        time_s: f64,
        /// The stability limit then \[s\].
        limit_s: f64,
        /// The time step \[s\].
        time_step_s: f64,
        /// A time step that is far enough below this limit \[s\].
        advised_s: f64,
        /// The safety factor of that time step.
        safety_factor: f64,
    },
    /// The run diverged; there is no result.
    #[error(
        "diverged at step {step} (t = {time_s:.6e} s), worst at node {node} \
         (x = {x:.4} mm, y = {y:.4} mm, z = {z:.4} mm): {what}; {cause}",
        x = position_m[0] * 1e3, y = position_m[1] * 1e3, z = position_m[2] * 1e3
    )]
    Diverged {
        /// Step at which the divergence was detected.
        step: u64,
        /// Its time \[s\].
        time_s: f64,
        /// The node with the largest (or a non-finite) velocity.
        node: usize,
        /// That node's position \[m\].
        position_m: [f64; 3],
        /// Description of what diverged.
        what: String,
        /// The likely cause.
        cause: String,
    },
}

/// The widths of strips that a mesh has next to the one that is wanted, in words.
fn nearest_widths(below_m: f64, above_m: f64) -> String {
    let [below, above] = [short(below_m), short(above_m)];
    if below == above {
        format!("the nearest width is {below} m")
    } else {
        format!("the nearest widths are {below} m and {above} m")
    }
}
