//! The fundamental frequency of N from its section crossings.

use crate::analysis::signals::{SQUEAL_HZ, STEP_S, cut, sample, sine};
use crate::random::Random;
use tribosweep_mechanics::analysis::cycles::Cycle;
use tribosweep_mechanics::analysis::steady;
use tribosweep_mechanics::spec::Detection;

/// The frequency as a record reports it, over the window in which the state was found periodic.
fn reported_hz(cycles: &[Cycle]) -> (f64, usize) {
    let found = steady::find(cycles, &Detection::default(), None).expect("a periodic signal");
    let window = &cycles[cycles.len() - found.window_crossings..];
    (steady::frequency_hz(window, found.crossings_per_cycle), found.crossings_per_cycle)
}

fn assert_near(found_hz: f64, tolerance_hz: f64, what: &str) {
    assert!((found_hz - SQUEAL_HZ).abs() < tolerance_hz, "{what}: {found_hz} Hz");
}

/// Protects: the interpolated crossings give the frequency of a sinusoid of any amplitude, for any time step.
/// Linear interpolation misses the crossing of a sinusoid by at most ω²Δt³/8 < 6 ns for Δt ≤ 1.75 µs. Two
/// such errors over 20 cycles are 0.12 Hz.
#[test]
fn a_sinusoid_on_any_grid() {
    let mut random = Random::new(1);
    for step_s in [STEP_S, 8.37e-7, 1.0e-6 / 1.3, 1.75e-6, 5.5e-8] {
        for amplitude in [1.0e-6, 0.01, 0.3, 1.0] {
            let phase = random.between(0.0, 6.0);
            let cycles = cut(step_s, 0.01, |t| sample(t, 1.0 + amplitude * sine(SQUEAL_HZ, t, phase)));
            let (hz, crossings) = reported_hz(&cycles);
            assert_eq!(crossings, 1);
            assert_near(hz, 0.2, &format!("Δt {step_s}, amplitude {amplitude}"));
        }
    }
}

/// Protects: strong harmonics (30 % and 20 %) neither add crossings nor bias the frequency. After the section
/// filters |x''/x'| is below 2ω at the crossing, so an interpolated crossing is off by at most 2ωΔt²/8 = 17
/// ns. This is 0.4 Hz over 20 cycles.
#[test]
fn strong_harmonics() {
    for eighth in 0..8 {
        let phase = f64::from(eighth) * 0.785;
        let cycles = cut(STEP_S, 0.004, |t| {
            let harmonics =
                0.3 * sine(2.0 * SQUEAL_HZ, t, phase) + 0.2 * sine(3.0 * SQUEAL_HZ, t, 2.0 * phase);
            sample(t, 1.0 + 0.6 * (sine(SQUEAL_HZ, t, 0.0) + harmonics))
        });
        assert_near(reported_hz(&cycles).0, 1.0, &format!("phase {phase}"));
    }
}

/// N of amplitude 0.8 F with a one-step spike of `height` F at `phase` of every cycle.
fn spiky(height: f64, phase: f64) -> Vec<Cycle> {
    let mut last = 0.0;
    cut(STEP_S, 0.006, |t| {
        let count = (t * SQUEAL_HZ - phase).floor();
        let spike = if count > last { height } else { 0.0 };
        last = count;
        sample(t, 1.0 + 0.8 * sine(SQUEAL_HZ, t, 0.0) + spike)
    })
}

