//! When a sequence of cycles counts as a periodic steady state.
//!
//! A limit cycle may have several section crossings (a subharmonic, or a normal force with two humps per
//! cycle). Therefore groups of m = 1, 2, 3, 4 crossings are tried. The smallest m whose groups repeat gives
//! the limit cycle. Groups repeat if, over the last `cycles` of them, the range of every figure is within
//! `tolerance`, and its means over the two halves differ by at most `drift_tolerance`. The amplitude of N is
//! one of the figures: a slowly growing or decaying oscillation is not periodic, however small it is.
//!
//! Where a material yields, the share of the plastic work must stand still as well: negligible (shakedown), or the same in both halves
//! within `tolerance` of itself (`plastic.rs`).
//!
//! A rate of growth or decay below `drift_tolerance` over half of the window is not seen: 1.5 1/s in the reference scene.
//!
//! In a periodic state the mean tangential forces of clamp and contact are equal. A difference of more than `drift_tolerance` is a
//! change of momentum: something still swings.
//!
//! With a holder that moves, the groups cover its slowest motion, because a part of a swing looks periodic where the swing turns. A
//! holder that sticks and slips below the squeal has a cycle of its own, from one rise of T through its mean to the next. The squeal
//! need not be in step with it, so no two of these cycles are quite the same. Therefore the spread may be three times as large there, and the
//! halves may differ by what chance makes; a swing that grows or decays differs by more. The peak stress, which is that of the squeal, does
//! not count, and the amplitude is that of T and N together.

use super::cycles::Cycle;
use super::plastic::{self, shares_of_halves};
use super::sums::Sums;
use crate::spec::{Detection, SlowTimes};
use serde::{Deserialize, Serialize};

/// Largest number of section crossings in one limit cycle, unless a holder moves.
const MAX_CROSSINGS: usize = 4;

/// A periodic steady state at the end of a sequence of cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SteadyState {
    /// Section crossings per limit cycle.
    pub crossings_per_cycle: usize,
    /// Section crossings in the window in which the state was found.
    pub window_crossings: usize,
}

/// Finds a periodic steady state at the end of `cycles` of N. `slow` is how slowly the pin moves with its holder, if that moves.
pub fn find(cycles: &[Cycle], detection: &Detection, slow: Option<SlowTimes>) -> Option<SteadyState> {
    let covered_s = slow.map_or(0.0, |slow| slow.swing_s + slow.relaxation_s);
    (1..=MAX_CROSSINGS).find_map(|m| find_groups(cycles, m, detection, covered_s, Kind::Normal))
}

/// Finds a periodic steady state at the end of `swings`, the cycles of T at a holder that moves.
pub fn find_swing(swings: &[Cycle], detection: &Detection, slow: SlowTimes) -> Option<SteadyState> {
    (1..=MAX_CROSSINGS).find_map(|m| find_groups(swings, m, detection, slow.relaxation_s, Kind::Holder))
}

/// The last `count` groups of `m` crossings; none if there are fewer.
fn last_groups(cycles: &[Cycle], m: usize, count: usize) -> Option<&[Cycle]> {
    Some(&cycles[cycles.len().checked_sub(m * count)?..])
}

/// Groups of `m` crossings that repeat, in a window of at least `covered_s`.
fn find_groups(
    cycles: &[Cycle],
    m: usize,
    detection: &Detection,
    covered_s: f64,
    kind: Kind,
) -> Option<SteadyState> {
    let state = |window: &[Cycle]| {
        let groups: Vec<[f64; FIGURES]> = window.chunks_exact(m).map(|group| kind.figures(group)).collect();
        let is_steady = repeats(&groups, detection, kind)
            && is_balanced(window, detection)
            && flow_stands_still(window, m, detection);
        is_steady.then_some(SteadyState { crossings_per_cycle: m, window_crossings: window.len() })
    };
    let window = last_groups(cycles, m, detection.cycles)?;
    let found = state(window)?;
    let end_s = window[window.len() - 1].end_s;
    if end_s - window[0].start_s >= covered_s {
        return Some(found);
    }
    let first = cycles.partition_point(|cycle| end_s - cycle.start_s >= covered_s).checked_sub(1)?;
    state(last_groups(cycles, m, (cycles.len() - first).div_ceil(m))?)
}

/// Whether clamp and contact carry the same mean force.
fn is_balanced(window: &[Cycle], detection: &Detection) -> bool {
    imbalance(window).abs() <= detection.drift_tolerance
}

