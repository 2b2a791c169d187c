//! What a study says: the values of fields and the grid, before any job is made.

use super::draft::Draft;
use super::grid::Grid;
use super::source::SourceText;
use serde_json::Value;

/// The content of a study file, with the changes that the command line makes.
#[derive(Debug, Clone)]
pub(super) struct Outline {
    /// The study's object; its types have been checked.
    pub document: Value,
    /// The axes of its `grid`.
    pub grid: Grid,
    /// The file's text, for messages.
    pub source: SourceText,
    /// Whether its jobs may compute complex modes without a run. A study file cannot ask for that.
    pub allows_modes: bool,
    /// Whether it is a new study, and not one that a database has already.
    pub is_new: bool,
}

impl Outline {
    /// The draft of the job without the grid's values.
    pub(super) fn draft(&self) -> Draft {
        Draft::of(&self.document)
    }
}
