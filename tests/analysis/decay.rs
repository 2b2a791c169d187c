//! When sliding counts as decaying.

use crate::analysis::signals::{STEP_S, sample, sine};
use crate::random::Random;
use tribosweep_mechanics::analysis::decay::DecayMonitor;
use tribosweep_mechanics::analysis::lines::ROUNDING;
use tribosweep_mechanics::analysis::sample::Sample;

/// The default observation time [s].
const OBSERVATION_S: f64 = 0.008;

/// One line of N/F: amplitude, frequency [Hz], growth rate [1/s], phase.
#[derive(Debug, Clone, Copy)]
struct Line(f64, f64, f64, f64);

fn sliding(time_s: f64, n_over_f: f64) -> Sample {
    Sample { stick: 0, slip: 63, separated: 0, ..sample(time_s, n_over_f) }
}

fn value(lines: &[Line], t: f64) -> f64 {
    lines.iter().map(|&Line(a, f, rate, phase)| a * (rate * t).exp() * sine(f, t, phase)).sum()
}

fn monitor() -> DecayMonitor {
    DecayMonitor::new(STEP_S, 0.0, OBSERVATION_S, ROUNDING, false)
}

/// Time [s] at which sliding with these lines is first declared decaying, and the measured rate.
fn declared(lines: &[Line], duration_s: f64) -> Option<(f64, f64)> {
    let mut monitor = monitor();
    (0..(duration_s / STEP_S) as usize).find_map(|n| {
        let t = n as f64 * STEP_S;
        monitor
            .push(&sliding(t, 1.0 + value(lines, t)))
            .then(|| (t, monitor.growth_rate_per_s().unwrap_or(0.0)))
    })
}

/// Protects: sliding with one damped line is declared decaying after the observation time, with the rate of
/// that line, for any frequency, amplitude, rate and phase. The logarithm of a line's amplitude is linear
/// except for the window's side lobes (1e-7), so a tolerance of 1 % of the rate (or 0.01 /s) is generous.
#[test]
fn a_damped_line_decays_at_its_rate() {
    let mut random = Random::new(11);
    for _ in 0..40 {
        let rate = -(10.0_f64).powf(random.between(1.0, 3.0));
        let amplitude = (10.0_f64).powf(random.between(-5.0, 0.0));
        let line = Line(amplitude, random.between(5.0e3, 1.5e5), rate, random.between(0.0, 6.0));
        let (at_s, found) = declared(&[line], 0.02).unwrap_or_else(|| panic!("{line:?} is not declared"));
        assert!((0.0079..0.0085).contains(&at_s), "{line:?}: after {at_s} s");
        assert!((found - rate).abs() < 0.01 * rate.abs() + 0.01, "{line:?}: found {found}");
    }
}

/// Protects: of several well separated strong lines, the one that decays slowest gives the rate, to 3 %.
#[test]
fn the_slowest_of_several_lines_gives_the_rate() {
    let mut random = Random::new(12);
    for _ in 0..30 {
        let lines: Vec<Line> = (0..5)
            .map(|i| {
                let frequency = 9.0e3 + 8.0e3 * f64::from(i) + random.between(-1.0e3, 1.0e3);
                let amplitude = (10.0_f64).powf(random.between(-2.0, 0.0));
                Line(amplitude, frequency, random.between(-500.0, -40.0), random.between(0.0, 6.0))
            })
            .collect();
        let slowest = lines.iter().map(|line| line.2).fold(f64::NEG_INFINITY, f64::max);
        let (at_s, found) = declared(&lines, 0.03).unwrap_or_else(|| panic!("{lines:?} not declared"));
        assert!(at_s < 0.012, "{lines:?}: only after {at_s} s");
        assert!((found / slowest - 1.0).abs() < 0.03, "{lines:?}: found {found}");
    }
}

/// Protects: a growing line is always detected, even if it is weak beside a decaying one (down to 1e-6), and
/// whether it is far away from it or only 1.5 kHz. Sliding must not be declared decaying at any time of the
/// run.
#[test]
fn a_weak_growing_line_is_not_overlooked() {
    let mut random = Random::new(13);
    for _ in 0..60 {
        let decaying = Line(
            (10.0_f64).powf(random.between(-2.0, 0.0)),
            random.between(1.2e4, 1.8e4),
            random.between(-800.0, -20.0),
            random.between(0.0, 6.0),
        );
        let distance = [1.5e3, -1.5e3, 5.0e3, 3.0e4][(random.unit() * 4.0) as usize];
        let weakness = (10.0_f64).powf(random.between(-6.0, -1.0));
        let growing = Line(
            decaying.0 * weakness,
            decaying.1 + distance,
            random.between(20.0, 400.0),
            random.between(0.0, 6.0),
        );
        let found = declared(&[decaying, growing], 0.025);
        assert_eq!(found, None, "{decaying:?} hides {growing:?}");
    }
}