/// Whether the material yields as much in both halves of a window.
fn flow_stands_still(window: &[Cycle], m: usize, detection: &Detection) -> bool {
    plastic::stands_still(shares_of_halves(window, m), detection.tolerance)
}

/// [`Sums::imbalance`] of a window.
fn imbalance(window: &[Cycle]) -> f64 {
    Sums::merged(window.iter().map(|cycle| &cycle.sums)).imbalance()
}

/// Why the end of a run does not count as periodic.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Obstacle {
    /// There are fewer section crossings than must repeat.
    FewCycles {
        /// Number of crossings.
        found: usize,
        /// Number of crossings that must repeat.
        needed: usize,
    },
    /// All nodes slip all the time: the oscillation grows or decays, and there is no limit cycle.
    SlipOnly,
    /// A figure differs from cycle to cycle, for every number of crossings per cycle.
    Unsteady {
        /// The figure that exceeds its tolerance most.
        figure: String,
        /// Its largest minus its smallest value over the cycles, relative to the mean for period, stress and
        /// amplitude.
        spread: f64,
        /// The difference of its means over the two halves of the cycles, relative in the same way.
        drift: f64,
    },
    /// The last cycles repeat, but not over the slowest motion of the pin with its holder, or clamp and contact carry different mean forces.
    Swing {
        /// ⟨T⟩/⟨F⟩ of the clamp minus ⟨T⟩/⟨N⟩ of the contact over the last cycles.
        imbalance: f64,
        /// The time \[s\] over which the cycles must repeat; none if nothing in the scene is slow.
        covered_s: Option<f64>,
    },
    /// The last cycles repeat, or all oscillations decay, but the material goes on yielding.
    Flow {
        /// Plastic work over the sum of it and the work of friction, in the half of the window where it is larger.
        share: f64,
    },
    /// All oscillations decay, but the mean friction has not come to its end.
    Creep {
        /// What the mean over an observation will still change.
        still_to_come: f64,
        /// How far ⟨T⟩/⟨F⟩ of the clamp and ⟨T⟩/⟨N⟩ of the contact differ over the observation.
        imbalance: f64,
    },
}

/// Why the end of `cycles` is not periodic, if [`find`] finds nothing.
pub fn obstacle(cycles: &[Cycle], detection: &Detection, slow: Option<SlowTimes>) -> Obstacle {
    let few = Obstacle::FewCycles { found: cycles.len(), needed: detection.cycles };
    let attempts = (1..=MAX_CROSSINGS).filter_map(|m| {
        let window = last_groups(cycles, m, detection.cycles)?;
        let groups: Vec<[f64; FIGURES]> = window.chunks_exact(m).map(figures_of).collect();
        if slips_only(&groups) {
            return Some((f64::INFINITY, Obstacle::SlipOnly));
        }
        if repeats(&groups, detection, Kind::Normal) {
            if !flow_stands_still(window, m, detection) {
                let [first, last] = shares_of_halves(window, m);
                return Some((0.0, Obstacle::Flow { share: first.max(last) }));
            }
            let covered_s = slow.map(|slow| slow.swing_s + slow.relaxation_s);
            return Some((0.0, Obstacle::Swing { imbalance: imbalance(window), covered_s }));
        }
        let excesses = (0..FIGURES).map(|f| (Variation::of(&groups, f).excess(detection), f));
        let (excess, f) = excesses.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let Variation { spread, drift, scale } = Variation::of(&groups, f);
        // A record cannot store infinity.
        let relative = |x: f64| if scale > 0.0 { x / scale } else { 0.0 };
        let figure = NAMES[f].to_owned();
        Some((excess, Obstacle::Unsteady { figure, spread: relative(spread), drift: relative(drift) }))
    });
    attempts.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(few, |(_, obstacle)| obstacle)
}

/// Number of figures compared.
const FIGURES: usize = 8;
/// Names of the compared figures.
const NAMES: [&str; FIGURES] = [
    "mu_star",
    "n_over_f",
    "stick_share",
    "slip_share",
    "separated_share",
    "period",
    "sigma_n_max",
    "amplitude of N",
];
/// Figures from this index on are compared relative to their mean.
const FIRST_RELATIVE: usize = 5;

