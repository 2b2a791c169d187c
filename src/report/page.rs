//! The Markdown pages: one per table, and `report.md` for the whole report.

use super::figure::Plot;
use super::input::Report;
use super::layout::parameters_in_words;
use super::row::{JobRow, RowState};
use super::summary::{self, Summary};
use super::tables::{self, Quantity};
use super::{accuracy, comparison, comparison_files, digits, markdown, trouble};
use crate::analysis::{JobRecord, Outcome};
use crate::publish::{Sheet, SheetLine, value};
use std::fmt::Write;

/// Largest number of jobs in a list. The others are in the export.
const MAX_LISTED: usize = 20;

/// The file of a figure and what it shows.
pub(super) struct FigureLink {
    pub plot: Plot,
    pub caption: String,
    pub file: String,
}

/// A table and the name of its files, without the ending.
pub(super) struct Table {
    pub quantity: Quantity,
    pub stem: &'static str,
    pub markdown: String,
}

/// The page of one table.
pub(super) fn of_table(table: &Table, title: &str) -> String {
    tables::titled(title, table.quantity, &table.markdown)
}

/// The page of the whole report. `sections` are those on programs and on linear stability.
pub(super) fn of_report(
    report: &Report,
    tables: &[Table],
    figures: &[FigureLink],
    data: &[String],
    differences: Option<&comparison::Comparison>,
    sections: &str,
) -> String {
    let rows = report.rows;
    let description =
        report.description.map_or_else(String::new, |text| format!("{}\n\n", markdown::escape(text)));
    let mut page = format!(
        "# {}\n\n{description}As a page for a browser, with all figures and tables in it: [report.html](report.html).\n\n{}\n",
        markdown::escape(report.title),
        summary(rows)
    );
    if !report.warnings.is_empty() {
        let lines = report.warnings.iter().map(|warning| format!("- {}\n", markdown::escape(warning)));
        let lines = lines.collect::<Vec<_>>().concat();
        page += "**Check these inputs before you use the results:**\n\n";
        page += &lines;
        page.push('\n');
    }
    for remark in report.remarks {
        let _ = writeln!(page, "Cost, without an effect on results: {}\n", markdown::escape(remark));
    }
    page += &differences.map_or_else(String::new, comparison_files::markdown);
    page += &errors(rows);
    page += &report.sheet.map_or_else(String::new, scene);
    for table in tables {
        page += &section(table, figures);
    }
    page += sections;
    page += &trouble(rows);
    page += &list("Failed jobs", rows, failed);
    page += &list("Not periodic", rows, not_periodic);
    page += &list("Missing jobs", rows, missing);
    page += "\n## Residuals\n\n![residuals of energy balance and identities](residuals.svg)\n";
    let data: Vec<String> = data.iter().map(|file| format!("[{file}]({file})")).collect();
    page + &format!(
        "\n## Data\n\nOne line per job with all figures: [jobs.csv](jobs.csv). Behind the figures: {}.\n",
        data.join(", ")
    )
}

/// The errors of the results.
fn errors(rows: &[JobRow]) -> String {
    let sentences = accuracy::in_words(rows);
    if sentences.is_empty() {
        return String::new();
    }
    let lines = sentences.iter().map(|sentence| format!("- {}\n", markdown::escape(sentence)));
    format!("\n## Accuracy\n\n{}", lines.collect::<String>())
}

/// What was simulated: the drawings, and all inputs.
fn scene(sheet: &Sheet) -> String {
    let mut text = "\n## What was simulated\n\n".to_owned();
    for drawing in &sheet.drawings {
        let _ = write!(text, "![{0}]({1}.svg)\n\n{0}\n\n", markdown::escape(&drawing.caption), drawing.stem);
    }
    let header = ["symbol", "quantity", "value", "name in files", "from"].map(str::to_owned);
    for group in &sheet.groups {
        let line = |line: &SheetLine| -> Vec<String> {
            [line.symbol, &line.name, &line.value, line.key, line.origin].map(str::to_owned).into()
        };
        let lines: Vec<Vec<String>> = group.lines.iter().map(line).collect();
        let _ = writeln!(text, "### {}\n\n{}", group.heading, markdown::table(&header, &lines, false));
    }
    text
}

