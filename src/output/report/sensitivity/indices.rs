//! Sensitivity indices from given points.
//!
//! On a full grid ([`on_grid`]) all sums are exact. Otherwise the points are a sample, and the indices are estimates, which hold for
//! parameters that do not depend on each other ([`super::design`] decides that):
//!
//! * **First-order index** S = Var(E(Y|x))/Var(Y). Where a parameter has few values, by the variance of the means over each of them, with the
//!   correction of its bias of Fisher (the adjusted coefficient of determination). Where all its values differ, by RBD-FAST: the values in the
//!   order of x, up and down again, have the variance of their first harmonics (Tarantola, Gatelli and Mara, Reliab. Eng. Syst. Saf. 91, 2006),
//!   with the correction of bias of Tissot and Prieur (Reliab. Eng. Syst. Saf. 107, 2012).
//! * **PAWN**: the median over slices of x of the largest distance between the distribution of Y in the slice and that of all Y
//!   (Pianosi and Wagener, Environ. Model. Softw. 67, 2015, and 108, 2018).
//! * **Shares**: the same for classes: half the sum of the differences between their shares in a slice and in all points.

use std::f64::consts::TAU;

/// Number of harmonics of RBD-FAST.
pub(super) const HARMONICS: usize = 10;

/// Fewest points of a slice.
const FEWEST_IN_SLICE: usize = 5;

/// Most slices.
const MOST_SLICES: usize = 10;

/// A variance below this share of the square of the mean is that of rounding.
const ROUNDING: f64 = 1e-24;

/// The positions of points in ascending order of x.
fn order(x: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|a, b| x[*a].total_cmp(&x[*b]).then(a.cmp(b)));
    order
}

/// The first-order index of x, whose values differ; none with fewer than 2·[`HARMONICS`] + 1 points, or if y does not vary.
pub(super) fn first_order(x: &[f64], y: &[f64]) -> Option<f64> {
    let count = y.len();
    let mean = y.iter().sum::<f64>() / count as f64;
    let variance = y.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / count as f64;
    if count < 2 * HARMONICS + 1 || variance <= 0.0 {
        return None;
    }
    // Up through every second point and down through the others, so that the sequence closes.
    let order = order(x);
    let up = order.iter().step_by(2);
    let sequence: Vec<f64> =
        up.chain(order.iter().skip(1).step_by(2).rev()).map(|&at| y[at] - mean).collect();
    let mut explained = 0.0;
    for harmonic in 1..=HARMONICS {
        let [mut cosine, mut sine] = [0.0; 2];
        for (at, y) in sequence.iter().enumerate() {
            let (s, c) = (TAU * (harmonic * at) as f64 / count as f64).sin_cos();
            cosine += y * c;
            sine += y * s;
        }
        explained += 2.0 * (cosine * cosine + sine * sine) / (count * count) as f64;
    }
    let raw = explained / variance;
    let bias = 2.0 * HARMONICS as f64 / count as f64;
    Some(raw - bias / (1.0 - bias) * (1.0 - raw))
}

/// The positions of the points with each value of x, in ascending order of x.
pub(super) fn levels(x: &[f64]) -> Vec<Vec<usize>> {
    let mut levels: Vec<Vec<usize>> = Vec::new();
    for at in order(x) {
        match levels.last_mut().filter(|level| x[level[0]] == x[at]) {
            Some(level) => level.push(at),
            None => levels.push(vec![at]),
        }
    }
    levels
}

/// The variance of the means of y over groups of points, over the variance of y; none if y does not vary.
fn explained(groups: &[Vec<usize>], y: &[f64]) -> Option<f64> {
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let variance = y.iter().map(|y| (y - mean).powi(2)).sum::<f64>();
    let own = |group: &Vec<usize>| {
        let sum: f64 = group.iter().map(|&at| y[at] - mean).sum();
        sum * sum / group.len() as f64
    };
    (variance > ROUNDING * mean * mean * y.len() as f64)
        .then(|| groups.iter().map(own).sum::<f64>() / variance)
}

