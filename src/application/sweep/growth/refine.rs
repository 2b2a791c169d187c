//! Where curves and boundaries need more points.

use super::series::{Kind, Point, Series, along, kind, series_along};
use crate::report::{Crossing, JobRow, Minimum, Scalar};
use crate::study::{Boundaries, Curves, Refine, Study};
use serde_json::Value;

/// A point that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// What is known is so many times worse than what is asked for.
    pub urgency: f64,
    pub parameters: Vec<(String, Value)>,
    /// `curve`, `minimum`, `boundary` or `step`.
    pub purpose: &'static str,
}

/// An interval whose error is not known is as urgent as this.
const UNKNOWN: f64 = 1.0e9;

/// So many points without a value may lie in an interval. Then it is given up.
const MOST_UNKNOWN: usize = 3;

/// Two estimates of a crossing agree if they differ by up to so many times what is asked for.
const AGREES: f64 = 4.0;

/// Points on both sides of an estimate are so many times as far from it as what is asked for: together they are near enough.
const REACH: f64 = 0.45;

/// Rounding must not make another point of an interval that is narrow enough.
const ROUNDING: f64 = 1.0 + 1.0e-6;

/// A position may be rounded by this share of the width of its interval.
const ROUNDED_BY: f64 = 0.02;

/// Steps may be rounded by this share of the largest one.
const STEPS_ROUNDED_BY: f64 = 1.0e-8;

/// Most steps of an interval in one wave.
const MOST_STEPS: f64 = 1.0e3;

/// A share of a boundary's value is too little near zero. There the boundary is narrowed down to this part of its interval.
const FINEST_PART: f64 = 1.0 / 4096.0;

/// All points that are asked for, the most urgent ones first, and the number of intervals that are given up.
pub fn wanted(study: &Study, refine: &Refine, rows: &[JobRow]) -> (Vec<Wanted>, usize) {
    let mut all = Vec::new();
    if let Some(curves) = &refine.curves {
        all.extend(on_all(study, &curves.over, rows, |series| on_curve(series, curves)));
    }
    if let Some(own) = &refine.boundaries {
        let kind = |row: &JobRow| kind(row, own.between);
        all.extend(on_all(study, &own.over, rows, |series| on_boundaries(series, own, kind)));
    }
    let given_up = all.iter().filter(|point| point.is_none()).count();
    let mut wanted: Vec<Wanted> = all.into_iter().flatten().collect();
    // The sort is stable: what is equally urgent keeps the order of the study.
    wanted.sort_by(|a, b| b.urgency.total_cmp(&a.urgency));
    (wanted, given_up)
}

/// What is found on all series along a parameter that have points of the study's author.
fn on_all<T>(
    study: &Study,
    over: &str,
    rows: &[JobRow],
    find: impl Fn(&Series<'_, JobRow>) -> Vec<T>,
) -> Vec<T> {
    series_along(rows, &along(study, over)).values().filter(|own| own.is_given()).flat_map(find).collect()
}

/// The boundaries of a study as far as they are known.
pub fn crossings(study: &Study, boundaries: &Boundaries, rows: &[JobRow]) -> Vec<Crossing> {
    on_all(study, &boundaries.over, rows, |series| {
        let (known, _) = series.known(|row| kind(row, boundaries.between));
        let crossing = |pair: &[(f64, Kind)]| Crossing {
            rest: series.rest.clone(),
            over: boundaries.over.clone(),
            between: [pair[0].1.name.clone(), pair[1].1.name.clone()],
            range: [pair[0].0, pair[1].0],
            wanted: within(series, boundaries, [pair[0].0, pair[1].0]),
        };
        known.windows(2).filter(|pair| pair[0].1.name != pair[1].1.name).map(crossing).collect()
    })
}

/// The minima of the curves of a study.
pub fn minima(study: &Study, curves: &Curves, rows: &[JobRow]) -> Vec<Minimum> {
    let Some(wanted) = curves.minimum_within else { return Vec::new() };
    let Some(scalar) = Scalar::find(&curves.of) else { return Vec::new() };
    let minimum = |series: &Series<'_, JobRow>| {
        let (known, _) = series.known(|row| scalar.value(row));
        let at = lowest(&known)?;
        let neighbour = |index: Option<usize>| known.get(index?).map(|(x, _)| *x);
        Some(Minimum {
            rest: series.rest.clone(),
            over: curves.over.clone(),
            of: curves.of.clone(),
            at: known[at].0,
            value: known[at].1,
            neighbours: [neighbour(at.checked_sub(1)), neighbour(Some(at + 1))],
            wanted,
            is_flat: is_flat(&known, curves),
        })
    };
    on_all(study, &curves.over, rows, |series| minimum(series).into_iter().collect())
}

