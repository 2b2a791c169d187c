//! The report as a folder of files.

use super::calibration::Calibration;
use super::comparison::Comparison;
use super::comparison_files;
use super::explore;
use super::export;
use super::figure::{self, DataFile, Figure, Plot, RESIDUALS, RUN_TIMES};
use super::input::Report;
use super::inspections::inspections;
use super::layout::Layout;
use super::page::{self, Layouts, Parts};
use super::program::{self, Programs};
use super::row::JobRow;
use super::spectra;
use super::stability::{self, Analysis};
use super::tables::{self, Quantity};
use crate::publish::table::Format;
use crate::publish::{Folder, PublishError, html, markdown};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

const QUANTITIES: [Quantity; 3] = [Quantity::MuStar, Quantity::Frequency, Quantity::Regime];

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
    /// How far the first source is from each of the others, in sentences.
    pub verdicts: Vec<String>,
    /// Where only one of a source and the first source squeals: a head and lines; empty if nowhere.
    pub contradictions: Vec<String>,
    /// What is not compared, one sentence each: points without a counterpart, and measured points with other studies than the first.
    pub unmatched: Vec<String>,
}

/// As [`write`](fn@write). Also returns what a reader must know first.
///
/// # Errors
/// As [`write`](fn@write).
pub fn write_compared(report: &Report, out_dir: &Path) -> Result<Written, PublishError> {
    let mut folder = Folder::create(out_dir, "report")?;
    let (given, shown) = (report, shown(report));
    let report = &Report { rows: shown.as_deref().unwrap_or(given.rows), ..*given };
    let Report { rows, view, .. } = *report;

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
    let pages = inspections(out_dir).into_iter().filter_map(|found| Some((found.job.clone(), found.page()?)));
    let pages: HashMap<String, String> = pages.collect();
    let plots: Vec<Plot> = Plot::ALL
        .into_iter()
        .filter(|plot| view.span || *plot != Plot::Span)
        .chain(view.y.iter().map(|scalar| Plot::Of(scalar)))
        .collect();
    let quantities = QUANTITIES.into_iter().chain(view.y.iter().map(|scalar| Quantity::Of(scalar)));

    // With many jobs the texts of files are large, so that only some of them are in memory at a time.
    let explored = || {
        let mut out = Vec::new();
        explore::write(given, &pages, &mut out).map(|()| out)
    };
    let jobs = || {
        let mut out = Vec::new();
        export::write(given.rows, Format::Csv, &mut out).map(|()| out)
    };
    let residuals = || {
        let mut chart = figure::residuals::draw(rows);
        chart.link(&pages);
        chart.svg("residuals of the energy balance and of the identities")
    };
    let (explored, (jobs, residuals)) = rayon::join(explored, || rayon::join(jobs, residuals));
    for (file, contents) in [(explore::PAGE, explored), ("jobs.csv", jobs)] {
        folder.write_with(file, |out| {
            *out = contents?;
            Ok(())
        })?;
    }
    folder.write_text(&format!("{}.svg", RESIDUALS.stem), &residuals)?;
    for drawing in report.sheet.iter().flat_map(|sheet| &sheet.drawings) {
        folder.write_text(&format!("{}.svg", drawing.stem), &drawing.svg)?;
    }
    for quantity in quantities {
        folder.write_table(&tables::table_of(&layout, quantity))?;
    }
    let figures = write_figures(&mut folder, report, &layouts, &plots, (&spectra, &pages))?;
    write_data(&mut folder, rows, &layout, &plots)?;
    if !spectra.is_empty() {
        folder.write_table(&spectra::table(&layout, &spectra))?;
    }
    let programs = write_programs(&mut folder, rows)?;
    write_findings(&mut folder, report)?;
    let stability_rows = stability::rows(report.stability, report.along);
    let analysis = (!report.stability.is_empty())
        .then(|| Analysis::of(report.stability, &stability_rows, report.along, view));
    let of_stability = analysis.as_ref().map(|own| stability::write_files(own, &mut folder)).transpose()?;
    let stability = analysis.as_ref().zip(of_stability.as_ref());
    let comparison = compared(report, given.rows, shown.as_deref(), &layout);
    if let Some(comparison) = &comparison {
        folder.write_table(&comparison_files::table(comparison))?;
        if let Some(chart) = figure::differences::draw(comparison) {
            folder.write_text(figure::differences::FILE, &chart.svg(figure::differences::TITLE))?;
        }
    }
    let differences = comparison.as_ref();
    let parts = Parts {
        report,
        layouts,
        figures: &figures,
        comparison: differences,
        residuals: &residuals,
        programs: programs.as_ref(),
        stability,
        files: folder.written().iter().cloned().chain(["report.html".to_owned()]).collect(),
        pages,
    };
    let page = page::of_report(&parts);
    folder.write_text("report.html", &html::of_page(&page))?;
    folder.write_text("report.md", &markdown::of_page(&page))?;
    let verdicts = comparison.as_ref().map_or_else(Vec::new, Comparison::verdicts);
    let contradictions = comparison.as_ref().map_or_else(Vec::new, Comparison::contradictions_in_words);
    let unmatched = comparison.map_or_else(Vec::new, |comparison| comparison.unmatched);
    let files = folder.finish()?;
    Ok(Written { files, verdicts, contradictions, unmatched })
}

