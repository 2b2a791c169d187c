//! History matching of functions that are known exactly.

use super::*;

/// Places that fill the unit cube: multiples of irrational numbers (Roberts' sequence).
fn even(seed: usize, count: usize, parameters: usize) -> Vec<Vec<f64>> {
    // The positive root of x^(d+1) = x + 1.
    let mut root = 1.5_f64;
    for _ in 0..60 {
        root = (1.0 + root).powf(1.0 / (parameters as f64 + 1.0));
    }
    let coordinate =
        |number: usize, k: i32| (0.5 + 0.137 * seed as f64 + number as f64 / root.powi(k)).fract();
    (1..=count).map(|number| (1..=parameters as i32).map(|k| coordinate(number, k)).collect()).collect()
}

/// A pin of numbers: μ* and frequency at a speed for a place, with a threshold below which it slides steadily.
fn pin(place: &[f64], speed: f64) -> Outcome {
    let (mu, stiffness) = (0.2 + 0.4 * place[0], 1.0 + 3.0 * place[1]);
    let squeals = mu > 0.27;
    let drop = if squeals { (mu - 0.27) * (1.0 - speed) } else { 0.0 };
    let value = |value: f64| Some(Computed { value, mesh_deviation: None });
    let log_frequency = squeals.then(|| value(0.5 * stiffness.ln() - 0.1 * mu * speed)).flatten();
    Outcome { squeals: Some(squeals), values: [value(mu - drop), log_frequency] }
}

fn run(place: Vec<f64>, speeds: &[f64]) -> Run {
    let outcomes = speeds.iter().map(|speed| Some(pin(&place, *speed))).collect();
    Run { place, outcomes }
}

fn measured(truth: &[f64], speeds: &[f64], share: f64) -> Vec<Target> {
    let target = |speed: &f64| {
        let outcome = pin(truth, *speed);
        let of = |computed: Option<Computed>, deviation: fn(f64, f64) -> f64| {
            computed.map(|own| Measured { value: own.value, deviation: deviation(own.value, share) })
        };
        let [mu_star, frequency] = outcome.values;
        let values = [of(mu_star, |value, share| value * share), of(frequency, |_, share| share)];
        Target { squeals: outcome.squeals, values }
    };
    speeds.iter().map(target).collect()
}

const SPEEDS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// Waves until the region is known: the history, the region and the number of runs.
fn match_history(truth: &[f64], most: usize) -> (History, Region) {
    let targets = measured(truth, &SPEEDS, 0.02);
    let mut runs: Vec<Run> = even(0, 16, 2).into_iter().map(|place| run(place, &SPEEDS)).collect();
    loop {
        let history = History::new(runs.clone(), targets.clone());
        let region = history.region(|seed, count| even(seed + 1, count, 2), |_| true);
        if history.is_known(&region) || runs.len() >= most {
            return (history, region);
        }
        let next = history.next(&region, 8);
        assert!(!next.is_empty());
        runs.extend(next.into_iter().map(|place| run(place, &SPEEDS)));
    }
}

/// Protects: the true place is never ruled out, the region is small, and it takes at most 40 runs of two parameters.
#[test]
fn the_truth_stays_inside() {
    for truth in [[0.3, 0.2], [0.5, 0.5], [0.8, 0.9], [0.25, 0.7], [0.95, 0.1]] {
        let (history, region) = match_history(&truth, 60);
        let at = history.at(&truth);
        let worst = at.iter().map(|own| own.implausibility).fold(0.0, f64::max);
        assert!(worst <= history.cutoff(), "{truth:?}: {worst}");
        assert!(region.share > 0.0 && region.share < 0.05, "{truth:?}: {}", region.share);
        for (x, [low, high]) in truth.iter().zip(region.extent()) {
            assert!(low <= *x && *x <= high, "{truth:?}: {x} from {low} to {high}");
        }
        assert!(history.runs().len() <= 40, "{truth:?}: {} runs", history.runs().len());
    }
}

/// Protects: values that no place gives leave nothing.
#[test]
fn values_that_nothing_explains_leave_nothing() {
    let mut targets = measured(&[0.5, 0.5], &SPEEDS, 0.02);
    for target in &mut targets {
        target.values[LOG_FREQUENCY].as_mut().unwrap().value += 1.0;
    }
    let runs: Vec<Run> = even(0, 16, 2).into_iter().map(|place| run(place, &SPEEDS)).collect();
    let history = History::new(runs, targets);
    let region = history.region(|seed, count| even(seed + 1, count, 2), |_| true);
    assert_eq!((region.share, region.inside.len()), (0.0, 0));
    assert!(history.is_known(&region) && region.best.unwrap().implausibility > history.cutoff());
}