fn figures_of(group: &[Cycle]) -> [f64; FIGURES] {
    let sums = Sums::merged(group.iter().map(|cycle| &cycle.sums));
    let [stick, slip, separated] = sums.shares();
    [
        sums.mu_star(),
        sums.normal_over_load(),
        stick,
        slip,
        separated,
        group[group.len() - 1].end_s - group[0].start_s,
        sums.sigma_n_max_pa,
        group.iter().map(|cycle| cycle.amplitude_n).fold(0.0, f64::max),
    ]
}

/// The figures of a group of cycles of the holder.
fn figures_of_swing(group: &[Cycle]) -> [f64; FIGURES] {
    let sums = Sums::merged(group.iter().map(|cycle| &cycle.sums));
    let [stick, slip, separated] = sums.shares();
    let of_both = |cycle: &Cycle| {
        let of_normal_n = 0.5 * (cycle.sums.normal_max_n - cycle.sums.normal_min_n);
        libm::hypot(cycle.amplitude_n, of_normal_n)
    };
    [
        sums.mu_star_contact(),
        sums.normal_over_load(),
        stick,
        slip,
        separated,
        group[group.len() - 1].end_s - group[0].start_s,
        1.0,
        group.iter().map(of_both).sum::<f64>() / group.len() as f64,
    ]
}

/// Whose cycles they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Normal,
    Holder,
}

impl Kind {
    fn figures(self, group: &[Cycle]) -> [f64; FIGURES] {
        match self {
            Self::Normal => figures_of(group),
            Self::Holder => figures_of_swing(group),
        }
    }
}

/// How many times the tolerated spread the cycles of a holder may differ by, and how many standard errors their halves.
const CHANCE: f64 = 3.0;

fn repeats(groups: &[[f64; FIGURES]], detection: &Detection, kind: Kind) -> bool {
    let is_tolerated = |f| {
        let variation = Variation::of(groups, f);
        match kind {
            Kind::Normal => variation.is_tolerated(detection, 1.0, 0.0),
            Kind::Holder => variation.is_tolerated(detection, CHANCE, CHANCE * chance_of_drift(groups, f)),
        }
    };
    !slips_only(groups) && (0..FIGURES).all(is_tolerated)
}

/// Standard error of the difference of a figure's means over the two halves, from the scatter within each.
fn chance_of_drift(groups: &[[f64; FIGURES]], f: usize) -> f64 {
    let half = groups.len() / 2;
    let of_mean = |part: &[[f64; FIGURES]]| {
        let n = part.len() as f64;
        let mean = part.iter().map(|group| group[f]).sum::<f64>() / n;
        part.iter().map(|group| (group[f] - mean).powi(2)).sum::<f64>() / (n * (n - 1.0).max(1.0))
    };
    (of_mean(&groups[..half]) + of_mean(&groups[groups.len() - half..])).sqrt()
}

/// Whether all nodes slip all the time. Such sliding is linear: it grows or decays, and has no limit cycle.
fn slips_only(groups: &[[f64; FIGURES]]) -> bool {
    let slip = 3;
    groups.iter().all(|group| group[slip] >= 1.0)
}

/// How a figure varies over the groups.
struct Variation {
    spread: f64,
    drift: f64,
    scale: f64,
}

impl Variation {
    fn of(groups: &[[f64; FIGURES]], f: usize) -> Self {
        let half = groups.len() / 2;
        let mean = |part: &[[f64; FIGURES]]| part.iter().map(|g| g[f]).sum::<f64>() / part.len() as f64;
        let highest = groups.iter().map(|g| g[f]).fold(f64::NEG_INFINITY, f64::max);
        let lowest = groups.iter().map(|g| g[f]).fold(f64::INFINITY, f64::min);
        Self {
            spread: highest - lowest,
            drift: (mean(&groups[groups.len() - half..]) - mean(&groups[..half])).abs(),
            scale: if f < FIRST_RELATIVE { 1.0 } else { mean(groups) },
        }
    }

    /// Whether the spread is within `times` the tolerance, and the drift within its tolerance or `chance`.
    fn is_tolerated(&self, detection: &Detection, times: f64, chance: f64) -> bool {
        self.spread <= times * detection.tolerance * self.scale
            && self.drift <= (detection.drift_tolerance * self.scale).max(chance)
    }

    /// The larger of spread and drift, each over its tolerance.
    fn excess(&self, detection: &Detection) -> f64 {
        let over = |x: f64, tolerance: f64| if x == 0.0 { 0.0 } else { x / (tolerance * self.scale) };
        over(self.spread, detection.tolerance).max(over(self.drift, detection.drift_tolerance))
    }
}

