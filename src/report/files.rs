//! The report as a folder of files.

use super::error::ReportError;
use super::figure::{self, Plot};
use super::folder::Folder;
use super::page::{self, FigureLink};
use super::tables::{self, Quantity};
use super::{export, row::Row};
use std::path::{Path, PathBuf};

/// Writes tables, figures, the export and the page `report.md` into `out_dir`; returns the files.
///
/// Every file appears whole: it is written beside its place and then renamed. A folder that exists
/// is fine; files of the same name are replaced, others are left alone.
///
/// # Errors
/// The first file that could not be written. Files before it are complete.
pub fn write(rows: &[Row], out_dir: &Path, title: &str) -> Result<Vec<PathBuf>, ReportError> {
    let mut folder = Folder::create(out_dir)?;

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
