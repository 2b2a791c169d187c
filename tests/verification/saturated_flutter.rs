//! B9 The saturated flutter of the mode-coupled oscillator (`mode_coupling`): stick, slip and lift-off.
//!
//! Growth ends when the contact opens and sticks. There is no closed solution. But over a window T with load
//! F = N0 and belt speed V, every bounded motion obeys:
//!
//! ```text
//! momentum in z:   ⟨N⟩ = F + ΔP_z/T
//! momentum in y:   ⟨friction⟩ = ⟨force of clamp⟩ + ΔP_y/T
//! law of friction: μ − μ* = (1/F)⟨Σ_stick (μN − τ) + Σ_slip μN (1 − cos φ)⟩,  μ* = ⟨clamp⟩/F, ΔP = 0
//! energy:          work of the drive = friction + contact loss + stored energy
//! ```
//!
//! φ is the angle between slip and belt velocity. Source: Newton's second law and Coulomb's law, summed over
//! the window. The scheme's contact forces act at t_n and change p_n → p_{n+1}, so the sums hold to rounding.
//! By these identities the program judges its own μ*. Here they are tested on a system whose onset of flutter
//! is known exactly.

use crate::verification::evidence::Evidence;
use crate::verification::mode_coupling::{BODY_Z, NORMAL_N, oscillator, steady};
use crate::verification::particles::{Y, Z, audited_step};
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, State};

/// Averages over a window of the saturated oscillation, in units of the load N0.
#[derive(Default)]
struct Saturated {
    steps: usize,
    normal: f64,
    friction: f64,
    clamp: f64,
    /// μN − τ of sticking and μN(1 − cos φ) of slipping steps, φ between slip and belt velocity.
    deficit: f64,
    /// Change of momentum in y and z over N0 times the window.
    momentum: [f64; 2],
    /// Largest momentum over N0 times the window.
    largest_momentum: f64,
    shares: [f64; 3],
    energy_residual: f64,
}

fn saturated(mu: f64, belt_speed_m_s: f64, time_step_s: f64) -> Saturated {
    let model = oscillator(time_step_s);
    let drive = Drive { law: Law::coulomb(mu), rate: belt_speed_m_s, force_n: NORMAL_N, ramp_s: 0.0 };
    let mut state = steady(&model, mu);
    state.u[Y] += 1.0e-2;
    let mut ledger = EnergyLedger::new(&model, 1);
    // The start takes 100 e-folds of the linear growth. The window is as long again.
    let steps = (1000.0 / time_step_s) as usize;
    for _ in 0..steps {
        audited_step(&model, drive, &mut state, &mut ledger);
    }
    let momentum = |state: &State<1>| [state.p[Y], state.p[Z] + state.p[BODY_Z]];
    let before = momentum(&state);
    let mut found = Saturated { steps, ..Saturated::default() };
    for _ in 0..steps {
        audited_step(&model, drive, &mut state, &mut ledger);
        let contacts = &state.contacts;
        let [_, friction, normal] = contacts.force_of(0, 0);
        found.normal += normal;
        found.friction += friction;
        found.clamp -= state.reaction_n[Y][0];
        found.shares[contacts.state_of(0, 0) as usize] += 1.0;
        found.deficit += match contacts.state_of(0, 0) {
            ContactState::Separated => 0.0,
            ContactState::Stick => mu * normal - friction,
            // Belt and slip are parallel, and cos φ is 1 where the belt overtakes the node.
            ContactState::Slip => mu * normal * (1.0 + contacts.increment_of(0, 0)[Y].signum()),
        };
        let now = momentum(&state).map(f64::abs);
        found.largest_momentum = found.largest_momentum.max(now[0] + mu * now[1]);
    }
    let window = steps as f64 * NORMAL_N;
    let after = momentum(&state);
    found.momentum = [0, 1].map(|c| (after[c] - before[c]) / (window * time_step_s));
    found.largest_momentum /= window * time_step_s;
    for sum in [&mut found.normal, &mut found.friction, &mut found.clamp, &mut found.deficit] {
        *sum /= window;
    }
    found.shares = found.shares.map(|count| count / steps as f64);
    found.energy_residual = ledger.energies(0).relative_residual();
    found
}

/// Protects: the identities on which μ* rests hold on a limit cycle with stick, slip and lift-off: momentum
/// in both directions, the deficit of friction, and energy.
#[test]
fn the_saturated_oscillation_obeys_the_identities() {
    const MOMENTUM: &str = "momentum of the oscillator over the window, an identity of the scheme";
    let mu = 0.4;
    let mut normal = Evidence::new(
        "B9",
        "mean normal contact force of saturated flutter less the change of momentum over the load",
        MOMENTUM,
    );
    let mut friction = Evidence::new(
        "B9",
        "mean force of the clamp on saturated flutter plus momentum gained, over the mean friction force",
        MOMENTUM,
    );
    let mut deficit = Evidence::new(
        "B9",
        "μ − μ* of saturated flutter, forces of clamp and load, against the deficit of friction",
        "μ − μ* = (1/F)⟨Σ_stick (μN − τ) + Σ_slip μN (1 − cos φ)⟩ in the periodic state",
    );
    let mut energy = Evidence::new(
        "B9",
        "energy balance of saturated flutter, relative to the energy put in",
        "work of the drive = friction + contact loss + stored energy, an identity of the scheme",
    );
    for belt_speed_m_s in [0.1, 0.3, 1.0] {
        for time_step_s in [0.05, 0.0125] {
            let found = saturated(mu, belt_speed_m_s, time_step_s);
            let at = format!("V = {belt_speed_m_s} m/s, Δt = {time_step_s} s");
            assert!(
                found.shares.iter().all(|&share| share > 0.02),
                "{at}: stick, slip, lift-off {:?}",
                found.shares
            );
            // The sums have one term per step, each rounded at the size of the sum. There are twice as many
            // steps since the start.
            let rounding = 4.0 * found.steps as f64 * f64::EPSILON;
            normal.bounded(&at, found.normal - found.momentum[1], 1.0, 1.0, rounding);
            friction.bounded(&at, (found.clamp + found.momentum[0]) / found.friction, 1.0, 1.0, rounding);
            let mu_star = found.clamp;
            assert!(found.deficit > 0.05 * mu, "{at}: stick and reversed slip lower μ*");
            deficit.bounded(
                &at,
                mu - mu_star,
                found.deficit,
                mu,
                2.0 * found.largest_momentum / mu + rounding,
            );
            energy.bounded(&at, found.energy_residual, 0.0, 1.0, rounding);
        }
    }
    normal.judge_bounded("4 roundings a step");
    friction.judge_bounded("4 roundings a step");
    deficit.judge_bounded(
        "twice the largest momentum over load times window: the window is no whole number of cycles",
    );
    energy.judge_bounded("4 roundings a step");
}
