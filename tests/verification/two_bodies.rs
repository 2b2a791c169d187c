//! B4b Two elastic bodies hit each other.
//!
//! Problem: two bars have length L = 10, E = 100, ρ = 0.01, ν = 0 (c = 100, impedance z = ρc = 1). The upper
//! one comes down at v = 0.1, and the gap of 0.01 closes at t = 0.1. Source: D. M. Runcie, *Impact of two
//! bars* as used in explicit contact codes (2022), d'Alembert. Contact lasts 2L/c, from 0.1 to 0.3, with the
//! interface at v/2 and the stress zv/2 = 0.05. Then the upper bar rests and the lower one has all of its
//! velocity. With E = 49 (c = 70, z = 0.7) the interface moves at z1 v/(z1+z2) = 0.0411765, and the stress
//! has the same value. At 0.3 the lower bar's wave is back, and the stress falls to 0.0072664 while contact
//! continues.
//!
//! The test is in three dimensions: the blocks are ten times as wide as long and have one element across (ν =
//! 0, so nothing moves sideways). The general contact solve is used, with target nodes of finite mass. The
//! lower block has its own stages where its step is the smaller.
//!
//! Below its limit the scheme disperses fronts, which gives order ⅔ (see `bar`). Action equals reaction at
//! every step, so momentum is conserved to rounding. With several stages it is formed with M̃ = M B⁻¹.

use crate::verification::common::{FRONT_ORDER, IDLE, ROUNDINGS_PER_FORCE, advance, normal_force_n};
use crate::verification::elastic::{Below, free_block, momentum, on_block};
use crate::verification::evidence::Evidence;
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::{ModelDefinition, State, TimeStep};
use tribosweep_mechanics::spec::{DiskTimeStep, TargetSurface};

const LENGTH: f64 = 10.0;
const SPEED: f64 = 0.1;
const GAP: f64 = 0.01;
const RUNCIE: &str = "two bars of Runcie (2022), d'Alembert";
const FRONT: &str = "dispersed fronts and the whole steps of contact shift single values";

#[derive(Debug)]
struct Impact {
    /// Mean contact stress in two spans.
    stress: [f64; 2],
    /// Momentum of both bars at the end over that at the start.
    momentum: [f64; 2],
    stages: usize,
    drift: f64,
    imbalance: f64,
    steps: usize,
}

/// Runs an impact until `end_s`. The stress is averaged in two `spans` [s].
fn run(
    layers: usize,
    young_modulus_pa: f64,
    clock: DiskTimeStep,
    spans: [[f64; 2]; 2],
    end_s: f64,
) -> Impact {
    let material = |young_modulus_pa| Material { young_modulus_pa, poisson_ratio: 0.0, density_kg_m3: 0.01 };
    let size = [10.0 * LENGTH, 10.0 * LENGTH, LENGTH];
    let base = free_block(size, [1, 1, layers], material(young_modulus_pa));
    let below = Below {
        material: material(100.0),
        thickness_m: LENGTH,
        elements: [1, 1, layers],
        target: TargetSurface::Bilinear,
        clock,
        held: false,
    };
    let model = on_block(ModelDefinition { time_step: TimeStep::FractionOfLimit(0.9), ..base }, &below);
    let (dt, area) = (model.time_step_s(), size[0] * size[1]);
    let mut state = State::<1>::at_rest(&model);
    for node in 0..model.mesh().block().unwrap().node_count() {
        state.u[3 * node + 2] = GAP;
        state.p[3 * node + 2] = -SPEED;
    }
    let start = momentum(&model, &state)[0];
    let mut ledger = EnergyLedger::new(&model, 1);
    let (mut stress, mut counts, mut drift) = ([0.0; 2], [0.0; 2], 0.0_f64);
    let steps = (end_s / dt).ceil() as usize;
    for n in 0..steps {
        ledger.before_step(&model, &state);
        advance(&model, &IDLE, &mut state, 1);
        ledger.after_step(&model, &[IDLE], &state);
        for (span, [from, to]) in spans.into_iter().enumerate() {
            if (from..to).contains(&(n as f64 * dt)) {
                stress[span] += normal_force_n(&state) / area;
                counts[span] += 1.0;
            }
        }
        let [upper, lower] = momentum(&model, &state);
        drift = drift.max(((upper + lower) / start - 1.0).abs());
    }
    Impact {
        stress: [0, 1].map(|span| stress[span] / counts[span]),
        momentum: momentum(&model, &state).map(|m| m / start),
        stages: model.ring().unwrap().stages().count(),
        drift,
        imbalance: ledger.energies(0).relative_residual(),
        steps,
    }
}

/// Rounding of sums over all degrees of freedom, at every step.
fn rounding(impact: &Impact, layers: usize) -> f64 {
    ROUNDINGS_PER_FORCE * (8 * layers * impact.steps) as f64 * f64::EPSILON
}

/// Protects: equal bars exchange their velocities with the exact stress, and momentum and energy are
/// conserved.
#[test]
fn equal_bars_exchange_their_velocities() {
    let mut stress = Evidence::new("B4b", "equal bars, contact stress over ρcv/2", RUNCIE);
    let mut upper = Evidence::new("B4b", "equal bars, momentum of the upper bar after it", RUNCIE);
    let mut lower = Evidence::new("B4b", "equal bars, momentum of the lower bar after it", RUNCIE);
    for layers in [20, 40, 80] {
        let found = run(layers, 100.0, DiskTimeStep::Common, [[0.15, 0.25], [0.15, 0.25]], 0.38);
        let name = format!("{layers} layers");
        stress.found(&name, found.stress[0] / 0.05, 1.0, 1.0);
        upper.found(&name, found.momentum[0], 0.0, 1.0);
        lower.found(&name, found.momentum[1], 1.0, 1.0);
        let bound = rounding(&found, layers);
        assert!(found.drift < bound && found.imbalance < bound, "{found:?}");
    }
    for evidence in [stress, upper, lower] {
        evidence.judge_overall_order(FRONT_ORDER, 2.0, FRONT);
    }
}

/// Protects: bars of different impedance have the exact stress in both phases of the contact, with two clocks
/// as with one.
#[test]
fn dissimilar_bars_stay_in_contact() {
    for (clock, name) in [(DiskTimeStep::Common, "one clock"), (DiskTimeStep::Own, "two clocks")] {
        let mut first =
            Evidence::new("B4b", format!("dissimilar bars, {name}, first stress over its size"), RUNCIE);
        let mut second =
            Evidence::new("B4b", format!("dissimilar bars, {name}, second stress over the first"), RUNCIE);
        for layers in [20, 40, 80] {
            let found = run(layers, 49.0, clock, [[0.15, 0.25], [0.33, 0.36]], 0.37);
            assert_eq!(found.stages > 1, clock == DiskTimeStep::Own, "{found:?}");
            let size = 0.07 / 1.7;
            first.found(format!("{layers} layers"), found.stress[0] / size, 1.0, 1.0);
            second.found(format!("{layers} layers"), found.stress[1] / size, 0.007_266_4 / size, 1.0);
            let bound = rounding(&found, layers);
            assert!(found.drift < bound && found.imbalance < bound, "{found:?}");
        }
        first.judge_overall_order(FRONT_ORDER, 2.0, FRONT);
        second.judge_overall_order(FRONT_ORDER, 2.0, FRONT);
    }
}
