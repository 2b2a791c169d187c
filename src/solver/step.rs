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
use super::model::Model;
use super::state::{Drive, State};

/// Factors of Δt² a in `u_{n+1}` and of Δt a in `p_{n+1}`.
pub(super) fn factors(beta2: f64, step: u64) -> (f64, f64) {
    if step == 0 { (0.5, 1.0 - beta2) } else { (0.5 + beta2, 1.0) }
}

/// Advances all lanes from `t_n` to `t_{n+1}`.
pub fn step<const L: usize>(model: &Model, drives: &[Drive; L], state: &mut State<L>) {
    let time_s = state.step as f64 * model.time_step_s();
    for l in 0..L {
        state.load_n[l] = drives[l].load_n(time_s);
    }
    internal_forces(model, state);
    apply_load(model, state);
    collect_reactions(model, state);
    for (slave, slave_node) in model.slaves().iter().enumerate() {
        let (to, from) = (3 * L * slave, 3 * L * slave_node.node);
        state.workspace.slave_u[to..to + 3 * L].copy_from_slice(&state.u[from..from + 3 * L]);
    }
    let (u_factor, p_factor) = factors(model.beta2(), state.step);
    predict(model, state, u_factor, p_factor);
    rigid::solve(
        model,
        drives,
        &mut Prediction {
            u: &mut state.u,
            p: &mut state.p,
            u_old: &state.workspace.slave_u,
            u_factor,
            p_factor,
        },
        &mut state.contacts,
    );
    collect_held_friction(model, state);
    account_load_work(model, state);
    state.step += 1;
}

/// residual = K (u + β_R p).
fn internal_forces<const L: usize>(model: &Model, state: &mut State<L>) {
    let beta_r = model.beta_r_s();
    let work = &mut state.workspace;
    if beta_r == 0.0 {
        model.operator().apply::<L>(&state.u, &mut work.residual);
        return;
    }
    for ((s, u), p) in work.strained.iter_mut().zip(&state.u).zip(&state.p) {
        *s = u + beta_r * p;
    }
    model.operator().apply::<L>(&work.strained, &mut work.residual);
}

/// residual −= external forces.
fn apply_load<const L: usize>(model: &Model, state: &mut State<L>) {
    if state.step == 0 {
        state.workspace.load_stroke_m = [load_stroke(model, &state.u); 2];
    }
    for loaded in model.load() {
        for l in 0..L {
            state.workspace.residual[loaded.dof * L + l] -= loaded.share * state.load_n[l];
        }
    }
}

/// At a fixed degree of freedom the support carries the residual.
fn collect_reactions<const L: usize>(model: &Model, state: &mut State<L>) {
    let mut reaction = [[0.0; L]; 3];
    for &dof in model.fixed() {
        for l in 0..L {
            reaction[dof % 3][l] += state.workspace.residual[dof * L + l];
        }
    }
    state.reaction_n = reaction;
}

/// Where a contact node is held, the support carries its friction, too.
fn collect_held_friction<const L: usize>(model: &Model, state: &mut State<L>) {
    for (slave_node, force) in model.slaves().iter().zip(&state.contacts.force_n) {
        for c in (0..2).filter(|&c| !slave_node.mobile[c]) {
            for l in 0..L {
                state.reaction_n[c][l] -= force[c][l];
            }
        }
    }
}

/// u* and p* without contact, in place.
fn predict<const L: usize>(model: &Model, state: &mut State<L>, u_factor: f64, p_factor: f64) {
    let dt = model.time_step_s();
    let (u_scale, p_scale) = (u_factor * dt * dt, p_factor * dt);
    // Before the general update: it overwrites the old values that the ties need.
    for (group, tie) in model.ties().iter().enumerate() {
        for l in 0..L {
            let residual: f64 = tie.dofs.iter().map(|dof| state.workspace.residual[dof * L + l]).sum();
            let a = -residual * tie.inverse_mass;
            let at = tie.dofs[0] * L + l;
            state.workspace.tied[group][l] =
                (state.u[at] + (dt * state.p[at] + u_scale * a), state.p[at] + p_scale * a);
        }
    }
    let fields = state.u.chunks_exact_mut(L).zip(state.p.chunks_exact_mut(L));
    let forces = state.workspace.residual.chunks_exact(L).zip(model.inverse_mass());
    for ((u, p), (residual, inverse_mass)) in fields.zip(forces) {
        for l in 0..L {
            let a = -residual[l] * inverse_mass;
            u[l] += dt * p[l] + u_scale * a;
            p[l] += p_scale * a;
        }
    }
    for (tie, values) in model.ties().iter().zip(&state.workspace.tied) {
        for &dof in &tie.dofs {
            for l in 0..L {
                (state.u[dof * L + l], state.p[dof * L + l]) = values[l];
            }
        }
    }
}

/// The load times the displacement increments on both sides of `t_n`.
fn account_load_work<const L: usize>(model: &Model, state: &mut State<L>) {
    let next = load_stroke(model, &state.u);
    let [before, now] = state.workspace.load_stroke_m;
    for l in 0..L {
        state.load_work_j.after_j[l] = state.load_n[l] * (next[l] - now[l]);
        state.load_work_j.before_j[l] = state.load_n[l] * (now[l] - before[l]);
    }
    state.workspace.load_stroke_m = [now, next];
}

/// Displacement [m] on which a unit of the total load does work.
fn load_stroke<const L: usize>(model: &Model, u: &[f64]) -> [f64; L] {
    let mut stroke = [0.0; L];
    for loaded in model.load() {
        for l in 0..L {
            stroke[l] += loaded.share * u[loaded.dof * L + l];
        }
    }
    stroke
}
