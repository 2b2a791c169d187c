//! B32 Complex modes of steady sliding with holders, friction laws and bases that are not flat.
//!
//! * **A stiff pin on a soft holder** is a mass M + m on the spring k and the damper d of the holder. A law μ(v) adds the damper
//!   F μ′(V) along the disk's velocity, and friction that turns adds μF/V across it. So in y λ is a root of
//!   (M + m)λ² + (d + F μ′(V))λ + k, and in x of (M + m)λ² + (d + μ(V)F/V)λ + k. The pin's own stiffness k_p changes λ by a share of
//!   the order (k + |λ|d)/k_p. The disk is so large that its speed is the same at all nodes to 10⁻⁵.
//! * **A heavy holder** is an ideal clamp: the part of a mode that moves it falls like 1/M.
//! * **Runs in time** grow and decay as the eigenvalues say, as in B31.
//! * **A crowned base** touches the disk where a slow run touches it.

use crate::verification::sliding_in_time::Pin;
use crate::verification::sliding_modes::{EXACT, scene};
use nalgebra::Complex;
use std::f64::consts::TAU;
use tribosweep_mechanics::analysis;
use tribosweep_mechanics::solver::interface::law::{
    Exponential, Law, PrakashClifton, Regularised, StaticKinetic,
};
use tribosweep_mechanics::solver::{Drive, Model, State, step};
use tribosweep_mechanics::spec::{ClampSide, FrictionLaw, JobSpec};
use tribosweep_mechanics::stability::{StabilityError, Structure};

/// Damping that leaves the lead to the mode near 15 kHz, which grows much faster than all others. The shapes of the start are those
/// without a time step, and friction that a run takes a step later changes them. The periods before the fit leave the fastest
/// mode.
const DAMPING_S: f64 = 5.0e-7;

const HOLDER_KG: f64 = 0.05;
const STIFFNESS_N_M: f64 = 2.0e4;
const DAMPING_N_S_M: f64 = 3.0;
const SPEED_M_S: f64 = 0.4;
const SCALE_M_S: f64 = 0.15;

/// The whole top of the pin on a holder that moves in x and y, on a disk of 1 km.
fn on_holder(young_modulus_pa: f64) -> JobSpec {
    let mut spec = scene([3, 4, 3], 0.004, 0.3, 0.0);
    spec.scene.clamp.side = ClampSide::WholeTop;
    spec.scene.pin.young_modulus_pa = young_modulus_pa;
    let holder = &mut spec.scene.holder;
    holder.mass_kg = Some(HOLDER_KG);
    (holder.stiffness_x_n_m, holder.stiffness_y_n_m) = (Some(2.0 * STIFFNESS_N_M), Some(STIFFNESS_N_M));
    (holder.damping_x_n_s_m, holder.damping_y_n_s_m) = (Some(2.0 * DAMPING_N_S_M), Some(DAMPING_N_S_M));
    spec.scene.disk.track_radius_m = 1000.0;
    spec.scene.disk.omega_rpm = SPEED_M_S / 1000.0 / TAU * 60.0;
    spec
}

/// The root with a frequency ≥ 0 of m λ² + d λ + k.
fn oscillator(mass_kg: f64, damping_n_s_m: f64, stiffness_n_m: f64) -> Complex<f64> {
    let half = Complex::new(damping_n_s_m / (2.0 * mass_kg), 0.0);
    (half * half - stiffness_n_m / mass_kg).sqrt() - half
}

/// The eigenvalues of modes that move the holder in x and in y, and the exact ones.
#[expect(clippy::large_types_passed_by_value, reason = "a test makes one, whose size does not matter")]
fn holder_modes(
    law: Law,
    young_modulus_pa: f64,
    mu: f64,
    slope_s_m: f64,
) -> [(Complex<f64>, Complex<f64>); 2] {
    let spec = on_holder(young_modulus_pa);
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let drive = Drive { law, ..analysis::drive(&spec) };
    let point = Structure::new(&model).unwrap().point_with(&model, &drive, 12, EXACT).unwrap();
    let mass_kg = HOLDER_KG + model.pin().masses_kg().iter().sum::<f64>();
    let force_n = drive.force_n;
    let exact = [
        oscillator(mass_kg, 2.0 * DAMPING_N_S_M + mu * force_n / SPEED_M_S, 2.0 * STIFFNESS_N_M),
        oscillator(mass_kg, DAMPING_N_S_M + slope_s_m * force_n, STIFFNESS_N_M),
    ];
    exact.map(|exact| {
        let values = point.modes.iter().map(|mode| mode.eigenvalue_per_s);
        let distance = |value: &Complex<f64>| (value - exact).norm();
        (values.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap(), exact)
    })
}