/// The first-order index of a parameter of which each value has several points; none if y does not vary.
pub(super) fn of_levels(levels: &[Vec<usize>], y: &[f64]) -> Option<f64> {
    let [count, groups] = [y.len(), levels.len()].map(|number| number as f64);
    Some(1.0 - (count - 1.0) / (count - groups) * (1.0 - explained(levels, y)?))
}

/// The first-order and the total index of a parameter on a full grid, on which every value of a parameter counts the same. `levels` are the
/// points of each of its values. `others` are the points of each combination of the other parameters.
pub(super) fn on_grid(levels: &[Vec<usize>], others: &[Vec<usize>], y: &[f64]) -> Option<[f64; 2]> {
    Some([explained(levels, y)?, 1.0 - explained(others, y)?])
}

/// Slices of the points along x: at most `most` of about equal size, each with `fewest` points or more; equal values stay together. None
/// with fewer than two.
pub(super) fn slices_of(x: &[f64], most: usize, fewest: usize) -> Option<Vec<Vec<usize>>> {
    let count = (x.len() / fewest).min(most);
    let order = order(x);
    let mut slices: Vec<Vec<usize>> = Vec::new();
    // The place among `count` equal slices at which the last slice begins.
    let mut begun = 0;
    for (rank, &at) in order.iter().enumerate() {
        let place = rank * count / x.len();
        let is_equal = rank > 0 && x[at] == x[order[rank - 1]];
        match slices.last_mut() {
            Some(last) if is_equal || place == begun || last.len() < fewest => last.push(at),
            _ => {
                begun = place;
                slices.push(vec![at]);
            }
        }
    }
    if slices.len() > 1 && slices.last().is_some_and(|last| last.len() < fewest) {
        let rest = slices.pop().unwrap_or_default();
        slices.last_mut()?.extend(rest);
    }
    (slices.len() > 1).then_some(slices)
}

/// The slices of indices.
pub(super) fn slices(x: &[f64]) -> Option<Vec<Vec<usize>>> {
    slices_of(x, MOST_SLICES, FEWEST_IN_SLICE)
}

/// The PAWN index of some slices.
pub(super) fn pawn(slices: &[Vec<usize>], y: &[f64]) -> f64 {
    let mut all: Vec<f64> = y.to_vec();
    all.sort_by(f64::total_cmp);
    let distance = |slice: &Vec<usize>| {
        let mut own: Vec<f64> = slice.iter().map(|&at| y[at]).collect();
        own.sort_by(f64::total_cmp);
        largest_distance(&own, &all)
    };
    median(slices.iter().map(distance).collect())
}

/// The largest distance between the distributions of two ascending samples (Kolmogorov and Smirnov).
fn largest_distance(a: &[f64], b: &[f64]) -> f64 {
    let [mut i, mut j] = [0; 2];
    let mut largest: f64 = 0.0;
    while i < a.len() && j < b.len() {
        let value = a[i].min(b[j]);
        while i < a.len() && a[i] <= value {
            i += 1;
        }
        while j < b.len() && b[j] <= value {
            j += 1;
        }
        largest = largest.max((i as f64 / a.len() as f64 - j as f64 / b.len() as f64).abs());
    }
    largest
}

