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
}
