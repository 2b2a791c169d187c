//! The report as a folder of files.

use super::comparison::Comparison;
use super::comparison_files;
use super::export;
use super::figure::{self, DataFile, Figure, Plot, RESIDUALS, RUN_TIMES};
use super::growth::Findings;
use super::html::{self, Layouts, Parts};
use super::input::Report;
use super::inspections::inspections;
use super::layout::Layout;
use super::page::{self, FigureLink, Table};
use super::program::{self, Programs};
use super::row::JobRow;
use super::spectra;
use super::stability::{self, Analysis};
use super::stale::could_be_of_a_report;
use super::tables::{self, Quantity};
use crate::publish::{FigureError, Folder, PublishError};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::path::{Path, PathBuf};

const QUANTITIES: [(Quantity, &str); 3] =
    [(Quantity::MuStar, "mu_star"), (Quantity::Frequency, "frequency"), (Quantity::Regime, "regime")];

/// Writes the page `report.html`, tables, figures with the data behind them, the export and `report.md` into `out_dir`;
/// returns the files.
///
/// Each file is replaced as a whole. The folder may exist: files of an earlier report that this one does not have are
/// removed, and files that are no report's are left alone. A hidden file in the folder lists the report's files.
///
/// # Errors
/// The first file that could not be written. Files before it are complete, and nothing is removed.
pub fn write(report: &Report, out_dir: &Path) -> Result<Vec<PathBuf>, PublishError> {
    Ok(write_compared(report, out_dir)?.files)
}

/// A report that has been written.
#[derive(Debug)]
pub struct Written {
    /// Its files.
    pub files: Vec<PathBuf>,
    /// Where only one of a source and the first source squeals: a head and lines; empty if nowhere.
    pub contradictions: Vec<String>,
}

