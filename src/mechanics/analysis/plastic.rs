//! The plastic flow of a run: how much of it there is, and whether it stands still.

use super::cycles::Cycle;
use crate::solver::energy::Energies;
use serde::{Deserialize, Serialize};

/// Share of the plastic work in what plastic flow and friction dissipate, below which nothing counts as yielding. A plastic work of this share
/// changes μ\* by about the same share.
pub const NEGLIGIBLE_SHARE: f64 = 1.0e-4;

/// The plastic flow of a pin that may yield.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlasticFlow {
    /// Largest plastic strain at the end of the run.
    pub strain_max: f64,
    /// Plastic work \[J\] since the start.
    pub work_j: f64,
    /// Plastic work within the averaging window over the sum of it and the work of friction there.
    pub share: f64,
}

impl PlasticFlow {
    /// Its state in words: `elastic` if nothing has yielded, `shaken_down` if next to nothing yields in the window, and `yielding`.
    pub fn state(&self) -> &'static str {
        match (self.work_j != 0.0, self.is_yielding()) {
            (false, _) => "elastic",
            (true, false) => "shaken_down",
            (true, true) => "yielding",
        }
    }

    /// Whether it goes on within the averaging window.
    pub fn is_yielding(&self) -> bool {
        self.share.abs() > NEGLIGIBLE_SHARE
    }
}

/// The share between two times.
pub(super) fn share(start: &Energies, end: &Energies) -> f64 {
    share_of([end.plastic_j - start.plastic_j, end.friction_j - start.friction_j])
}

fn share_of([plastic_j, friction_j]: [f64; 2]) -> f64 {
    let both_j = plastic_j + friction_j;
    if plastic_j == 0.0 || both_j <= 0.0 { 0.0 } else { plastic_j / both_j }
}

/// The shares of the first and the last half of consecutive cycles, each in whole groups of `m`.
pub(super) fn shares_of_halves(cycles: &[Cycle], m: usize) -> [f64; 2] {
    let half = cycles.len() / m / 2 * m;
    [&cycles[..half], &cycles[cycles.len() - half..]].map(|part| {
        let sum = |of: fn(&Cycle) -> f64| part.iter().map(of).sum::<f64>();
        share_of([sum(|cycle| cycle.plastic_j), sum(|cycle| cycle.friction_j)])
    })
}

/// Whether the shares of two halves are negligible, or the same within `tolerance` of the larger one.
pub(super) fn stands_still([first, last]: [f64; 2], tolerance: f64) -> bool {
    let most = first.abs().max(last.abs());
    most <= NEGLIGIBLE_SHARE || (last - first).abs() <= tolerance * most
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: flow that falls or rises from half to half does not stand still, however small its share is, until it is negligible. Without
    /// friction all that is dissipated is plastic.
    #[test]
    fn flow_stands_still_or_not() {
        for (shares, expected) in [
            ([0.0, 0.0], true),
            ([9.0e-5, 2.0e-5], true),
            ([2.4e-3, 2.0e-3], false),
            ([2.00e-3, 1.99e-3], true),
            ([0.1, 0.2], false),
            ([0.0, 2.0e-4], false),
        ] {
            assert_eq!(stands_still(shares, 0.01), expected, "{shares:?}");
        }
        assert_eq!([share_of([0.0, 0.0]), share_of([2.0, 0.0]), share_of([1.0, 3.0])], [0.0, 1.0, 0.25]);
        let flow = |work_j, share| PlasticFlow { strain_max: 0.1, work_j, share }.state();
        assert_eq!(
            [flow(0.0, 0.0), flow(1.0, 1.0e-5), flow(1.0, 0.1)],
            ["elastic", "shaken_down", "yielding"]
        );
    }
}
