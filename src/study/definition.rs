//! A study that has been read and checked.

use super::grid::Grid;
use super::parameter::Parameter;
use super::source::SourceText;
use crate::spec::JobSpec;
use serde_json::Value;

/// A study that has been read and checked: every job of its grid is physical.
#[derive(Debug, Clone)]
pub struct Study {
    pub(super) name: String,
    pub(super) description: Option<String>,
    pub(super) base: JobSpec,
    pub(super) grid: Grid,
    /// The job of every grid point, decoded once for the check and for the expansion.
    pub(super) specs: Vec<JobSpec>,
    pub(super) source: SourceText,
}

impl Study {
    /// The study's name: `[A-Za-z0-9_-]+`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the study is for, in its author's words.
    pub fn description(&self) -> Option<&str> {
        self.description.as_deref()
    }

    /// The job on which the grid's parameters are set.
    pub fn base(&self) -> &JobSpec {
        &self.base
    }

    /// The grid's parameters and their values, in the order of the file.
    pub fn axes(&self) -> impl Iterator<Item = (&'static Parameter, &[Value])> {
        self.grid.axes.iter().map(|axis| (axis.parameter, axis.values.as_slice()))
    }

    /// Number of grid points; 1 without a grid.
    ///
    /// [`Study::expand`] may return fewer jobs, because it returns equal jobs only once.
    pub fn grid_size(&self) -> usize {
        self.grid.size()
    }
}
