//! B15 Identities on a real limit cycle: momentum, macroscopic friction and energy.
//!
//! Problem: the reference pin on a coarse mesh at 7 rpm and μ = 0.4. Its limit cycle has stick, slip and
//! separation. P = Σ m p is the momentum of the free degrees of freedom (p_{n+1} = p_n + Δt a_n).
//!
//! * Newton: P_{n+1} − P_n = Δt (reaction + load + contact forces) in x, y and z at every step, because a
//!   translation causes no strain. The rounding is that of all rows of K u together.
//! * Macroscopic identity: let R = ⟨Σ_stick(μN − t_y) + Σ_slip μN(1 − cos φ)⟩/F over a window of time W. Then
//!   μ − ⟨T⟩/F − R = (ΔP_y − μ ΔP_z)/(F W) for *every* window, because Σt_y = μN − (the sums) holds at every
//!   step, ⟨T_contact⟩ − ⟨T⟩ = ΔP_y/W and ⟨N⟩ − F = ΔP_z/W. So over n cycles the residual stays below (range
//!   P_y + μ range P_z)/(F W), which falls as 1/W. Over whole periods it vanishes.
//! * Energy identity: work of drive and load − friction − damping − contact loss = change of the stored
//!   energy, to rounding if every step is audited. Over a window, the drive's work alone differs from the
//!   losses by at most the range of stored energy and load potential, which falls as 1/W relative to the
//!   work.
//!
//! Source: momentum and energy balance of the pin; the identities are derived here from Newton's law and the
//! definitions of `analysis`.

use crate::verification::common::{ROUNDINGS_PER_FORCE, stiffness_rows};
use crate::verification::evidence::Evidence;
use tribosweep_mechanics::analysis::sample::Sampler;
use tribosweep_mechanics::analysis::sums::Sums;
use tribosweep_mechanics::solver::energy::{Energies, EnergyLedger};
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, Model, State, step};
use tribosweep_mechanics::spec::JobSpec;

const MU: f64 = 0.4;
const LOAD_N: f64 = 30.0;
/// The limit cycle is reached before this time. The observation starts at it.
const TRANSIENT_S: f64 = 5.0e-3;
const WINDOWS_S: [f64; 4] = [0.5e-3, 1.0e-3, 2.0e-3, 4.0e-3];

fn model() -> Model {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    Model::from_scene(&spec.scene, &spec.numerics).unwrap()
}

fn momentum_ns(model: &Model, state: &State<1>) -> [f64; 3] {
    std::array::from_fn(|c| {
        (0..model.mesh().block().unwrap().node_count())
            .map(|node| model.pin().masses_kg()[node] * state.p[3 * node + c])
            .sum()
    })
}

/// Smallest and largest value so far.
#[derive(Clone, Copy)]
struct Range(f64, f64);

impl Range {
    const EMPTY: Self = Self(f64::INFINITY, f64::NEG_INFINITY);

    fn see(&mut self, value: f64) {
        *self = Self(self.0.min(value), self.1.max(value));
    }

    fn width(self) -> f64 {
        self.1 - self.0
    }
}

/// Work of the drive less all losses over a window [J].
fn drive_excess_j(from: &Energies, to: &Energies) -> f64 {
    let excess = |e: &Energies| e.drive_work_j - e.friction_j - e.damping_j - e.contact_loss_j;
    excess(to) - excess(from)
}

