//! A look as a folder of files.

use super::look::Look;
use super::summary::Summary;
use super::{fields, figures, tables};
use crate::publish::{Folder, PublishError};
use std::path::{Path, PathBuf};

/// Writes figures, tables, fields and the summary `inspection.json` into `out_dir`; returns the files.
///
/// Files appear whole; files of the same name are replaced, others are left alone.
///
/// # Errors
/// The first file that could not be written. Files before it are complete.
pub fn write(look: &Look, out_dir: &Path, title: &str) -> Result<Vec<PathBuf>, PublishError> {
    let mut folder = Folder::create(out_dir)?;
    tables::write(look, &mut folder)?;
    figures::write(look, &mut folder)?;
    fields::write(&look.capture, &mut folder)?;
    folder.with("inspection.json", |out| {
        serde_json::to_writer_pretty(&mut *out, &Summary::of(look))?;
        out.push(b'\n');
        Ok(())
    })?;
    Ok(folder.written)
}
