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

use super::contact::{Face, elastic};
use super::field::in_slots;
use super::integrate::Factors;
use super::model::Model;
use super::operator::Operator;
use super::state::{ContactSolve, Drive, State};

/// Factors of Δt² a in `u_{n+1}` and of Δt a in `p_{n+1}`.
pub(super) fn factors(beta2: f64, step: u64) -> (f64, f64) {
    if step == 0 { (0.5, 1.0 - beta2) } else { (0.5 + beta2, 1.0) }
}

/// Advances all lanes from `t_n` to `t_{n+1}`.
pub fn step<const L: usize>(model: &Model, drives: &[Drive; L], state: &mut State<L>) {
    let dt = model.time_step_s();
    let (mut u_scale, mut p_scale) = ([0.0; L], [0.0; L]);
    let steps: [u64; L] = std::array::from_fn(|lane| state.steps_done(lane));
    for lane in 0..L {
        let n = steps[lane];
        state.load_n[lane] = drives[lane].load_n(n as f64 * dt);
        let (u_factor, p_factor) = factors(model.beta2(), n);
        (u_scale[lane], p_scale[lane]) = (u_factor * dt * dt, p_factor * dt);
    }
    let factors = Factors {
        time_step_s: dt,
        beta_r_s: model.beta_r_s(),
        u_scale: in_slots(&u_scale),
        p_scale: in_slots(&p_scale),
    };
    begin_load_strokes(state);
    internal_forces(model, &factors, state);
    let work = &mut state.workspace;
    state.reaction_n = work.supports.apply(&state.load_n, &mut work.residual);
    work.integration.advance_constrained_planes(&factors, &mut state.u, &mut state.p, &work.residual);
    let inverse_mass = work.integration.face_inverse_mass();
    let mut face = Face { u: &mut state.u, p: &mut state.p, residual: &work.residual, inverse_mass };
    match (&mut work.contact, model.disk(), &mut state.disk) {
        (ContactSolve::Rigid(contact), _, _) => {
            let held_n = contact.solve(&factors, drives, &mut face, &mut state.contacts);
            for c in 0..3 {
                for lane in 0..L {
                    state.reaction_n[c][lane] -= held_n[c][lane];
                }
            }
        }
        (ContactSolve::Elastic(contact), Some(body), Some(disk)) => {
            let given = elastic::Given {
                factors: &factors,
                drives,
                steps: steps.map(|n| n + 1),
                turned_rad: std::array::from_fn(|lane| drives[lane].rate * ((steps[lane] + 1) as f64 * dt)),
            };
            contact.solve(body, &given, &mut face, disk, &mut state.contacts);
        }
        (ContactSolve::Elastic(_), _, _) => unreachable!("an elastic contact has a disk"),
    }
    let [_, before, now] = state.load_stroke_m;
    state.load_stroke_m = [before, now, work.supports.load_stroke_m(&state.u)];
    state.step += 1;
}

/// Whoever begins with a deformed pin does not tell how it got there.
fn begin_load_strokes<const L: usize>(state: &mut State<L>) {
    if (0..L).all(|lane| state.steps_done(lane) > 0) {
        return;
    }
    let stroke = state.workspace.supports.load_stroke_m(&state.u);
    for lane in 0..L {
        if state.steps_done(lane) == 0 {
            for time in &mut state.load_stroke_m {
                time[lane] = stroke[lane];
            }
        }
    }
}

/// residual = K (u + β_R p) on the constrained planes; the others are moved.
fn internal_forces<const L: usize>(model: &Model, factors: &Factors, state: &mut State<L>) {
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
