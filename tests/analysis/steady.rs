//! When a sequence of cycles counts as periodic.

use crate::signals::{LOAD_N, SQUEAL_HZ, STEP_S, cut, sample, sine};
use tribosweep::analysis::cycles::Cycle;
use tribosweep::analysis::steady::{self, Obstacle, SteadyState};
use tribosweep::spec::Detection;

/// The result of `steady::find` for every prefix of `cycles`.
fn along(cycles: &[Cycle]) -> Vec<Option<SteadyState>> {
    (0..=cycles.len()).map(|n| steady::find(&cycles[..n], &Detection::default())).collect()
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
            sample.clamp_tangential_n += per_ten_cycles * t * SQUEAL_HZ / 10.0 * LOAD_N;
            sample
        })
    };
    never_periodic(&drifting(0.002), "rising friction");
    never_periodic(&drifting(-0.002), "falling friction");
    assert!(steady::find(&drifting(0.0005), &Detection::default()).is_some(), "half of what is tolerated");
}

/// Protects: the obstacle of a run that is not periodic names the true reason: the figure that varies and by
/// how much, that all nodes slip, or that there are too few cycles.
#[test]
fn what_is_not_periodic_is_told_why() {
    let detection = Detection::default();
    let told = |cycles: &[Cycle]| {
        assert_eq!(steady::find(cycles, &detection), None);
        steady::obstacle(cycles, &detection)
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
        assert_eq!(steady::find(&settled[..count - 1], &detection), None);
        let expected = SteadyState { crossings_per_cycle: 1, window_crossings: count };
        assert_eq!(steady::find(&settled[..count], &detection), Some(expected));
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
        let found = steady::find(settled, &Detection::default()).unwrap();
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
