//! Studies as data: a JSON file that names a base job and a grid of parameters to vary.
//!
//! ```text
//! text ──► locate (positions, repeated keys) ──► file (serde) ──► preset ──► axis (values) ──► validate (every job)
//!                                                                     │
//!                                              single (one job) ◄── Study ──► expand (all jobs, keys, costs)
//! ```
//!
//! Whatever is wrong is found in [`Study::parse`], so that a [`Study`] in hand always expands into
//! usable jobs. Messages name the file, line and column, the field, its value and what would be right.

mod axis;
mod cost;
mod error;
mod expand;
mod file;
mod json;
mod key;
mod locate;
mod origin;
mod parameter;
mod parse;
mod preset;
mod schema;
mod single;
mod suggest;
mod validate;

pub use error::{Problem, StudyError};
pub use expand::{Job, MAX_JOBS};
pub use key::job_key;
pub use locate::Position;
pub use parameter::{PARAMETERS, Parameter};
pub use preset::{CaseEvidence, Evidence, Preset, PresetEvidence, ReferenceEvidence};
pub use schema::schema;

use crate::spec::JobSpec;
use axis::Axis;
use origin::Origin;
use serde_json::Value;
use std::path::Path;

/// A study that has been read and checked: every job of its grid is physical.
#[derive(Debug, Clone)]
pub struct Study {
    name: String,
    description: Option<String>,
    base: JobSpec,
    axes: Vec<Axis>,
    origin: Origin,
}

impl Study {
    /// Reads and checks a study file.
    ///
    /// # Errors
    /// The file cannot be read, or anything that [`Study::parse`] refuses.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        let text = std::fs::read_to_string(path)
            .map_err(|reason| StudyError::Read { file: path.display().to_string(), reason })?;
        Self::parse(&text, &path.display().to_string())
    }

    /// Checks the text of a study file; `source_name` stands for the file in messages, and its stem
    /// is the study's name unless the text gives one.
    ///
    /// # Errors
    /// Broken JSON, repeated keys, unknown fields or parameters, wrong types, unusable axes, more
    /// than [`MAX_JOBS`] jobs, or jobs that violate a limit of [`JobSpec::check`].
    pub fn parse(text: &str, source_name: &str) -> Result<Self, StudyError> {
        parse::parse(text, source_name)
    }

    /// The study's name: `[A-Za-z0-9_-]+`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the study is for, in its author's words.
    pub fn description(&self) -> Option<&str> {
        self.description.as_deref()
    }

    /// The job that the grid's parameters are set on.
    pub fn base(&self) -> &JobSpec {
        &self.base
    }

    /// The grid's parameters and their values, in the order of the file.
    pub fn axes(&self) -> impl Iterator<Item = (&'static Parameter, &[Value])> {
        self.axes.iter().map(|axis| (axis.parameter, axis.values.as_slice()))
    }

    /// Number of grid points; 1 without a grid.
    ///
    /// [`Study::expand`] may give fewer jobs, because grid points that are the same job count once.
    pub fn grid_size(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product()
    }
}
