//! B8 An oscillator that moves across the direction of its belt. Dry friction acts as viscous damping.
//!
//! A mass m on a spring k in x is held in y, the direction in which the belt moves with V. It slips all the
//! time. Coulomb's friction μN opposes the whole slip (ẋ, −V), so its part in x is −μN ẋ/√(V² + ẋ²). For |ẋ|
//! ≪ V this is the viscous force −cẋ with **c = μN/V**, however large the static friction would be. The
//! amplitude decays as e^{−ct/(2m)}, the frequency is √(k/m − c²/(4m²)), and the mean force on the support in
//! y is μN. Source: the expansion above, which neglects (ẋ/V)²/2, here below 10⁻¹². (A law that gave the
//! whole cone to x would stop the mass within a quarter of a period.)
//!
//! **The discrete solution**: friction at t_n opposes the step from t_n to t_{n+1}, so the displacement obeys
//! (1 + γ) x_{n+1} − (2 + γ − W²) x_n + x_{n−1} = 0, γ = cΔt/m, W² = kΔt²/m. The amplitude falls by the
//! factor √(1 + γ) in a step. The decay rate is ln(1 + γ)/(2Δt) = (c/2m)(1 − γ/2 + …), of first order. The
//! phase is of first order, too.

use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, X, Y, Z, audited_step};
use std::f64::consts::PI;
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, Model, State, TimeStep};

const MASS_KG: f64 = 2.0;
const OMEGA: f64 = 5.0;
const BELT_M_S: f64 = 0.5;
const NORMAL_N: f64 = 10.0;
/// c/(2m) = 0.4 1/s: 8 % of critical.
const MU: f64 = 0.08;
const DRIVE: Drive = Drive { law: Law::coulomb(MU), rate: BELT_M_S, force_n: NORMAL_N, ramp_s: 0.0 };
const DECAY: f64 = MU * NORMAL_N / BELT_M_S / (2.0 * MASS_KG);
/// (ẋ/V)² = 10⁻¹⁴ at the start.
const AMPLITUDE_M: f64 = 1.0e-7 * BELT_M_S / OMEGA;

/// Node 0 is held in y: released in x and z only.
fn oscillator(w: f64) -> (Model, State<1>) {
    let mut system = Particles::corners(MASS_KG);
    system.release(0, X).release(0, Z).load(0, Z, -1.0);
    system.spring(0, 1, [1.0, 0.0, 0.0], MASS_KG * OMEGA * OMEGA);
    let model = system.model(0.0, TimeStep::Given(w / OMEGA));
    let mut state = State::at_rest(&model);
    state.u[X] = AMPLITUDE_M;
    (model, state)
}

/// Protects: friction of a node that is held in one direction opposes its whole slip.
#[test]
fn is_damped_by_the_friction_across() {
    const SOURCE: &str = "friction μN against the slip (ẋ, −V), |ẋ| ≪ V: c = μN/V";
    let mut decay = Evidence::new("B8", "decay rate of an oscillator across the belt's motion [1/s]", SOURCE);
    let mut frequency =
        Evidence::new("B8", "frequency of an oscillator across the belt's motion [rad/s]", SOURCE);
    let mut discrete = Evidence::new(
        "B8",
        "displacement of an oscillator across the belt's motion against its difference equation, worst [m]",
        "exact discrete solution of (1 + γ) x_{n+1} − (2 + γ − W²) x_n + x_{n−1} = 0",
    );
    let mut support = Evidence::new(
        "B8",
        "force of the support of an oscillator across the belt's motion over μN, worst step",
        "the friction that the held direction carries",
    );
    let mut energy = Evidence::new(
        "B8",
        "energy balance of an oscillator across the belt's motion, relative to the energy put in",
        "work of the drive = friction + contact loss + stored energy, an identity of the scheme",
    );
    let mut most = 0;
    for w in [0.1, 0.05, 0.025] {
        let (model, mut state) = oscillator(w);
        let gamma = 2.0 * DECAY * w / OMEGA;
        let steps = (8.0 * PI / w) as usize;
        most = most.max(steps);
        let (mut x, mut own) = (vec![AMPLITUDE_M], vec![AMPLITUDE_M]);
        let (mut ledger, mut worst_carried) = (EnergyLedger::new(&model, 1), 1.0);
        for n in 0..steps {
            audited_step(&model, DRIVE, &mut state, &mut ledger);
            assert_eq!(
                state.contacts.state_of(0, 0),
                ContactState::Slip,
                "a held node slips on a moving belt"
            );
            assert_eq!(state.u[Y], 0.0, "what is held does not move");
            let carried = -state.reaction_n[Y][0] / (MU * NORMAL_N);
            if f64::abs(carried - 1.0) >= f64::abs(worst_carried - 1.0) {
                worst_carried = carried;
            }
            x.push(state.u[X]);
            // The first step from rest has half the force, so half of W² and of γ appear in it.
            let next = if n == 0 {
                own[0] - 0.5 * w * w / (1.0 + 0.5 * gamma) * own[0]
            } else {
                ((2.0 + gamma - w * w) * own[n] - own[n - 1]) / (1.0 + gamma)
            };
            own.push(next);
        }
        let resolution = format!("ωΔt = {w}");
        // The slip's direction gives at most (ẋ/V)²/2 of the force to x. N and the cone add ten roundings.
        let bound = 0.5 * (AMPLITUDE_M * OMEGA / BELT_M_S).powi(2) + 10.0 * f64::EPSILON;
        support.bounded(&resolution, worst_carried, 1.0, 1.0, bound);
        energy.found(&resolution, ledger.energies(0).relative_residual(), 0.0, 1.0);
        let worst =
            (0..x.len()).max_by(|&a, &b| (x[a] - own[a]).abs().total_cmp(&(x[b] - own[b]).abs())).unwrap();
        discrete.found(&resolution, x[worst], own[worst], AMPLITUDE_M);
        // x_{n+1} = a x_n + b x_{n−1} is fitted by least squares; e^{−2 decay Δt} = −b.
        let sums = x[1..].windows(3).fold([0.0; 5], |s, x| {
            [
                s[0] + x[1] * x[1],
                s[1] + x[1] * x[0],
                s[2] + x[0] * x[0],
                s[3] + x[1] * x[2],
                s[4] + x[0] * x[2],
            ]
        });
        let determinant = sums[0] * sums[2] - sums[1] * sums[1];
        let a = (sums[3] * sums[2] - sums[4] * sums[1]) / determinant;
        let b = (sums[0] * sums[4] - sums[1] * sums[3]) / determinant;
        let dt = model.time_step_s();
        decay.found(&resolution, -0.5 * (-b).ln() / dt, DECAY, DECAY);
        let exact = (OMEGA * OMEGA - DECAY * DECAY).sqrt();
        frequency.found(&resolution, (a / (2.0 * (-b).sqrt())).acos() / dt, exact, exact);
    }
    // There are about ten roundings per step, and they do not grow. The neglected term of the expansion,
    // 10⁻¹⁴ of c, is smaller.
    discrete.judge_exact(10.0 * most as f64);
    // A fitted coefficient is uncertain by a few roundings of x over its second difference W² x. The decay is
    // uncertain by that over 2Δt.
    let rounding = 4.0 * f64::EPSILON / (0.025_f64.powi(3) / OMEGA) / (2.0 * DECAY);
    decay.judge_order(1.0, 2.0, rounding);
    frequency.judge_order(1.0, 2.0, rounding);
    support.judge_bounded("(ẋ/V)²/2 and ten roundings");
    energy.judge_exact(most as f64);
}
