//! When a sequence of cycles counts as periodic.

use crate::analysis::signals::{LOAD_N, SQUEAL_HZ, STEP_S, cut, sample, sine};
use tribosweep_mechanics::analysis::cycles::{Cycle, CycleCutter};
use tribosweep_mechanics::analysis::steady::{self, Obstacle, SteadyState};
use tribosweep_mechanics::solver::energy::Energies;
use tribosweep_mechanics::spec::{Detection, SlowTimes};

/// The result of `steady::find` for every prefix of `cycles`.
fn along(cycles: &[Cycle]) -> Vec<Option<SteadyState>> {
    (0..=cycles.len()).map(|n| steady::find(&cycles[..n], &Detection::default(), None)).collect()
}

fn never_periodic(cycles: &[Cycle], what: &str) {
    assert!(cycles.len() > 100, "{what}: only {} cycles to look at", cycles.len());
    let first = along(cycles).iter().position(Option::is_some);
    assert_eq!(first, None, "{what}: called periodic");
}

/// Protects: growth and decay are never called periodic, however small the oscillation is. The means over the
/// halves of 20 cycles (0.69 ms apart) may differ by 0.1 %, so rates down to 1.5 /s are resolved. 3 /s is
/// twice that.
#[test]
fn growth_or_decay_is_not_periodic() {
    for rate in [3.0, -3.0, 20.0, -20.0, 300.0, -300.0] {
        for amplitude in [1.0e-6, 0.01, 0.3] {
            let cycles = cut(STEP_S, 0.02, |t| {
                sample(t, 1.0 + amplitude * (rate * t).exp() * sine(SQUEAL_HZ, t, 0.1))
            });
            // The cutter's filters start one F below. These cycles are skipped.
            let settled = cycles.iter().position(|c| c.start_s > 0.007).unwrap();
            never_periodic(&cycles[settled..], &format!("rate {rate}, amplitude {amplitude}"));
        }
    }
}

/// Protects: a drift of T/F by 0.002 per 10 cycles is not called periodic. This is twice the tolerated
/// difference between the halves of 20 cycles. Over the 20 cycles it is within the tolerated spread, so only
/// the drift reveals it.
#[test]
fn a_drift_of_friction_is_not_periodic() {
    let drifting = |per_ten_cycles: f64| {
        cut(STEP_S, 0.015, |t| {
            let mut sample = sample(t, 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0));
            let more_n = per_ten_cycles * t * SQUEAL_HZ / 10.0 * LOAD_N;
            sample.clamp_tangential_n += more_n;
            sample.contact_tangential_n += more_n;
            sample
        })
    };
    never_periodic(&drifting(0.002), "rising friction");
    never_periodic(&drifting(-0.002), "falling friction");
    assert!(
        steady::find(&drifting(0.0005), &Detection::default(), None).is_some(),
        "half of what is tolerated"
    );
}

/// Protects: the obstacle of a run that is not periodic names the true reason: the figure that varies and by
/// how much, that all nodes slip, or that there are too few cycles.
#[test]
fn what_is_not_periodic_is_told_why() {
    let detection = Detection::default();
    let told = |cycles: &[Cycle]| {
        assert_eq!(steady::find(cycles, &detection, None), None);
        steady::obstacle(cycles, &detection, None)
    };
    let periodic = cut(STEP_S, 0.015, |t| sample(t, 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0)));
    let few = &periodic[5..5 + detection.cycles - 1];
    assert_eq!(told(few), Obstacle::FewCycles { found: detection.cycles - 1, needed: detection.cycles });
    // T/F rises by 0.002 per ten cycles. Its means over the halves of twenty cycles differ by as much.
    let drifting = cut(STEP_S, 0.015, |t| {
        let mut sample = sample(t, 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0));
        sample.clamp_tangential_n += 0.002 * t * SQUEAL_HZ / 10.0 * LOAD_N;
        sample
    });
    let Obstacle::Unsteady { figure, spread, drift } = told(&drifting) else { panic!("unsteady") };
    assert_eq!(figure, "mu_star");
    // Both values are uncertain by the interpolation of a cycle's ends: a step in a cycle.
    let tolerance = STEP_S * SQUEAL_HZ * 0.002;
    assert!(
        (drift - 0.002).abs() < tolerance && (spread - 0.0038).abs() < 2.0 * tolerance,
        "{spread}, {drift}"
    );
    let slipping = cut(STEP_S, 0.015, |t| {
        let mut sample = sample(t, 1.0 + 0.1 * sine(SQUEAL_HZ, t, 0.0));
        (sample.slip, sample.stick, sample.separated) = (10, 0, 0);
        sample
    });
    assert_eq!(told(&slipping), Obstacle::SlipOnly);
}

