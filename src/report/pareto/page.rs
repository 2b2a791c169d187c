//! The page of a comparison.

use super::case::Case;
use super::compare::Comparison;
use super::done::DoneJob;
use super::early::EarlyStop;
use super::reference::{Chain, Direction, FIGURE_NAMES, FIGURES, FREQUENCY, MU_STAR, Reference};
use super::refinement::{Limit, Unclean};
use super::score::{Score, exceeds};
use super::settings::{self, SETTINGS};
use crate::publish::markdown;
use crate::publish::page::{Block, Figure, Grid, Page, Section, Text};
use crate::publish::value::{self, MISSING};

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
    blocks.extend(reference_in_words(case));
    blocks.extend(jobs_table(case));
    blocks.push(Block::List(LEGEND.map(Text::marked).into()));
    blocks.extend(early_table(case));
    blocks
}

const LEGEND: [&str; 4] = [
    "error of μ* and f: relative to the reference; of the shares: the largest absolute difference",
    "`≤` not resolved: below standard error and uncertainty of the reference, which is what the number says",
    "`~` not periodic: an average over the last part of the run",
    "front: `t` no other job is faster (solver time) and better, `n` none has fewer node-steps and is better",
];

fn reference_in_words(case: &Case) -> [Block; 2] {
    let Reference { job, chains, targets } = &case.reference;
    let finest = &case.jobs[*job];
    let texts = settings::texts(finest.numerics);
    let head = format!("Reference: {}, Δt = {:.3e} s, job ", texts[0], finest.record.time_step_s);
    let head = Text::from(head).and(Text::code(&finest.row.job)).and(".");
    let in_words: Vec<String> = (0..FIGURES)
        .filter_map(|figure| {
            let target = targets[figure]?;
            let digits = if figure == FREQUENCY { 1 } else { 5 };
            let uncertainty = target
                .uncertainty
                .map_or_else(|| "uncertainty not known".to_owned(), |u| format!("± {u:.digits$}"));
            Some(format!("{} {:.digits$} ({uncertainty})", FIGURE_NAMES[figure], target.value))
        })
        .collect();
    let taken = format!("Taken as true: {}.", in_words.join(", "));
    [Block::Text(head), Block::list(chains.iter().map(chain_in_words).chain([taken]))]
}

fn chain_in_words(chain: &Chain) -> String {
    let (what, unit, scale) = match chain.direction {
        Direction::Mesh => ("mesh, step given", "mm", 1.0e3),
        Direction::MeshAndStep => ("mesh, step in proportion", "mm", 1.0e3),
        Direction::Step => ("step", "µs", 1.0e6),
    };
    let sizes: Vec<String> = chain.sizes.iter().map(|size| format!("{:.3}", size * scale)).collect();
    let limits: Vec<String> = (0..FIGURES)
        .filter_map(|figure| {
            let limit = chain.limits[figure].as_ref()?;
            Some(format!("{} {}", FIGURE_NAMES[figure], limit_in_words(limit)))
        })
        .collect();
    format!("Refinement of the {what} ({} {unit}): {}.", sizes.join(", "), limits.join("; "))
}

fn limit_in_words(limit: &Limit) -> String {
    let by = format!("uncertain by {:.2e}", limit.uncertainty);
    match limit.order {
        Ok(order) => format!("order {order:.2}, corrected by {:.2e}", limit.uncertainty),
        Err(Unclean::TooFewLevels) => format!("two levels, {by}"),
        Err(Unclean::WithinNoise) => format!("converged within its standard error, {by}"),
        Err(Unclean::NotMonotone) => format!("not monotone, {by}"),
        Err(Unclean::OrderOutOfRange(Some(order))) => format!("order {order:.2} is not clean, {by}"),
        Err(Unclean::OrderOutOfRange(None)) => format!("no order, {by}"),
        Err(Unclean::OrderNotStable(a, b)) => format!("orders {a:.2} and {b:.2} differ, {by}"),
    }
}

/// Indices of the settings that vary within the case.
fn varying(case: &Case) -> Vec<usize> {
    let texts: Vec<_> = case.jobs.iter().map(|job| settings::texts(job.numerics)).collect();
    (0..SETTINGS.len()).filter(|&i| texts.iter().any(|text| text[i] != texts[0][i])).collect()
}

