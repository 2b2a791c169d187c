//! A folder whose files appear whole.

use super::error::PublishError;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A folder that files are written into.
pub struct Folder<'a> {
    path: &'a Path,
    /// The files written so far.
    pub written: Vec<PathBuf>,
}

impl<'a> Folder<'a> {
    /// Creates the folder unless it is there.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn create(path: &'a Path) -> Result<Self, PublishError> {
        fs::create_dir_all(path).map_err(|source| PublishError::Folder { path: path.to_owned(), source })?;
        Ok(Self { path, written: Vec::new() })
    }

    /// Where a file of this name is.
    pub fn path_of(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file of text.
    ///
    /// # Errors
    /// If it cannot be written; an earlier version of it is unchanged.
    pub fn text(&mut self, name: &str, text: &str) -> Result<(), PublishError> {
        self.with(name, |out| {
            out.extend_from_slice(text.as_bytes());
            Ok(())
        })
    }

    /// Writes a file that `fill` gives the contents of.
    ///
    /// # Errors
    /// As [`Folder::text`], and those of `fill`.
    pub fn with(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut Vec<u8>) -> io::Result<()>,
    ) -> Result<(), PublishError> {
        let path = self.path_of(name);
        let mut contents = Vec::new();
        match fill(&mut contents).and_then(|()| replace(self.path, name, &contents)) {
            Ok(()) => {
                self.written.push(path);
                Ok(())
            }
            Err(source) => Err(PublishError::File { path, source }),
        }
    }
}

/// Replaces a file as a whole: readers see the old one or the new one.
fn replace(folder: &Path, name: &str, contents: &[u8]) -> io::Result<()> {
    // The process id keeps two reports into one folder apart.
    let temporary = folder.join(format!(".{name}.{}.tmp", std::process::id()));
    let result = fs::write(&temporary, contents).and_then(|()| fs::rename(&temporary, folder.join(name)));
    if result.is_err() {
        // The first error is the one to report; that of the clean-up adds nothing.
        let _ = fs::remove_file(&temporary);
    }
    result
}
