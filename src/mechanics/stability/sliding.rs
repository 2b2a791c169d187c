//! Steady sliding at a point: its equilibrium and its modes.

use nalgebra::Complex;

/// The equilibrium of steady sliding.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Displacements \[m\] of the pin, three per node.
    pub u_m: Vec<f64>,
    /// Normal contact forces \[N\] of the slave nodes; zero where a node is lifted.
    pub normal_n: Vec<f64>,
    /// Whether each slave node is in contact.
    pub in_contact: Vec<bool>,
    /// Displacement \[m\] of an elastic disk's surface under each slave node in z; zero on a rigid one.
    pub disk_z_m: Vec<f64>,
    /// The scale of the friction coefficients.
    pub mu: f64,
    /// Friction coefficient of each slave node over the scale.
    pub mu_share: Vec<f64>,
    /// Macroscopic friction coefficient: the tangential contact force in y over the normal force.
    pub mu_star: f64,
}

/// A complex mode of small vibrations about steady sliding. Its motion is Re(q exp(λt)).
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// λ \[1/s\]: growth rate and angular frequency. The angular frequency is not negative.
    pub eigenvalue_per_s: Complex<f64>,
    /// λ \[1/s\] of a run with the model's time step, whose vibrations are proportional to exp(λ n Δt).
    pub eigenvalue_in_steps_per_s: Complex<f64>,
    /// Residual of the full problem, relative.
    pub residual: f64,
    /// Estimated largest error \[1/s\] of the growth rate.
    pub growth_error_per_s: f64,
    /// Whether the residual is within the tolerance.
    pub is_converged: bool,
    /// q of the pin, three per node. The largest component is 1. Empty if shapes were not asked for, but on an elastic disk.
    pub shape: Vec<Complex<f64>>,
}

/// Steady sliding at one friction coefficient, speed and load.
#[derive(Debug, Clone)]
pub struct SlidingPoint {
    /// The equilibrium.
    pub equilibrium: Equilibrium,
    /// The leading modes, largest growth rate first.
    pub modes: Vec<Mode>,
    /// Frequency \[Hz\] up to which the modes were looked for.
    pub band_hz: f64,
    /// Whether all modes of the mesh were looked for.
    pub has_all_modes: bool,
    /// A frequency \[Hz\] above which no mode can grow, because damping wins there; none if none is known.
    pub damped_above_hz: Option<f64>,
    /// Number of vectors of the basis in which the modes were found.
    pub basis: usize,
    /// Whether that basis is smaller than the space of the mesh, so that it has the modes near the end of the band badly.
    pub is_reduced: bool,
}

/// Share of a reduced basis's band in which modes are judged one by one.
pub const JUDGED: f64 = 0.85;

impl SlidingPoint {
    /// Frequency \[Hz\] up to which the modes are sure.
    pub fn sure_hz(&self) -> f64 {
        if self.is_reduced { JUDGED * self.band_hz } else { self.band_hz }
    }
}