/// As [`write`](fn@write). Also returns what a reader must know first.
///
/// # Errors
/// As [`write`](fn@write).
#[expect(clippy::too_many_lines, reason = "one file after the other")]
pub fn write_compared(report: &Report, out_dir: &Path) -> Result<Written, PublishError> {
    let mut folder = Folder::create(out_dir, "report")?;
    let (given, shown) = (report, thinned(report.rows));
    let report = &Report { rows: shown.as_deref().unwrap_or(given.rows), ..*given };
    let Report { title, rows, view, .. } = *report;

    let layout = Layout::of(rows.iter().filter(|row| !row.is_at_boundary()), view);
    let spectra = spectra::read(out_dir, rows);
    let jobs_alone = |with_boundaries: bool| {
        let jobs = rows.iter().filter(|row| !row.is_measured());
        Layout::of(jobs.filter(|row| with_boundaries || !row.is_at_boundary()), view)
    };
    let has_measured = rows.iter().any(JobRow::is_measured);
    let jobs_layout = has_measured.then(|| jobs_alone(false));
    let jobs_layout = jobs_layout.as_ref().unwrap_or(&layout);
    let whole = rows.iter().any(JobRow::is_at_boundary).then(|| jobs_alone(true));
    let layouts = Layouts { all: &layout, jobs: jobs_layout, whole: whole.as_ref().unwrap_or(jobs_layout) };
    let plots: Vec<Plot> =
        Plot::ALL.into_iter().chain(view.y.iter().map(|scalar| Plot::Of(scalar))).collect();
    let quantities =
        QUANTITIES.into_iter().chain(view.y.iter().map(|scalar| (Quantity::Of(scalar), scalar.name)));
    let quantities: Vec<(Quantity, &'static str)> = quantities.collect();

    let tables = || quantities.into_par_iter().map(|(quantity, stem)| table(&layout, quantity, stem));
    let draw = |plot: Plot| (plot, figure::figures_of(layouts.of(plot), plot, &spectra, report.stability));
    let figures = || plots.clone().into_par_iter().map(draw);
    let jobs = || {
        let mut out = Vec::new();
        export::csv(given.rows, &mut out).map(|()| out)
    };
    let residuals = || figure::residuals::draw(rows);
    let ((tables, figures), (jobs, residuals)): ((Vec<_>, Vec<_>), _) = rayon::join(
        || rayon::join(|| tables().collect(), || figures().collect()),
        || rayon::join(jobs, residuals),
    );
    for drawing in report.sheet.iter().flat_map(|sheet| &sheet.drawings) {
        folder.write_text(&format!("{}.svg", drawing.stem), &drawing.svg)?;
    }
    for table in &tables {
        folder.write_text(&format!("{}.md", table.stem), &page::of_table(table, title))?;
        folder
            .write_with(&format!("{}.csv", table.stem), |out| tables::csv_of(&layout, table.quantity, out))?;
    }

    let mut links = Vec::new();
    let mut drawn: Vec<(Plot, Vec<Figure>)> = Vec::new();
    for (plot, figures) in figures {
        let mut figures = figures.map_err(|source| cannot_draw(out_dir, plot.stem(), source))?;
        figures.extend(figure::over_others(rows, view, layouts.of(plot), plot));
        for figure in &figures {
            let file = format!("{}{}.svg", plot.stem(), figure.suffix);
            folder.write_text(&file, &figure.svg)?;
            links.push(FigureLink { plot, caption: figure.caption.clone(), file });
        }
        drawn.push((plot, figures));
    }
    let residuals = residuals.svg("residuals of the energy balance and of the identities");
    folder.write_text(&format!("{}.svg", RESIDUALS.stem), &residuals)?;

    let mut data_files = write_data(&mut folder, rows, &layout, &plots)?;
    if !spectra.is_empty() {
        folder.write_with("waterfall.csv", |out| {
            *out = figure::waterfall::csv(&layout, &spectra)?;
            Ok(())
        })?;
        data_files.push("waterfall.csv".to_owned());
    }
    let programs = write_programs(&mut folder, rows)?;
    data_files.extend(programs.iter().map(|_| program::WINDOWS.to_owned()));
    data_files.extend(write_findings(&mut folder, report)?);
    let stability_rows = stability::rows(report.stability, report.along);
    let analysis = (!report.stability.is_empty())
        .then(|| Analysis::of(report.stability, &stability_rows, report.along, view));
    let of_stability = analysis.as_ref().map(|own| stability::write_files(own, &mut folder)).transpose()?;
    let stability = analysis.as_ref().zip(of_stability.as_ref());
    data_files.extend(of_stability.iter().flat_map(|files| &files.data).map(|(file, _)| (*file).to_owned()));
    folder.write_with("jobs.csv", |out| {
        *out = jobs?;
        Ok(())
    })?;
    let layout_of_all =
        shown.as_ref().map(|_| Layout::of(given.rows.iter().filter(|row| !row.is_at_boundary()), view));
    let mut comparison = Comparison::of(layout_of_all.as_ref().unwrap_or(&layout), view);
    if let (Some(comparison), Some(shown)) = (&mut comparison, &shown) {
        let [all, part] =
            [given.rows, shown.as_slice()].map(|rows| rows.iter().filter(|row| row.is_measured()).count());
        comparison.notes.push(format!(
            "Tables and figures show {part} of the {all} measured points, evenly through the files; this summary, differences.csv and \
             jobs.csv have all."
        ));
    }
    if let Some(comparison) = &comparison {
        folder.write_with("differences.csv", |out| comparison_files::csv(comparison, out))?;
    }
    let differences = comparison.as_ref();
    let mut section = report.findings.map_or_else(String::new, Findings::markdown);
    section += &programs.as_ref().map_or_else(String::new, Programs::markdown);
    section += &stability.map_or_else(String::new, |(own, files)| stability::markdown(own, files));
    let markdown = page::of_report(report, &tables, &links, &data_files, differences, &section);
    folder.write_text("report.md", &markdown)?;
    let pages = inspections(out_dir).into_iter().filter_map(|found| Some((found.job.clone(), found.page()?)));
    let pages = pages.collect();
    let parts = Parts {
        report,
        layouts,
        figures: &drawn,
        comparison: differences,
        residuals: &residuals,
        spectra: &spectra,
        programs: programs.as_ref(),
        stability,
        pages,
    };
    folder.write_text("report.html", &html::page(&parts))?;
    let contradictions = comparison.as_ref().map_or_else(Vec::new, Comparison::contradictions_in_words);
    let files = folder.finish(|name| could_be_of_a_report(name, out_dir))?;
    Ok(Written { files, contradictions })
}

/// Most measured points in tables and figures: more would make pages that no browser shows.
const MOST_MEASURED: usize = 2000;

/// The rows without most of the measured points, of which every k-th stays; none if there are few of them.
fn thinned(rows: &[JobRow]) -> Option<Vec<JobRow>> {
    let measured = rows.iter().filter(|row| row.is_measured()).count();
    let every = measured.div_ceil(MOST_MEASURED);
    if every <= 1 {
        return None;
    }
    let mut number = 0;
    let is_shown = |row: &&JobRow| {
        number += usize::from(row.is_measured());
        !row.is_measured() || number % every == 1
    };
    Some(rows.iter().filter(is_shown).cloned().collect())
}

/// Writes the data behind the figures, and returns the files.
fn write_data(
    folder: &mut Folder,
    rows: &[JobRow],
    layout: &Layout,
    plots: &[Plot],
) -> Result<Vec<String>, PublishError> {
    let mut data_files = Vec::new();
    let behind_figures = plots.iter().map(|plot| plot.data());
    for DataFile { stem, columns } in behind_figures.chain([RESIDUALS, RUN_TIMES]) {
        let file = format!("{stem}.csv");
        // Two figures may share a file of data.
        if data_files.contains(&file) {
            continue;
        }
        folder.write_with(&file, |out| {
            *out = export::selection(rows, &layout.further, &columns)?;
            Ok(())
        })?;
        data_files.push(file);
    }
    Ok(data_files)
}

/// Writes the tables of what a study that grows has found, and returns the files.
fn write_findings(folder: &mut Folder, report: &Report) -> Result<Vec<String>, PublishError> {
    let mut files = Vec::new();
    for table in report.findings.iter().flat_map(|own| own.tables()) {
        let file = format!("{}.csv", table.stem);
        folder.write_with(&file, |out| {
            *out = table.csv()?;
            Ok(())
        })?;
        files.push(file);
    }
    Ok(files)
}

/// Writes the figures and the windows of the jobs whose speed or load changes in time; none if there are no such jobs.
fn write_programs<'a>(folder: &mut Folder, rows: &'a [JobRow]) -> Result<Option<Programs<'a>>, PublishError> {
    let programs = Programs::of(rows);
    for figure in programs.iter().flat_map(Programs::figures) {
        folder.write_text(&figure.file, &figure.svg())?;
    }
    if let Some(programs) = &programs {
        folder.write_with(program::WINDOWS, |out| {
            out.extend_from_slice(programs.csv());
            Ok(())
        })?;
    }
    Ok(programs)
}

fn cannot_draw(out_dir: &Path, stem: &str, source: FigureError) -> PublishError {
    PublishError::Figure { path: out_dir.join(format!("{stem}.svg")), source }
}

fn table(layout: &Layout, quantity: Quantity, stem: &'static str) -> Table {
    Table { quantity, stem, markdown: tables::markdown_of(layout, quantity) }
}
