//! Runs in single precision beside the same runs in double precision.
//!
//! A number is rounded at most by ε = 2⁻²⁴ of itself. A limit cycle is stable, so roundings do not add up over cycles. What
//! they change is the step at which a node changes its state. Such a change by one step shifts the share of a state by
//! 1/(slave nodes × steps of the window).

use crate::analysis::signals::coarse;
use tribosweep_mechanics::analysis::{JobRecord, Outcome, Unobserved, solve};
use tribosweep_mechanics::spec::{JobSpec, Precision};

/// Half an ulp of f32 over the number.
const EPSILON: f64 = f32::EPSILON as f64 / 2.0;

fn in_both(spec: &JobSpec) -> [JobRecord; 2] {
    [Precision::Double, Precision::Single].map(|precision| {
        let mut spec = spec.clone();
        spec.numerics.precision = precision;
        solve(&spec, &mut Unobserved).unwrap()
    })
}

fn job(omega_rpm: f64, mu: f64) -> JobSpec {
    let mut spec = coarse();
    spec.scene.disk.omega_rpm = omega_rpm;
    spec.scene.contact.mu = mu;
    spec
}

/// Asserts that μ*, the frequency over its size, and the shares of the states differ by at most `tolerance`.
fn assert_agree(name: &str, [double, single]: &[JobRecord; 2], tolerance: f64) {
    assert_eq!(single.outcome, double.outcome, "{name}");
    let figures = |record: &JobRecord| {
        let frequency = record.frequency_hz.unwrap_or(1.0) / double.frequency_hz.unwrap_or(1.0);
        [record.mu_star, frequency, record.stick_share, record.slip_share, record.separated_share]
    };
    for (figure, (s, d)) in figures(single).iter().zip(figures(double)).enumerate() {
        assert!((s - d).abs() <= tolerance, "{name}: figure {figure} is {s}, in double precision {d}");
    }
}

/// Protects: the figures of limit cycles of all regimes. The tolerance is that of twenty changes of state by one step: the
/// window has at least 20 steps in each of some cycles of 63 nodes, and so a change shifts a share by at most 1.6·10⁻⁵.
#[test]
fn limit_cycles_have_the_figures_of_double_precision() {
    for (omega_rpm, mu) in [(2.0, 0.4), (7.0, 0.4), (35.0, 0.4), (100.0, 0.4), (7.0, 0.6)] {
        let records = in_both(&job(omega_rpm, mu));
        assert_eq!(records[0].outcome, Outcome::Periodic);
        assert_agree(&format!("{omega_rpm} rpm, μ = {mu}"), &records, 3.0e-4);
    }
}

/// Protects: sliding that decays is found to decay, although roundings keep up an oscillation of 10⁻⁶ of F, and a weak growth
/// is still measured as a growth. The rate is that of the fastest line, and lines below 10⁻⁵ of F are not judged, so it can be
/// the rate of another line than in double precision, but not of a faster one by more than an error of 1 %.
#[test]
fn decay_and_weak_growth_are_told_apart() {
    let decaying = in_both(&job(7.0, 0.2));
    assert_eq!(decaying[0].outcome, Outcome::Decayed);
    assert_agree("decay", &decaying, 3.0e-4);
    let rates = in_both(&job(7.0, 0.3)).map(|record| record.growth_rate_per_s.unwrap());
    assert!(rates[1] > 0.0 && rates[1] < 1.01 * rates[0], "{rates:?}");
}

/// Protects: nearly incompressible material. The pressure in K u is λ/G = 2ν/(1−2ν) times as large as the shear and cancels,
/// so its roundings count that many times: 2ε·250 = 3·10⁻⁵ at ν = 0.498.
#[test]
fn a_nearly_incompressible_pin_keeps_its_figures() {
    let mut spec = job(7.0, 0.4);
    spec.scene.pin.poisson_ratio = 0.498;
    spec.run.limit_s = 0.004;
    spec.run.stop_early = false;
    let records = in_both(&spec);
    let [double, single] = &records;
    assert!((single.mu_star - double.mu_star).abs() < 3.0e-4, "{} {}", single.mu_star, double.mu_star);
    assert!((single.stick_share - double.stick_share).abs() < 3.0e-3);
}

/// Protects: long runs. After a quarter of a million steps the roundings of u + Δt p have not made the pin creep: N is still
/// the load, and T is still μN. Independent roundings add up like the root of their number, to 500 ε, and damping forgets them
/// earlier than that.
#[test]
fn roundings_do_not_add_up_in_a_long_run() {
    let mut spec = job(7.0, 0.2);
    spec.scene.pin.elements = [3, 4, 3];
    spec.scene.clamp.width_m = 0.004;
    spec.run.stop_early = false;
    spec.run.average_last_fraction = 0.1;
    let [short, _] = in_both(&JobSpec { run: spec.run.clone(), ..spec.clone() });
    spec.run.limit_s = 250_000.0 * short.time_step_s;
    let [double, single] = in_both(&spec);
    assert_eq!(single.steps, 250_000);
    let tolerance = 500.0 * EPSILON;
    assert!((single.mu_star - double.mu_star).abs() < tolerance, "{} {}", single.mu_star, double.mu_star);
    let spread = single.n_over_f_max - single.n_over_f_min;
    assert!(spread < 2.0 * tolerance && single.slip_share == 1.0, "N/F varies by {spread}");
}

/// Protects: a very slow disk. A sticking node moves by VΔt a step, which is rounded at ε of its displacement. At 0.05 rpm that
/// is less than 10⁻³ of the step, and so is the error of the period of stick and slip.
#[test]
fn a_slow_disk_still_carries_its_nodes() {
    let mut spec = job(0.05, 0.4);
    spec.run.limit_s = 0.004;
    spec.run.stop_early = false;
    let [double, single] = in_both(&spec);
    assert!((single.mu_star - double.mu_star).abs() < 1.0e-3, "{} {}", single.mu_star, double.mu_star);
    assert!(double.stick_share > 0.5 && (single.stick_share - double.stick_share).abs() < 0.01);
}
