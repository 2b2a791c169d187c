//! One time step of the β₂ method with contact; nothing else happens here.
//!
//! The method (the paper's equation \[2\]; Newmark with β = 0, γ = β₂) in the variables u_n and
//! p_n = v_{n−1} + (1−β₂)Δt a_{n−1}, with C = β_R K evaluated at p_n:
//!
//! ```text
//! M a_n   = r_n − K (u_n + β_R p_n) + contact forces
//! u_{n+1} = u_n + Δt p_n + (½+β₂) Δt² a_n
//! p_{n+1} = p_n + Δt a_n
//! ```
//!
//! At n = 0, p_0 is the initial velocity v_0 and the factors are ½ and 1−β₂: the half-force first step.

use super::contact::rigid::{self, Prediction};
use super::field::Field;
use super::integrate::Factors;
use super::model::Model;
use super::operator::Operator;
use super::places::Places;
use super::state::{Drive, State};

/// Factors of Δt² a in `u_{n+1}` and of Δt a in `p_{n+1}`.
pub(super) fn factors(beta2: f64, step: u64) -> (f64, f64) {
    if step == 0 { (0.5, 1.0 - beta2) } else { (0.5 + beta2, 1.0) }
}

/// Advances all lanes from `t_n` to `t_{n+1}`.
pub fn step<const L: usize>(model: &Model, drives: &[Drive; L], state: &mut State<L>) {
    let dt = model.time_step_s();
    let time_s = state.step as f64 * dt;
    for l in 0..L {
        state.load_n[l] = drives[l].load_n(time_s);
    }
    let work = &mut state.workspace;
    for (old, &place) in work.slave_u.iter_mut().zip(&work.places.slaves) {
        for c in 0..3 {
            old[c] = *state.u.at(place, c);
        }
    }
    if state.step == 0 {
        work.load_stroke_m = [load_stroke(&work.places, &state.u); 2];
    }
    let (u_factor, p_factor) = factors(model.beta2(), state.step);
    let factors = Factors {
        time_step_s: dt,
        beta_r_s: model.beta_r_s(),
        u_scale: u_factor * dt * dt,
        p_scale: p_factor * dt,
    };
    internal_forces(model, factors, state);
    apply_load(state);
    collect_reactions(state);
    advance_constrained_planes(model, factors, state);
    rigid::solve(
        model,
        drives,
        &mut Prediction {
            u: &mut state.u,
            p: &mut state.p,
            places: &state.workspace.places.slaves,
            u_old: &state.workspace.slave_u,
            u_factor,
            p_factor,
        },
        &mut state.contacts,
    );
    collect_held_friction(state);
    account_load_work(state);
    state.step += 1;
}

/// residual = K (u + β_R p) on the constrained planes; the others are moved.
fn internal_forces<const L: usize>(model: &Model, factors: Factors, state: &mut State<L>) {
    let work = &mut state.workspace;
    match model.operator() {
        Operator::Tensor(operator) => work.integration.advance_free_planes(
            operator,
            factors,
            &mut state.u,
            &mut state.p,
            &mut work.residual,
            &mut work.product,
        ),
        Operator::Assembled(operator) => {
            let mut strained = state.u.clone();
            for (s, p) in strained.blocks_mut().iter_mut().zip(state.p.blocks()) {
                for (s, p) in s.0.as_flattened_mut().iter_mut().zip(p.0.as_flattened()) {
                    *s += factors.beta_r_s * p;
                }
            }
            operator.product(&strained, &mut work.residual);
        }
    }
}

/// residual −= external forces.
fn apply_load<const L: usize>(state: &mut State<L>) {
    let work = &mut state.workspace;
    for (dof, share) in &work.places.loaded {
        let lanes = work.residual.at_mut(dof.place, dof.component);
        for l in 0..L {
            lanes[l] -= share * state.load_n[l];
        }
    }
}

/// At a fixed degree of freedom the support carries the residual.
fn collect_reactions<const L: usize>(state: &mut State<L>) {
    let work = &state.workspace;
    let mut reaction = [[0.0; L]; 3];
    for dof in &work.places.fixed {
        let lanes = work.residual.at(dof.place, dof.component);
        for l in 0..L {
            reaction[dof.component][l] += lanes[l];
        }
    }
    state.reaction_n = reaction;
}

/// Where a contact node is held, the support carries its friction, too.
fn collect_held_friction<const L: usize>(state: &mut State<L>) {
    for &(slave, component) in &state.workspace.places.held {
        let force = &state.contacts.force_n[slave][component];
        for l in 0..L {
            state.reaction_n[component][l] -= force[l];
        }
    }
}

/// u* and p* of the constrained planes without contact, in place.
fn advance_constrained_planes<const L: usize>(model: &Model, factors: Factors, state: &mut State<L>) {
    let work = &mut state.workspace;
    // Before the general update: it overwrites the old values that the ties need.
    for ((tie, dofs), values) in model.ties().iter().zip(&work.places.tied).zip(&mut work.tied) {
        let mut residual = [0.0; L];
        for dof in dofs {
            let lanes = work.residual.at(dof.place, dof.component);
            for l in 0..L {
                residual[l] += lanes[l];
            }
        }
        let first = dofs[0];
        let (u, p) = (state.u.at(first.place, first.component), state.p.at(first.place, first.component));
        for l in 0..L {
            let a = residual[l] * tie.inverse_mass;
            values[l] =
                (u[l] + (p[l] * factors.time_step_s - a * factors.u_scale), p[l] - a * factors.p_scale);
        }
    }
    work.integration.advance_constrained_planes(factors, &mut state.u, &mut state.p, &work.residual);
    for (dofs, values) in work.places.tied.iter().zip(&work.tied) {
        for dof in dofs {
            *state.u.at_mut(dof.place, dof.component) = values.map(|(u, _)| u);
            *state.p.at_mut(dof.place, dof.component) = values.map(|(_, p)| p);
        }
    }
}

/// The load times the displacement increments on both sides of `t_n`.
fn account_load_work<const L: usize>(state: &mut State<L>) {
    let next = load_stroke(&state.workspace.places, &state.u);
    let [before, now] = state.workspace.load_stroke_m;
    for l in 0..L {
        state.load_work_j.after_j[l] = state.load_n[l] * (next[l] - now[l]);
        state.load_work_j.before_j[l] = state.load_n[l] * (now[l] - before[l]);
    }
    state.workspace.load_stroke_m = [now, next];
}

/// Displacement [m] on which a unit of the total load does work.
fn load_stroke<const L: usize>(places: &Places, u: &Field<L>) -> [f64; L] {
    let mut stroke = [0.0; L];
    for (dof, share) in &places.loaded {
        let lanes = u.at(dof.place, dof.component);
        for l in 0..L {
            stroke[l] += share * lanes[l];
        }
    }
    stroke
}
