//! The files of the stability: a part of a study's report, or a report of its own.

use super::analysis::{Analysis, rows};
use super::table::{ShownModes, modes_table, onsets_table};
use crate::publish::html;
use crate::publish::{Folder, PublishError};
use crate::report::figure::Figure;
use crate::report::figure::stability::{StabilityPlot, figures};
use crate::report::input::Report;
use crate::report::page;
use std::path::{Path, PathBuf};

/// The name of the page.
pub const PAGE: &str = "stability.html";
/// The folder beside the page in which shapes of modes may be.
pub const SHAPES: &str = "modes";

/// What was written.
pub(in crate::report) struct Files {
    pub figures: Vec<(StabilityPlot, Vec<Figure>)>,
    /// File names of data with their contents.
    pub data: Vec<(String, String)>,
}

/// Writes figures and data of the stability.
pub(in crate::report) fn write_files(
    analysis: &Analysis,
    folder: &mut Folder,
) -> Result<Files, PublishError> {
    let mut drawn = Vec::new();
    // Where ω moves with μ there is one series, and no axis besides that of the thresholds.
    let has_axes = !analysis.along.moves(analysis.along.across());
    for plot in StabilityPlot::ALL.into_iter().filter(|plot| has_axes || *plot == StabilityPlot::LockIn) {
        let own = figures(analysis, plot);
        for figure in &own {
            folder.write_text(&format!("{}{}.svg", plot.stem(), figure.suffix), &figure.svg)?;
        }
        drawn.push((plot, own));
    }
    let mut data = Vec::new();
    let thresholds = analysis.has_series().then(|| onsets_table(analysis));
    for table in [modes_table(analysis.points(), ShownModes::ALL)].into_iter().chain(thresholds) {
        data.push((folder.write_table(&table)?, table.csv()));
    }
    Ok(Files { figures: drawn, data })
}

/// Writes the stability of `report.stability` alone into a folder: the page `stability.html`, figures, `modes.csv` and
/// `thresholds.csv`; returns the files. The report needs no rows.
///
/// Each file is replaced as a whole. Files of an earlier result that this one does not have are removed, and other files are
/// left alone.
///
/// # Errors
/// The first file that could not be written. Files before it are complete, and nothing is removed.
pub fn write_stability(report: &Report, out_dir: &Path) -> Result<Vec<PathBuf>, PublishError> {
    let mut folder = Folder::create(out_dir, "stability")?;
    let rows = rows(report.stability, report.along);
    let analysis = Analysis::of(report.stability, &rows, report.along, report.view);
    let files = if report.stability.is_empty() {
        Files { figures: Vec::new(), data: Vec::new() }
    } else {
        write_files(&analysis, &mut folder)?
    };
    let has_shapes = out_dir.join(SHAPES).is_dir();
    folder.write_text(PAGE, &html::of_page(&page::of_stability(report, &analysis, &files, has_shapes)))?;
    folder.finish()
}