/// Protects: an exactly periodic state is found as soon as there are `cycles` cycles of it, and not sooner.
#[test]
fn a_periodic_state_is_found_after_the_asked_cycles() {
    let cycles = cut(STEP_S, 0.01, |t| sample(t, 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0)));
    let settled = &cycles[5..];
    for count in [2, 20, 57] {
        let detection = Detection { cycles: count, ..Detection::default() };
        assert_eq!(steady::find(&settled[..count - 1], &detection, None), None);
        let expected = SteadyState { crossings_per_cycle: 1, window_crossings: count };
        assert_eq!(steady::find(&settled[..count], &detection, None), Some(expected));
    }
}

/// Protects: limit cycles of two, three and four crossings are found with their number of crossings, after m
/// × `cycles` crossings.
#[test]
fn limit_cycles_of_several_crossings() {
    for m in 2..=4_usize {
        let cycles = cut(STEP_S, 0.012, |t| {
            let whole = 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0);
            sample(t, whole + 0.05 * sine(SQUEAL_HZ / m as f64, t, 0.3))
        });
        let settled = &cycles[8..];
        let first = along(settled).iter().position(Option::is_some);
        assert_eq!(first, Some(20 * m), "{m} crossings per cycle");
        let found = steady::find(settled, &Detection::default(), None).unwrap();
        assert_eq!(found, SteadyState { crossings_per_cycle: m, window_crossings: 20 * m });
    }
}

/// Protects: a cycle of five crossings is longer than the longest that is tried, and a cycle with an
/// incommensurate modulation never repeats. Neither is called periodic.
#[test]
fn long_and_quasi_periodic_cycles_are_not_periodic() {
    for ratio in [5.0, 2.0_f64.sqrt() * 5.0] {
        let cycles = cut(STEP_S, 0.015, |t| {
            sample(t, 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0) + 0.1 * sine(SQUEAL_HZ / ratio, t, 0.3))
        });
        never_periodic(&cycles, &format!("modulated every {ratio} cycles"));
    }
}

/// Protects: sliding without stick or separation is linear. It has no limit cycle, however regular it is.
#[test]
fn pure_sliding_is_never_periodic() {
    let cycles = cut(STEP_S, 0.01, |t| {
        let mut sample = sample(t, 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0));
        (sample.stick, sample.slip, sample.separated) = (0, 63, 0);
        sample
    });
    never_periodic(&cycles, "pure sliding");
}

/// Protects: clamp and contact carry the same mean force in a periodic state. Where they differ by more than the tolerated drift of
/// 0.001, something still swings, and the obstacle says by how much.
#[test]
fn a_difference_between_clamp_and_contact_is_not_periodic() {
    let apart = |difference: f64| {
        cut(STEP_S, 0.015, |t| {
            let mut sample = sample(t, 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0));
            sample.clamp_tangential_n += difference * LOAD_N;
            sample
        })
    };
    for difference in [0.0005, -0.0005] {
        assert!(steady::find(&apart(difference), &Detection::default(), None).is_some(), "{difference}");
    }
    for difference in [0.002, -0.002] {
        never_periodic(&apart(difference), "clamp and contact differ");
        let told = steady::obstacle(&apart(difference), &Detection::default(), None);
        let Obstacle::Swing { imbalance, covered_s: None } = told else { panic!("{told:?}") };
        // N is sampled at steps, so its mean over a window has an error of a step in 20 cycles.
        assert!((imbalance - difference).abs() < 0.3 * STEP_S * SQUEAL_HZ / 20.0, "{imbalance}");
    }
}

/// How slowly a pin moves with a holder that swings at `swing_hz`.
fn swinging_at(swing_hz: f64) -> SlowTimes {
    SlowTimes { swing_s: 1.0 / swing_hz, relaxation_s: 0.0 }
}

/// The squeal with T/F = 0.3 + `swing` at clamp and contact.
fn swung(duration_s: f64, swing: impl Fn(f64) -> f64) -> Vec<Cycle> {
    cut(STEP_S, duration_s, |t| {
        let n_over_f = 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0);
        let mut sample = sample(t, n_over_f);
        sample.clamp_tangential_n += LOAD_N * swing(t);
        sample.contact_tangential_n += n_over_f * LOAD_N * swing(t);
        sample
    })
}