/// Whether the values of a curve differ by no more than the error that is asked for. Then its minimum is anywhere.
fn is_flat(known: &[(f64, f64)], curves: &Curves) -> bool {
    let values = || known.iter().map(|(_, value)| *value);
    let spread = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
    curves.within.is_some_and(|within| spread <= within)
}

fn lowest(known: &[(f64, f64)]) -> Option<usize> {
    (0..known.len()).min_by(|&a, &b| known[a].1.total_cmp(&known[b].1))
}

/// The points that a curve asks for; none for an interval that is given up.
fn on_curve(series: &Series<'_, JobRow>, curves: &Curves) -> Vec<Option<Wanted>> {
    let Some(scalar) = Scalar::find(&curves.of) else { return Vec::new() };
    let (known, unknown) = series.known(|row| scalar.value(row));
    let (Some(first), Some(last)) = (known.first(), known.last()) else { return Vec::new() };
    let finest = curves.finest.or(curves.minimum_within).unwrap_or((last.0 - first.0) / 1.0e3);
    let errors = errors_of_lines(&known);
    let mut urgencies: Vec<(f64, &'static str)> = vec![(0.0, "curve"); errors.len()];
    for (index, urgency) in urgencies.iter_mut().enumerate() {
        let width = known[index + 1].0 - known[index].0;
        if let Some(within) = curves.within
            && width > finest * ROUNDING
        {
            urgency.0 = errors[index].map_or(UNKNOWN, |error| error / within);
        }
    }
    if let (Some(within), Some(at)) = (curves.minimum_within, lowest(&known))
        && !is_flat(&known, curves)
    {
        for index in [at.checked_sub(1), Some(at)].into_iter().flatten().filter(|&index| index < errors.len())
        {
            let needed = (known[index + 1].0 - known[index].0) / within;
            if needed > urgencies[index].0 && needed > ROUNDING {
                urgencies[index] = (needed, "minimum");
            }
        }
    }
    let point = |(index, (urgency, purpose)): (usize, (f64, &'static str))| {
        let x = inside([known[index].0, known[index + 1].0], &unknown, 0.5, f64::INFINITY)?;
        Some(Wanted { urgency, parameters: series.at(x)?, purpose })
    };
    urgencies.into_iter().enumerate().filter(|(_, (urgency, _))| *urgency > ROUNDING).map(point).collect()
}

/// For each interval the error of a straight line in it, |f″|h²/8, with the larger of the second differences at its two ends; none if
/// there are fewer than three points.
fn errors_of_lines(known: &[(f64, f64)]) -> Vec<Option<f64>> {
    let bend = |at: usize| {
        let [(x0, f0), (x1, f1), (x2, f2)] = [known[at - 1], known[at], known[at + 1]];
        (2.0 * ((f2 - f1) / (x2 - x1) - (f1 - f0) / (x1 - x0)) / (x2 - x0)).abs()
    };
    let inner = 1..known.len().saturating_sub(1);
    (0..known.len().saturating_sub(1))
        .map(|index| {
            let bends = [index, index + 1].into_iter().filter(|at| inner.contains(at)).map(bend);
            let width = known[index + 1].0 - known[index].0;
            bends.max_by(f64::total_cmp).map(|bend| bend * width * width / 8.0)
        })
        .collect()
}

/// The points that the boundaries of a series ask for, likewise. `kind` is what they are boundaries of. Where neighbours are too far from
/// each other, there are steps first.
fn on_boundaries<P: Point>(
    series: &Series<'_, P>,
    boundaries: &Boundaries,
    kind: impl Fn(&P) -> Option<Kind>,
) -> Vec<Option<Wanted>> {
    let point = |x: f64, urgency: f64, purpose: &'static str| {
        Some(Wanted { urgency, parameters: series.at(x)?, purpose })
    };
    let mut found = Vec::new();
    let mut wide = Vec::new();
    for pair in series.points.windows(2) {
        let range = [pair[0].0, pair[1].0];
        let steps = boundaries.largest_step.map_or_else(Vec::new, |largest| steps(range, largest));
        wide.extend((!steps.is_empty()).then_some(range));
        found.extend(steps.into_iter().map(|x| point(x, UNKNOWN, "step")));
    }
    let (known, unknown) = series.known(kind);
    for (index, pair) in known.windows(2).enumerate().filter(|(_, pair)| pair[0].1.name != pair[1].1.name) {
        let [low, high] = [pair[0].0, pair[1].0];
        let (width, within) = (high - low, within(series, boundaries, [low, high]));
        if width <= within * ROUNDING || wide.iter().any(|[from, to]| low <= *from && *to <= high) {
            continue;
        }
        let rates: Vec<(f64, f64)> = known[index.saturating_sub(1)..(index + 3).min(known.len())]
            .iter()
            .filter_map(|(x, kind)| Some((*x, kind.rate_per_s?)))
            .collect();
        found.extend(
            shares([low, high], within, &rates).into_iter().map(|share| {
                point(inside([low, high], &unknown, share, within)?, width / within, "boundary")
            }),
        );
    }
    found
}

/// The width within which a boundary in an interval is to be known.
fn within<P: Point>(series: &Series<'_, P>, boundaries: &Boundaries, [low, high]: [f64; 2]) -> f64 {
    let of_share = |share: f64| {
        let least = FINEST_PART * series.width_given([low, high]);
        (share * low.abs().max(high.abs())).max(least)
    };
    boundaries.within.or(boundaries.within_share.map(of_share)).unwrap_or(f64::INFINITY)
}

/// Equal steps in an interval, none larger than `largest`; none if it is not longer than that.
fn steps([low, high]: [f64; 2], largest: f64) -> Vec<f64> {
    let count = ((high - low) / largest - (ROUNDING - 1.0)).ceil().min(MOST_STEPS);
    let step = |step: u32| {
        let x = low + (high - low) * f64::from(step) / count;
        rounded(x, STEPS_ROUNDED_BY * largest)
    };
    (1..count as u32).map(step).collect()
}

/// Where a crossing is looked for in its range, as shares of the width: on both sides of the zero of the growth rates, if it is known;
/// otherwise in the middle. `rates` are positions and growth rates \[1/s\] at the ends of the range and next to it.
///
/// The zero is known if the straight line between the ends and the parabola through a third point agree. Growth rates bend where
/// two modes become one, and there a secant alone takes more points than bisection.
fn shares([low, high]: [f64; 2], within: f64, rates: &[(f64, f64)]) -> Vec<f64> {
    let middle = vec![0.5];
    let rate_at = |x: f64| rates.iter().find(|(own, _)| *own == x).map(|(_, rate)| *rate);
    let (Some(at_low), Some(at_high)) = (rate_at(low), rate_at(high)) else { return middle };
    let width = high - low;
    let secant = low - at_low * width / (at_high - at_low);
    let third = rates.iter().filter(|(x, _)| *x != low && *x != high);
    let zeros = third.map(|(x, rate)| zero([(low, at_low), (high, at_high), (*x, *rate)]));
    let zeros: Vec<f64> = zeros.collect();
    let agrees = |zero: &f64| (zero - secant).abs() <= AGREES * within;
    let Some(zero) = zeros.first().filter(|_| zeros.iter().all(agrees)) else { return middle };
    let both = [zero - REACH * within, zero + REACH * within].map(|x| (x - low) / width);
    // What is as near to an end is a point already.
    let both: Vec<f64> = both.into_iter().filter(|share| (0.02..=0.98).contains(share)).collect();
    if both.is_empty() { middle } else { both }
}

/// The zero of the parabola of x over the rate through three points.
fn zero([(x0, r0), (x1, r1), (x2, r2)]: [(f64, f64); 3]) -> f64 {
    x0 * r1 * r2 / ((r0 - r1) * (r0 - r2))
        + x1 * r0 * r2 / ((r1 - r0) * (r1 - r2))
        + x2 * r0 * r1 / ((r2 - r0) * (r2 - r1))
}

/// The shortest decimal number that differs from `value` by at most `by`.
fn rounded(value: f64, by: f64) -> f64 {
    let to = |decimals| {
        let scale = 10_f64.powi(decimals);
        (value * scale).round() / scale
    };
    (0..=12).map(to).find(|rounded| (rounded - value).abs() <= by).unwrap_or(value)
}

/// A position inside an interval, at this share of its width. If there are points without a value in it, the middle of the widest gap
/// between them; none if there are too many. It is rounded by a small share of the width and of `within`.
fn inside([low, high]: [f64; 2], unknown: &[f64], share: f64, within: f64) -> Option<f64> {
    let mut stops = vec![low];
    stops.extend(unknown.iter().copied().filter(|x| (low..high).contains(x) && *x > low));
    stops.push(high);
    if stops.len() - 2 >= MOST_UNKNOWN {
        return None;
    }
    let (low, high, share) = if stops.len() == 2 {
        (low, high, share)
    } else {
        let widest = stops.windows(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
        (widest[0], widest[1], 0.5)
    };
    let width = high - low;
    let x = rounded(low + share * width, ROUNDED_BY * width.min(within));
    (low < x && x < high).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::{Wanted, errors_of_lines, inside, on_boundaries, shares, steps};
    use crate::report::Along;
    use crate::study::{Boundaries, Side};
    use crate::sweep::growth::series::{Kind, Point, position, series_along};
    use serde_json::Value;

    /// Protects: the error of straight lines is that of a parabola, exactly.
    #[test]
    fn the_error_of_a_line_is_that_of_a_parabola() {
        let known: Vec<(f64, f64)> = [0.0, 1.0, 3.0, 4.0].map(|x| (x, 5.0 * x * x - x)).to_vec();
        let errors: Vec<f64> = errors_of_lines(&known).into_iter().flatten().collect();
        let expected = [1.25, 5.0, 1.25];
        assert_eq!(errors.len(), 3);
        for (error, expected) in errors.iter().zip(expected) {
            assert!((error - expected).abs() < 1.0e-12, "{error} {expected}");
        }
        assert_eq!(errors_of_lines(&known[..2]), [None]);
    }

    /// Protects: a crossing of a growth rate is found with two points fewer than bisection where the rate is nearly straight, and with
    /// two more at most where it bends as that of two modes that become one.
    #[test]
    fn crossings_are_found_with_few_points() {
        let within = 0.002;
        let bisection = (0.2_f64 / within).log2().ceil() as usize;
        for threshold in [0.3137_f64, 0.2201, 0.3799, 0.2503] {
            for (bends, most) in [(false, bisection - 2), (true, bisection + 2)] {
                let rate = |mu: f64| {
                    let beyond = mu - threshold;
                    if bends {
                        -700.0 + 700.0 * ((beyond + 0.02).max(0.0) / 0.02).sqrt()
                    } else {
                        9.0e3 * beyond * (1.0 + beyond)
                    }
                };
                let mut known: Vec<(f64, f64)> = vec![(0.2, rate(0.2)), (0.4, rate(0.4))];
                loop {
                    known.sort_by(|a, b| a.0.total_cmp(&b.0));
                    let at = known.windows(2).position(|pair| pair[0].1 < 0.0 && pair[1].1 >= 0.0).unwrap();
                    let range = [known[at].0, known[at + 1].0];
                    if range[1] - range[0] <= within * 1.000_001 {
                        assert!(range[0] < threshold && threshold <= range[1], "{range:?}");
                        break;
                    }
                    let near = known[at.saturating_sub(1)..(at + 3).min(known.len())].to_vec();
                    for share in shares(range, within, &near) {
                        let x = inside(range, &[], share, within).unwrap();
                        known.push((x, rate(x)));
                    }
                }
                let points = known.len() - 2;
                assert!(points <= most, "{threshold} {bends}: {points}");
            }
        }
    }

    /// Protects: points without a value are passed by, and an interval that has several of them is given up.
    #[test]
    fn failed_points_do_not_stall() {
        assert_eq!(inside([0.0, 1.0], &[], 0.5, 1.0), Some(0.5));
        let second = inside([0.0, 1.0], &[0.5], 0.5, 1.0).unwrap();
        assert!(second != 0.5 && second > 0.0 && second < 1.0);
        assert!(inside([0.0, 1.0], &[0.5, second], 0.5, 1.0).is_some());
        assert_eq!(inside([0.0, 1.0], &[0.25, 0.5, 0.75], 0.5, 1.0), None);
        assert_eq!(inside([0.0, 1.0], &[1.0, 2.0, -1.0], 0.5, 1.0), Some(0.5));
    }

    /// A point with its growth rate.
    struct At {
        parameters: Vec<(String, Value)>,
        rate: f64,
        is_given: bool,
    }

    impl Point for At {
        fn parameters(&self) -> &[(String, Value)] {
            &self.parameters
        }

        fn is_given(&self) -> bool {
            self.is_given
        }
    }

    /// The places of a series in which the boundary of stability is known as well as it is asked for, by ascending place, and the number of
    /// waves that this takes. `rate` is the growth rate at a place.
    fn narrowed(given: &[f64], own: &Boundaries, rate: impl Fn(f64) -> f64) -> (Vec<f64>, usize) {
        let along = Along { parameter: own.over.clone(), with: Vec::new() };
        let at = |x: f64, is_given: bool| {
            let parameters = vec![("omega_rpm".to_owned(), 7.into()), (own.over.clone(), x.into())];
            At { parameters, rate: rate(x), is_given }
        };
        let kind = |point: &At| {
            let name = if point.rate < 0.0 { "stable" } else { "unstable" };
            Some(Kind { name: name.to_owned(), rate_per_s: Some(point.rate) })
        };
        let mut points: Vec<At> = given.iter().map(|x| at(*x, true)).collect();
        for wave in 0..20 {
            let series = series_along(&points, &along);
            let wanted: Vec<Wanted> = on_boundaries(&series[0], own, kind).into_iter().flatten().collect();
            if wanted.is_empty() {
                return (series[0].points.iter().map(|(x, _)| *x).collect(), wave);
            }
            assert!(wanted.iter().all(|one| one.purpose != "boundary") || wanted.len() <= 2, "{wanted:?}");
            let places: Vec<f64> =
                wanted.iter().filter_map(|one| position(&along, &one.parameters)).collect();
            points.extend(places.into_iter().map(|x| at(x, false)));
        }
        panic!("the waves do not end")
    }

    /// A boundary of stability that is to be known to 0.2 %.
    fn to_a_share(over: &str, largest_step: Option<f64>) -> Boundaries {
        let (over, between, within_share) = (over.to_owned(), Side::Stability, Some(0.002));
        Boundaries { over, between, within: None, within_share, largest_step }
    }

    /// The points on both sides of a threshold.
    fn sides(places: &[f64], threshold: f64) -> [f64; 2] {
        let below = places.iter().copied().filter(|x| *x <= threshold).fold(f64::NEG_INFINITY, f64::max);
        [below, places.iter().copied().filter(|x| *x > threshold).fold(f64::INFINITY, f64::min)]
    }

    /// Protects: a boundary is known to a share of its value after few waves of at most two points, also where the growth rate bends at
    /// it as that of two modes that become one, and a boundary that is known gets no more points. A grid of steps of 0.25 of μ has
    /// points between them first.
    #[test]
    fn few_waves_find_a_threshold() {
        for threshold in [0.100_3, 0.123_4, 0.271, 0.299_9, 0.549_9] {
            let rate = |mu: f64| {
                let beyond = (mu - threshold + 0.001).max(0.0).sqrt();
                -800.0 + 800.0 * beyond / 0.001_f64.sqrt()
            };
            let own = to_a_share("mu", Some(0.05));
            let (places, waves) = narrowed(&[0.05, 0.3, 0.55, 0.7], &own, rate);
            assert!(places.windows(2).all(|pair| pair[1] - pair[0] < 0.050_001), "{places:?}");
            let [below, above] = sides(&places, threshold);
            assert!(above - below <= 1.01 * 0.002 * above, "{threshold}: {below} to {above}");
            assert!(waves <= 10 && places.len() <= 30, "{threshold}: {waves} waves, {places:?}");
        }
        let (places, waves) = narrowed(&[0.1, 0.2], &to_a_share("mu", None), |_| -1.0);
        assert_eq!((places, waves), (vec![0.1, 0.2], 0));
    }

    /// Protects: where sliding becomes stable again is narrowed down as well, along any parameter, and tiny numbers keep their digits.
    #[test]
    fn a_threshold_downwards_is_found_too() {
        let rate = |beta_r_s: f64| 500.0 * (3.3e-8 - beta_r_s) / 1.0e-8;
        let own = to_a_share("beta_r_s", None);
        let (places, _) = narrowed(&[2.0e-8, 4.0e-8, 8.0e-8], &own, rate);
        let [below, above] = sides(&places, 3.3e-8);
        assert!(above - below <= 1.01 * 0.002 * above, "{below} to {above}");
    }

    /// Protects: the waves of a boundary at zero end, although no share of zero is a width.
    #[test]
    fn a_boundary_at_zero_ends() {
        let rate = |x: f64| if x > 0.0 { 1.0 } else { -1.0 };
        let (places, waves) = narrowed(&[-0.5, 0.5], &to_a_share("tilt_deg", None), rate);
        let [below, above] = sides(&places, 0.0);
        assert!(above - below <= 1.0 / 4096.0 && waves <= 13, "{below} to {above}: {waves} waves");
    }

    /// Protects: no step is larger than the largest, and intervals that are short enough get none.
    #[test]
    fn wide_intervals_get_steps() {
        assert_eq!(steps([0.25, 0.4], 0.05), [0.3, 0.35]);
        assert_eq!(steps([0.2, 0.32], 0.05), [0.24, 0.28]);
        assert_eq!(steps([0.1, 0.15], 0.05), [0.0; 0]);
        assert_eq!(steps([0.0, 1.0e9], 0.05).len(), 999);
    }
}