/// Protects: sliding with an undamped line, with or without rounding noise, is not declared decaying.
#[test]
fn an_undamped_line_does_not_decay() {
    let mut random = Random::new(14);
    for _ in 0..20 {
        let line = Line(0.1, random.between(5.0e3, 5.0e4), 0.0, random.between(0.0, 6.0));
        assert_eq!(declared(&[line], 0.04), None, "{line:?}");
    }
    for noise in [1.0e-14, 1.0e-8, 1.0e-3] {
        let mut monitor = monitor();
        for n in 0..47_000 {
            let t = f64::from(n) * STEP_S;
            let n_over_f = 1.0 + 0.1 * sine(14_500.0, t, 0.0) + noise * random.normal();
            assert!(!monitor.push(&sliding(t, n_over_f)), "noise {noise}, t = {t}");
        }
    }
}

/// Protects: two undamped or growing lines whose beat falls for a while are not declared decaying. Beats of
/// at least 150 Hz have more than one period in the observation of 8 ms.
#[test]
fn a_falling_beat_is_not_a_decay() {
    let mut random = Random::new(15);
    for trial in 0..60 {
        let spacing = [150.0, 200.0, 300.0, 500.0, 900.0, 2.0e3][trial % 6];
        let rate = [0.0, 10.0, 50.0][trial % 3];
        let one = Line(0.1, 15.0e3, rate, random.between(0.0, 6.0));
        let two = Line(random.between(0.02, 0.1), 15.0e3 + spacing, rate, random.between(0.0, 6.0));
        assert_eq!(declared(&[one, two], 0.04), None, "{one:?} and {two:?}");
    }
}

/// Protects: two close decaying lines beat, but they are declared decaying in the end, with a negative rate.
/// From 500 Hz on (two periods of the beat in a long stretch) this is the rate of the slower line, to a
/// tenth. Below 500 Hz the beat itself is part of the measurement. There the rate only has to be between half
/// that of the slower line and that of the faster line.
#[test]
fn beating_decaying_lines_are_declared() {
    let mut random = Random::new(16);
    for trial in 0..40 {
        let spacing = [100.0, 200.0, 500.0, 1.0e3, 2.0e3][trial % 5];
        let lines = [
            Line(0.1, 15.0e3, random.between(-400.0, -150.0), random.between(0.0, 6.0)),
            Line(0.05, 15.0e3 + spacing, random.between(-900.0, -500.0), random.between(0.0, 6.0)),
        ];
        let (_, found) = declared(&lines, 0.04).unwrap_or_else(|| panic!("{lines:?} not declared"));
        let (slow, fast) = if spacing < 500.0 { (0.5, lines[1].2) } else { (0.9, 1.1 * lines[0].2) };
        assert!(found < slow * lines[0].2 && found > fast, "{lines:?}: {found}");
    }
}

/// Protects: sliding without any oscillation, or with one that falls to rounding at once, is declared
/// decaying, with a finite rate that is not positive.
#[test]
fn nothing_left_is_decaying() {
    for lines in [&[][..], &[Line(1.0, 15.0e3, -2.0e4, 0.0)], &[Line(1.0e-13, 15.0e3, 0.0, 0.0)]] {
        let (_, rate) = declared(lines, 0.02).unwrap_or_else(|| panic!("{lines:?} not declared"));
        assert!(rate.is_finite() && rate <= 0.0, "{lines:?}: {rate}");
    }
    let mut constant = monitor();
    let decaying = (0..47_000).any(|n| constant.push(&sliding(f64::from(n) * STEP_S, 1.0)));
    assert!(decaying && constant.growth_rate_per_s().is_none(), "nothing ever moved: no rate");
}

/// Protects: the measured rate remains after the oscillation has fallen to rounding (at −1000 /s it reaches
/// 1e-11 after 25 ms).
#[test]
fn the_rate_outlives_the_oscillation() {
    let mut monitor = monitor();
    for n in 0..70_000 {
        let t = f64::from(n) * STEP_S;
        monitor.push(&sliding(t, 1.0 + value(&[Line(1.0, 15.0e3, -1000.0, 0.0)], t)));
    }
    let found = monitor.growth_rate_per_s().unwrap();
    assert!((found / -1000.0 - 1.0).abs() < 0.03, "{found}");
}