/// Protects: mass, spring and damper of a holder are in the modes, and the slope of a law is a damper along the disk's velocity.
#[test]
fn a_stiff_pin_on_a_holder_is_an_oscillator() {
    let fall = 0.2 * (-SPEED_M_S / SCALE_M_S).exp();
    let sum = SPEED_M_S + SCALE_M_S;
    let exponential = |slope_s_m| {
        Law::Exponential(Exponential { mu: 0.3, mu_static: 0.5, speed_m_s: SCALE_M_S, slope_s_m })
    };
    let cases = [
        (Law::coulomb(0.3), 0.3, 0.0),
        (Law::StaticKinetic(StaticKinetic { mu: 0.3, mu_static: 0.5 }), 0.3, 0.0),
        (exponential(0.0), 0.3 + fall, -fall / SCALE_M_S),
        (exponential(0.5), 0.3 + fall + 0.5 * SPEED_M_S, -fall / SCALE_M_S + 0.5),
        (
            Law::Regularised(Regularised { mu: 0.3, speed_m_s: SCALE_M_S }),
            0.3 * SPEED_M_S / sum,
            0.3 * SCALE_M_S / (sum * sum),
        ),
    ];
    for (law, mu, slope_s_m) in cases {
        let errors = [1.0e10, 4.0e10].map(|young_modulus_pa| {
            holder_modes(law, young_modulus_pa, mu, slope_s_m).map(|(found, exact)| {
                println!("{law:?}, E = {young_modulus_pa:e}: {found:.4}, exact {exact:.4}");
                [(found.re / exact.re - 1.0).abs(), (found.im / exact.im - 1.0).abs()]
            })
        });
        for (stiff, soft) in errors[1].iter().flatten().zip(errors[0].iter().flatten()) {
            // (k + |λ|d)/k_p is 9·10⁻⁴ for the softer pin in x, with k_p = G A/h in shear.
            assert!(*soft < 9.0e-4, "{law:?}: {soft:e}");
            // The limit is reached with the first power of 1/E.
            assert!(*stiff < 0.3 * soft + 1.0e-7, "{law:?}: {stiff:e} after {soft:e}");
        }
    }
}

/// Protects: the eigenvalue of the pin tends to that under an ideal clamp, as 1/M.
#[test]
fn a_heavy_holder_is_an_ideal_clamp() {
    let leading = |spec: &JobSpec| {
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let structure = Structure::new(&model).unwrap();
        structure.point_with(&model, &analysis::drive(spec), 4, EXACT).unwrap().modes[0].eigenvalue_per_s
    };
    let mut spec = scene([4, 5, 4], 0.003, 0.4, 7.0);
    let ideal = leading(&spec);
    let mut errors = Vec::new();
    for mass_kg in [1.0, 10.0, 100.0] {
        spec.scene.holder.mass_kg = Some(mass_kg);
        spec.scene.holder.stiffness_x_n_m = Some(1.0e3);
        spec.scene.holder.stiffness_y_n_m = Some(1.0e3);
        errors.push((leading(&spec) - ideal).norm() / ideal.norm());
    }
    println!("ideal {ideal:.3}, errors {errors:?}");
    // The pin has 4.5 g, so a holder of 1 kg moves by less than 1 % of it. Each eigenvalue is exact to 10⁻⁹.
    assert!(errors[0] < 0.01);
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] / 10.0 - 1.0).abs() < 0.05, "{errors:?}");
    }
}

/// Compares the growth of a run with its eigenvalue, as B31 does, after so many periods.
fn compare_with_run(name: &str, spec: &JobSpec, before: f64) {
    let pin = Pin::new(spec, 0.1);
    let vibration = pin.vibration(spec, EXACT);
    let mode = vibration.leading();
    let (growth_per_s, frequency_hz) = vibration.run_after(before, 20.0, 1.0e-7);
    let [exact, in_steps] = [mode.eigenvalue_per_s, mode.eigenvalue_in_steps_per_s];
    let lifted = vibration.point.equilibrium.in_contact.iter().filter(|on| !**on).count();
    println!(
        "{name}: run {growth_per_s:.2} 1/s, {frequency_hz:.1} Hz; mode {exact:.2}, in steps {in_steps:.2}, {lifted} lifted"
    );
    // The step changes λ by some 10⁻⁴ of |λ|, as in B31.
    let effect_per_s = 2.0e-4 * exact.norm();
    assert!((growth_per_s - exact.re).abs() < effect_per_s, "{name}: {growth_per_s} 1/s and {exact}");
    assert!((growth_per_s / in_steps.re - 1.0).abs() < 0.001, "{name}: {growth_per_s} 1/s and {in_steps}");
    assert!((frequency_hz * TAU / in_steps.im - 1.0).abs() < 1e-4, "{name}: {frequency_hz} Hz, {in_steps}");
}