/// Protects: impact spikes of one step, at any phase, barely change the frequency. They fall on the time
/// steps, so they jitter by a step. After the filters a spike of height h is h Δt t/τ² exp(−t/τ) with τ = 6.4
/// µs. Its slope is at most hΔt/τ² = 0.062 F/µs for h = 3. A spike that is shifted by a step moves the
/// crossing (slope ≥ 0.055 F/µs) by less than 1 µs: 10 Hz over 20 cycles. The filters delay the crossing to
/// the phase 0.17. Of a spike that comes half a cycle or more before the next crossing (phases 0.2 to 0.65),
/// only 2 % is left there. A spike in the trough may cause a hump of its own, but the fundamental remains.
#[test]
fn impact_spikes() {
    for twentieth in 0..20 {
        let phase = f64::from(twentieth) / 20.0;
        let cycles = spiky(3.0, phase);
        let tolerance_hz = if (0.2..0.66).contains(&phase) { 1.0 } else { 10.0 };
        // The jitter of the spikes may keep the window from being periodic. The frequency must be right in
        // this case, too.
        let hz = steady::find(&cycles, &Detection::default(), None).map_or_else(
            || {
                let crossings = if cycles.len() > 100 { 2 } else { 1 };
                let whole = &cycles[cycles.len() - 20 * crossings..];
                steady::frequency_hz(whole, crossings)
            },
            |_| reported_hz(&cycles).0,
        );
        assert_near(hz, tolerance_hz, &format!("spike at {phase} of the cycle, {} crossings", cycles.len()));
    }
}

/// Protects: two unequal humps are one cycle. The fundamental is reported, not the harmonic.
#[test]
fn two_unequal_humps_are_one_cycle() {
    for (second, phase) in [(1.3, 0.3), (1.6, 1.0), (2.0, -0.5), (1.5, 2.0), (2.0, 3.0), (2.0, 1.3)] {
        let cycles = cut(STEP_S, 0.006, |t| {
            let hump = second * sine(2.0 * SQUEAL_HZ, t, phase) / 0.42;
            sample(t, 1.0 + 0.2 * (sine(SQUEAL_HZ, t, 0.0) / 0.75 + hump))
        });
        let (hz, crossings) = reported_hz(&cycles);
        assert_eq!(crossings, 2, "second harmonic {second}, phase {phase}");
        assert_near(hz, 1.0, &format!("second harmonic {second}, phase {phase}"));
    }
}

/// Protects: a slightly period-doubled N (every second cycle is 6 % higher) has a limit cycle of two
/// crossings, but the reported frequency is still that of the crossings.
#[test]
fn a_slight_period_doubling_keeps_the_frequency() {
    let cycles = cut(STEP_S, 0.006, |t| {
        sample(t, 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0) + 0.02 * sine(SQUEAL_HZ / 2.0, t, 0.4))
    });
    let (hz, crossings) = reported_hz(&cycles);
    assert_eq!(crossings, 2);
    assert_near(hz, 1.0, "period doubled");
}

/// Protects: if the cycle of two unequal humps is slightly period-doubled, the limit cycle has four
/// crossings. The period of the fundamental is that of two crossings, not of four.
#[test]
fn a_slight_period_doubling_of_two_humps_keeps_the_fundamental() {
    let cycles = cut(STEP_S, 0.012, |t| {
        let humps = sine(SQUEAL_HZ, t, 0.0) / 0.75 + 1.6 * sine(2.0 * SQUEAL_HZ, t, 1.0) / 0.42;
        sample(t, 1.0 + 0.2 * humps * (1.0 + 0.08 * sine(SQUEAL_HZ / 2.0, t, 0.4)))
    });
    let (hz, crossings) = reported_hz(&cycles);
    assert_eq!(crossings, 4);
    assert_near(hz, 1.0, "doubled humps");
}

/// Protects: after a violent start, a small limit cycle is still divided into cycles. The memory of the
/// start's amplitude must fade (here the filters themselves start a whole F below).
#[test]
fn a_small_cycle_after_a_violent_start() {
    for amplitude in [0.1, 0.01, 1.0e-4] {
        let cycles = cut(STEP_S, 0.01, |t| {
            let start = 6.0 * (-t / 2.0e-5).exp() * sine(9_000.0, t, 0.0);
            sample(t, 1.0 + start + amplitude * sine(SQUEAL_HZ, t, 0.0))
        });
        assert!(cycles.len() > 60, "amplitude {amplitude}: {} crossings in 145 cycles", cycles.len());
        assert_near(reported_hz(&cycles).0, 0.2, &format!("amplitude {amplitude}"));
    }
}
