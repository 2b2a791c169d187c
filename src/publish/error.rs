//! What can go wrong while results are published.

use super::plot::FigureError;
use std::path::PathBuf;

/// A folder of results, or a part of it, could not be written.
#[derive(Debug, thiserror::Error)]
pub enum PublishError {
    /// The folder could not be made.
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
    /// A figure could not be drawn.
    #[error("cannot draw {}: {source}", path.display())]
    Figure {
        /// The file it was meant for.
        path: PathBuf,
        /// Why not.
        source: FigureError,
    },
}