/// Protects: one node that sticks or separates in one step starts the observation anew.
#[test]
fn stick_or_separation_starts_anew() {
    for (stick, separated) in [(1, 0), (0, 1)] {
        let mut monitor = monitor();
        let line = [Line(0.1, 15.0e3, -100.0, 0.0)];
        let mut interrupted_s = None;
        let mut declared_again_s = None;
        for n in 0..30_000 {
            let t = f64::from(n) * STEP_S;
            let mut sample = sliding(t, 1.0 + value(&line, t));
            if t > 0.01 && interrupted_s.is_none() {
                (sample.stick, sample.separated, sample.slip) = (stick, separated, 62);
                sample.transitions = 1;
                interrupted_s = Some(t);
                assert!(!monitor.push(&sample));
                assert_eq!(monitor.growth_rate_per_s(), None);
            } else if monitor.push(&sample) && interrupted_s.is_some() {
                declared_again_s.get_or_insert(t);
            }
        }
        let waited_s = declared_again_s.unwrap() - interrupted_s.unwrap();
        assert!((0.0079..0.0085).contains(&waited_s), "declared again after {waited_s} s");
    }
}

/// Protects: a node that sticks all the time, without a transition, is no steady sliding, however fast the oscillation
/// decays.
#[test]
fn a_node_that_always_sticks_is_no_sliding() {
    let mut monitor = monitor();
    let decays = (0..30_000).any(|n| {
        let t = f64::from(n) * STEP_S;
        let mut sample = sliding(t, 1.0 + value(&[Line(0.1, 15.0e3, -100.0, 0.0)], t));
        (sample.stick, sample.slip) = (1, 62);
        monitor.push(&sample)
    });
    assert!(!decays && monitor.growth_rate_per_s().is_none());
}

/// Protects: no decay is declared during the load's ramp. An observation time far beyond any run needs no
/// memory and declares nothing.
#[test]
fn ramp_and_endless_observation() {
    let mut ramped = DecayMonitor::new(STEP_S, 1.0, OBSERVATION_S, ROUNDING, false);
    assert!(!(0..20_000).any(|n| ramped.push(&sliding(f64::from(n) * STEP_S, 1.0))));
    for observation in [1.0e9, 1.0e300] {
        let mut endless = DecayMonitor::new(STEP_S, 0.0, observation, ROUNDING, false);
        assert!(!(0..20_000).any(|n| endless.push(&sliding(f64::from(n) * STEP_S, 1.0))));
    }
}

/// Protects: a mode that is odd across the pin is detected although the total normal force does not show it.
/// Here the moment of N grows while N itself decays.
#[test]
fn a_growing_tilt_is_not_overlooked() {
    for tilt in [1.0e-9, 1.0e-4] {
        let mut monitor = monitor();
        for n in 0..30_000 {
            let t = f64::from(n) * STEP_S;
            let mut sample = sliding(t, 1.0 + value(&[Line(0.1, 15.0e3, -300.0, 0.0)], t));
            sample.x_moment_n = sample.load_n * value(&[Line(tilt, 16.0e3, 40.0, 1.0)], t);
            assert!(!monitor.push(&sample), "declared decaying at {t} s with a tilt of {tilt}");
        }
        assert!((monitor.growth_rate_per_s().unwrap() / 40.0 - 1.0).abs() < 0.03);
    }
}

/// Protects: with a holder that moves, a growing swing is seen in T although N shows no line of it, and its rate is that of the mode: N, whose
/// amplitude is the square of the mode's, grows twice as fast at twice the frequency. Without a holder T is not looked at. The rate
/// is measured to 3 % (as that of any line).
#[test]
fn the_growth_rate_is_that_of_the_mode_and_not_of_its_harmonic() {
    let (swing_hz, rate_per_s) = (3.0e3, 40.0);
    let amplitude = |t: f64| 0.02 * (rate_per_s * t).exp();
    for holder_moves in [true, false] {
        let mut monitor = DecayMonitor::new(STEP_S, 0.0, OBSERVATION_S, ROUNDING, holder_moves);
        for n in 0..20_000 {
            let t = f64::from(n) * STEP_S;
            let harmonic = 0.5 * amplitude(t).powi(2) * sine(2.0 * swing_hz, t, 0.3);
            let mut sample = sliding(t, 1.0 + harmonic);
            sample.clamp_tangential_n += sample.load_n * amplitude(t) * sine(swing_hz, t, 0.0);
            assert!(!monitor.push(&sample));
        }
        let found = monitor.growth_rate_per_s().unwrap();
        let expected = if holder_moves { rate_per_s } else { 2.0 * rate_per_s };
        assert!((found / expected - 1.0).abs() < 0.03, "{holder_moves}: {found} instead of {expected}");
    }
}

/// Protects: a second mode at twice the frequency of the first keeps its own rate: only a line with the sum of the rates is a product.
#[test]
fn a_faster_mode_at_twice_the_frequency_is_no_harmonic() {
    let lines = [Line(0.1, 6.0e3, 20.0, 0.0), Line(0.01, 12.0e3, 70.0, 1.0)];
    let mut monitor = monitor();
    for n in 0..20_000 {
        let t = f64::from(n) * STEP_S;
        monitor.push(&sliding(t, 1.0 + value(&lines, t)));
    }
    let found = monitor.growth_rate_per_s().unwrap();
    assert!((found / 70.0 - 1.0).abs() < 0.03, "{found}");
}
