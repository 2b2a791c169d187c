//! An inspection as a folder of files.

use super::inspection::Inspection;
use super::page::PageHeader;
use super::summary::Summary;
use super::{fields, figures, page, tables};
use crate::publish::{Folder, PublishError};
use std::path::{Path, PathBuf};

/// The file with all numbers.
const SUMMARY: &str = "inspection.json";

/// The file name of the page, which links the other files.
pub const PAGE: &str = "index.html";

/// Writes figures, tables, fields, the summary `inspection.json` and the page `index.html` into `out_dir`; returns the
/// files.
///
/// Each file is replaced as a whole. Files of the same name are replaced, and others are left alone.
///
/// # Errors
/// The first file that could not be written. Files before it are complete.
pub fn write(
    inspection: &Inspection,
    out_dir: &Path,
    header: &PageHeader,
) -> Result<Vec<PathBuf>, PublishError> {
    let mut folder = Folder::create(out_dir)?;
    remove_stale_files(out_dir);
    let tables = tables::write(inspection, &mut folder)?;
    let figures = figures::write(inspection, &mut folder)?;
    fields::write(&inspection.capture, &mut folder)?;
    let summary = Summary::of(inspection);
    folder.write_with(SUMMARY, |out| {
        serde_json::to_writer_pretty(&mut *out, &summary)?;
        out.push(b'\n');
        Ok(())
    })?;
    folder.write_text(PAGE, &page::of(inspection, &summary, &figures, &tables, header))?;
    Ok(folder.written)
}

/// Removes the files of single nodes and frames that an earlier inspection left. Their number may differ, and the rest
/// would look like files of this inspection. Errors are ignored: a file that has to be replaced fails when it is written.
fn remove_stale_files(out_dir: &Path) {
    if !out_dir.join(SUMMARY).is_file() {
        return;
    }
    for (folder, prefix, suffix) in
        [(out_dir.to_owned(), "node_", ".csv"), (out_dir.join(fields::FRAMES_FOLDER), "pin_", ".vtu")]
    {
        let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
        for file in files.filter(|file| {
            let name = file.file_name();
            name.to_str().is_some_and(|name| name.starts_with(prefix) && name.ends_with(suffix))
        }) {
            let _ = std::fs::remove_file(file.path());
        }
    }
}