/// The index of classes of some slices. Classes are numbers below `classes`.
pub(super) fn of_classes(slices: &[Vec<usize>], class: &[usize], classes: usize) -> f64 {
    let shares = |points: &mut dyn Iterator<Item = usize>| -> Vec<f64> {
        let mut counts = vec![0.0; classes];
        let mut total: f64 = 0.0;
        for at in points {
            counts[class[at]] += 1.0;
            total += 1.0;
        }
        counts.iter().map(|count| count / total.max(1.0)).collect()
    };
    let all = shares(&mut (0..class.len()));
    let distance = |slice: &Vec<usize>| {
        let own = shares(&mut slice.iter().copied());
        0.5 * own.iter().zip(&all).map(|(a, b)| (a - b).abs()).sum::<f64>()
    };
    median(slices.iter().map(distance).collect())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let count = values.len();
    match count {
        0 => 0.0,
        _ => 0.5 * (values[(count - 1) / 2] + values[count / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points that fill the unit square evenly (Kronecker's sequence with the plastic number).
    fn even(count: usize) -> Vec<[f64; 3]> {
        let g: f64 = 1.220_744_084_605_759_6;
        (0..count).map(|n| [1.0, 2.0, 3.0].map(|k| (0.5 + (n + 1) as f64 * g.powf(-k)).fract())).collect()
    }

    /// Protects: the first-order indices of Ishigami's function, which are known in closed form (Ishigami and Homma 1990): with a = 7
    /// and b = 0.1, V = a²/8 + bπ⁴/5 + b²π⁸/18 + ½, S₁ = ½(1 + bπ⁴/5)²/V = 0.3139, S₂ = a²/8/V = 0.4424, S₃ = 0.
    #[test]
    fn first_order_indices_of_ishigami() {
        let points = even(4096);
        let angle = |u: f64| std::f64::consts::PI * (2.0 * u - 1.0);
        let y: Vec<f64> = points
            .iter()
            .map(|point| {
                let [a, b, c] = point.map(angle);
                a.sin() + 7.0 * b.sin().powi(2) + 0.1 * c.powi(4) * a.sin()
            })
            .collect();
        for (k, exact) in [0.3139, 0.4424, 0.0].into_iter().enumerate() {
            let x: Vec<f64> = points.iter().map(|point| point[k]).collect();
            let found = first_order(&x, &y).unwrap();
            // The standard error of a share of variance from n points is about √(2·2M)/n of the rest, and some percent of S.
            assert!((found - exact).abs() < 0.02, "S{}: {found} instead of {exact}", k + 1);
        }
    }

    /// Protects: a parameter without effect has the index 0 within its error, and one that decides alone has nearly 1.
    #[test]
    fn indices_are_between_nothing_and_all() {
        let points = even(1000);
        let column = |k: usize| points.iter().map(|point| point[k]).collect::<Vec<f64>>();
        let y: Vec<f64> = column(0).iter().map(|x| x.powi(3)).collect();
        assert!(first_order(&column(0), &y).unwrap() > 0.99);
        assert!(first_order(&column(1), &y).unwrap().abs() < 0.03);
        let slices_of = |k: usize| slices(&column(k)).unwrap();
        assert_eq!(slices_of(0).len(), MOST_SLICES);
        assert!(slices_of(0).iter().all(|slice| slice.len() == 100));
        // In slice s of ten, the distance is that of [s/10, (s + 1)/10] from all: max(s, 9 − s)/10, whose median is 0.7.
        assert!((pawn(&slices_of(0), &y) - 0.7).abs() < 0.01);
        assert!(pawn(&slices_of(1), &y) < 0.1);
        let class: Vec<usize> = column(0).iter().map(|x| usize::from(*x > 0.5)).collect();
        assert!((of_classes(&slices_of(0), &class, 2) - 0.5).abs() < 0.01);
        assert!(of_classes(&slices_of(1), &class, 2) < 0.05);
        // Equal values stay in one slice.
        let three: Vec<f64> = (0..30).map(|n| f64::from(n % 3)).collect();
        assert_eq!(slices(&three).unwrap().iter().map(Vec::len).collect::<Vec<_>>(), [10, 10, 10]);
        assert_eq!(slices(&[1.0; 40]), None);
    }

    /// Protects: no slice has fewer than five points, however the values repeat. A slice of one point would have the distance 1/2 or more from
    /// all others without any effect.
    #[test]
    fn slices_have_enough_points() {
        let lengths = |x: &[f64]| slices(x).map(|slices| slices.iter().map(Vec::len).collect::<Vec<_>>());
        let repeated = |values: &[(f64, usize)]| -> Vec<f64> {
            values.iter().flat_map(|&(value, times)| vec![value; times]).collect()
        };
        // One point of 40 is no slice.
        assert_eq!(lengths(&repeated(&[(0.0, 39), (1.0, 1)])), None);
        assert_eq!(lengths(&repeated(&[(0.0, 20), (1.0, 3), (2.0, 17)])), Some(vec![20, 20]));
        let half: Vec<f64> = (0..40).map(|n| f64::from((n - 20).max(0))).collect();
        assert_eq!(lengths(&half), Some(vec![21, 5, 5, 9]));
        // Six values of each of 17 speeds: slices are whole speeds.
        let speeds: Vec<f64> = (0..102).map(|n| f64::from(n % 17)).collect();
        let found = lengths(&speeds).unwrap();
        assert!(found.iter().all(|length| length % 6 == 0 && *length >= 6), "{found:?}");
        assert_eq!(found.iter().sum::<usize>(), 102);
    }

    /// Protects: the index of a parameter with few values. y = a + b with a of three values 0, 1, 2 and b even on [−1, 1] has the variances 2/3 and
    /// 1/3, so S of a is 2/3; a parameter of three values without effect has 0.
    #[test]
    fn few_values_have_their_own_estimator() {
        let points = even(999);
        let step = |k: usize| points.iter().map(|point| (3.0 * point[k]).floor()).collect::<Vec<f64>>();
        let y: Vec<f64> = points.iter().zip(step(0)).map(|(point, a)| a + 2.0 * point[1] - 1.0).collect();
        let found = |k: usize| of_levels(&levels(&step(k)), &y).unwrap();
        // The standard error of a share of variance s from n points is below 2 √(s/n) = 0.05; an even sequence has less.
        assert!((found(0) - 2.0 / 3.0).abs() < 0.02, "{}", found(0));
        assert!(found(2).abs() < 0.02, "{}", found(2));
        // 90 values explain 89/998 = 9 % of the variance of anything that varies at random, and the correction takes them off.
        let many: Vec<f64> = (0..999).map(|n| f64::from(n * 487 % 999 / 11)).collect();
        let noise: Vec<f64> = (0..999).map(|n| (f64::from(n).powi(2) * 0.754_877_666).fract()).collect();
        let corrected = of_levels(&levels(&many), &noise).unwrap();
        assert!(corrected.abs() < 0.04, "{corrected}");
        assert_eq!(of_levels(&levels(&step(0)), &[1.0; 999]), None);
    }

    /// Protects: on a full grid the decomposition is exact: y = x₁ + x₂ + c x₁x₂ with centred values has the variances v₁, v₂ and c² v₁ v₂.
    #[test]
    fn a_full_grid_is_decomposed_exactly() {
        let [first, second] = [[-1.0, 0.0, 1.0, 4.0, -4.0].as_slice(), [-3.0, 3.0, 1.0, -1.0].as_slice()];
        let c = 0.5;
        let points: Vec<[f64; 2]> = first.iter().flat_map(|a| second.iter().map(|b| [*a, *b])).collect();
        let y: Vec<f64> = points.iter().map(|[a, b]| 7.0 + a + b + c * a * b).collect();
        let variance = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
        let (v1, v2) = (variance(first), variance(second));
        let v12 = c * c * v1 * v2;
        let all = v1 + v2 + v12;
        let of = |k: usize| levels(&points.iter().map(|point| point[k]).collect::<Vec<_>>());
        for (own, other, v) in [(0, 1, v1), (1, 0, v2)] {
            let [main, total] = on_grid(&of(own), &of(other), &y).unwrap();
            assert!((main - v / all).abs() < 1e-14 && (total - (v + v12) / all).abs() < 1e-14);
        }
        // A quantity that differs in its last bits only does not vary.
        let noise: Vec<f64> = (0..20).map(|n| 1.0 + f64::EPSILON * f64::from(n % 2)).collect();
        assert_eq!(on_grid(&of(0), &of(1), &noise), None);
    }
}