/// The differences of all `rows`, of which the report may have `shown` some only, in `layout`; none if there is only one source.
fn compared(
    report: &Report,
    rows: &[JobRow],
    shown: Option<&[JobRow]>,
    layout: &Layout,
) -> Option<Comparison> {
    let of_all = shown.map(|_| Layout::of(rows.iter().filter(|row| !row.is_at_boundary()), report.view));
    let mut comparison = Comparison::of(of_all.as_ref().unwrap_or(layout), report.view)?;
    if let Some(shown) = shown {
        let [all, part] = [rows, shown].map(|rows| rows.iter().filter(|row| row.is_measured()).count());
        let note = format!(
            "Tables and figures show {part} of the {all} measured points, evenly through the files; this summary, differences.csv and \
             jobs.csv have all."
        );
        comparison.notes.extend((part < all).then_some(note));
    }
    comparison.explain_by(report.sensitivity);
    Some(comparison)
}

/// Writes the figures of the plots, and returns those that have room in the page with their drawings.
fn write_figures(
    folder: &mut Folder,
    report: &Report,
    layouts: &Layouts,
    plots: &[Plot],
    (spectra, pages): (&spectra::Spectra, &HashMap<String, String>),
) -> Result<Vec<(Plot, Vec<Figure>)>, PublishError> {
    let draw = |plot: &Plot| {
        let layout = layouts.of(*plot);
        let mut figures = figure::figures_of(layout, *plot, spectra, report.stability);
        figures.extend(figure::over_others(report.rows, report.view, layout, *plot));
        let figures: Vec<_> = figures.into_iter().map(|figure| figure.finished(pages)).collect();
        (*plot, figures)
    };
    let mut all = Vec::new();
    for some in plots.chunks(rayon::current_num_threads()) {
        let mut drawn: Vec<_> = some.into_par_iter().map(draw).collect();
        for (plot, figures) in &mut drawn {
            for figure in figures {
                folder.write_text(&format!("{}{}.svg", plot.stem(), figure.suffix), &figure.svg)?;
                if !page::has_room_for(layouts.of(*plot), figure) {
                    figure.svg = String::new();
                }
            }
        }
        all.extend(drawn);
    }
    Ok(all)
}

/// Most measured points in tables and figures: more would make pages that no browser shows.
const MOST_MEASURED: usize = 2000;

/// The rows that tables and figures show; none if they show all.
fn shown(report: &Report) -> Option<Vec<JobRow>> {
    let calibration = report.findings.and_then(|own| own.calibration.as_ref());
    calibration.and_then(|own| own.rows_of_best(report.rows)).or_else(|| thinned(report.rows))
}

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

/// Writes the data behind the figures.
fn write_data(
    folder: &mut Folder,
    rows: &[JobRow],
    layout: &Layout,
    plots: &[Plot],
) -> Result<(), PublishError> {
    let mut written = Vec::new();
    let behind_figures = plots.iter().map(|plot| plot.data());
    for DataFile { stem, columns } in behind_figures.chain([RESIDUALS, RUN_TIMES]) {
        let file = format!("{stem}.csv");
        // Two figures may share a file of data.
        if written.contains(&file) {
            continue;
        }
        folder.write_table(&export::selection(stem, rows, &layout.varied, &columns))?;
        written.push(file);
    }
    Ok(())
}

/// Writes the tables of what a study that grows has found.
fn write_findings(folder: &mut Folder, report: &Report) -> Result<(), PublishError> {
    let mut tables = report.findings.iter().flat_map(|own| own.tables());
    tables.try_for_each(|found| folder.write_table(&found.table).map(drop))?;
    match report.findings.and_then(|own| own.calibration.as_ref()).and_then(Calibration::chart) {
        Some(chart) => folder.write_text(figure::pairs::FILE, &chart.svg(figure::pairs::TITLE)),
        None => Ok(()),
    }
}

/// Writes the figures and the windows of the jobs whose speed or load changes in time; none if there are no such jobs.
fn write_programs<'a>(folder: &mut Folder, rows: &'a [JobRow]) -> Result<Option<Programs<'a>>, PublishError> {
    let programs = Programs::of(rows);
    for figure in programs.iter().flat_map(Programs::figures) {
        folder.write_text(&figure.file, &figure.svg())?;
    }
    if let Some(programs) = &programs {
        folder.write_with(program::WINDOWS, |out| {
            out.extend_from_slice(programs.csv().as_bytes());
            Ok(())
        })?;
    }
    Ok(programs)
}