fn jobs_table(case: &Case) -> Vec<Block> {
    let varying = varying(case);
    let mut header: Vec<String> = varying.iter().map(|&i| SETTINGS[i].head.name.to_string()).collect();
    header.extend(
        ["Δt [µs]", "μ*", "error of μ*", "error of f", "error of shares", "time [s]", "node-steps", "front"]
            .map(str::to_owned),
    );
    let lines: Vec<Vec<String>> = case
        .jobs
        .iter()
        .zip(&case.scores)
        .enumerate()
        .map(|(index, (job, score))| {
            let texts = settings::texts(job.numerics);
            let mut line: Vec<String> = varying.iter().map(|&i| texts[i].clone()).collect();
            line.extend(results(job, score, index == case.reference.job));
            line
        })
        .collect();
    let constant: Vec<String> = {
        let texts = settings::texts(case.jobs[0].numerics);
        (0..SETTINGS.len())
            .filter(|i| !varying.contains(i))
            .map(|i| format!("{} {}", SETTINGS[i].head.name, texts[i]))
            .collect()
    };
    let constant = format!("In all jobs: {}.", constant.join(", "));
    let is_said = varying.len() < SETTINGS.len();
    is_said.then(|| Block::Text(constant.into())).into_iter().chain([grid(&header, lines)]).collect()
}

fn grid(heads: &[String], lines: Vec<Vec<String>>) -> Block {
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    Block::Table(Grid::of(&heads, lines, "pareto.csv"))
}

fn results(job: &DoneJob, score: &Score, is_reference: bool) -> [String; 8] {
    let not_periodic = if job.row.status() == "not_periodic" { "~" } else { "" };
    let frequency = score.frequency_error.zip(score.frequency_resolution);
    let front = match (score.on_wall_front, score.on_node_step_front) {
        (true, true) => "t n",
        (true, false) => "t",
        (false, true) => "n",
        (false, false) => "",
    };
    [
        format!("{:.4}", job.record.time_step_s * 1.0e6),
        format!("{}{not_periodic}", value::fixed(job.record.mu_star, 5)),
        percent(score.mu_star_error, score.mu_star_resolution),
        frequency.map_or_else(|| MISSING.to_owned(), |(error, resolution)| percent(error, resolution)),
        resolved(score.shares_error, score.shares_resolution, |x| format!("{x:.4}")),
        score.wall_s.map_or_else(|| MISSING.to_owned(), |wall| format!("{wall:.2}")),
        format!("{:.2e}", score.node_steps),
        if is_reference { format!("reference {front}").trim().to_owned() } else { front.to_owned() },
    ]
}

/// A signed relative error in percent, or the resolution if the error is not resolved.
fn percent(error: f64, resolution: f64) -> String {
    if exceeds(error, resolution) {
        format!("{:+.3} %", 100.0 * error)
    } else {
        resolved(error, resolution, |x| format!("{:.3} %", 100.0 * x))
    }
}

fn resolved(error: f64, resolution: f64, write: impl Fn(f64) -> String) -> String {
    match (error.is_finite(), exceeds(error, resolution)) {
        (false, _) => MISSING.to_owned(),
        (true, true) => write(error),
        (true, false) => format!("≤ {}", write(resolution)),
    }
}

fn early_table(case: &Case) -> Vec<Block> {
    if case.early.is_empty() {
        return Vec::new();
    }
    let mut shown = varying(case);
    shown.retain(|&i| SETTINGS[i].head.name != "stop early" && SETTINGS[i].head.name != "limit [s]");
    let mut header: Vec<String> = shown.iter().map(|&i| SETTINGS[i].head.name.to_string()).collect();
    header.extend(
        ["stopped at [ms]", "change of μ*", "change of f", "change of shares", "steps saved", "time saved"]
            .map(str::to_owned),
    );
    let lines: Vec<Vec<String>> = case
        .early
        .iter()
        .map(|pair| {
            let texts = settings::texts(case.jobs[pair.early].numerics);
            let mut line: Vec<String> = shown.iter().map(|&i| texts[i].clone()).collect();
            line.extend(changes(case, pair));
            line
        })
        .collect();
    let words = "Against the same job run to its limit.";
    vec![Block::Heading("What stopping early changes".to_owned()), Block::text(words), grid(&header, lines)]
}

fn changes(case: &Case, pair: &EarlyStop) -> [String; 6] {
    let share = |x: Option<f64>| x.map_or_else(|| MISSING.to_owned(), |x| format!("{:.0} %", 100.0 * x));
    [
        format!("{:.2}", case.jobs[pair.early].record.simulated_s * 1.0e3),
        percent(pair.mu_star_change, pair.mu_star_resolution),
        pair.frequency_change.map_or_else(|| MISSING.to_owned(), |x| format!("{:+.3} %", 100.0 * x)),
        format!("{:.4}", pair.shares_change),
        share(Some(pair.steps_saved)),
        share(pair.wall_saved),
    ]
}

/// The name of the ordinate of the figure.
pub(super) fn figure_title() -> String {
    format!("relative error of {}", FIGURE_NAMES[MU_STAR])
}
