//! What the points of a study are: a full grid, on which indices are exact; a sample, from which they are estimated; or points from which
//! nothing can be said.

use super::indices::{HARMONICS, levels, slices_of};
use super::parameter::Parameter;
use crate::publish::value;
use std::collections::BTreeSet;

/// What the points are.
#[derive(Debug, Clone, PartialEq)]
pub enum Design {
    /// Every combination of the values of all parameters once: the numbers of values, in the order of the parameters.
    Grid(Vec<usize>),
    /// A sample of parameters that do not depend on each other.
    Sample,
    /// No indices, for this reason.
    Unknown(String),
}

/// How the first-order index of a parameter of a sample is estimated.
pub(super) enum Estimator {
    /// By the means over each of its values.
    Levels,
    /// By the harmonics of the values in its order.
    Harmonics,
}

/// A grid with gaps is no sample: its values repeat in an order, and an estimator takes off the variance that they would have by chance. A
/// sample from few combinations has less of this variance, by the share of the combinations that it has. With this share, a tenth of the
/// correction is wrong.
const LARGEST_SHARE_OF_GRID: f64 = 0.1;

/// Points of a value, on average, from which on the means of values are used. The correction of their bias is at most a tenth then.
const POINTS_OF_LEVEL: usize = 10;

/// The share of values that differ from all others, from which on points have an order.
const DISTINCT: f64 = 0.9;

/// Random pairs of values fill at least 1 − 1/e of the places that they can have.
const PAIRS: f64 = 0.6;

/// Standard deviations beyond which a pair of parameters depends on each other: by chance, one pair of 4000.
const DEPENDENT: f64 = 3.5;

/// What some points are: the positions `points` among the values of the parameters.
pub(super) fn design_of(parameters: &[Parameter], points: &[usize]) -> Design {
    let count = points.len();
    let columns: Vec<Vec<f64>> =
        parameters.iter().map(|parameter| points.iter().map(|&at| parameter.values[at]).collect()).collect();
    let sizes: Vec<usize> = columns.iter().map(|column| levels(column).len()).collect();
    let combinations = sizes.iter().map(|size| *size as f64).product::<f64>();
    let different: BTreeSet<Vec<u64>> =
        (0..count).map(|at| columns.iter().map(|column| column[at].to_bits()).collect()).collect();
    if count > 1 && different.len() == count && combinations == count as f64 {
        return Design::Grid(sizes);
    }
    if different.len() < count {
        return Design::Unknown("some points are there more than once".to_owned());
    }
    if count as f64 > LARGEST_SHARE_OF_GRID * combinations {
        let sizes = sizes.iter().map(usize::to_string).collect::<Vec<_>>().join(" × ");
        return Design::Unknown(format!(
            "the points are a grid with gaps: {count} of {sizes} combinations; indices need all of them, or less than a tenth"
        ));
    }
    if count == 0 {
        return Design::Unknown("no job has a value".to_owned());
    }
    if count <= 2 * HARMONICS {
        return Design::Unknown(format!(
            "{count} points are too few: indices need {} or more",
            2 * HARMONICS + 1
        ));
    }
    for (at, first) in columns.iter().enumerate() {
        for (other, second) in columns.iter().enumerate().skip(at + 1) {
            if are_dependent(first, second) {
                let [first, second] = [at, other].map(|at| &parameters[at].name);
                return Design::Unknown(format!(
                    "{first} and {second} depend on each other in these points, so it cannot be said which of them decides"
                ));
            }
        }
    }
    Design::Sample
}

/// Whether two parameters depend on each other: their pairs of values repeat more than pairs by chance, or a test of χ² on a table of
/// slices of both says so.
fn are_dependent(a: &[f64], b: &[f64]) -> bool {
    let count = a.len() as f64;
    let pairs: BTreeSet<[u64; 2]> = a.iter().zip(b).map(|(a, b)| [a.to_bits(), b.to_bits()]).collect();
    let places = count.min((levels(a).len() * levels(b).len()) as f64);
    if (pairs.len() as f64) < PAIRS * places {
        return true;
    }
    // Five points or more in a place of the table, on average.
    let most = ((count / 5.0).sqrt() as usize).clamp(2, 4);
    let slices = |x: &[f64]| slices_of(x, most, (x.len() / (2 * most)).max(1));
    let (Some(a), Some(b)) = (slices(a), slices(b)) else { return false };
    let mut chi_square = 0.0;
    for row in &a {
        let own: BTreeSet<usize> = row.iter().copied().collect();
        for column in &b {
            let found = column.iter().filter(|at| own.contains(at)).count() as f64;
            let expected = (row.len() * column.len()) as f64 / count;
            chi_square += (found - expected).powi(2) / expected;
        }
    }
    // χ² as standard deviations (Wilson and Hilferty 1931).
    let freedom = ((a.len() - 1) * (b.len() - 1)) as f64;
    let width = 2.0 / (9.0 * freedom);
    ((chi_square / freedom).cbrt() - (1.0 - width)) / width.sqrt() > DEPENDENT
}

