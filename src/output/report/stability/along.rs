//! The parameter along which sliding becomes unstable.

use crate::report::parameters::{MU, OMEGA};
use std::sync::LazyLock;

/// What thresholds are thresholds of: a number that the study varies, with the parameters that move with it.
#[derive(Debug, Clone, PartialEq)]
pub struct Along {
    /// The parameter.
    pub parameter: String,
    /// The other parameters of its `zip`, whose values move with it.
    pub with: Vec<String>,
}

impl Along {
    /// Along μ alone.
    pub fn mu() -> Self {
        Self { parameter: MU.to_owned(), with: Vec::new() }
    }

    /// Whether a parameter changes along it.
    pub fn moves(&self, name: &str) -> bool {
        self.parameter == name || self.with.iter().any(|with| with == name)
    }

    /// Whether it is μ.
    pub fn is_mu(&self) -> bool {
        self.parameter == MU
    }

    /// Sorts points by their places along it. Some points may share a place while what moves with it differs. They keep the order of the
    /// list, or have the reverse one if the list goes down, so that neighbours stay neighbours. `listed` says which points the list has.
    pub fn sort<T>(points: &mut [(f64, T)], listed: impl Fn(&T) -> bool) {
        let mut ends = points.iter().filter(|(_, point)| listed(point)).map(|(at, _)| *at);
        let first = ends.next();
        if first.zip(ends.next_back()).is_some_and(|(first, last)| last < first) {
            points.reverse();
        }
        points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    }

    /// The parameter along the other axis of figures and tables: ω, unless the thresholds are those of ω. It may move along it, too. Then
    /// it has no value of its own there.
    pub fn across(&self) -> &'static str {
        if self.parameter == OMEGA { MU } else { OMEGA }
    }

    /// What moves with it, and what it does: `load_n moves`, `load_n and mu move`.
    pub(super) fn with_in_words(&self, one: &str, several: &str) -> String {
        match self.with.as_slice() {
            [] => String::new(),
            [with] => format!("{with} {one}"),
            [others @ .., last] => format!("{} and {last} {several}", others.join(", ")),
        }
    }

    /// The name of the threshold in tables.
    pub fn threshold(&self) -> String {
        if self.is_mu() { "mu_c".to_owned() } else { format!("{}_c", self.parameter) }
    }
}

static DEFAULT: LazyLock<Along> = LazyLock::new(Along::mu);

impl Default for &Along {
    fn default() -> Self {
        &DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::Along;

    /// Protects: points of a zip that share a place stay in the order of the list, which may go up or down. Added points do not decide that.
    #[test]
    fn points_at_one_place_keep_their_neighbours() {
        let sorted = |places: &[(f64, u32)]| {
            let mut points = places.to_vec();
            Along::sort(&mut points, |load| *load < 100);
            points.iter().map(|(_, load)| *load).collect::<Vec<_>>()
        };
        assert_eq!(sorted(&[(0.1, 10), (0.3, 30), (0.3, 50), (0.2, 100)]), [10, 100, 30, 50]);
        assert_eq!(sorted(&[(0.3, 50), (0.3, 30), (0.1, 10), (0.4, 100)]), [10, 30, 50, 100]);
        assert_eq!(sorted(&[(0.3, 50)]), [50]);
        assert_eq!(sorted(&[]), [0; 0]);
    }
}