/// Frequency \[Hz\] of the fundamental over consecutive `cycles`. A limit cycle has `crossings` of them.
///
/// # Panics
/// Unless `cycles` are one or more whole limit cycles.
pub fn frequency_hz(cycles: &[Cycle], crossings: usize) -> f64 {
    assert!(!cycles.is_empty() && cycles.len().is_multiple_of(crossings), "whole limit cycles");
    let groups: Vec<_> = cycles.chunks_exact(crossings).collect();
    let duration_s = cycles[cycles.len() - 1].end_s - cycles[0].start_s;
    fundamental_per_crossing(&groups) * cycles.len() as f64 / duration_s
}

/// Periods of the fundamental per section crossing, 1/d.
///
/// Two [`Cycle`]s are alike if they differ by at most a fifth, in duration and in how far N goes above and
/// below F. Those that are not alike are humps of one limit cycle. d is the smallest divisor of m for which
/// all of them at a distance of d are alike. A limit cycle of m crossings is then a cycle of d humps with a
/// slight subharmonic. Its normal force still has its strongest low line at 1/d of the crossing frequency,
/// and that line is reported.
fn fundamental_per_crossing(groups: &[&[Cycle]]) -> f64 {
    const ALIKE: f64 = 0.2;
    let m = groups[0].len();
    // Duration, highest and lowest N − F at each position, as means over all groups.
    let passages: Vec<[f64; 3]> = (0..m)
        .map(|position| {
            let figures = groups.iter().map(|group| {
                let [highest, lowest] = group[position].extremes_n;
                [group[position].period_s(), highest, lowest]
            });
            let sums = figures.fold([0.0; 3], |sums, f| std::array::from_fn(|i| sums[i] + f[i]));
            sums.map(|sum| sum / groups.len() as f64)
        })
        .collect();
    let extreme = |i: usize, first: usize, every: usize| {
        let values = passages.iter().skip(first).step_by(every).map(|passage| passage[i]);
        values.fold([f64::NEG_INFINITY, f64::INFINITY], |[high, low], v| [v.max(high), v.min(low)])
    };
    let longest_s = extreme(0, 0, 1)[0];
    let amplitude_n = (extreme(1, 0, 1)[0] - extreme(2, 0, 1)[1]) / 2.0;
    let scales = [longest_s, amplitude_n, amplitude_n];
    let repeats = |d: usize| {
        (0..d).all(|first| {
            (0..3).all(|i| {
                let [high, low] = extreme(i, first, d);
                high - low <= ALIKE * scales[i]
            })
        })
    };
    let humps = (1..=m).find(|&d| m.is_multiple_of(d) && repeats(d)).unwrap_or(m);
    1.0 / humps as f64
}

/// Standard error of the mean of consecutive, correlated `values`, from the means of ⌊√n⌋ batches, at least
/// two. It is zero for a single value, from which no error can be estimated.
pub fn standard_error(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return 0.0;
    }
    let batches = values.len().isqrt().max(2);
    let size = values.len() / batches;
    let means: Vec<f64> = values
        .rchunks_exact(size)
        .take(batches)
        .map(|batch| batch.iter().sum::<f64>() / size as f64)
        .collect();
    let mean = means.iter().sum::<f64>() / batches as f64;
    let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (batches - 1) as f64;
    (variance / batches as f64).sqrt()
}

/// Standard error of the mean of consecutive `values` with what they still drift: the difference D of the means of the two halves,
/// as far as it is larger than chance makes it. D has the standard error 2s, with the standard error s of the mean. Twice that is chance. Here s
/// comes from the differences of successive batches, because a drift is in the differences of all of them.
pub fn standard_error_with_drift(values: &[f64]) -> f64 {
    let chance = standard_error(values);
    let half = values.len() / 2;
    if half == 0 {
        return chance;
    }
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let drift = mean(&values[values.len() - half..]) - mean(&values[..half]);
    let batches = values.len().isqrt().max(2);
    let size = values.len() / batches;
    let means: Vec<f64> = values.rchunks_exact(size).take(batches).map(mean).collect();
    let steps: f64 = means.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
    let of_steps = steps / (2 * (means.len() - 1) * means.len()) as f64;
    (chance * chance + (drift * drift - 16.0 * of_steps).max(0.0)).sqrt()
}