/// Protects: a holder that swings more slowly than the 20 cycles last looks periodic where it turns, unless the cycles cover the swing. The
/// range of T/F over a swing, 0.016, is more than the tolerated 0.01. Within 20 cycles, a quarter of the swing, it is 0.0023 at a turn.
#[test]
fn a_part_of_a_swing_is_not_periodic() {
    let swing_hz = SQUEAL_HZ / 83.7;
    let cycles = swung(0.03, |t| 0.008 * sine(swing_hz, t, 0.0));
    let found =
        |slow| (5..=cycles.len()).any(|n| steady::find(&cycles[..n], &Detection::default(), slow).is_some());
    assert!(found(None), "the swing is not slow enough for this test");
    assert!(!found(Some(swinging_at(swing_hz))));
    // A time in which a motion without a swing decays counts like a period.
    assert!(!found(Some(SlowTimes { swing_s: 0.0, relaxation_s: 1.0 / swing_hz })));
    let weak = swung(0.03, |t| 0.0004 * sine(swing_hz, t, 0.0));
    let state =
        steady::find(&weak, &Detection::default(), Some(swinging_at(swing_hz))).expect("too weak to matter");
    assert!((84..=86).contains(&state.window_crossings), "{state:?}");
}

/// The cycles of T at a holder whose force is `force_over_f`, under a squeal that is not in step with it, with N's amplitude over F.
fn swings(duration_s: f64, swing_hz: f64, n_amplitude: f64, force_over_f: impl Fn(f64) -> f64) -> Vec<Cycle> {
    let mut cutter = CycleCutter::of_holder(STEP_S, 0.0, 1.0 / swing_hz);
    let steps = (duration_s / STEP_S) as usize;
    let sample_at = |t: f64| {
        let n_over_f = 1.0 + n_amplitude * sine(0.618 * SQUEAL_HZ, t, 0.0);
        let mut sample = sample(t, n_over_f);
        sample.clamp_tangential_n = LOAD_N * force_over_f(t);
        sample
    };
    (0..steps).filter_map(|n| cutter.push(&sample_at(n as f64 * STEP_S), &Energies::default())).collect()
}

/// Protects: a holder that sticks and slips below the squeal has a cycle, which is found although N shows only the squeal. Its frequency is that
/// of the holder: either end of the window is known to a step, and the mean of T is within a step of its end.
#[test]
fn a_holder_that_sticks_and_slips_has_a_cycle() {
    for ratio in [5.0, 11.3, 40.0] {
        let swing_hz = SQUEAL_HZ / ratio;
        // A saw tooth: stick loads the holder, and slip relieves it in an eighth of the time.
        let tooth = |t: f64| {
            let phase = (t * swing_hz).fract();
            0.3 + 0.1 * if phase < 0.875 { phase / 0.875 - 0.5 } else { 0.5 - (phase - 0.875) / 0.125 }
        };
        let cycles = swings(90.0 / swing_hz, swing_hz, 0.003, tooth);
        let slow = SlowTimes { swing_s: 1.0 / swing_hz, relaxation_s: 0.0 };
        let state = steady::find_swing(&cycles, &Detection::default(), slow);
        assert_eq!(state, Some(SteadyState { crossings_per_cycle: 1, window_crossings: 20 }), "{ratio}");
        let found_hz = steady::frequency_hz(&cycles[cycles.len() - 20..], 1);
        assert!((found_hz / swing_hz - 1.0).abs() < 3.0 * STEP_S * swing_hz / 20.0, "{found_hz} Hz");
        // The means of a motion without a swing must have settled, too.
        let slow = SlowTimes { relaxation_s: 100.0 / swing_hz, ..slow };
        assert_eq!(steady::find_swing(&cycles, &Detection::default(), slow), None);
    }
}

/// Protects: a swing that grows or decays is no cycle, however small it is: its range may change by 0.1 % in ten periods, and here it changes by
/// 0.2 %.
#[test]
fn a_swing_that_changes_is_not_periodic() {
    let swing_hz = SQUEAL_HZ / 11.3;
    let slow = SlowTimes { swing_s: 1.0 / swing_hz, relaxation_s: 0.0 };
    let never = |cycles: &[Cycle], what: &str| {
        assert!(cycles.len() > 60, "{what}: only {} swings", cycles.len());
        // The mean of T begins at 0, and takes thirty periods to come near its end.
        for n in 50..=cycles.len() {
            let found = steady::find_swing(&cycles[..n], &Detection::default(), slow);
            assert_eq!(found, None, "{what}, after {n} swings");
        }
    };
    let duration_s = 110.0 / swing_hz;
    for rate_per_s in [2.0e-4 * swing_hz, -2.0e-4 * swing_hz] {
        for amplitude in [0.05, 1.0e-4] {
            let swing = |t: f64| 0.3 + amplitude * (rate_per_s * t).exp() * sine(swing_hz, t, 0.2);
            never(&swings(duration_s, swing_hz, 0.0, swing), "a swing that changes");
        }
    }
    // The same swing is a cycle if it does not change.
    let cycles = swings(duration_s, swing_hz, 0.0, |t| 0.3 + 0.05 * sine(swing_hz, t, 0.2));
    assert!(steady::find_swing(&cycles, &Detection::default(), slow).is_some());
}