fn summary(rows: &[JobRow]) -> String {
    let summary = Summary::of(rows);
    let mut text = format!(
        "{} of {} done ({}), {} failed, {} missing ({}).\n",
        summary.done(),
        value::count(summary.total, "job"),
        summary.done_in_words(),
        summary.failed,
        summary.missing(),
        summary.missing_in_words(),
    );
    if summary.done() < summary.total {
        text += "\n**This report is incomplete**: tables and figures hold only the jobs that are done.\n";
    }
    text += &worst("energy residual", rows, |record| record.energy_residual.abs());
    text + &worst("identity residual", rows, JobRecord::identity_residual)
}

fn worst(name: &str, rows: &[JobRow], residual: impl Fn(&JobRecord) -> f64) -> String {
    summary::worst(rows, residual)
        .map(|(residual, row)| {
            format!("\nLargest {name}: {residual:.1e} ({}).\n", markdown::escape(&parameters_in_words(row)))
        })
        .unwrap_or_default()
}

fn section(table: &Table, figures: &[FigureLink]) -> String {
    let Table { quantity, stem, markdown: lines } = table;
    let (heading, plots) = match *quantity {
        Quantity::MuStar => ("Macroscopic friction".into(), vec![Plot::MuStar, Plot::Bifurcation]),
        Quantity::Frequency => {
            ("Frequency".into(), vec![Plot::Frequency, Plot::FrequencyMap, Plot::Waterfall])
        }
        Quantity::Regime => (
            "Contact regime".into(),
            vec![Plot::RegimeMap, Plot::RegimePlane, Plot::GrowthRate, Plot::Shares],
        ),
        Quantity::Of(scalar) => (quantity.title(), vec![Plot::Of(scalar)]),
    };
    let mut parts = vec![format!("\n## {heading}\n\n")];
    for figure in figures.iter().filter(|figure| plots.contains(&figure.plot)) {
        if !figure.caption.is_empty() {
            parts.push(format!("{}:\n\n", markdown::escape(&figure.caption)));
        }
        parts.push(format!("![{}]({})\n\n", figure.plot.title(), figure.file));
    }
    parts.push(format!("Table: [{stem}.md]({stem}.md), [{stem}.csv]({stem}.csv)\n\n"));
    parts.push(lines.clone());
    parts.concat()
}

/// Where jobs fail or do not become periodic.
fn trouble(rows: &[JobRow]) -> String {
    let sentences = trouble::sentences(&trouble::regions(rows));
    if sentences.is_empty() {
        return String::new();
    }
    let lines = sentences.iter().map(|sentence| format!("- {}\n", markdown::escape(sentence)));
    format!("\n## Where it fails\n\n{}", lines.collect::<String>())
}

/// A list of the rows for which `entry` returns a line. Rows beyond [`MAX_LISTED`] are counted only.
fn list(heading: &str, rows: &[JobRow], entry: fn(&JobRow) -> Option<String>) -> String {
    let mut entries = rows.iter().filter_map(entry);
    let listed: Vec<String> = entries.by_ref().take(MAX_LISTED).collect();
    if listed.is_empty() {
        return String::new();
    }
    let more = entries.count();
    let rest =
        if more > 0 { format!("- and {more} more: see [jobs.csv](jobs.csv)\n") } else { String::new() };
    format!("\n## {heading} ({})\n\n{}{rest}", listed.len() + more, listed.concat())
}

fn entry(row: &JobRow, what: &str) -> String {
    format!("- {} – {what} (job {})\n", markdown::escape(&parameters_in_words(row)), markdown::code(&row.job))
}

fn failed(row: &JobRow) -> Option<String> {
    match &row.state {
        RowState::Failed { error } => Some(entry(row, &markdown::code(error))),
        _ => None,
    }
}

fn not_periodic(row: &JobRow) -> Option<String> {
    let record = row.record().filter(|record| record.outcome == Outcome::NotPeriodic)?;
    let reason = format!(
        "time limit reached after {} s without a periodic state; {}, μ\\* = {} over {} cycles",
        value::significant(record.simulated_s, 4),
        record.regime.name(),
        digits::mu_star_with_error(row, record),
        record.cycles,
    );
    Some(entry(row, &reason))
}

fn missing(row: &JobRow) -> Option<String> {
    match &row.state {
        RowState::Pending | RowState::Running | RowState::Cancelled => Some(entry(row, row.status())),
        RowState::Unreadable { reason } => {
            Some(entry(row, &format!("{}: {}", row.status(), markdown::code(reason))))
        }
        _ => None,
    }
}