/// Protects: steady sliding that was measured rules out places that squeal, and nothing else is needed for it.
#[test]
fn steady_sliding_is_data() {
    let stable = Target { squeals: Some(false), values: [None, None] };
    let runs: Vec<Run> = even(0, 60, 2).into_iter().map(|place| run(place, &SPEEDS)).collect();
    let history = History::new(runs, vec![stable; SPEEDS.len()]);
    let at = |place: [f64; 2]| history.at(&place).iter().map(|own| own.implausibility).fold(0.0, f64::max);
    assert!(at([0.05, 0.5]) <= history.cutoff() && at([0.6, 0.5]) > history.cutoff());
}

/// Protects: runs with half the frequency are a branch of their own, and do not spoil the emulator of the others.
#[test]
fn a_jump_of_the_frequency_is_another_branch() {
    let mut runs: Vec<Run> = even(0, 30, 2).into_iter().map(|place| run(place, &SPEEDS)).collect();
    let halved = |run: &Run| run.place[0] > 0.8;
    for own in runs.iter_mut().filter(|own| halved(own)) {
        own.outcomes[2].as_mut().unwrap().values[LOG_FREQUENCY].as_mut().unwrap().value -= 2.0_f64.ln();
    }
    assert!(runs.iter().filter(|own| halved(own)).count() >= 2);
    let truth = [0.5, 0.5];
    let history = History::new(runs, measured(&truth, &SPEEDS, 0.02));
    let [_, check] = history.checks();
    assert!(check.root_mean_square < 1.5, "{check:?}");
    assert!(history.at(&truth).iter().all(|own| own.implausibility < 1.0));
}

/// Protects: a history without runs has no region.
#[test]
fn no_runs_have_no_region() {
    let history = History::new(Vec::new(), measured(&[0.5, 0.5], &SPEEDS, 0.02));
    let region = history.region(|seed, count| even(seed, count, 2), |_| true);
    assert_eq!(region, Region::default());
}

/// Protects: a true place next to the boundary of squeal is not ruled out because runs squeal or slide steadily around it: of 2000 places within
/// 0.05 of straight boundaries, with 20 runs, at most 2⁻⁶ are lost, as when each of the six nearest runs is on either side by chance.
#[test]
fn places_at_the_boundary_of_squeal_stay() {
    let mut lost = 0;
    let mut all = 0;
    for seed in 0..20 {
        // Boundaries in all directions.
        let angle = 0.31 * f64::from(seed);
        let side = |place: &[f64]| (place[0] - 0.5) * angle.cos() + (place[1] - 0.5) * angle.sin();
        let outcome = |place: &[f64]| Outcome { squeals: Some(side(place) > 0.0), values: [None, None] };
        let runs = even(seed as usize, 20, 2).into_iter();
        let runs: Vec<Run> = runs.map(|place| Run { outcomes: vec![Some(outcome(&place))], place }).collect();
        for squeals in [false, true] {
            let target = Target { squeals: Some(squeals), values: [None, None] };
            let history = History::new(runs.clone(), vec![target]);
            let near = even(99, 2000, 2).into_iter().filter(|place| side(place).abs() < 0.05);
            for place in near.filter(|place| (side(place) > 0.0) == squeals) {
                all += 1;
                lost += usize::from(history.at(&place)[0].is_other_state);
            }
        }
    }
    assert!(all > 2000 && (lost as f64) < all as f64 / 64.0, "{lost} of {all}");
}

/// Protects: impossible places are no part of the region.
#[test]
fn impossible_places_are_left_out() {
    let runs: Vec<Run> = even(0, 20, 2).into_iter().map(|place| run(place, &SPEEDS)).collect();
    let history = History::new(runs, vec![Target::default()]);
    let region = history.region(|seed, count| even(seed + 1, count, 2), |place| place[0] > 0.5);
    assert!((region.share - 0.5).abs() < 0.02 && region.extent()[0][0] > 0.5, "{}", region.share);
}

/// Protects: runs of which few or none have a value that was measured rule nothing out by it, and all numbers of runs and values work.
#[test]
fn few_values_have_no_emulator() {
    let truth = [0.5, 0.5];
    for count in 1..9 {
        for values in 0..=count {
            let mut runs: Vec<Run> = even(0, count, 2).into_iter().map(|place| run(place, &SPEEDS)).collect();
            for own in runs.iter_mut().skip(values) {
                // At some measured points only, so that the points differ in how many values they have.
                for outcome in own.outcomes.iter_mut().skip(1).flatten() {
                    outcome.values = [None, None];
                }
            }
            let history = History::new(runs, measured(&truth, &SPEEDS, 0.02));
            let region = history.region(|seed, count| even(seed + 1, count.min(200), 2), |_| true);
            let has_emulator = history.checks().iter().any(|check| check.values > 0);
            assert!(has_emulator || region.share > 0.5, "{count} {values}: {}", region.share);
        }
    }
}
