//! Sums, means and weights of windows.

use crate::analysis::signals::{LOAD_N, SQUEAL_HZ, STEP_S, cut, sample, sine};
use crate::random::Random;
use tribosweep_mechanics::analysis::sample::Sample;
use tribosweep_mechanics::analysis::sums::Sums;

fn random_samples(count: usize) -> Vec<Sample> {
    let mut random = Random::new(31);
    (0..count)
        .map(|n| {
            let mut sample = sample(n as f64 * STEP_S, random.between(0.0, 3.0));
            sample.clamp_tangential_n = random.between(-10.0, 20.0);
            sample.stick_deficit_n = random.between(0.0, 5.0);
            sample.slip_deficit_n = random.between(0.0, 5.0);
            sample.stick = (random.unit() * 20.0) as usize;
            sample.slip = (random.unit() * 20.0) as usize;
            sample.separated = 63 - sample.stick - sample.slip;
            sample.sigma_n_max_pa = random.between(0.0, 1e7);
            sample.slip_speed_max_m_s = random.unit();
            sample.lift_max_m = random.unit() * 1e-7;
            for node in &mut sample.nodes {
                node.u_m[1] = random.between(-1e-6, 1e-6);
                node.gap_m = random.unit() * 1e-7;
            }
            sample
        })
        .collect()
}

fn sum(samples: &[Sample]) -> Sums {
    samples.iter().fold(Sums::EMPTY, |mut all, sample| {
        all.add(sample, 1.0);
        all
    })
}

fn ratios(sums: &Sums) -> [f64; 8] {
    let [stick, slip, separated] = sums.shares();
    [
        sums.mu_star(),
        sums.mu_star_contact(),
        sums.normal_over_load(),
        sums.stick_reduction(),
        sums.slip_reduction(),
        stick,
        slip,
        separated,
    ]
}

/// Protects: the shares sum to one for any weights.
#[test]
fn shares_sum_to_one() {
    let mut sums = Sums::EMPTY;
    for (i, sample) in random_samples(1000).iter().enumerate() {
        sums.add(sample, [1.0, 0.3, 1.0e-9][i % 3]);
        assert!((sums.shares().iter().sum::<f64>() - 1.0).abs() < 1e-14);
    }
}

/// Protects: merging windows gives the same as adding all their samples. Sums agree to rounding (1000
/// additions of either sign), extremes exactly.
#[test]
fn merged_equals_adding_all() {
    let samples = random_samples(1000);
    let all = sum(&samples);
    let parts: Vec<Sums> = samples.chunks(37).map(sum).collect();
    let merged = Sums::merged(&parts);
    for (a, b) in ratios(&all).iter().zip(ratios(&merged)) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
    let extremes = |sums: &Sums| {
        [sums.normal_min_n, sums.normal_max_n, sums.sigma_n_max_pa, sums.slip_speed_max_m_s, sums.lift_max_m]
    };
    assert_eq!(extremes(&all), extremes(&merged));
    for (a, b) in all.nodes.iter().zip(&merged.nodes) {
        assert_eq!(a, b);
    }
}

/// Protects: the taper removes an unfinished oscillation from the mean. T/F oscillates by ±0.1 with a period
/// of 7.3 windows, so the 40 windows contain 5.48 periods. The plain mean is off by up to 0.1/(π·5.48) =
/// 6·10⁻³. Under the taper the leakage is 1/(1 − 5.48²) = 1/29 of that, 2·10⁻⁴.
#[test]
fn tapered_mean_kills_an_unfinished_oscillation() {
    let mut worst = [0.0_f64; 2];
    for eighth in 0..8 {
        let windows: Vec<Sums> = (0..40)
            .map(|w| {
                let samples: Vec<Sample> = (0..50)
                    .map(|n| {
                        let t = f64::from(50 * w + n);
                        let mut sample = sample(t, 1.0);
                        let phase = f64::from(eighth) * 0.785;
                        sample.clamp_tangential_n += 0.1 * LOAD_N * sine(1.0 / (7.3 * 50.0), t, phase);
                        sample
                    })
                    .collect();
                sum(&samples)
            })
            .collect();
        for (worst, sums) in worst.iter_mut().zip([Sums::merged(&windows), Sums::tapered(windows.iter())]) {
            *worst = worst.max((sums.mu_star() - 0.3).abs());
        }
    }
    assert!(worst[0] > 2.0e-3, "the plain mean {worst:?} shows what there is to kill");
    assert!(worst[1] < 3.0e-4, "{worst:?}");
}

/// Protects: an empty window is recognised as empty, and its figures are finite.
#[test]
fn an_empty_window_is_finite() {
    assert!(Sums::EMPTY.is_empty());
    assert!(!sum(&random_samples(1)).is_empty());
    assert!(ratios(&Sums::EMPTY).iter().all(|ratio| ratio.is_finite()), "{:?}", ratios(&Sums::EMPTY));
}

/// Protects: the step in which a cycle ends is divided between the two cycles without loss. So the mean over
/// consecutive cycles is the integral of the samples between the first and the last crossing. Each sample
/// stands for the step that ends at it. T is a straight line here, so a step that is counted twice or not at
/// all would show: ⟨T⟩/F = ½(start + end) + half a step, to rounding.
#[test]
fn cycles_share_their_last_step() {
    let cycles = cut(STEP_S, 0.005, |t| {
        let mut sample = sample(t, 1.0 + 0.5 * sine(SQUEAL_HZ, t, 0.0));
        sample.clamp_tangential_n = t * LOAD_N;
        sample
    });
    assert!(cycles.len() > 60);
    for pair in cycles.windows(2) {
        assert_eq!(pair[0].end_s, pair[1].start_s, "no gap between cycles");
    }
    for window in [&cycles[..], &cycles[3..4], &cycles[7..29]] {
        let (start_s, end_s) = (window[0].start_s, window[window.len() - 1].end_s);
        let found = Sums::merged(window.iter().map(|cycle| &cycle.sums)).mu_star();
        // The samples form a staircase. This is its integral up to a time with the fraction θ of a step.
        let stairs = |time_s: f64| {
            let whole = (time_s / STEP_S).floor();
            let theta = time_s / STEP_S - whole;
            (whole * (whole + 1.0) / 2.0 + theta * (whole + 1.0)) * STEP_S * STEP_S
        };
        let expected = (stairs(end_s) - stairs(start_s)) / (end_s - start_s);
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} instead of {expected}");
    }
}
