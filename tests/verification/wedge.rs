//! B7 A block on a wedge: the push that makes it slide.
//!
//! A block of weight G on a rigid wedge of slope tan α = 0.1 is pushed horizontally with F. Along the slope
//! the pull is F cos α − G sin α, and the pressure is F sin α + G cos α. Coulomb's limit is reached at F/G =
//! tan(α + arctan μ) = (tan α + μ)/(1 − μ tan α). For μ = 0, 0.1, 0.2, 0.3 this gives F/G = 0.1, 0.202020,
//! 0.306122, 0.412371, the published values of the NAFEMS contact benchmark CGS-4 (Feng and Prinja,
//! *Benchmark Tests for Finite Element Modelling of Contact, Gliding and Sliding*, R0081, 2001).
//!
//! The acceleration beyond the limit is linear in F, so two runs give the limit by extrapolation to zero
//! acceleration. There is no discretisation error; only rounding remains.

use crate::verification::common::advance;
use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, Y, Z};
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, State, TimeStep};

const SLOPE: f64 = 0.1;
const STEPS: usize = 100;

/// Pushes the block with `push` times the weight for some steps. Returns the distance [weights over mass
/// times elapsed time²/2], and whether it stuck throughout.
fn pushed(push: f64, mu: f64) -> (f64, bool) {
    let (sine, cosine) = SLOPE.atan().sin_cos();
    let mut block = Particles::corners(1.0);
    block.release(0, Y).release(0, Z).load(0, Y, push * cosine - sine).load(0, Z, -(push * sine + cosine));
    let model = block.model(0.0, TimeStep::Given(1.0e-3));
    let drive = Drive { law: Law::coulomb(mu), rate: 0.0, force_n: 1.0, ramp_s: 0.0 };
    let mut state = State::at_rest(&model);
    let mut sticks = true;
    for _ in 0..STEPS {
        advance(&model, &drive, &mut state, 1);
        sticks &= state.contacts.state_of(0, 0) == ContactState::Stick;
    }
    let elapsed_s = STEPS as f64 * model.time_step_s();
    (state.u[Y] / (0.5 * elapsed_s * elapsed_s), sticks)
}

/// Protects: the friction limit is right with normal and tangential force from the same load.
#[test]
fn slides_at_the_published_push() {
    let mut limit = Evidence::new(
        "B7",
        "push F/G at which a block on a wedge slides",
        "NAFEMS contact benchmark CGS-4 (R0081): F/G = tan(α + arctan μ)",
    );
    for (mu, published) in [(0.0, "0.1"), (0.1, "0.202020"), (0.2, "0.306122"), (0.3, "0.412371")] {
        let exact = (SLOPE + mu) / (1.0 - mu * SLOPE);
        assert!((exact - published.parse::<f64>().unwrap()).abs() < 5.1e-7, "{exact} is as published");
        let (low, high) = (1.5 * exact, 2.5 * exact);
        let (slow, fast) = (pushed(low, mu).0, pushed(high, mu).0);
        let found = low - slow * (high - low) / (fast - slow);
        limit.found(format!("μ = {mu}"), found, exact, exact);
        // Trial force and limit are differences of rounded products of size G. The two pushes are a thousand
        // roundings off the limit.
        let edge = 1000.0 * f64::EPSILON;
        if mu > 0.0 {
            assert!(pushed(exact * (1.0 - edge), mu).1, "μ = {mu}: it sticks below the limit");
        }
        assert!(!pushed(exact * (1.0 + edge), mu).1, "μ = {mu}: it slides above the limit");
    }
    // There are a few roundings per step. The extrapolation amplifies them by at most G/F.
    limit.judge_exact(10.0 * STEPS as f64 / SLOPE);
}
