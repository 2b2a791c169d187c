//! What a reader wants to see: the axes, the quantities, and the names of parameters.

use super::scalar::Scalar;
use std::collections::BTreeMap;

/// How a report lays out its jobs. The default is ω along the axis and a curve for each μ.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct View {
    /// The parameter along the axis of figures and the rows of tables. A name that no job has is ignored.
    pub x: Option<String>,
    /// The parameter that tells the curves of a figure and the columns of a table apart; `source` for the study or file.
    pub by: Option<String>,
    /// Quantities that get figures and tables besides μ\*, the frequency and the regime.
    pub y: Vec<&'static Scalar>,
    /// Whether μ\* has a figure of its span over everything but the axis and the parameter of the curves.
    pub span: bool,
    /// Parameters in words, by name, for the titles of axes: `pin's Young's modulus`, without the unit.
    pub descriptions: BTreeMap<String, String>,
    /// Parameters whose axes are known to be logarithmic (true) or linear; the values of others decide.
    pub is_log: BTreeMap<String, bool>,
    /// Whether the jobs are those of a Morris design, in its order. They are no sample.
    pub is_morris: bool,
    /// What a reader must know to compare the sources, one sentence each.
    pub notes: Vec<String>,
}

impl View {
    /// The default, for a layout that outlives its caller.
    pub(super) const DEFAULT: Self = Self {
        x: None,
        by: None,
        y: Vec::new(),
        span: false,
        descriptions: BTreeMap::new(),
        is_log: BTreeMap::new(),
        is_morris: false,
        notes: Vec::new(),
    };
}

static DEFAULT: View = View::DEFAULT;

impl Default for &View {
    fn default() -> Self {
        &DEFAULT
    }
}
