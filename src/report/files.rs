//! The report as a folder of files.

use super::figure::{self, Plot};
use super::layout::Layout;
use super::page::{self, FigureLink, Table};
use super::tables::{self, Quantity};
use super::{export, row::Row};
use crate::publish::Folder;
use crate::publish::PublishError;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::path::{Path, PathBuf};

const QUANTITIES: [(Quantity, &str); 3] =
    [(Quantity::MuStar, "mu_star"), (Quantity::Frequency, "frequency"), (Quantity::Regime, "regime")];

const PLOTS: [(Plot, &str); 2] = [(Plot::MuStar, "figure7"), (Plot::Frequency, "frequency")];

/// Writes tables, figures, the export and the page `report.md` into `out_dir`; returns the files.
///
/// Every file appears whole: it is written beside its place and then renamed. A folder that exists
/// is fine; files of the same name are replaced, others are left alone.
///
/// # Errors
/// The first file that could not be written. Files before it are complete.
pub fn write(rows: &[Row], out_dir: &Path, title: &str) -> Result<Vec<PathBuf>, PublishError> {
    let mut folder = Folder::create(out_dir)?;

    let layout = Layout::new(rows);
    let tables = || QUANTITIES.into_par_iter().map(|(quantity, stem)| table(&layout, quantity, stem));
    let figures = || PLOTS.into_par_iter().map(|(plot, _)| figure::figures_of(&layout, plot));
    let jobs = || {
        let mut out = Vec::new();
        export::csv(rows, &mut out).map(|()| out)
    };
    let ((tables, figures), jobs): ((Vec<_>, Vec<_>), _) =
        rayon::join(|| rayon::join(|| tables().collect(), || figures().collect()), jobs);
    for table in &tables {
        folder.text(&format!("{}.md", table.stem), &page::of_table(table, title))?;
        folder.with(&format!("{}.csv", table.stem), |out| tables::csv_of(&layout, table.quantity, out))?;
    }

    let mut links = Vec::new();
    for ((plot, stem), figures) in PLOTS.into_iter().zip(figures) {
        let path = || out_dir.join(format!("{stem}.svg"));
        for figure in figures.map_err(|source| PublishError::Figure { path: path(), source })? {
            let file = format!("{stem}{}.svg", figure.suffix);
            folder.text(&file, &figure.svg)?;
            links.push(FigureLink { plot, caption: figure.caption, file });
        }
    }

    folder.with("jobs.csv", |out| {
        *out = jobs?;
        Ok(())
    })?;
    folder.text("report.md", &page::of_report(rows, &tables, &links, title))?;
    Ok(folder.written)
}

fn table(layout: &Layout, quantity: Quantity, stem: &'static str) -> Table {
    Table { quantity, stem, markdown: tables::markdown_of(layout, quantity) }
}
