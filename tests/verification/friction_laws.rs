//! B17 Friction laws: a mass on a moving belt, with closed forms for every law.
//!
//! A mass m is held by a spring k from the ground and pressed with N on a belt of speed V. ω = √(k/m).
//!
//! * **Static and kinetic coefficients.** The mass is carried until k x = μ_s N, and then slips about x = μN/k. With
//!   Δ = (μ_s − μ)N/k and tan φ = V/(ωΔ), the slip lasts (π + 2φ)/ω: it ends at the mirror image of its beginning, where the
//!   mass has the velocity V again. Then the belt carries it over 2Δ. The period is (π + 2φ)/ω + 2Δ/V (den Hartog, *Mechanical
//!   Vibrations*, 4th ed. 1956, § 7.1).
//! * **A coefficient μ(v)** acts on a small oscillation about steady sliding like a damper of N μ′(V): the growth rate is
//!   −N μ′(V)/(2m). For `table` between pairs on a line it is the slope of that. For `exponential` μ′(V) = −(μ_s − μ) e^(−V/v₀)/v₀ + s, for `regularised` μ′(V) = μ v₀/(V + v₀)².
//! * **Prakash and Clifton's law** under a constant N depends on the slip s alone: limit = μN (1 − e^(−s/L)).

use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, X, Y, Z, audited_step};
use std::f64::consts::PI;
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::interface::law::{
    Exponential, Law, PrakashClifton, Regularised, StaticKinetic,
};
use tribosweep_mechanics::solver::{Drive, Model, State, TimeStep};
use tribosweep_mechanics::spec::{Contact, FrictionLaw, MuOfSpeed};

const MASS_KG: f64 = 2.0;
const STIFFNESS_N_M: f64 = 50.0;
const OMEGA: f64 = 5.0;
const NORMAL_N: f64 = 10.0;
const MU: f64 = 0.3;
const MU_STATIC: f64 = 0.5;

/// The mass can move in all directions, so that the vector code solves its contact.
fn oscillator(stiffness_n_m: f64, time_step_s: f64) -> Model {
    let mut system = Particles::corners(MASS_KG);
    system.release(0, X).release(0, Y).release(0, Z).load(0, Z, -1.0);
    if stiffness_n_m > 0.0 {
        system.spring(0, 2, [0.0, 1.0, 0.0], stiffness_n_m);
    }
    system.model(0.0, TimeStep::Given(time_step_s))
}

#[expect(clippy::large_types_passed_by_value, reason = "a test makes one, whose size does not matter")]
fn on_belt(law: Law, belt_speed_m_s: f64) -> Drive {
    Drive { law, rate: belt_speed_m_s, force_n: NORMAL_N, ramp_s: 0.0 }
}

/// Protects: the limit cycle of stick and slip that a static coefficient above the kinetic one causes.
#[test]
fn a_static_coefficient_causes_stick_slip() {
    let mut period = Evidence::new(
        "B17",
        "period of stick and slip with a static and a kinetic coefficient [s]",
        "(π + 2φ)/ω + 2Δ/V, tan φ = V/(ωΔ), Δ = (μ_s − μ)N/k",
    );
    let mut energy = Evidence::new(
        "B17",
        "energy balance of stick and slip, relative to the energy put in",
        "work of the drive = friction + contact loss + stored energy, an identity of the scheme",
    );
    let drop_m = (MU_STATIC - MU) * NORMAL_N / STIFFNESS_N_M;
    let speed_m_s = 0.731 * drop_m * OMEGA;
    let phase = (speed_m_s / (OMEGA * drop_m)).atan();
    let exact_s = (PI + 2.0 * phase) / OMEGA + 2.0 * drop_m / speed_m_s;
    for w in [0.08, 0.04, 0.02, 0.01] {
        let model = oscillator(STIFFNESS_N_M, w / OMEGA);
        let drive = on_belt(Law::StaticKinetic(StaticKinetic { mu: MU, mu_static: MU_STATIC }), speed_m_s);
        let (mut state, mut ledger) = (State::at_rest(&model), EnergyLedger::new(&model, 1));
        state.p[Y] = speed_m_s;
        let (mut ends, mut stuck) = (Vec::new(), true);
        while ends.len() <= PERIODS {
            audited_step(&model, drive, &mut state, &mut ledger);
            let sticks = state.contacts.state_of(0, 0) == ContactState::Stick;
            if stuck && !sticks {
                ends.push(state.step as f64 * model.time_step_s());
            }
            stuck = sticks;
        }
        let found_s = (ends[PERIODS] - ends[0]) / PERIODS as f64;
        period.found(format!("ωΔt = {w}"), found_s, exact_s, exact_s);
        let steps = state.step as f64;
        energy.bounded(
            format!("ωΔt = {w}"),
            ledger.energies(0).relative_residual(),
            0.0,
            1.0,
            steps * f64::EPSILON,
        );
    }
    period.judge_overall_order(1.0, 2.0, "stick ends anywhere in a step");
    energy.judge_bounded("one rounding a step");
}

const PERIODS: usize = 40;

