//! The report as a folder of files.

use super::export;
use super::figure::{self, DataFile, Figure, Plot, RESIDUALS, RUN_TIMES};
use super::html::{self, Parts};
use super::input::Report;
use super::layout::Layout;
use super::page::{self, FigureLink, Table};
use super::tables::{self, Quantity};
use crate::publish::{FigureError, Folder, PublishError};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::path::{Path, PathBuf};

const QUANTITIES: [(Quantity, &str); 3] =
    [(Quantity::MuStar, "mu_star"), (Quantity::Frequency, "frequency"), (Quantity::Regime, "regime")];

/// Writes the page `report.html`, tables, figures with the data behind them, the export and `report.md` into `out_dir`;
/// returns the files.
///
/// Each file is replaced as a whole. The folder may exist: files of the same name are replaced, and others are left
/// alone.
///
/// # Errors
/// The first file that could not be written. Files before it are complete.
pub fn write(report: &Report, out_dir: &Path) -> Result<Vec<PathBuf>, PublishError> {
    let mut folder = Folder::create(out_dir)?;
    let Report { title, rows, .. } = *report;

    let layout = Layout::new(rows);
    let tables = || QUANTITIES.into_par_iter().map(|(quantity, stem)| table(&layout, quantity, stem));
    let figures = || Plot::ALL.into_par_iter().map(|plot| (plot, figure::figures_of(&layout, plot)));
    let jobs = || {
        let mut out = Vec::new();
        export::csv(rows, &mut out).map(|()| out)
    };
    let residuals = || figure::residuals::draw(rows);
    let ((tables, figures), (jobs, residuals)): ((Vec<_>, Vec<_>), _) = rayon::join(
        || rayon::join(|| tables().collect(), || figures().collect()),
        || rayon::join(jobs, residuals),
    );
    for table in &tables {
        folder.write_text(&format!("{}.md", table.stem), &page::of_table(table, title))?;
        folder
            .write_with(&format!("{}.csv", table.stem), |out| tables::csv_of(&layout, table.quantity, out))?;
    }

    let mut links = Vec::new();
    let mut drawn: Vec<(Plot, Vec<Figure>)> = Vec::new();
    for (plot, figures) in figures {
        let figures = figures.map_err(|source| cannot_draw(out_dir, plot.stem(), source))?;
        for figure in &figures {
            let file = format!("{}{}.svg", plot.stem(), figure.suffix);
            folder.write_text(&file, &figure.svg)?;
            links.push(FigureLink { plot, caption: figure.caption.clone(), file });
        }
        drawn.push((plot, figures));
    }
    let residuals = residuals.map_err(|source| cannot_draw(out_dir, RESIDUALS.stem, source))?;
    folder.write_text(&format!("{}.svg", RESIDUALS.stem), &residuals)?;

    let mut data_files = Vec::new();
    for DataFile { stem, columns } in Plot::ALL.map(Plot::data).into_iter().chain([RESIDUALS, RUN_TIMES]) {
        let file = format!("{stem}.csv");
        // Two figures may share a file of data.
        if data_files.contains(&file) {
            continue;
        }
        folder.write_with(&file, |out| {
            *out = export::selection(rows, &layout.further, columns)?;
            Ok(())
        })?;
        data_files.push(file);
    }
    folder.write_with("jobs.csv", |out| {
        *out = jobs?;
        Ok(())
    })?;
    folder.write_text("report.md", &page::of_report(rows, &tables, &links, &data_files, title))?;
    let parts = Parts { report, layout: &layout, figures: &drawn, residuals: &residuals };
    folder.write_text("report.html", &html::page(&parts))?;
    Ok(folder.written)
}

fn cannot_draw(out_dir: &Path, stem: &str, source: FigureError) -> PublishError {
    PublishError::Figure { path: out_dir.join(format!("{stem}.svg")), source }
}

fn table(layout: &Layout, quantity: Quantity, stem: &'static str) -> Table {
    Table { quantity, stem, markdown: tables::markdown_of(layout, quantity) }
}