/// Protects: vibrations of a pin on a holder grow and decay as the eigenvalues say, with the holder's mass, spring and damper.
#[test]
fn runs_on_a_holder_grow_like_their_modes() {
    for (mu, side) in [(0.5, ClampSide::InnerSide), (0.4, ClampSide::WholeTop)] {
        let mut spec = scene([6, 8, 5], 0.002, mu, 7.0);
        spec.scene.clamp.side = side;
        spec.numerics.beta_r_s = DAMPING_S;
        let holder = &mut spec.scene.holder;
        holder.mass_kg = Some(0.02);
        (holder.stiffness_y_n_m, holder.damping_y_n_s_m) = (Some(2.0e7), Some(5.0));
        (holder.stiffness_x_n_m, holder.stiffness_z_n_m) = (Some(1.0e7), Some(0.0));
        compare_with_run(side.name(), &spec, 20.0);
    }
}

/// Protects: vibrations under other laws grow and decay as the eigenvalues say, with the moment at which a law takes the slip.
#[test]
fn runs_under_other_laws_grow_like_their_modes() {
    for law in [FrictionLaw::StaticKinetic, FrictionLaw::Exponential, FrictionLaw::Regularised] {
        let mut spec = scene([6, 8, 5], 0.002, 0.4, 7.0);
        spec.numerics.beta_r_s = DAMPING_S;
        let contact = &mut spec.scene.contact;
        contact.law = law;
        contact.mu_static = Some(0.45);
        contact.speed_m_s = Some(if law == FrictionLaw::Regularised { 0.005 } else { 0.05 });
        compare_with_run(law.name(), &spec, 20.0);
    }
}

fn crowned() -> JobSpec {
    let mut spec = scene([8, 10, 5], 0.0015, 0.1, 20.0);
    spec.scene.pin.base.crown_radius_m = Some(8.0);
    spec.numerics.beta_r_s = 5.0e-7;
    spec
}

/// Protects: the nodes of a crowned base that touch, and their forces, are those of a run that has settled. They depend on the
/// load.
#[test]
fn a_crowned_base_touches_where_a_run_touches() {
    let mut counts = Vec::new();
    for force_n in [10.0, 60.0] {
        let mut spec = crowned();
        spec.scene.load.force_n = force_n;
        spec.scene.load.ramp_s = 0.002;
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let drive = analysis::drive(&spec);
        let point = Structure::new(&model).unwrap().point(&model, &drive, 4).unwrap();
        let mut state = State::<1>::at_rest(&model);
        for _ in 0..(0.02 / model.time_step_s()) as usize {
            step(&model, &[drive], &mut state);
        }
        let equilibrium = &point.equilibrium;
        let mut worst: f64 = 0.0;
        for slave in 0..model.slaves().len() {
            let found_n = state.contacts.force_of(slave, 0)[2];
            assert_eq!(found_n > 0.0, equilibrium.in_contact[slave], "node {slave}: {found_n} N");
            worst = worst.max((found_n - equilibrium.normal_n[slave]).abs());
        }
        let on = equilibrium.in_contact.iter().filter(|on| **on).count();
        println!("{force_n} N: {on} of {} nodes, forces differ by {worst:e} N", model.slaves().len());
        // Vibrations of the run have decayed to this part of the load.
        assert!(worst < 1.0e-4 * force_n, "{worst:e} N");
        counts.push(on);
    }
    assert!(counts[0] < counts[1] && counts[1] < 99, "{counts:?}");
}

/// Protects: vibrations of a pin with a crowned base grow and decay as the eigenvalues say.
#[test]
fn runs_on_a_crowned_base_grow_like_their_modes() {
    for mu in [0.1, 0.5] {
        let mut spec = crowned();
        spec.scene.contact.mu = mu;
        compare_with_run("crowned", &spec, 0.0);
    }
}

/// Protects: a holder that friction pushes away, and friction with a state, are refused.
#[test]
fn scenes_without_an_equilibrium_are_refused() {
    let mut spec = scene([3, 4, 3], 0.004, 0.3, 7.0);
    spec.scene.holder.stiffness_y_n_m = Some(0.0);
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    assert_eq!(Structure::new(&model).unwrap_err(), StabilityError::Holder);
    let ideal = scene([3, 4, 3], 0.004, 0.3, 7.0);
    let model = Model::from_scene(&ideal.scene, &ideal.numerics).unwrap();
    let drive = Drive {
        law: Law::PrakashClifton(PrakashClifton { mu: 0.3, length_m: 1.0e-6 }),
        ..analysis::drive(&ideal)
    };
    let refused = Structure::new(&model).unwrap().point(&model, &drive, 4).unwrap_err();
    assert_eq!(refused, StabilityError::FrictionLaw { law: "prakash_clifton" });
}
