//! Where curves and boundaries need more points.

use super::series::{Kind, Series, kind, series_along};
use crate::report::{Crossing, JobRow, Minimum, Scalar};
use crate::study::{Boundaries, Curves, Refine};
use serde_json::Value;

/// A point that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// What is known is so many times worse than what is asked for.
    pub urgency: f64,
    pub parameters: Vec<(String, Value)>,
    /// `curve`, `minimum` or `boundary`.
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

/// All points that are asked for, the most urgent ones first, and the number of intervals that are given up.
pub fn wanted(refine: &Refine, rows: &[JobRow]) -> (Vec<Wanted>, usize) {
    let mut all = Vec::new();
    if let Some(curves) = &refine.curves {
        for series in series_along(rows, &curves.over) {
            all.extend(on_curve(&series, curves));
        }
    }
    if let Some(boundaries) = &refine.boundaries {
        for series in series_along(rows, &boundaries.over) {
            all.extend(on_boundaries(&series, boundaries));
        }
    }
    let given_up = all.iter().filter(|point| point.is_none()).count();
    let mut wanted: Vec<Wanted> = all.into_iter().flatten().collect();
    // The sort is stable: what is equally urgent keeps the order of the study.
    wanted.sort_by(|a, b| b.urgency.total_cmp(&a.urgency));
    (wanted, given_up)
}

/// The boundaries of a study as far as they are known.
pub fn crossings(boundaries: &Boundaries, rows: &[JobRow]) -> Vec<Crossing> {
    let series = series_along(rows, &boundaries.over);
    let of_series = |series: &Series<'_>| -> Vec<Crossing> {
        let (known, _) = series.known(|row| kind(row, boundaries.between));
        let crossing = |pair: &[(f64, Kind)]| Crossing {
            rest: series.rest.clone(),
            over: boundaries.over.clone(),
            between: [pair[0].1.name.clone(), pair[1].1.name.clone()],
            range: [pair[0].0, pair[1].0],
            wanted: boundaries.within,
        };
        known.windows(2).filter(|pair| pair[0].1.name != pair[1].1.name).map(crossing).collect()
    };
    series.iter().flat_map(of_series).collect()
}

/// The minima of the curves of a study.
pub fn minima(curves: &Curves, rows: &[JobRow]) -> Vec<Minimum> {
    let Some(wanted) = curves.minimum_within else { return Vec::new() };
    let Some(scalar) = Scalar::find(&curves.of) else { return Vec::new() };
    let minimum = |series: Series<'_>| {
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
    series_along(rows, &curves.over).into_iter().filter_map(minimum).collect()
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
fn on_curve(series: &Series<'_>, curves: &Curves) -> Vec<Option<Wanted>> {
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
        Some(Wanted { urgency, parameters: series.at(&curves.over, x), purpose })
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

/// The points that the boundaries of a series ask for, likewise.
fn on_boundaries(series: &Series<'_>, boundaries: &Boundaries) -> Vec<Option<Wanted>> {
    let (known, unknown) = series.known(|row| kind(row, boundaries.between));
    let mut found = Vec::new();
    for (index, pair) in known.windows(2).enumerate().filter(|(_, pair)| pair[0].1.name != pair[1].1.name) {
        let [low, high] = [pair[0].0, pair[1].0];
        let width = high - low;
        if width <= boundaries.within * ROUNDING {
            continue;
        }
        let rates: Vec<(f64, f64)> = known[index.saturating_sub(1)..(index + 3).min(known.len())]
            .iter()
            .filter_map(|(x, kind)| Some((*x, kind.rate_per_s?)))
            .collect();
        let shares = shares([low, high], boundaries.within, &rates);
        found.extend(shares.into_iter().map(|share| {
            let x = inside([low, high], &unknown, share, boundaries.within)?;
            let parameters = series.at(&boundaries.over, x);
            Some(Wanted { urgency: width / boundaries.within, parameters, purpose: "boundary" })
        }));
    }
    found
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
    use super::{errors_of_lines, inside, shares};

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
}
