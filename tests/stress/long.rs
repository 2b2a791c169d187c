//! Long runs at 0.99 of the true stability limit. An analysis of the scheme gives bounds of their energies.
//!
//! A run in the ordinary suite has 20 000 steps, a run in `scripts/stability.py` a million.

use crate::random::Random;
use crate::stress::audited::Audited;
use crate::stress::modes;
use crate::stress::scenes::{IDLE, in_the_air, pin};
use crate::stress::summary;
use serde_json::json;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::support::Support;
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, State};

const FRACTION: f64 = 0.99;
const SHORT: u64 = 20_000;
const LONG: u64 = 1_000_000;

/// The result of a long run.
struct Course {
    scene: &'static str,
    steps: u64,
    /// Largest ratio of the energy to its analytical bound; must be ≤ 1.
    energy_over_bound: f64,
    /// |imbalance| over the rounding bound at the end; must be ≤ 1.
    imbalance_over_rounding: f64,
    /// |imbalance| over the energy put in.
    residual: f64,
}

/// Runs `steps` steps. `energy_over_bound` is the ratio of the energy to its analytical bound after every
/// step.
fn follow(
    scene: &'static str,
    mut run: Audited<'_>,
    steps: u64,
    energy_over_bound: impl Fn(&Audited<'_>) -> f64,
) -> Course {
    let mut highest: f64 = 0.0;
    for _ in 0..steps {
        run.advance();
        let ratio = energy_over_bound(&run);
        // `max` would ignore a NaN.
        highest = if ratio <= highest { highest } else { ratio };
    }
    let energies = run.energies();
    let course = Course {
        scene,
        steps,
        energy_over_bound: highest,
        imbalance_over_rounding: energies.imbalance_j().abs() / run.rounding_bound_j(),
        residual: energies.relative_residual(),
    };
    // These comparisons also fail for NaN.
    assert!(course.energy_over_bound <= 1.0, "{scene}: {} of the bound", course.energy_over_bound);
    assert!(course.imbalance_over_rounding <= 1.0, "{scene}: {}", course.imbalance_over_rounding);
    course
}

fn at_the_limit(definition: &ModelDefinition) -> Model {
    let mode = modes::highest(definition, false);
    modes::at_fraction(definition, &mode, FRACTION).expect("a step that is not checked")
}

/// A pin in the air with random velocities, without momentum in z. (Its supports prevent all other rigid
/// motions.)
fn shaken(model: &Model) -> State<1> {
    let mut state = State::at_rest(model);
    let mut random = Random::of_case(1, 0);
    let (mut momentum, mut total) = (0.0, 0.0);
    for dof in 0..state.p.len() {
        state.p[dof] = random.between(-1.0e-3, 1.0e-3);
        if dof % 3 == 2 {
            momentum += state.p[dof] * model.pin().masses_kg()[dof / 3];
            total += model.pin().masses_kg()[dof / 3];
        }
    }
    let nodes = model.mesh().node_count();
    for node in 0..nodes {
        state.p[3 * node + 2] -= momentum / total;
        // The height is far above the amplitudes (10⁻³ m/s over 10⁴ to 10⁶ 1/s), but so small that its
        // rounding does not hide them.
        state.u[3 * node + 2] = 2.0e-6;
    }
    state
}

/// Gives clamped and tied degrees of freedom initial velocities that their supports allow.
fn admissible(definition: &ModelDefinition, model: &Model, state: &mut State<1>) {
    for support in &definition.supports {
        if let Support::Fixed(fixed) = support {
            fixed.dofs.iter().for_each(|&dof| state.p[dof] = 0.0);
        }
        if let Support::Tied(tied) = support {
            let mass = |node: &usize| model.pin().masses_kg()[*node];
            let total: f64 = tied.nodes.iter().map(mass).sum();
            let momentum: f64 = tied.nodes.iter().map(|n| mass(n) * state.p[3 * n + tied.component]).sum();
            tied.dofs().for_each(|dof| state.p[dof] = momentum / total);
        }
    }
}

/// A pin that is shaken in the air. For β₂ = ½ without damping the scheme conserves its energy E. For every
/// mode ½vMv + ½uKu is at most E/(1 − (ωΔt/2)²), so it is at most E/(1 − 0.99²) = 50.3 E at all times. With
/// β₂ > ½ or β_R > 0, E only falls.
fn in_the_air_course(
    scene: &'static str,
    elements: [usize; 3],
    beta2: f64,
    damped: bool,
    steps: u64,
) -> Course {
    let mut definition = in_the_air(ModelDefinition { beta2, ..pin(elements) });
    if damped {
        definition.beta_r_s = 0.02 / modes::highest(&definition, false).omega;
    }
    let model = at_the_limit(&definition);
    let mut state = shaken(&model);
    admissible(&definition, &model, &mut state);
    let run = Audited::new(&model, IDLE, state);
    let conserves = beta2 == 0.5 && !damped;
    follow(scene, run, steps, |run| {
        let e = run.energies();
        let rounding_j = run.rounding_bound_j();
        if conserves {
            e.elastic_j / ((e.initial_j + rounding_j) / (1.0 - FRACTION * FRACTION))
        } else {
            (e.kinetic_j + e.elastic_j) / (e.initial_j + rounding_j)
        }
    })
}

/// A pin under a sudden load without friction. Only the load does work, W = F s with the stroke s. Damping
/// and contact do not supply energy (for β₂ = ½ a contact force N takes N z_{n−1}/2 ≥ 0). With the pin's
/// stiffness k ≥ EA/h, ½ k s² ≤ stored ≤ F s. So stored ≤ 2F²h/(EA), four times the static compression.
fn pressed_course(elements: [usize; 3], steps: u64) -> Course {
    let definition = pin(elements);
    let model = at_the_limit(&definition);
    let drive = Drive { force_n: 30.0, ..IDLE };
    let [lx, ly, lz] = model.mesh().size_m();
    let most_j = 2.0 * 30.0_f64.powi(2) * lz / (model.pin().material().young_modulus_pa * lx * ly);
    let run = Audited::new(&model, drive, State::at_rest(&model));
    follow("sudden load, no friction", run, steps, |run| {
        (run.energies().kinetic_j + run.energies().elastic_j) / (most_j + run.rounding_bound_j())
    })
}

/// A pin that is dragged over the disk. It stores at most the energy that was put in.
fn sliding_course(scene: &'static str, elements: [usize; 3], mu: f64, steps: u64) -> Course {
    let definition = ModelDefinition { beta_r_s: 5.0e-8, ..pin(elements) };
    let model = at_the_limit(&definition);
    let drive = Drive { law: Law::coulomb(mu), rate: 0.733, force_n: 30.0, ramp_s: 1.0e-4 };
    let run = Audited::new(&model, drive, State::at_rest(&model));
    follow(scene, run, steps, |run| {
        let e = run.energies();
        let put_in_j = e.load_work_j + e.drive_work_j + run.rounding_bound_j();
        (e.kinetic_j + e.elastic_j) / put_in_j
    })
}

fn all(steps: u64) -> Vec<Course> {
    vec![
        in_the_air_course("in the air, one element, undamped", [1, 1, 1], 0.5, false, steps),
        in_the_air_course("in the air, undamped", [2, 2, 2], 0.5, false, steps),
        in_the_air_course("in the air, β₂ = 1", [2, 2, 2], 1.0, false, steps),
        in_the_air_course("in the air, β_R > 0", [2, 2, 2], 0.5, true, steps),
        pressed_course([1, 1, 1], steps),
        pressed_course([2, 2, 2], steps),
        sliding_course("sliding, μ = 0.4", [1, 1, 1], 0.4, steps),
        sliding_course("sliding, μ = 0.4", [2, 2, 2], 0.4, steps),
        sliding_course("sliding, μ = 2", [2, 2, 2], 2.0, steps),
    ]
}

/// Protects: at 0.99 of the true limit the energies stay below the bounds from an analysis of the scheme, and
/// the balance closes to the rounding of the run.
#[test]
fn energies_stay_bounded() {
    all(SHORT);
}

/// Protects: the same over a million steps.
#[test]
#[ignore = "a minute or two; scripts/stability.py runs it"]
fn energies_stay_bounded_over_a_million_steps() {
    let lines: Vec<_> = all(LONG)
        .iter()
        .map(|course| {
            json!({
                "scene": course.scene,
                "steps": course.steps,
                "energy_over_bound": course.energy_over_bound,
                "imbalance_over_rounding": course.imbalance_over_rounding,
                "residual": course.residual,
            })
        })
        .collect();
    summary::write("long", &lines);
}