/// The growth rate [1/s] of a small oscillation about steady sliding at the speed of the belt, over three periods.
#[expect(clippy::large_types_passed_by_value, reason = "a test makes one, whose size does not matter")]
fn growth_rate_per_s(law: Law, speed_m_s: f64, coefficient: f64, w: f64) -> f64 {
    let model = oscillator(STIFFNESS_N_M, w / OMEGA);
    let drive = on_belt(law, speed_m_s);
    let mut state = State::at_rest(&model);
    let centre_m = coefficient * NORMAL_N / STIFFNESS_N_M;
    state.u[Y] = centre_m;
    state.p[Y] = 1.0e-5 * speed_m_s;
    // A law that uses the slip of the step before would otherwise see a node without slip in the first step.
    state.contacts.increment_m[Y] = -speed_m_s * model.time_step_s();
    let mut ledger = EnergyLedger::new(&model, 1);
    // The largest displacement of each half period, from the parabola through three steps.
    let (mut peaks, mut last) = (Vec::new(), [0.0_f64; 2]);
    while peaks.len() < 7 {
        audited_step(&model, drive, &mut state, &mut ledger);
        let y = state.u[Y] - centre_m;
        let [first, middle] = last;
        let turns = (middle.abs() > first.abs()) && (middle.abs() >= y.abs()) && state.step > 2;
        if turns {
            let (slope, curvature) = (0.5 * (y - first), y - 2.0 * middle + first);
            let top: f64 = middle - 0.5 * slope * slope / curvature;
            peaks.push((state.step as f64 - slope / curvature, top.abs()));
        }
        last = [middle, y];
    }
    let (first, end) = (peaks[0], peaks[peaks.len() - 1]);
    (end.1 / first.1).ln() / ((end.0 - first.0) * model.time_step_s())
}

/// Protects: friction that depends on the slip speed feeds or damps oscillations as its slope says.
#[test]
fn the_slope_of_friction_is_a_damper() {
    let (speed_m_s, scale_m_s) = (0.4, 0.15);
    let exponential = |slope_s_m: f64| {
        let law =
            Law::Exponential(Exponential { mu: MU, mu_static: MU_STATIC, speed_m_s: scale_m_s, slope_s_m });
        let fall = (MU_STATIC - MU) * (-speed_m_s / scale_m_s).exp();
        (law, MU + fall + slope_s_m * speed_m_s, -fall / scale_m_s + slope_s_m)
    };
    let regularised = (
        Law::Regularised(Regularised { mu: MU, speed_m_s: scale_m_s }),
        MU * speed_m_s / (speed_m_s + scale_m_s),
        MU * scale_m_s / (speed_m_s + scale_m_s).powi(2),
    );
    // Where three pairs lie on a line, the curve is that line.
    let pairs = [[0.0, 0.52], [0.2, 0.46], [0.3, 0.43], [0.5, 0.37], [0.6, 0.34], [2.0, 0.4]];
    let table = Law::of(&Contact {
        law: FrictionLaw::Table,
        mu: 0.4,
        mu_of_speed: MuOfSpeed(pairs.to_vec()),
        ..Contact::default()
    });
    let cases = [
        ("table, falling", (table, 0.4, -0.3)),
        ("exponential, falling", exponential(0.0)),
        ("exponential with a viscous part, rising", exponential(1.0)),
        ("regularised", regularised),
    ];
    for (name, (law, coefficient, slope)) in cases {
        let mut growth = Evidence::new(
            "B17",
            format!("growth rate of an oscillation on a belt, law {name} [1/s]"),
            "−N μ′(V)/(2m)",
        );
        let exact = -NORMAL_N * slope / (2.0 * MASS_KG);
        for w in [0.04, 0.02, 0.01, 0.005] {
            let found = growth_rate_per_s(law, speed_m_s, coefficient, w);
            growth.found(format!("ωΔt = {w}"), found, exact, exact);
        }
        // The curvature of μ(v) shifts the centre by N μ″(ωA)²/(4k), which is 10⁻⁶ of the amplitude A = 2·10⁻⁶ m at the end. e⁻ˣ has
        // an error of up to 10⁻¹¹, which shifts it by another 10⁻⁶.
        growth.judge_order(1.0, 2.0, 1.0e-5);
    }
}

/// Protects: the limit of Prakash and Clifton's law follows the slip exactly, and its friction is what accelerates the mass.
#[test]
fn friction_follows_the_normal_force_over_a_slip() {
    let mut limit = Evidence::new(
        "B17",
        "friction limit of Prakash and Clifton's law over the slip [N]",
        "μN(1 − e^(−s/L))",
    );
    let (speed_m_s, length_m) = (0.5, 0.03);
    let model = oscillator(0.0, 1.0e-3);
    let drive = on_belt(Law::PrakashClifton(PrakashClifton { mu: MU, length_m }), speed_m_s);
    let (mut state, mut ledger) = (State::at_rest(&model), EnergyLedger::new(&model, 1));
    let mut slip_m = 0.0;
    let mut slid = 0;
    for step in 1..=400 {
        audited_step(&model, drive, &mut state, &mut ledger);
        // The limit of a step has seen the slip up to the step before.
        let exact_n = MU * NORMAL_N * (1.0 - libm::exp(-slip_m / length_m));
        let found_n = state.contacts.friction_limit_of(0, 0);
        if step % 100 == 0 {
            limit.bounded(format!("step {step}"), found_n, exact_n, MU * NORMAL_N, 1.0e-10);
        }
        assert!((found_n - exact_n).abs() < 1.0e-10 * MU * NORMAL_N, "step {step}: {found_n}, {exact_n}");
        let [x, y, _] = state.contacts.increment_of(0, 0);
        slip_m += libm::hypot(x, y);
        slid += usize::from(state.contacts.state_of(0, 0) == ContactState::Slip);
    }
    assert!(slid > 300, "it slips for most of the time: {slid}");
    assert!(ledger.energies(0).relative_residual() < 400.0 * f64::EPSILON);
    limit.judge_bounded("400 factors e^(−δ/L), each exact to 10⁻¹¹ of δ/L and rounding");
}
