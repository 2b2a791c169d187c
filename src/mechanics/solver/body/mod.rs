//! Deformable bodies.
//!
//! A body has nodes with lumped masses, internal forces K (u + β_R p), stored energies, the work of its damping,
//! and an upper bound of its largest frequency.
//!
//! * [`pin`] – the pin. Its nodes are moved in the same pass that forms the product with K.
//! * [`ring`] – the elastic disk.
//! * [`hexahedron`] – the finite element of both.
//!
//! No body uses another body, `support` or `interface`.

pub mod hexahedron;
pub mod pin;
pub mod ring;

/// How one degree of freedom of a body may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freedom {
    /// It moves by itself.
    Free,
    /// It does not move.
    Fixed,
    /// It moves with the other members of the group of this number.
    Tied(usize),
    /// It moves with a rigid plane that rotates.
    Carried,
}

/// Stored energies \[J\] at t_n, and the work \[J\] of damping in one step, summed over bodies and supports.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "units are part of the names")]
pub(in crate::solver) struct EnergySums<const L: usize> {
    pub kinetic_j: [f64; L],
    pub elastic_j: [f64; L],
    /// Plastic work since the start.
    pub plastic_j: [f64; L],
    /// Work of the damping forces at t_n over the increment after t_n.
    pub damping_after_j: [f64; L],
    /// Work of the damping forces at t_n over the increment before t_n.
    pub damping_before_j: [f64; L],
    /// Energy that β₂ > ½ dissipates in the step before t_n.
    pub numerical_j: [f64; L],
}

impl<const L: usize> EnergySums<L> {
    pub const ZERO: Self = Self {
        kinetic_j: [0.0; L],
        elastic_j: [0.0; L],
        plastic_j: [0.0; L],
        damping_after_j: [0.0; L],
        damping_before_j: [0.0; L],
        numerical_j: [0.0; L],
    };
}

/// Adds `part` to `total` lane by lane.
pub(in crate::solver) fn add_lanes<const L: usize>(total: &mut [f64; L], part: &[f64; L]) {
    for (total, part) in total.iter_mut().zip(part) {
        *total += part;
    }
}
