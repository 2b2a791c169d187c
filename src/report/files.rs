//! The report as a folder of files.

use super::error::ReportError;
use super::figure::{self, Plot};
use super::page::{self, FigureLink};
use super::tables::{self, Quantity};
use super::{export, row::Row};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Writes tables, figures, the export and the page `report.md` into `out_dir`; returns the files.
///
/// Every file appears whole: it is written beside its place and then renamed. A folder that exists
/// is fine; files of the same name are replaced, others are left alone.
///
/// # Errors
/// The first file that could not be written. Files before it are complete.
pub fn write(rows: &[Row], out_dir: &Path, title: &str) -> Result<Vec<PathBuf>, ReportError> {
    fs::create_dir_all(out_dir).map_err(|source| ReportError::Folder { path: out_dir.to_owned(), source })?;
    let mut folder = Folder { path: out_dir, written: Vec::new() };

    let quantities =
        [(Quantity::MuStar, "mu_star"), (Quantity::Frequency, "frequency"), (Quantity::Regime, "regime")];
    for (quantity, stem) in quantities {
        folder.text(&format!("{stem}.md"), &page::of_table(rows, quantity, title))?;
        folder.with(&format!("{stem}.csv"), |out| tables::csv(rows, quantity, out))?;
    }

    let mut links = Vec::new();
    for (plot, stem) in [(Plot::MuStar, "figure7"), (Plot::Frequency, "frequency")] {
        let figures = figure::figures(rows, plot)
            .map_err(|source| ReportError::Figure { path: out_dir.join(format!("{stem}.svg")), source })?;
        for figure in figures {
            let file = format!("{stem}{}.svg", figure.suffix);
            folder.text(&file, &figure.svg)?;
            links.push(FigureLink { plot, caption: figure.caption, file });
        }
    }

    folder.with("jobs.csv", |out| export::csv(rows, out))?;
    folder.text("report.md", &page::of_report(rows, &links, title))?;
    Ok(folder.written)
}

struct Folder<'a> {
    path: &'a Path,
    written: Vec<PathBuf>,
}

impl Folder<'_> {
    fn text(&mut self, name: &str, text: &str) -> Result<(), ReportError> {
        self.with(name, |out| {
            out.extend_from_slice(text.as_bytes());
            Ok(())
        })
    }

    fn with(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut Vec<u8>) -> io::Result<()>,
    ) -> Result<(), ReportError> {
        let path = self.path.join(name);
        let mut contents = Vec::new();
        match fill(&mut contents).and_then(|()| replace(self.path, name, &contents)) {
            Ok(()) => {
                self.written.push(path);
                Ok(())
            }
            Err(source) => Err(ReportError::File { path, source }),
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
