//! Nodes on a holder: they share one displacement in one component, with a mass of the holder, on a spring and a damper to the
//! frame.
//!
//! ```text
//! (M + Σm) a = −Σ (K (u + β_R p))_members − k u − d p
//! ```
//!
//! The spring and the damper act at t_n like K and β_R K. The frame carries k u + d p, which an instrument behind the holder
//! measures.

use super::applied::{AppliedSupport, Supported, Way};
use super::tied::{AppliedTie, Tied};
use crate::solver::body::EnergySums;
use crate::solver::field::{FieldOf, LaneSlot, Layout};
use crate::solver::number::Number;
use crate::solver::scheme::{Bound, Scheme};

/// Nodes on a holder, in one component.
#[derive(Debug, Clone, PartialEq)]
pub struct Held {
    /// The nodes that share a displacement.
    pub tied: Tied,
    /// Mass \[kg\] of the holder, ≥ 0.
    pub mass_kg: f64,
    /// Stiffness \[N/m\] of the spring, ≥ 0.
    pub stiffness_n_m: f64,
    /// Coefficient \[N s/m\] of the damper, ≥ 0.
    pub damping_n_s_m: f64,
}

impl Held {
    /// The spring and the damper on the mass of the holder and the nodes.
    pub fn bound(&self, masses_kg: &[f64]) -> Bound {
        let mass_kg = self.mass_kg + self.tied.nodes.iter().map(|&node| masses_kg[node]).sum::<f64>();
        Bound {
            omega_max_rad_s: (self.stiffness_n_m / mass_kg).sqrt(),
            damping_per_s: self.damping_n_s_m / mass_kg,
        }
    }
}

/// A holder in every lane.
#[derive(Debug, Clone)]
pub(super) struct AppliedHeld<const L: usize, R: Number> {
    tie: AppliedTie<R>,
    held: Held,
    /// One of the nodes.
    place: LaneSlot,
    /// Displacement \[m\], p \[m/s\] and acceleration \[m/s²\] at t_n.
    motion: [[f64; L]; 3],
}

impl<const L: usize, R: Number> AppliedHeld<L, R> {
    pub fn new(held: &Held, layout: Layout, masses_kg: &[f64]) -> Self {
        Self {
            tie: AppliedTie::new(&held.tied, layout, L, masses_kg, held.mass_kg),
            held: held.clone(),
            place: FieldOf::<L, R>::zeros(layout).place(held.tied.nodes[0]),
            motion: [[0.0; L]; 3],
        }
    }
}

impl<const L: usize, R: Number> AppliedSupport<L, R> for AppliedHeld<L, R> {
    fn act(&mut self, pin: &mut Supported<'_, L, R>, reaction_n: &mut [[f64; L]; 3]) {
        let Held { tied, stiffness_n_m, damping_n_s_m, .. } = &self.held;
        let [u, p] = [pin.u, pin.p].map(|field| field.at(self.place, tied.component).map(R::to_f64));
        let mut sums: [f64; L] =
            std::array::from_fn(|lane| stiffness_n_m * u[lane] + damping_n_s_m * p[lane]);
        for (reaction, carried) in reaction_n[tied.component].iter_mut().zip(&sums) {
            *reaction -= carried;
        }
        self.tie.share(pin.residual.blocks_mut(), &mut sums);
        self.motion = [u, p, sums.map(|minus_a| -minus_a)];
    }

    fn add_energies(
        &self,
        scheme: &Scheme,
        steps_done: &[u64; L],
        u_after: &FieldOf<L, R>,
        total: &mut EnergySums<L>,
    ) {
        let Held { tied, mass_kg, stiffness_n_m, damping_n_s_m } = &self.held;
        let way = Way { inertia: *mass_kg, stiffness: *stiffness_n_m, damping: *damping_n_s_m };
        let after = u_after.at(self.place, tied.component).map(R::to_f64);
        way.add_energies(scheme, steps_done, &self.motion, &after, total);
    }

    fn motion(&self) -> Option<(usize, [[f64; L]; 2])> {
        let [u, _, a] = self.motion;
        Some((self.held.tied.component, [u, a]))
    }

    fn boxed(&self) -> Box<dyn AppliedSupport<L, R>> {
        Box::new(self.clone())
    }
}
