//! The page of a report as data: what was found first, then how it was found, then where it comes from.
//!
//! The page contains all drawings, tables and the data behind them. If a study is too large for that, the page shows a part
//! of it, says what is left out, and names the files that have it.

mod figures;
mod findings;
mod head;
mod parts;
mod stability;
mod tables;
mod times;
mod trouble;

pub(super) use figures::has_room_for;
pub(super) use parts::{Layouts, Parts};
pub(super) use tables::blocks as tables_of;

use super::input::Report;
use super::provenance::{Provenance, ResultGroup};
use super::stability::{Analysis, Files};
use crate::publish::page::{Block, Grid, Page, Section, Span, Text};
use crate::publish::value;

/// The page of a report.
pub(super) fn of_report(parts: &Parts) -> Page {
    let report = parts.report;
    let mut sections = vec![figures::friction(parts)];
    sections.extend(parts.comparison.map(findings::comparison));
    sections.extend(parts.programs.map(findings::programs));
    sections.extend(report.findings.map(findings::growth));
    sections.extend([figures::frequency(parts), figures::regimes(parts)]);
    sections.extend(parts.stability.map(|(analysis, files)| stability::section(analysis, files)));
    sections.extend(report.view.y.iter().map(|scalar| figures::quantity(parts, scalar)));
    sections.extend([figures::bifurcation(parts), figures::shares(parts)]);
    sections.extend(trouble::section(report.rows));
    sections.extend([figures::residuals(parts), times::section(parts)]);
    sections.extend(setup(report, "What was simulated"));
    sections.extend(report.provenance.map(provenance));
    sections.push(files(&parts.files));
    sections.retain(|section| !section.blocks.is_empty());
    Page {
        title: report.title.to_owned(),
        lead: head::lead(parts),
        sections,
        foot: vec![foot(report)],
        refresh_s: report.refresh_s,
    }
}

/// The page of the stability alone. If it has shapes of modes, they are in a folder beside the page.
pub(super) fn of_stability(report: &Report, analysis: &Analysis, files: &Files, has_shapes: bool) -> Page {
    let mut foot = Text::marked(&format!(
        "Written {} by tribosweep. The folder of this page has the figures as SVG, all modes in `modes.csv` and the thresholds, \
         if there are any, in `thresholds.csv`.",
        value::utc_minute(report.written_ms)
    ));
    if has_shapes {
        foot = foot.and(" The shapes of modes, for ParaView, are in the folder ");
        foot = foot.and(Span::Link("modes".to_owned(), "modes/".to_owned())).and(".");
    }
    let mut sections = vec![stability::section(analysis, files)];
    sections.extend(setup(report, "What was analysed"));
    sections.extend(report.provenance.map(provenance));
    let mut lead: Vec<Block> = report.description.map(|text| Block::Text(text.into())).into_iter().collect();
    lead.extend(stability::found(analysis).map(|words| Block::Text(Text::strong(words))));
    lead.extend(head::doubts(report));
    Page {
        title: report.title.to_owned(),
        lead,
        sections,
        foot: vec![Block::Note(foot)],
        refresh_s: report.refresh_s,
    }
}

/// What was simulated: drawings, and all inputs below a fold.
fn setup(report: &Report, heading: &str) -> Option<Section> {
    let note = Block::note(
        "\"From\" says who gave the value: the study, its grid, its preset, or nobody (default). The names in files are those of \
         grids, of `--set` and of the export.",
    );
    let blocks = report.sheet?.blocks().into_iter().chain([note]).collect();
    Some(Section::new("scene", heading, vec![Block::Fold("Drawings and all inputs".to_owned(), blocks)]))
}

/// Number of characters of a commit that are shown.
const COMMIT_LENGTH: usize = 12;

/// Where the results come from: program, machine, dates, and the study as it was submitted.
fn provenance(own: &Provenance) -> Section {
    let heads = ["results", "program", "machine", "processor", "vectors", "threads", "finished"];
    let mut blocks: Vec<Block> =
        own.warnings().into_iter().map(|words| Block::Warning(words.into(), Vec::new())).collect();
    blocks.push(Block::Text(format!("Submitted {}.", value::utc_minute(own.submitted_ms)).into()));
    blocks.push(if own.groups.is_empty() {
        Block::text("There are no results yet.")
    } else {
        Block::Table(Grid::of(&heads, own.groups.iter().map(build), "jobs.csv").with_words())
    });
    let document = vec![Block::Code(own.document.clone())];
    blocks.push(Block::Fold("The study as it was submitted".to_owned(), document));
    Section::new("provenance", "Provenance", blocks)
}

fn build(group: &ResultGroup) -> Vec<Text> {
    let mut line: Vec<Text> = vec![group.jobs.to_string().into()];
    if let Some(build) = &group.build {
        let (commit, modified) = build.commit.split_at(build.commit.find('+').unwrap_or(build.commit.len()));
        let short: String = commit.chars().take(COMMIT_LENGTH).collect();
        let cpu = build.cpu.as_deref().unwrap_or(value::MISSING);
        line.extend([
            Text::from(&build.version).and(Span::Break).and(Text::code(short + modified)),
            (&build.host).into(),
            format!("{cpu} ({})", build.platform()).into(),
            (&build.vectors).into(),
            build.threads.to_string().into(),
        ]);
    } else {
        line.push("unknown".into());
        line.extend((0..4).map(|_| value::MISSING.into()));
    }
    let [first, last] = [group.first_ms, group.last_ms].map(value::utc_minute);
    line.push(Text::from(first).and(Span::Break).and(format!("to {last}")));
    line
}

/// The files beside the page.
fn files(names: &[String]) -> Section {
    let link = |name: &String| Text::from(Span::Link(name.clone(), name.clone()));
    let list = vec![Block::List(names.iter().map(link).collect())];
    let words = "All results are in `jobs.csv`, one line per job. The figures are there as SVG, and the tables and the data \
                 behind the figures as CSV.";
    let fold = Block::Fold(value::count(names.len(), "file"), list);
    Section::new("files", "Files", vec![Block::text(words), fold])
}

/// When the page was written.
fn foot(report: &Report) -> Block {
    let reload = report.refresh_s.map_or_else(String::new, |seconds| {
        format!(" The study is not finished: this page reloads every {seconds} s.")
    });
    Block::Note(format!("Written {} by tribosweep.{reload}", value::utc_minute(report.written_ms)).into())
}
