//! Unilateral contact with Coulomb friction by forward increment Lagrange multipliers.
//!
//! Carpenter, Taylor and Katona (1991): predict u* without contact; every slave node that would be
//! below its target at t_{n+1} gets a constraint row, and the multipliers that put it back act at t_n.

pub mod coulomb;
pub mod rigid;

/// State of a slave node during a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ContactState {
    /// No contact force.
    #[default]
    Separated,
    /// Contact force inside the friction cone: moves with the target.
    Stick,
    /// Contact force on the friction cone: moves relative to the target.
    Slip,
}

/// Contact of all slave nodes during the last step, slave → (component →) lane.
#[derive(Debug, Clone)]
pub struct Contacts<const L: usize> {
    /// Contact force [N] on the pin at t_n: x, y, and N ≥ 0 in z (the multipliers are its negative).
    pub force_n: Vec<[[f64; L]; 3]>,
    /// Gap [m] at t_{n+1}, positive when open.
    pub gap_m: Vec<[f64; L]>,
    /// State during the step.
    pub state: Vec<[ContactState; L]>,
    /// Displacement increment [m] relative to the target over the step: x, y and (target at rest) z.
    pub relative_increment_m: Vec<[[f64; L]; 3]>,
}

impl<const L: usize> Contacts<L> {
    /// No contact at `slaves` nodes.
    pub fn separated(slaves: usize) -> Self {
        Self {
            force_n: vec![[[0.0; L]; 3]; slaves],
            gap_m: vec![[0.0; L]; slaves],
            state: vec![[ContactState::Separated; L]; slaves],
            relative_increment_m: vec![[[0.0; L]; 3]; slaves],
        }
    }
}
