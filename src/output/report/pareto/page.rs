//! The page of a comparison.

use super::compare::{Case, Comparison};
use super::reference::{FIGURES, FREQUENCY, MU_STAR, Reference};
use super::tables::{jobs_for_readers, refinements_for_readers};
use crate::publish::markdown;
use crate::publish::page::{Block, Figure, Grid, Page, Section, Text};
use crate::publish::value;

/// The tables of all cases as Markdown.
pub fn markdown(comparison: &Comparison) -> String {
    markdown::of_page(&Page { sections: sections(comparison, &[]), ..Page::default() })
}

/// The whole page; `figures` has the file and the drawing of each case.
pub(super) fn page(comparison: &Comparison, figures: &[(String, String)], title: &str) -> Page {
    let words = "One line a job: `pareto.csv`; refinements: `refinement.csv`.";
    Page {
        title: format!("{title}: error against run time"),
        lead: vec![Block::text(words)],
        sections: sections(comparison, figures),
        ..Page::default()
    }
}

fn sections(comparison: &Comparison, figures: &[(String, String)]) -> Vec<Section> {
    let section = |(number, case): (usize, &Case)| {
        let figure = figures.get(number).map(|(file, svg)| {
            Block::figure(Figure {
                file: file.clone(),
                svg: svg.clone(),
                caption: "Error of μ* against run time.".to_owned(),
                data: Some(("pareto.csv".to_owned(), None)),
            })
        });
        let blocks = figure.into_iter().chain(body(case)).collect();
        Section::new(format!("case-{}", number + 1), case.caption.clone(), blocks)
    };
    let left_out = (!comparison.left_out.is_empty()).then(|| {
        let lines = vec![Block::list(comparison.left_out.iter().map(Text::from))];
        Section::new("left-out", "Left out: fewer than two jobs done", lines)
    });
    comparison.cases.iter().enumerate().map(section).chain(left_out).collect()
}

fn body(case: &Case) -> Vec<Block> {
    let mut blocks = Vec::new();
    if case.waiting + case.failed > 0 {
        let words = format!(
            "Incomplete: {} not done and {} failed; the reference is the finest of those that are done.",
            value::count(case.waiting, "job"),
            case.failed
        );
        blocks.push(Block::Warning(words.into(), Vec::new()));
    }
    blocks.push(Block::Text(reference_in_words(case)));
    let refinements = Grid::of_table(&refinements_for_readers(case));
    if !refinements.is_empty() {
        blocks.push(Block::text("Its refinements, which say how much of each figure is uncertain:"));
        blocks.push(Block::Table(refinements));
    }
    let (jobs, constant) = jobs_for_readers(case);
    if !constant.is_empty() {
        blocks.push(Block::Text(format!("In all jobs: {constant}.").into()));
    }
    blocks.push(Block::Table(Grid::of_table(&jobs)));
    blocks.push(Block::List(LEGEND.map(Text::marked).into()));
    blocks
}

const LEGEND: [&str; 4] = [
    "error of μ* and f: relative to the reference; of the shares: the largest absolute difference",
    "`≤` not resolved: below standard error and uncertainty of the reference, which is what the number says",
    "`~` not periodic: an average over the last part of the run",
    "front: `t` no other job is faster (solver time) and better, `n` none has fewer node-steps and is better",
];

fn reference_in_words(case: &Case) -> Text {
    let Reference { job, targets, .. } = &case.reference;
    let finest = &case.jobs[*job];
    let elements = finest.numerics.elements.map(|count| count.to_string()).join(" × ");
    let head = format!("Reference: {elements}, Δt = {:.3e} s, job ", finest.record.time_step_s);
    let in_words = FIGURES.iter().zip(targets).enumerate().filter_map(|(index, (figure, target))| {
        let digits = if index == FREQUENCY { 1 } else { 5 };
        let target = (*target)?;
        let uncertainty = target
            .uncertainty
            .map_or_else(|| "uncertainty not known".to_owned(), |u| format!("± {u:.digits$}"));
        Some(format!("{} {:.digits$} ({uncertainty})", figure.name, target.value))
    });
    let taken = in_words.collect::<Vec<_>>().join(", ");
    Text::from(head).and(Text::code(&finest.row.job)).and(format!(". Taken as true: {taken}."))
}

/// The name of the ordinate of the figure.
pub(super) fn figure_title() -> String {
    format!("relative error of {}", FIGURES[MU_STAR].name)
}
