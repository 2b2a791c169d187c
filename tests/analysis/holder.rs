//! The motion of a holder in samples and in the record.

use crate::random::Random;
use std::ops::ControlFlow;
use tribosweep_mechanics::analysis::sample::{HolderSample, Sample};
use tribosweep_mechanics::analysis::sums::Sums;
use tribosweep_mechanics::analysis::{self, JobObserver, JobRecord, Moment, Outcome};
use tribosweep_mechanics::spec::{Clamp, ClampSide, Contact, FrictionLaw, Holder, JobSpec};

#[derive(Default)]
struct Motions(Vec<(f64, [HolderSample; 3])>);

impl JobObserver for Motions {
    fn step(&mut self, moment: &Moment<'_>) {
        self.0.push((moment.sample.time_s, moment.sample.holder));
    }

    fn needs_run(&self) -> bool {
        true
    }

    fn progress(&mut self, _: f64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

fn spec() -> JobSpec {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.run.limit_s = 0.004;
    spec.run.stop_early = false;
    spec
}

/// Protects: the record has the figures of a holder in the directions in which it moves. The window can begin and end within a
/// step, so its extremes are within those of the steps from the one before it on.
#[test]
fn the_record_has_the_motion_of_the_holder() {
    let mut spec = spec();
    spec.scene.holder.mass_kg = Some(0.01);
    spec.scene.holder.stiffness_y_n_m = Some(1.0e7);
    spec.scene.holder.stiffness_z_n_m = Some(0.0);
    let mut seen = Motions::default();
    let record = analysis::solve(&spec, &mut seen).unwrap();
    let directions: Vec<_> = record.holder.iter().map(|motion| motion.direction.as_str()).collect();
    assert_eq!(directions, ["y", "z"]);
    for (motion, axis) in record.holder.iter().zip([1, 2]) {
        let first_s = record.window_start_s - record.time_step_s;
        let in_window = || seen.0.iter().filter(|(time_s, _)| *time_s >= first_s).map(|(_, all)| all[axis]);
        let high = in_window().fold(f64::NEG_INFINITY, |most, holder| most.max(holder.displacement_m));
        let low = in_window().fold(f64::INFINITY, |least, holder| least.min(holder.displacement_m));
        let strongest = in_window().fold(0.0_f64, |most, holder| most.max(holder.acceleration_m_s2.abs()));
        assert!(motion.peak_to_peak_m > 0.0 && motion.peak_to_peak_m <= high - low, "{motion:?}");
        let rms = motion.acceleration_rms_m_s2;
        assert!(rms > 0.0 && rms <= strongest, "{motion:?}, {strongest}");
    }
    // The acceleration is the second difference of the displacement, to the rounding of displacements over Δt².
    let dt = record.time_step_s;
    for window in seen.0.windows(3).skip(1) {
        let [before, now, after] = [0, 1, 2].map(|at| window[at].1[1].displacement_m);
        let second = (after - 2.0 * now + before) / (dt * dt);
        let rounding = 16.0 * f64::EPSILON * now.abs().max(after.abs()) / (dt * dt);
        let difference = (second - window[1].1[1].acceleration_m_s2).abs();
        assert!(difference <= rounding, "{difference:e} of {rounding:e}");
    }
}

/// Protects: an ideal holder has no figures, and its record is that of versions without them.
#[test]
fn an_ideal_holder_has_no_motion() {
    let mut seen = Motions::default();
    let record = analysis::solve(&spec(), &mut seen).unwrap();
    assert!(record.holder.is_empty());
    assert!(!serde_json::to_string(&record).unwrap().contains("holder"));
    assert!(seen.0.iter().all(|(_, holder)| *holder == [HolderSample::default(); 3]));
}

/// Protects: peak to peak and root mean square, with weights, in every direction. Eight numbers have a few roundings.
#[test]
fn figures_of_a_holder_are_extremes_and_a_root_mean_square() {
    let mut sums = Sums::EMPTY;
    let (mut squares, mut weights) = ([0.0; 3], 0.0);
    for step in 0..8 {
        let weight = if step == 0 { 0.25 } else { 1.0 };
        let at = |axis: usize| f64::from(step) * (axis as f64 + 1.0);
        let holder = [0, 1, 2]
            .map(|axis| HolderSample { displacement_m: at(axis) - 3.0, acceleration_m_s2: 10.0 - at(axis) });
        sums.add(&Sample { holder, ..Sample::default() }, weight);
        weights += weight;
        for axis in 0..3 {
            squares[axis] += weight * (10.0 - at(axis)).powi(2);
        }
    }
    for (axis, squares) in squares.into_iter().enumerate() {
        let [peak_to_peak_m, rms] = sums.holder(axis);
        assert_eq!(peak_to_peak_m, 7.0 * (axis as f64 + 1.0));
        assert!((rms / (squares / weights).sqrt() - 1.0).abs() < 8.0 * f64::EPSILON, "{rms}");
    }
}

/// A pin of 4 × 5 × 4 elements with a holder in the sliding direction, whose times are those that the scene needs by default: 210, 840 and 13 times √(m/k).
fn on_holder(
    contact: Contact,
    side: ClampSide,
    [mass_kg, stiffness, damping]: [f64; 3],
    omega_rpm: f64,
) -> JobSpec {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [4, 5, 4];
    spec.scene.clamp = Clamp { side, width_m: 0.003 };
    spec.scene.contact = contact;
    spec.scene.holder = Holder {
        mass_kg: Some(mass_kg),
        stiffness_y_n_m: Some(stiffness),
        damping_y_n_s_m: Some(damping),
        ..Holder::default()
    };
    spec.scene.disk.omega_rpm = omega_rpm;
    // The regimes, decays and times of these tests are those of this damping.
    spec.numerics.beta_r_s = 5.0e-8;
    let time_s = (mass_kg / stiffness).sqrt();
    spec.detection.decay_observation_s = 210.0 * time_s;
    spec.run.limit_s = 0.25;
    spec.scene.load.ramp_s = 13.0 * time_s;
    spec
}

fn solved(spec: &JobSpec) -> JobRecord {
    analysis::solve(spec, &mut Motions::default()).unwrap()
}

/// The result of a job beside a run that is ten times as long and does not stop early. They differ by at most three standard errors of both and what
/// the detection lets drift.
fn stands_beside_a_long_run(spec: &JobSpec, expected: Outcome, name: &str) -> JobRecord {
    let short = solved(spec);
    assert_eq!(short.outcome, expected, "{name}: {:?}", short.obstacle);
    let mut long = spec.clone();
    long.run.stop_early = false;
    long.run.limit_s = 10.0 * short.simulated_s;
    let long = solved(&long);
    let allowed = 3.0 * short.mu_star_se.hypot(long.mu_star_se) + spec.detection.drift_tolerance;
    let apart = (short.mu_star - long.mu_star).abs();
    assert!(apart <= allowed, "{name}: {} ± {}, later {}", short.mu_star, short.mu_star_se, long.mu_star);
    short
}

/// Protects: a result with a heavy holder is that of its steady state. In these scenes, of `scripts/holders.py`, a window of 20 cycles is a part of a
/// swing, and the force of the clamp over it was 2 to 5 % off.
#[test]
fn a_periodic_state_with_a_heavy_holder_is_that_of_a_long_run() {
    let contact = |law, mu| Contact { law, mu, ..Contact::default() };
    let clifton = Contact { length_m: Some(4.4e-6), ..contact(FrictionLaw::PrakashClifton, 0.306) };
    let regularised = Contact { speed_m_s: Some(0.00266), ..contact(FrictionLaw::Regularised, 0.344) };
    for (name, spec) in [
        ("prakash_clifton", on_holder(clifton, ClampSide::LeadingEnd, [0.6, 8.9e5, 4.8], 19.3)),
        ("regularised", on_holder(regularised, ClampSide::OuterSide, [1.15, 1.52e6, 206.0], 66.8)),
        (
            "coulomb",
            on_holder(contact(FrictionLaw::Coulomb, 0.4), ClampSide::InnerSide, [0.3, 1.0e6, 60.0], 20.0),
        ),
    ] {
        let record = stands_beside_a_long_run(&spec, Outcome::Periodic, name);
        assert_eq!(
            record.mu_star, record.mu_star_contact,
            "{name}: the momentum of the holder is in no mean"
        );
    }
}

/// Protects: a stable job has come to the end of its creep. With this law and speed the real modes of sliding decay at −38 and −229 1/s, so that the friction after
/// 8 ms without an oscillation is 12 % too small. In steady sliding it is μ v/(v + v₀) at each node; the exact value is that of the equilibrium.
#[test]
fn a_decay_waits_for_the_mean_friction() {
    let mut spec = spec();
    spec.scene.clamp.side = ClampSide::TrailingEnd;
    spec.scene.contact =
        Contact { law: FrictionLaw::Regularised, mu: 0.233, speed_m_s: Some(1.0e-4), ..Contact::default() };
    spec.scene.disk.omega_rpm = 0.02;
    // With less damping the oscillations end later than the creep, and nothing waits.
    spec.numerics.beta_r_s = 5.0e-8;
    spec.run.limit_s = 0.06;
    spec.run.stop_early = true;
    let record = stands_beside_a_long_run(&spec, Outcome::Decayed, "regularised");
    assert!((record.mu_star - 0.1529).abs() < 0.002, "{} ± {}", record.mu_star, record.mu_star_se);
    assert!(record.simulated_s > 0.016, "two observations");
}

/// Protects: a holder that sticks and slips at 1.41 kHz under a squeal of 15.5 kHz is periodic with the cycle of the holder, in which the squeal has eleven
/// periods.
#[test]
fn a_holder_that_sticks_and_slips_below_the_squeal_is_periodic() {
    let mut spec = spec();
    spec.scene.contact = Contact {
        law: FrictionLaw::Exponential,
        mu: 0.1,
        mu_static: Some(0.25),
        speed_m_s: Some(0.05),
        ..Contact::default()
    };
    spec.scene.holder = Holder {
        mass_kg: Some(0.02),
        stiffness_y_n_m: Some(2.0e6),
        damping_y_n_s_m: Some(5.0),
        ..Holder::default()
    };
    spec.scene.disk.omega_rpm = 7.0;
    spec.run.limit_s = 0.06;
    spec.run.stop_early = true;
    let record = solved(&spec);
    assert_eq!(
        (record.outcome, record.crossings_per_cycle),
        (Outcome::Periodic, 11),
        "{:?}",
        record.obstacle
    );
    // The period varies by 0.3 % from cycle to cycle.
    assert!((record.frequency_hz.unwrap() * 0.710e-3 - 1.0).abs() < 0.003, "{:?}", record.frequency_hz);
}

/// Protects: the estimate of the slowest swing is not shorter than the true period of a chain: a holder on its spring with a pin on a spring below it. A rigid holder
/// has none.
#[test]
fn the_estimated_swing_is_not_too_short() {
    assert_eq!(JobSpec::default().scene.slow_times(), None);
    let mut random = Random::new(31);
    let log_uniform = |random: &mut Random, low: f64, high: f64| (random.between(low.ln(), high.ln())).exp();
    for _ in 0..100 {
        let mut scene = JobSpec::default().scene;
        let mass_kg = log_uniform(&mut random, 0.001, 3.0);
        let stiffness_n_m = log_uniform(&mut random, 1.0e4, 1.0e8);
        scene.holder.mass_kg = Some(mass_kg);
        scene.holder.stiffness_y_n_m = Some(stiffness_n_m);
        let pin = &scene.pin;
        let [x, y, z] = pin.size_m;
        let pin_kg = pin.density_kg_m3 * x * y * z;
        // The pin as a mass on its shear stiffness, at the height of its centre.
        let pin_n_m = pin.young_modulus_pa / (2.0 * (1.0 + pin.poisson_ratio)) * x * y / (0.5 * z);
        // The lower root of det(K − ω² M) = 0.
        let [a, b, c] = [
            mass_kg * pin_kg,
            -(mass_kg * pin_n_m + pin_kg * (stiffness_n_m + pin_n_m)),
            stiffness_n_m * pin_n_m,
        ];
        let omega2 = 2.0 * c / (-b + (b * b - 4.0 * a * c).sqrt());
        let period_s = std::f64::consts::TAU / omega2.sqrt();
        let estimate_s = scene.slow_times().unwrap().swing_s;
        assert!(estimate_s >= period_s, "{mass_kg} kg, {stiffness_n_m} N/m: {estimate_s} < {period_s}");
        let rigid_s = std::f64::consts::TAU * ((mass_kg + pin_kg) / stiffness_n_m).sqrt();
        assert!(estimate_s < 3.0 * (period_s.max(rigid_s)) + 1.0e-3, "{estimate_s} is far too long");
    }
}
