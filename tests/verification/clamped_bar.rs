//! B6 A clamped bar that hits its obstacle periodically.
//!
//! Problem: a bar with ρ = E = L = 1 is held at u(1) = 0 and has the obstacle u(0) ≥ 0. It is released at
//! rest from u0 = (1 − x)/2. Source: the one-dimensional impact problem of F. Dabaghi, A. Petrov, J. Pousin,
//! Y. Renard, *A robust finite element redistribution approach for elastodynamic contact problems*, Appl.
//! Numer. Math. 103 (2016).
//!
//! The solution, by d'Alembert: the release sends a wave from the free end that relieves the stress −½ and
//! leaves v = −½, so u(0, t) = ½ − t/2. At t = 1 the wave is at the clamp, and the whole bar is undeformed at
//! v = −½. Then both ends stop, and u(0) = 0 with the contact stress ½. At t = 2 both waves have crossed, and
//! the whole bar moves at +½. From then on u(0, t) = (t − 2)/2, until the bar is at rest at t = 3 as at the
//! start. The period is 3, the energy ⅛, and the impulse ½ per period.
//!
//! The scheme with N elements and C = cΔt/h: its energy ½vMv + ½uKu − ¼Δt²aMa starts at (1 − C²/2N)/8,
//! because the stress at the released end accelerates its half element by c²/h. The first closing loses 1/2N
//! more (see `bar`). At C = 1 the motion is then exactly periodic, because the contact node is left at rest
//! when the bar leaves. So errors have order 1 and do not grow. Below the limit fronts disperse, which gives
//! order ⅔ (see `bar`).

use crate::verification::common::{
    FRONT_ORDER, IDLE, ROUNDINGS_PER_FORCE, advance, axial_bar, normal_force_n, step_at_cfl,
};
use crate::verification::evidence::Evidence;
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::{Model, ModelDefinition, State};

const PERIODS: usize = 3;
const DABAGHI: &str = "clamped bar of Dabaghi et al. (2016), d'Alembert";
const FRONT: &str = "dispersed fronts and the whole steps of contact shift single values";

fn base_m(t: f64) -> f64 {
    let t = t % 3.0;
    ((1.0 - t) / 2.0).max((t - 2.0) / 2.0).max(0.0)
}

#[derive(Default, Clone, Copy)]
struct Period {
    worst_base_m: f64,
    impulse_ns: f64,
    /// Mean contact stress over the middle half of the contact.
    stress_pa: f64,
    /// Stored energy at the end of the period over ⅛.
    energy: f64,
}

fn run(layers: usize, cfl: f64) -> [Period; PERIODS] {
    let material = Material { young_modulus_pa: 1.0, poisson_ratio: 0.0, density_kg_m3: 1.0 };
    let base = axial_bar(1.0, layers, material, true);
    let model = Model::new(ModelDefinition { time_step: step_at_cfl(&base, cfl), ..base }).unwrap();
    let area_m2 = model.mesh().block().unwrap().size_m()[0] * model.mesh().block().unwrap().size_m()[1];
    let dt = model.time_step_s();
    let mut state = State::at_rest(&model);
    for node in 0..model.mesh().block().unwrap().node_count() {
        state.u[3 * node + 2] = (1.0 - model.mesh().block().unwrap().coordinates_m(node)[2]) / 2.0;
    }
    let mut ledger = EnergyLedger::new(&model, 1);
    let steps = (3.0 / dt).round() as usize;
    let mut found = [Period::default(); PERIODS];
    for (number, period) in found.iter_mut().enumerate() {
        let mut middle_steps = 0;
        for n in 0..steps {
            let t = n as f64 * dt;
            period.worst_base_m = period.worst_base_m.max((state.u[2] - base_m(t)).abs());
            ledger.before_step(&model, &state);
            advance(&model, &IDLE, &mut state, 1);
            ledger.after_step(&model, &[IDLE], &state);
            let stress_pa = normal_force_n(&state) / area_m2;
            period.impulse_ns += stress_pa * dt;
            if (1.25..1.75).contains(&t) {
                period.stress_pa += stress_pa;
                middle_steps += 1;
            }
        }
        period.stress_pa /= f64::from(middle_steps);
        let energies = ledger.energies(0);
        period.energy = (energies.kinetic_j + energies.elastic_j) / (0.125 * area_m2);
        let rounding = ROUNDINGS_PER_FORCE * (layers * steps * (number + 1)) as f64 * f64::EPSILON;
        let initial = energies.initial_j / (0.125 * area_m2);
        let exact = 1.0 - cfl * cfl / (2.0 * layers as f64);
        assert!((initial - exact).abs() < rounding, "energy at the start: {initial} of ⅛ instead of {exact}");
        assert!(energies.relative_residual() < rounding, "the balance of energies closes: {energies:?}");
    }
    found
}

/// Protects: the results of three periods converge with their orders, at the limit and below it.
#[test]
fn impacts_repeat() {
    series("", &[20, 40, 80, 160]);
}

/// Protects: the orders are the same over six doublings.
#[test]
#[ignore = "bars of up to 1280 elements"]
fn impacts_repeat_over_six_doublings() {
    series(" (fine)", &[20, 40, 80, 160, 320, 640, 1280]);
}

fn series(suffix: &str, layers: &[usize]) {
    let finest = layers[layers.len() - 1] as f64;
    for (cfl, order) in [(1.0, 1.0), (0.5, FRONT_ORDER)] {
        let runs: Vec<_> = layers.iter().map(|&n| run(n, cfl)).collect();
        for period in 0..PERIODS {
            let case = |what: &str| {
                Evidence::new("B6", format!("cΔt/h = {cfl}{suffix}, period {}, {what}", period + 1), DABAGHI)
            };
            let mut base = case("worst error of the base over ½");
            let mut impulse = case("impulse of the contact");
            let mut stress = case("contact stress, mean of the middle half");
            let mut energy = case("energy over ⅛");
            for (n, run) in layers.iter().zip(&runs) {
                let name = format!("{n} elements");
                let found = run[period];
                base.found(&name, found.worst_base_m / 0.5, 0.0, 1.0);
                impulse.found(&name, found.impulse_ns, 0.5, 0.5);
                stress.found(&name, found.stress_pa, 0.5, 0.5);
                energy.found(&name, found.energy, 1.0, 1.0);
            }
            let operations = ROUNDINGS_PER_FORCE * finest * 3.0 * finest / cfl * (period + 1) as f64;
            let rounding = operations * f64::EPSILON;
            if cfl == 1.0 {
                base.judge_order(order, 2.0, rounding);
                impulse.judge_order(order, 2.0, rounding);
                stress.judge_exact(operations);
                energy.judge_order(order, 2.0, rounding);
            } else {
                base.judge_overall_order(order, 2.0, FRONT);
                impulse.judge_overall_order(order, 2.0, FRONT);
                stress.judge_overall_order(order, 2.0, FRONT);
                energy.judge_overall_order(order, 2.0, FRONT);
            }
        }
    }
}
