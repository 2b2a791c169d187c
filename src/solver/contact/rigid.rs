//! The forward-increment solve on a rigid target, in closed form.
//!
//! On a rigid target c Δt² G M⁻¹ Gᵀ is diagonal (c is the scheme's factor of Δt²a in u_{n+1}), so
//! each slave node is solved by itself and one pass is exact:
//!
//! ```text
//! N = −m z*/(cΔt²)  if z* < 0       t_trial = −m δ*/(cΔt²),  δ* = u*_t − u_t − VΔt
//! ```
//!
//! A node that is held in a tangential direction in which the target moves slips there in any case: friction
//! opposes the whole slip, and the free direction is left with its part of the cone ([`coulomb::oppose`]).

use super::coulomb::{self, project};
use super::{ContactState, Contacts};
use crate::solver::field::{Field, Place};
use crate::solver::model::Model;
use crate::solver::state::Drive;

/// The predicted step of the slave nodes, which this solve corrects in place.
pub struct Prediction<'a, const L: usize> {
    /// Displacements u* [m]; corrected to `u_{n+1}`.
    pub u: &'a mut Field<L>,
    /// p* [m/s], corrected to `p_{n+1}`.
    pub p: &'a mut Field<L>,
    /// Where the slave nodes are.
    pub places: &'a [Place],
    /// Displacements [m] of the slave nodes at `t_n`, slave → component → lane.
    pub u_old: &'a [[[f64; L]; 3]],
    /// The scheme's factor of Δt² a in `u_{n+1}`.
    pub u_factor: f64,
    /// The scheme's factor of Δt a in `p_{n+1}`.
    pub p_factor: f64,
}

/// Solves contact and friction of every slave node and corrects the prediction.
pub fn solve<const L: usize>(
    model: &Model,
    drives: &[Drive; L],
    prediction: &mut Prediction<'_, L>,
    contacts: &mut Contacts<L>,
) {
    let dt = model.time_step_s();
    let u_scale = prediction.u_factor * dt * dt;
    let p_scale = prediction.p_factor * dt;
    for (slave, slave_node) in model.slaves().iter().enumerate() {
        let mass = slave_node.mass_kg;
        let stiffness = mass / u_scale;
        let u_factor = u_scale / mass;
        let p_factor = p_scale / mass;
        let place = prediction.places[slave];
        let u_old = &prediction.u_old[slave];
        for l in 0..L {
            let z = prediction.u.at(place, 2)[l];
            let increment: [f64; 2] = std::array::from_fn(|c| {
                let moved = prediction.u.at(place, c)[l] - u_old[c][l];
                moved - slave_node.surface_motion[c] * drives[l].rate * dt
            });
            let mut force = [0.0; 3];
            let mut state = ContactState::Separated;
            if z < 0.0 && slave_node.mobile[2] {
                force[2] = -stiffness * z;
                let (friction, friction_state) =
                    tangential(slave_node.mobile, increment, stiffness, force[2], drives[l].mu);
                (force[0], force[1]) = (friction[0], friction[1]);
                state = friction_state;
                // Constrained displacements are set, not corrected: a sticking node must not creep, nor a
                // closed one sink, by the rounding of its correction.
                for c in 0..2 {
                    if !slave_node.mobile[c] {
                        continue;
                    }
                    let u = &mut prediction.u.at_mut(place, c)[l];
                    if state == ContactState::Stick {
                        let carried = slave_node.surface_motion[c] * drives[l].rate * dt;
                        *u = u_old[c][l] + carried;
                    } else {
                        *u += u_factor * force[c];
                    }
                    prediction.p.at_mut(place, c)[l] += p_factor * force[c];
                }
                prediction.u.at_mut(place, 2)[l] = 0.0;
                prediction.p.at_mut(place, 2)[l] += p_factor * force[2];
            }
            for c in 0..3 {
                contacts.force_n[slave][c][l] = force[c];
                let moved = prediction.u.at(place, c)[l] - u_old[c][l];
                let target = if c < 2 { slave_node.surface_motion[c] * drives[l].rate * dt } else { 0.0 };
                contacts.relative_increment_m[slave][c][l] = moved - target;
            }
            contacts.gap_m[slave][l] = prediction.u.at(place, 2)[l];
            contacts.state[slave][l] = state;
        }
    }
}

/// Friction [N] and state of a closed node with the predicted slip `increment` [m].
fn tangential(
    mobile: [bool; 3],
    increment: [f64; 2],
    stiffness: f64,
    normal_n: f64,
    mu: f64,
) -> ([f64; 2], ContactState) {
    let held_slip = |c: usize| !mobile[c] && increment[c] != 0.0;
    match (held_slip(0), held_slip(1)) {
        (false, false) => {
            project([0, 1].map(|c| if mobile[c] { -stiffness * increment[c] } else { 0.0 }), normal_n, mu)
        }
        (true, false) if mobile[1] => {
            (coulomb::oppose(increment[0], increment[1], stiffness, normal_n, mu), ContactState::Slip)
        }
        (false, true) if mobile[0] => {
            let [y, x] = coulomb::oppose(increment[1], increment[0], stiffness, normal_n, mu);
            ([x, y], ContactState::Slip)
        }
        // Held in both: nothing to solve.
        _ => {
            let slip = (increment[0] * increment[0] + increment[1] * increment[1]).sqrt();
            (increment.map(|s| -mu * normal_n * s / slip), ContactState::Slip)
        }
    }
}