/// How the first-order index of a parameter of a sample is estimated, or why it is not.
pub(super) fn estimator(name: &str, is_number: bool, x: &[f64]) -> Result<Estimator, String> {
    let (different, count) = (levels(x).len(), x.len());
    if different * POINTS_OF_LEVEL <= count {
        return Ok(Estimator::Levels);
    }
    if !is_number {
        return Err(format!("{name} has no order, and {different} values in {count} points are too many"));
    }
    if different as f64 >= DISTINCT * count as f64 {
        return Ok(Estimator::Harmonics);
    }
    let mean = value::fixed(count as f64 / different as f64, 1);
    Err(format!(
        "each value of {name} has {mean} points on average: too many for an order, too few for their means (at least \
         {POINTS_OF_LEVEL})"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters(columns: &[&[f64]]) -> Vec<Parameter> {
        let names = ["a", "b", "c"].iter().zip(columns);
        names
            .map(|(name, values)| Parameter {
                name: (*name).to_owned(),
                is_number: true,
                values: values.to_vec(),
            })
            .collect()
    }

    fn design(columns: &[&[f64]]) -> Design {
        let points: Vec<usize> = (0..columns[0].len()).collect();
        design_of(&parameters(columns), &points)
    }

    fn assert_unknown(found: &Design, expected: &str) {
        assert!(matches!(found, Design::Unknown(why) if why.contains(expected)), "{expected} in {found:?}");
    }

    /// The fractional parts of multiples of irrational numbers: even, and independent of each other.
    fn even(count: usize, step: f64) -> Vec<f64> {
        (1..=count).map(|n| (n as f64 * step).fract()).collect()
    }

    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    const OTHER: f64 = 0.414_213_562_373_095_1;

    /// Protects: a full grid is known as such in any order, with names as numbers, and also if it is what is left of a larger one. With a gap it is
    /// neither a grid nor a sample.
    #[test]
    fn a_grid_is_known() {
        let a: Vec<f64> = (0..102).map(|n| f64::from((n * 35) % 102 % 17)).collect();
        let b: Vec<f64> = (0..102).map(|n| f64::from((n * 35) % 102 / 17)).collect();
        assert_eq!(design(&[&a, &b]), Design::Grid(vec![17, 6]));
        assert_unknown(&design(&[&a[1..], &b[1..]]), "grid with gaps: 101 of 17 × 6 combinations");
        assert_unknown(&design(&[&a[..60], &b[..60]]), "a grid with gaps: 60 of");
        let twice = [&a[..], &a[..]].concat();
        assert_unknown(&design(&[&twice, &[&b[..], &b[..]].concat()]), "more than once");
        // One parameter is a grid of its own.
        assert_eq!(design(&[&even(30, GOLDEN)]), Design::Grid(vec![30]));
    }

    /// Protects: independent points are a sample. Points that move together, on a line, on a circle or in a product with a grid are none.
    #[test]
    fn dependent_points_are_no_sample() {
        for count in [21, 40, 100, 1000] {
            let (a, b) = (even(count, GOLDEN), even(count, OTHER));
            assert_eq!(design(&[&a, &b]), Design::Sample, "{count}");
            // Three values of the second.
            let three: Vec<f64> = b.iter().map(|b| (3.0 * b).floor()).collect();
            // 21 points are too few to see it; their indices say little.
            if count > 21 {
                assert_unknown(&design(&[&a, &b, &three]), "b and c depend on each other");
            }
            let c: Vec<f64> =
                even(count, 0.732_050_807_568_877_3).iter().map(|c| (3.0 * c).floor()).collect();
            assert_eq!(design(&[&a, &b, &c]), Design::Sample, "{count}");
            let together: Vec<f64> = a.iter().map(|a| 2.0 - a * a).collect();
            assert_unknown(&design(&[&b, &a, &together]), "b and c depend on each other");
        }
        let a = even(200, GOLDEN);
        let circle = a.iter().map(|a| (std::f64::consts::TAU * a).sin_cos());
        let (x, y): (Vec<f64>, Vec<f64>) = circle.unzip();
        assert_unknown(&design(&[&x, &y]), "a and b depend");
        // Half of the second is the first: a correlation of 0.45.
        let mixed: Vec<f64> = a.iter().zip(even(200, OTHER)).map(|(a, b)| 0.5 * a + b).collect();
        assert_unknown(&design(&[&a, &mixed]), "a and b depend");
        // A product of 60 points of two parameters with three values: the pairs of the two repeat.
        let product = |column: Vec<f64>| column.into_iter().flat_map(|value| [value; 3]).collect::<Vec<_>>();
        let grid: Vec<f64> = (0..180).map(|n| f64::from(n % 3)).collect();
        let found = design(&[&product(even(60, GOLDEN)), &product(even(60, OTHER)), &grid]);
        assert_unknown(&found, "a and b depend on each other");
        assert_unknown(&design(&[&even(20, GOLDEN), &even(20, OTHER)]), "20 points are too few");
    }

    /// Protects: each parameter has the estimator that fits its values, and none if neither does.
    #[test]
    fn estimators_fit_the_values() {
        let x = even(100, GOLDEN);
        assert!(matches!(estimator("x", true, &x), Ok(Estimator::Harmonics)));
        let steps = |count: f64| x.iter().map(|x| (count * x).floor()).collect::<Vec<_>>();
        assert!(matches!(estimator("x", true, &steps(10.0)), Ok(Estimator::Levels)));
        assert!(matches!(estimator("x", false, &steps(3.0)), Ok(Estimator::Levels)));
        let why = estimator("x", true, &steps(40.0)).err().unwrap();
        assert!(why.contains("each value of x has 2.5 points on average"), "{why}");
        let why = estimator("x", false, &x).err().unwrap();
        assert!(why.contains("no order"), "{why}");
    }
}
