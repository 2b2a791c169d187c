//! Errors of writing results.

use std::path::PathBuf;

/// A folder of results, or a file in it, could not be written.
#[derive(Debug, thiserror::Error)]
pub enum PublishError {
    /// The folder could not be created.
    #[error("cannot create the folder {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// A file could not be written; an earlier version of it is unchanged.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// A file of an earlier result could not be removed.
    #[error("cannot remove {}, which the result does not have any more: {source}", path.display())]
    Removal {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// A figure could not be drawn.
    #[error("cannot draw {}: {source}", path.display())]
    Figure {
        /// The file that was to hold it.
        path: PathBuf,
        /// Why not.
        source: FigureError,
    },
}

/// A figure could not be drawn.
///
/// Drawings are made in memory, so the drawing library has no reason to fail.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct FigureError(Box<dyn std::error::Error + Send + Sync>);

impl FigureError {
    /// Wraps an error of the drawing library.
    pub(crate) fn new(error: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self(Box::new(error))
    }
}
