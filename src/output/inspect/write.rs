//! An inspection as a folder of files.

use super::inspection::Inspection;
use super::page::PageHeader;
use super::summary::{SUMMARY, Summary};
use super::{fields, figures, page, tables};
use crate::publish::{Folder, PublishError, html};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// The kind of a folder of an inspection, whole or of the spectrum alone.
pub(super) const KIND: &str = "inspection";

/// The file name of the page, which links the other files.
pub const PAGE: &str = "index.html";

/// Writes figures, tables, fields, the summary `inspection.json` and the page `index.html` into `out_dir`; returns the
/// files.
///
/// Each file is replaced as a whole. Files of an earlier inspection that this one does not have are removed, and others are
/// left alone.
///
/// # Errors
/// The first file that could not be written. Files before it are complete.
pub fn write(
    inspection: &Inspection,
    out_dir: &Path,
    header: &PageHeader,
) -> Result<Vec<PathBuf>, PublishError> {
    let mut folder = Folder::create(out_dir, KIND)?;
    let tables = tables::write(inspection, &mut folder)?;
    fields::write(&inspection.capture, &mut folder)?;
    let summary = Summary { key: header.key.clone(), ..Summary::of(inspection) };
    folder.write_with(SUMMARY, |out| json(&summary, out))?;
    let page = page::of(inspection, &summary, &figures::figures(inspection), &tables, header);
    for figure in page.figures() {
        folder.write_text(&figure.file, &figure.svg)?;
    }
    folder.write_text(PAGE, &html::of_page(&page))?;
    folder.finish()
}

/// Writes a document as JSON.
pub(super) fn json(document: &impl Serialize, out: &mut Vec<u8>) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, document)?;
    out.push(b'\n');
    Ok(())
}

/// The key of the job whose inspection is in a folder; none if there is no inspection.
pub fn key_of(folder: &Path) -> Option<String> {
    #[derive(Deserialize)]
    struct Keyed {
        key: String,
    }
    let summary = std::fs::read(folder.join(SUMMARY)).ok()?;
    serde_json::from_slice::<Keyed>(&summary).ok().map(|found| found.key)
}

/// Whether a folder holds the spectrum of the job with this key, from an inspection of any kind.
pub fn has_spectrum(folder: &Path, key: &str) -> bool {
    key_of(folder).is_some_and(|found| found == key) && folder.join(tables::SPECTRUM_FILE).is_file()
}
