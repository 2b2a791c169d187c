//! What is known about the sensitivity of a quantity.

use super::design::Design;

/// An index, with its interval of confidence where it is an estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Index {
    /// The index of all points.
    pub value: f64,
    /// Its 5 % and 95 % quantiles over resamples of the points, moved so that their mean is the value. None on a full grid, where the value
    /// is exact.
    pub interval: Option<[f64; 2]>,
}

/// The indices of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Indices {
    /// Its name.
    pub name: String,
    /// The first-order index; none for regimes.
    pub first_order: Option<Index>,
    /// The total index, which is known on a full grid only; none for regimes.
    pub total: Option<Index>,
    /// The PAWN index; of regimes, the index of shares.
    pub pawn: Option<Index>,
    /// The elementary effects of a Morris design: the mean of their sizes, in the unit of the quantity for the whole range of the
    /// parameter, and their standard deviation.
    pub effects: Option<(Index, f64)>,
}

/// The indices of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// The name of the quantity; `regime` for the regimes, of which failed jobs are one.
    pub of: String,
    /// The number of points with a value.
    pub points: usize,
    /// The number of jobs without a value, or without an end.
    pub missing: usize,
    /// What these points are.
    pub design: Design,
    /// The indices of each parameter that varies.
    pub parameters: Vec<Indices>,
    /// Why single indices are not there.
    pub remarks: Vec<String>,
    /// What the index of a parameter without any effect would be, above which few of them are by chance: the 95 % quantile of the last
    /// index with shuffled parameters. None unless the indices are estimates.
    pub chance: Option<f64>,
}

/// The name of the sensitivity of regimes.
pub const REGIME: &str = "regime";

impl Index {
    pub(super) fn exact(value: f64) -> Self {
        Self { value, interval: None }
    }
}
