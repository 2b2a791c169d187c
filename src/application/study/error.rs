//! What is wrong with a study, in words for the person who corrects it.

use super::limits::MAX_JOBS;
use super::locate::Position;
use crate::units::printable;
use serde::Serialize;
use std::fmt;

/// Largest number of problems in a message; further ones are only counted.
const SHOWN: usize = 20;

/// Why a study or a selection of one of its jobs cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {reason}", printable(file))]
    Read {
        /// The file as given.
        file: String,
        /// What the operating system said.
        reason: std::io::Error,
    },
    /// The text is not JSON.
    #[error("{}:{position}: not valid JSON: {message}", printable(file))]
    Syntax {
        /// The file as given.
        file: String,
        /// Where reading stopped.
        position: Position,
        /// What is wrong there.
        message: String,
    },
    /// The grid has more than [`MAX_JOBS`] points.
    #[error(
        "{file}: grid: {points} jobs ({factors}): expected at most {MAX_JOBS}\n  help: shorten an axis, or split the study"
    )]
    TooManyJobs {
        /// The file as given.
        file: String,
        /// Number of grid points.
        points: u128,
        /// The product as written: `mu 6 × omega_rpm 17`.
        factors: String,
    },
    /// Fields, parameters or values that cannot be used; the list is never empty.
    #[error("{}", Listing(.0))]
    Invalid(Vec<Problem>),
}

impl StudyError {
    /// The single problems of [`StudyError::Invalid`]; empty for other errors.
    pub fn problems(&self) -> &[Problem] {
        if let Self::Invalid(problems) = self { problems } else { &[] }
    }
}

impl From<Problem> for StudyError {
    fn from(problem: Problem) -> Self {
        Self::Invalid(vec![problem])
    }
}

/// One thing to correct. Displayed as `file:line:column: field = value: message`, one help per line below.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Problem {
    /// The study file, or `--set` for an override.
    pub file: String,
    /// Position in the file, if the file gives the field.
    pub position: Option<Position>,
    /// Path of the field in the file: `scene.pin.poisson_ratio`, `grid.mu[2]`.
    pub field: String,
    /// The value as written; absent when the file does not give the field.
    pub value: Option<String>,
    /// What is wrong, or what is expected.
    pub message: String,
    /// Lines of advice: where the value comes from and what to do.
    pub help: Vec<String>,
}

impl Problem {
    /// Adds a line of help.
    pub(super) fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", printable(&self.file))?;
        if let Some(position) = self.position {
            write!(f, ":{position}")?;
        }
        write!(f, ": {}", printable(&self.field))?;
        if let Some(value) = &self.value {
            write!(f, " = {}", printable(value))?;
        }
        write!(f, ": {}", self.message)?;
        self.help.iter().try_for_each(|help| write!(f, "\n  help: {help}"))
    }
}

struct Listing<'a>(&'a [Problem]);

impl fmt::Display for Listing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.0.iter().take(SHOWN).enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            problem.fmt(f)?;
        }
        if self.0.len() > SHOWN {
            write!(f, "\n… and {} more problems", self.0.len() - SHOWN)?;
        }
        Ok(())
    }
}
