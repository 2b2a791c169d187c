//! Sections on what several sources, runs in time and studies that grow have found.

use crate::publish::page::{Block, Figure, Grid, MOST_DATA, Section, Text};
use crate::publish::value;
use crate::report::calibration::Calibration;
use crate::report::comparison::Comparison;
use crate::report::figure::{differences, pairs};
use crate::report::growth::Findings;
use crate::report::program::{self, Programs};

/// The differences between several sources.
pub(super) fn comparison(own: &Comparison) -> Section {
    let verdicts = own.verdicts();
    let mut blocks = Vec::new();
    if !verdicts.is_empty() {
        blocks.push(Block::list(verdicts.iter().map(|verdict| Text::strong(verdict.as_str()))));
    }
    if let [head, lines @ ..] = &own.contradictions_in_words()[..] {
        blocks.push(Block::Warning(Text::strong(head.as_str()), lines.iter().map(Text::from).collect()));
    }
    if !own.notes.is_empty() {
        blocks.push(Block::list(own.notes.iter().map(Text::from)));
    }
    let (heads, lines) = own.summary();
    if lines.is_empty() {
        let words = format!("No point of another source can be compared with {}.", own.reference);
        blocks.push(Block::Text(words.into()));
    } else {
        blocks.push(Block::Table(grid(&heads, lines)));
        if let Some(chart) = differences::draw(own) {
            blocks.push(Block::figure(Figure {
                file: differences::FILE.to_owned(),
                svg: chart.svg(differences::TITLE),
                caption: DIFFERENCES.to_owned(),
                data: None,
            }));
        }
        let (heads, lines) = own.table();
        let all = vec![Block::Table(grid(&heads, lines))];
        blocks.push(Block::Fold("Table: all differences".to_owned(), all));
        blocks.push(Block::Note(own.explanation().into()));
    }
    Section::new("comparison", "Comparison", blocks)
}

const DIFFERENCES: &str = "How far the simulation is from the measured values, as a share of them; of two studies, how far the other one is from the first. \
                           Error bars: the known errors of both together.";

fn grid(heads: &[String], lines: impl IntoIterator<Item = Vec<String>>) -> Grid {
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    Grid::of(&heads, lines, "differences.csv")
}

const CAPTION: &str = "Above: μ* of the windows against the speed (or the load), on the way up and on the way down. Below: μ* and \
                       the rate of the cycles of N against time. A window whose N hardly varies has no frequency.";

/// Runs whose speed or load changes in time.
pub(super) fn programs(own: &Programs) -> Section {
    let grid = Grid::of(&program::HEADS, own.lines(), program::WINDOWS);
    let mut blocks = vec![Block::text(program::MEANING), Block::Table(grid)];
    let data = own.csv();
    for (number, figure) in own.figures().iter().enumerate() {
        let contents = (number == 0 && data.len() <= MOST_DATA).then(|| data.to_owned());
        blocks.push(Block::Heading(figure.caption.clone()));
        blocks.push(Block::figure(Figure {
            file: figure.file.clone(),
            svg: figure.svg(),
            caption: CAPTION.to_owned(),
            data: (number == 0).then(|| (program::WINDOWS.to_owned(), contents)),
        }));
    }
    if own.jobs() > own.figures().len() {
        blocks.push(Block::note(&format!(
            "The first {} of {} have a figure; `{}` has all of them.",
            own.figures().len(),
            value::count(own.jobs(), "job"),
            program::WINDOWS
        )));
    }
    Section::new("program", "Speed and load in time", blocks)
}

const REGION: &str = "Pairs of the free parameters. Dots fill the region that the measured values do not rule out, circles are the points that \
                      were run, and the star is the run that fits best.";

/// What a study that grows has found.
pub(super) fn growth(own: &Findings) -> Section {
    let mut blocks = vec![Block::Text(own.state.as_str().into())];
    for found in own.tables() {
        blocks.push(Block::Heading(found.heading.to_owned()));
        blocks.push(Block::text(found.meaning));
        blocks.push(Block::Table(Grid::of_table(&found.table)));
    }
    if own.calibration.is_some() {
        blocks.push(Block::note(
            "The other tables and figures of this page show the run that fits best. `jobs.csv` and the page to explore have all jobs.",
        ));
    }
    if let Some(chart) = own.calibration.as_ref().and_then(Calibration::chart) {
        blocks.push(Block::figure(Figure {
            file: pairs::FILE.to_owned(),
            svg: chart.svg(pairs::TITLE),
            caption: REGION.to_owned(),
            data: None,
        }));
    }
    Section::new("findings", "What was found", blocks)
}
