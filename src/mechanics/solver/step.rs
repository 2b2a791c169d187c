//! One time step of the β₂ method ([`scheme`](super::scheme)) with contact.

use super::drive::Drive;
use super::interface::solve::{RunNumber, StepData};
use super::model::Model;
use super::state::StateOf;
use super::support::Supported;

/// Advances all lanes from `t_n` to `t_{n+1}`. It is compiled by its caller, for any number of lanes.
pub(crate) fn step_of_lanes<const L: usize, R: RunNumber>(
    model: &Model,
    drives: &[Drive; L],
    state: &mut StateOf<L, R>,
) {
    let steps_done = state.steps_of_lanes();
    for lane in 0..L {
        state.load_n[lane] = drives[lane].load_n(steps_done[lane] as f64 * model.time_step_s());
    }
    let factors = model.scheme().step_factors(&steps_done);
    begin_load_strokes(&steps_done, state);

    let work = &mut state.workspace;
    let history = state.history.numbers_mut();
    work.pin.advance_free_planes(model.pin(), &factors, &mut state.u, &mut state.p, history);
    let residual = work.pin.residual_mut();
    work.load.act(&state.load_n, residual);
    state.reaction_n = work.supports.act(&mut Supported { u: &state.u, p: &state.p, residual });
    work.pin.advance_constrained_planes(&factors, &mut state.u, &mut state.p);

    let given = StepData { factors: &factors, drives, steps_done: &steps_done };
    let mut face = work.pin.face(&mut state.u, &mut state.p);
    let held_n = state.target.solve(&given, &mut face, &mut state.contacts);
    for c in 0..3 {
        for lane in 0..L {
            state.reaction_n[c][lane] -= held_n[c][lane];
        }
    }
    let [_, before, now] = state.load_stroke_m;
    state.load_stroke_m = [before, now, work.load.stroke_m(&state.u)];
    state.step += 1;
}

/// Sets the load's displacements of lanes at their first step: a pin that begins deformed has not moved before.
fn begin_load_strokes<const L: usize, R: RunNumber>(steps_done: &[u64; L], state: &mut StateOf<L, R>) {
    if steps_done.iter().all(|&steps| steps > 0) {
        return;
    }
    let stroke = state.workspace.load.stroke_m(&state.u);
    for lane in 0..L {
        if steps_done[lane] == 0 {
            for time in &mut state.load_stroke_m {
                time[lane] = stroke[lane];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::interface::law::Law;
    use crate::solver::{State, step};
    use crate::spec::JobSpec;

    /// Protects: the load of a step is that at its time t_n, not that of the step before or after.
    #[test]
    fn a_step_takes_the_load_of_its_own_time() {
        let mut spec = JobSpec::default();
        spec.scene.pin.elements = [6, 8, 5];
        spec.scene.clamp.width_m = 0.002;
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let dt = model.time_step_s();
        let drive = Drive { law: Law::coulomb(0.4), rate: 0.7, force_n: 30.0, ramp_s: 5.5 * dt };
        let mut state = State::<1>::at_rest(&model);
        for n in 0..8 {
            step(&model, &[drive], &mut state);
            assert_eq!(state.load_n[0], drive.load_n(f64::from(n) * dt), "step {n}");
        }
    }
}