/// Protects: clamp reaction, contact forces, deficits of friction and energies agree with each other.
#[test]
fn identities_hold_in_every_window() {
    let model = model();
    let drive = Drive { law: Law::coulomb(MU), rate: 0.733, force_n: LOAD_N, ramp_s: 5.0e-4 };
    let dt = model.time_step_s();
    let rows = stiffness_rows(&model);
    let row_sums = rows.iter().map(|row| row.iter().map(|(_, k)| k.abs()).sum::<f64>()).sum::<f64>();

    let mut state = State::<1>::at_rest(&model);
    let mut ledger = EnergyLedger::new(&model, 1);
    let mut sampler = Sampler::new(&model);
    let mut sums = Sums::EMPTY;
    let (mut p_y, mut p_z, mut stored) = (Range::EMPTY, Range::EMPTY, Range::EMPTY);
    // Momentum, energies and time at the start of the observation.
    let mut start = ([0.0; 3], Energies::default(), 0.0);
    let (mut worst_newton, mut largest_u) = ([0.0_f64; 3], 0.0_f64);
    // Error that the rounding of the slip's direction may add to the sums of the deficits [N].
    let mut direction_rounding_n = 0.0;
    let mut macroscopic = Evidence::new("B15", "limit cycle, residual of the macroscopic identity", IDENTITY);
    let mut exact_residual = Evidence::new(
        "B15",
        "limit cycle, residual of the macroscopic identity against its own momentum change",
        IDENTITY,
    );
    let mut energy =
        Evidence::new("B15", "limit cycle, drive work less all losses over drive work", IDENTITY);
    let mut balance = Evidence::new("B15", "limit cycle, imbalance of energies over the input", IDENTITY);
    // (name, macroscopic residual, drive excess, drive work, window) of the windows. Their bounds follow at
    // the end, when the ranges over all of them are known.
    let mut windows = Vec::new();
    let total_s = TRANSIENT_S + WINDOWS_S[WINDOWS_S.len() - 1];
    let mut next_window = 0;
    for n in 0..(total_s / dt) as usize + 2 {
        let before = momentum_ns(&model, &state);
        let strained =
            state.u.values().zip(state.p.values()).map(|(u, p)| (u + model.scheme().beta_r_s * p).abs());
        largest_u = strained.fold(largest_u, f64::max);
        ledger.before_step(&model, &state);
        step(&model, &[drive], &mut state);
        ledger.after_step(&model, &[drive], &state);
        let after = momentum_ns(&model, &state);
        if n > 0 {
            for c in 0..3 {
                let contact: f64 = state.contacts.forces(0).map(|force| force[c]).sum();
                let load = if c == 2 { state.load_n[0] } else { 0.0 };
                let force = state.reaction_n[c][0] + contact - load;
                worst_newton[c] = worst_newton[c].max(((after[c] - before[c]) / dt - force).abs());
            }
        }
        let [sample] = sampler.sample(&model, &[drive], &state);
        if sample.time_s < TRANSIENT_S {
            start = (after, *ledger.energies(0), sample.time_s);
            continue;
        }
        sums.add(&sample, 1.0);
        p_y.see(after[1]);
        p_z.see(after[2]);
        let e = ledger.energies(0);
        stored.see(e.kinetic_j + e.elastic_j - e.load_work_j);
        for (slave, contact_state) in state.contacts.states(0).enumerate() {
            if contact_state == ContactState::Slip {
                let [x, y, _] = state.contacts.increment_of(slave, 0);
                let slip = (x * x + y * y).sqrt();
                direction_rounding_n += MU
                    * state.contacts.force_of(slave, 0)[2]
                    * (8.0 * f64::EPSILON * largest_u / slip).min(2.0);
            }
        }
        let window_s = sample.time_s - start.2;
        if next_window < WINDOWS_S.len() && window_s >= WINDOWS_S[next_window] {
            next_window += 1;
            let name = format!("{:.3} ms", window_s * 1e3);
            let residual = MU - sums.mu_star() - sums.stick_reduction() - sums.slip_reduction();
            let change = (after[1] - start.0[1]) - MU * (after[2] - start.0[2]);
            let steps = window_s / dt;
            let newton_n = newton_rounding_n(row_sums, largest_u);
            let bound =
                (direction_rounding_n / steps + (1.0 + MU) * newton_n) / LOAD_N + steps * f64::EPSILON;
            exact_residual.bounded(&name, residual, change / (LOAD_N * window_s), 1.0, bound);
            let drive_j = e.drive_work_j - start.1.drive_work_j;
            windows.push((name.clone(), residual, drive_excess_j(&start.1, e), drive_j, window_s));
            balance.found(&name, e.imbalance_j() / e.input_j(), 0.0, 1.0);
        }
    }
    let mut newton = Evidence::new("B15", "limit cycle, worst step of Newton's law, force off [N]", IDENTITY);
    let shares = sums.shares();
    assert!(shares.iter().all(|&share| share > 0.01), "stick, slip and separation all take part: {shares:?}");
    for (c, worst) in worst_newton.into_iter().enumerate() {
        // Each momentum is a sum over all nodes, and its change is Δt times a force.
        let size = model.pin().masses_kg().iter().sum::<f64>() * largest_speed(&state) / dt;
        let sums = 2.0 * rows.len() as f64 * f64::EPSILON * size;
        let bound = newton_rounding_n(row_sums, largest_u) + sums;
        newton.bounded(["x", "y", "z"][c], worst, 0.0, 1.0, bound);
    }
    for (name, residual, excess_j, drive_j, window_s) in windows {
        let bound = (p_y.width() + MU * p_z.width()) / (LOAD_N * window_s);
        macroscopic.bounded(&name, residual, 0.0, 1.0, bound + 1e-12);
        energy.bounded(&name, excess_j / drive_j, 0.0, 1.0, stored.width() / drive_j + 1e-12);
    }
    newton.judge_bounded("rounding of all rows of K u");
    exact_residual.judge_bounded("rounding of momentum, sums and slip directions");
    macroscopic.judge_bounded("range of the momentum over load times window");
    energy.judge_bounded("range of stored energy and load potential over the drive's work");
    balance.judge_exact(ROUNDINGS_PER_FORCE * state.step as f64);
}

const IDENTITY: &str = "balance of momentum and energy, see the topic's head";

/// Rounding [N] of the sum of all nodal forces.
fn newton_rounding_n(row_sums: f64, largest_u: f64) -> f64 {
    ROUNDINGS_PER_FORCE * f64::EPSILON * row_sums * largest_u
}

fn largest_speed(state: &State<1>) -> f64 {
    state.p.values().fold(0.0, |m: f64, p| m.max(p.abs()))
}
