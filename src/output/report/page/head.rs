//! The beginning of the page: what was found in a sentence for each study, what is missing, and doubts about inputs; and the
//! main numbers.

use super::{Parts, stability};
use crate::analysis::{JobRecord, Outcome};
use crate::publish::page::{Block, Span, Text, Tile};
use crate::publish::value;
use crate::report::accuracy;
use crate::report::digits;
use crate::report::input::Report;
use crate::report::layout::parameters_in_words;
use crate::report::row::JobRow;
use crate::report::scalar::{FREQUENCY, MU_STAR};
use crate::report::summary::{self, Summary};
use crate::report::tooltip::residual_text;
use crate::report::trouble::doubts_in_words;
use std::f64::consts::PI;

/// What comes before the links to sections.
pub(super) fn lead(parts: &Parts) -> Vec<Block> {
    let report = parts.report;
    let mut blocks: Vec<Block> =
        report.description.map(|text| Block::Text(text.into())).into_iter().collect();
    blocks.extend(found(parts).into_iter().map(|sentence| Block::Text(Text::strong(sentence))));
    let verdicts = parts.comparison.iter().flat_map(|own| own.verdicts());
    blocks.extend(verdicts.map(|sentence| Block::Text(Text::strong(sentence))));
    if let Some(head) = parts.comparison.and_then(|own| own.contradictions_in_words().into_iter().next()) {
        let link = Span::Link("where".to_owned(), "#comparison".to_owned());
        blocks.push(Block::Text(Text::strong(head.trim_end_matches(':')).and(" (").and(link).and(").")));
    }
    blocks.extend(incomplete(report.rows));
    blocks.extend(doubts(report));
    blocks
}

/// What each study found, in a sentence.
fn found(parts: &Parts) -> Vec<String> {
    let rows = parts.report.rows;
    let sources = &parts.layouts.jobs.sources;
    let threshold = parts.stability.and_then(|(analysis, _)| stability::found(analysis));
    let of_source = |name: &str| {
        let own: Vec<&JobRow> = rows.iter().filter(|row| row.study == name).collect();
        let words: Vec<String> = [
            friction(&own),
            frequencies(&own),
            damping(&own),
            not_solved(&own),
            doubts_in_words(own.iter().copied(), false),
        ]
        .into_iter()
        .flatten()
        .collect();
        let prefix = if sources.len() > 1 { format!("{name}: ") } else { String::new() };
        (!words.is_empty()).then(|| prefix + &words.join(" "))
    };
    let findings = parts.report.findings.iter().flat_map(|own| own.in_words());
    sources.iter().filter_map(|source| of_source(source.name)).chain(threshold).chain(findings).collect()
}

/// Whether a run came to its end. The average of one that did not settle is no result to begin with.
fn has_settled(row: &JobRow) -> bool {
    row.record().is_some_and(|record| record.outcome != Outcome::NotPeriodic)
}

/// The job whose macroscopic coefficient is the smallest in relation to the local one.
fn lowest<'a>(rows: &[&'a JobRow]) -> Option<(&'a JobRow, &'a JobRecord)> {
    let ratio = |row: &JobRow| {
        Some(row.record()?.mu_star / row.parameters.mu())
            .filter(|ratio| ratio.is_finite() && has_settled(row))
    };
    let ratios = rows.iter().filter_map(|row| Some((ratio(row)?, *row)));
    let (_, row) = ratios.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((row, row.record()?))
}

/// A larger share of μ is no fall.
const LITTLE: f64 = 0.995;

fn friction(rows: &[&JobRow]) -> Option<String> {
    let (row, record) = lowest(rows)?;
    if record.mu_star / row.parameters.mu() > LITTLE {
        // Where friction depends on the speed, μ* can be above μ.
        let settled = rows.iter().filter(|row| has_settled(row));
        let ratios = settled.clone().filter_map(|row| Some(row.record()?.mu_star / row.parameters.mu()));
        let is_mu = ratios.fold(0.0, f64::max) < 2.0 - LITTLE;
        let done = rows.iter().filter(|row| row.record().is_some()).count();
        let which = match settled.count() {
            all if all == done => "all jobs".to_owned(),
            1 => "the one job that settled".to_owned(),
            several => format!("the {several} jobs that settled"),
        };
        return is_mu.then(|| format!("μ* is μ within half a per cent in {which}."));
    }
    let mu_star = digits::with_error(MU_STAR, row);
    let place = parameters_in_words(row);
    let percent = value::significant(100.0 * record.mu_star / row.parameters.mu(), 2);
    Some(format!("μ* falls furthest below μ at {place}: to {mu_star}, {percent} % of μ."))
}

/// The frequencies of limit cycles \[Hz\]. The mean rate of a run that is not periodic is none.
fn frequencies_hz(rows: &[&JobRow]) -> impl Iterator<Item = f64> {
    let settled = rows.iter().filter(|row| !row.is_measured() && FREQUENCY.is_settled(row));
    settled.filter_map(|row| FREQUENCY.value(row))
}

/// The smallest and the largest number; none if there are no numbers.
fn range_of(numbers: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    numbers.map(|x| [x, x]).reduce(|[low, high], [x, _]| [low.min(x), high.max(x)])
}

/// The range of the frequencies of limit cycles in words; none if there are no limit cycles.
fn range_khz(rows: &[&JobRow]) -> Option<String> {
    let [low, high] = range_of(frequencies_hz(rows))?.map(|hz| value::fixed(hz / 1e3, 1));
    Some(if low == high { format!("{low} kHz") } else { format!("{low}–{high} kHz") })
}

fn frequencies(rows: &[&JobRow]) -> Option<String> {
    let done = rows.iter().filter_map(|row| row.record());
    let decayed = done.clone().filter(|record| record.outcome == Outcome::Decayed).count();
    match range_khz(rows) {
        Some(range) => Some(format!("Limit cycles have {range}.")),
        None if decayed > 0 && decayed == done.count() => Some("Every oscillation decays.".to_owned()),
        None => None,
    }
}

/// The damping of the jobs, which μ\* depends on where the contact oscillates; none if they have several, or steady sliding alone.
fn damping(rows: &[&JobRow]) -> Option<String> {
    let oscillates = |row: &&&JobRow| row.record().is_some_and(|record| record.outcome != Outcome::Decayed);
    let own = |row: &&JobRow| {
        let numerics = row.numerics.as_ref()?;
        // The damping of β₂ depends on the time step, which is another one on each mesh.
        let of_scheme_s = (numerics.beta2 - 0.5) * row.record()?.time_step_s;
        Some((numerics.beta_r_s, of_scheme_s, numerics.alpha_r_per_s))
    };
    let mut all = rows.iter().filter(oscillates).map(own);
    let first = all.next()??;
    let (beta_r_s, of_scheme_s, alpha) = Some(first).filter(|_| all.all(|other| other == Some(first)))?;
    let words = damping_in_words(beta_r_s, of_scheme_s, alpha);
    // Twice the damping ratio. A study may give it at a frequency at which nothing squeals.
    let loss_factor = |hz: f64| {
        let omega = 2.0 * PI * hz;
        alpha / omega + (beta_r_s + of_scheme_s) * omega
    };
    let is_damped = (beta_r_s, of_scheme_s, alpha) != (0.0, 0.0, 0.0);
    let factors = range_of(frequencies_hz(rows).map(loss_factor)).filter(|_| is_damped);
    Some(match factors.map(|range| range.map(|factor| value::significant(factor, 2))) {
        Some([low, high]) if low == high => {
            format!("{words} At the frequencies of the limit cycles the loss factor is {low}.")
        }
        Some([low, high]) => {
            format!("{words} At the frequencies of the limit cycles the loss factor is {low} to {high}.")
        }
        None => words,
    })
}

fn damping_in_words(beta_r_s: f64, of_scheme_s: f64, alpha: f64) -> String {
    if alpha > 0.0 {
        let alpha = value::significant(alpha, 4);
        return format!(
            "Damping: α_R = {alpha} 1/s in proportion to the mass, and β_R = {} in proportion to the stiffness.",
            value::quantity(beta_r_s + of_scheme_s, "s")
        );
    }
    let seconds = |x: f64| value::quantity(x, "s");
    match (beta_r_s, of_scheme_s) {
        (0.0, 0.0) => "The pin has no damping.".to_owned(),
        (_, 0.0) => {
            format!(
                "Damping: β_R = {}, that of β₂ = 1 at Δt = {}.",
                seconds(beta_r_s),
                seconds(2.0 * beta_r_s)
            )
        }
        (0.0, _) => format!("Damping: that of the time scheme, which is β_R = {}.", seconds(of_scheme_s)),
        _ => format!(
            "Damping: β_R = {} of the material and {} of the time scheme, {} in all.",
            seconds(beta_r_s),
            seconds(of_scheme_s),
            seconds(beta_r_s + of_scheme_s)
        ),
    }
}

fn not_solved(rows: &[&JobRow]) -> Option<String> {
    let jobs = rows.iter().filter(|row| !row.is_measured()).count();
    let open = rows
        .iter()
        .filter_map(|row| row.record())
        .filter(|record| record.outcome == Outcome::NotPeriodic)
        .count();
    let without = rows.iter().filter(|row| !row.is_measured() && row.record().is_none()).count();
    let of_jobs = value::count(jobs, "job");
    match (open, without) {
        (0, 0) => None,
        (0, without) => Some(format!("{without} of {of_jobs} have no result.")),
        (open, 0) => Some(format!("{open} of {of_jobs} did not become periodic.")),
        (open, without) => {
            Some(format!("Of {of_jobs}, {open} did not become periodic, and {without} have no result."))
        }
    }
}

/// Warnings about missing and failed jobs.
fn incomplete(rows: &[JobRow]) -> Vec<Block> {
    let summary = Summary::of(rows);
    let mut blocks = Vec::new();
    if summary.missing() > 0 {
        let verb = if summary.missing() == 1 { "is" } else { "are" };
        blocks.push(Block::Warning(
            format!(
                "This report is incomplete: {} of {} {verb} missing ({}). Figures and tables hold only the jobs that are done.",
                summary.missing(),
                value::count(summary.total, "job"),
                summary.missing_in_words()
            )
            .into(),
            Vec::new(),
        ));
    }
    if summary.failed > 0 {
        let head = if summary.failed == 1 {
            "1 job has failed".to_owned()
        } else {
            format!("{} jobs have failed", summary.failed)
        };
        let link = Span::Link("where and why".to_owned(), "#trouble".to_owned());
        blocks.push(Block::Warning(Text::from(head + ": see ").and(link).and("."), Vec::new()));
    }
    blocks
}

/// What is doubtful about the study's inputs, and, without standing out, what they cost: the results are right then.
pub(super) fn doubts(report: &Report) -> Vec<Block> {
    let mut blocks = Vec::new();
    if !report.warnings.is_empty() {
        let head = "Check these inputs before you use the results:";
        blocks.push(Block::Warning(head.into(), report.warnings.iter().map(Text::from).collect()));
    }
    let remark =
        |remark: &String| Block::Note(format!("Cost, without an effect on results: {remark}").into());
    blocks.extend(report.remarks.iter().map(remark));
    blocks
}

/// The main numbers, and what is known about their errors.
pub(super) fn numbers(rows: &[JobRow]) -> Vec<Block> {
    let summary = Summary::of(rows);
    let all: Vec<&JobRow> = rows.iter().collect();
    let missing = if summary.missing() > 0 { summary.missing_in_words() } else { String::new() };
    let mut tiles = vec![
        Tile::new("jobs done", format!("{} of {}", summary.done(), summary.total), summary.done_in_words()),
        Tile::new("failed", summary.failed.to_string(), ""),
        Tile::new("missing", summary.missing().to_string(), missing),
    ];
    tiles.extend(
        lowest(&all).map(|(row, _)| Tile::new("lowest μ*/μ", digits::ratio(row), parameters_in_words(row))),
    );
    tiles.extend(error_of_friction(rows));
    tiles.extend(range_khz(&all).map(|range| Tile::new("frequencies", range, "")));
    tiles.extend(residuals(rows));
    let sentences = accuracy::in_words(rows);
    let accuracy = (!sentences.is_empty())
        .then(|| Block::Fold("How accurate the results are".to_owned(), vec![Block::list(sentences)]));
    std::iter::once(Block::Tiles(tiles)).chain(accuracy).collect()
}

/// The largest error of μ\* by the mesh, relative to μ\*, and where it is unknown.
fn error_of_friction(rows: &[JobRow]) -> Option<Tile> {
    let done: Vec<&JobRow> = rows.iter().filter(|row| row.record().is_some()).collect();
    let share = |row: &JobRow| Some(row.mesh_error()?.mu_star / row.record()?.mu_star.abs());
    let known: Vec<(f64, &JobRow)> = done.iter().filter_map(|row| Some((share(row)?, *row))).collect();
    let unknown = done.len() - known.len();
    let title = "mesh error";
    match known.iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
        None => (unknown > 0).then(|| Tile::new(title, "unknown", "")),
        Some((share, row)) => {
            let place = format!("of μ*, at {}", parameters_in_words(row));
            let note = match unknown {
                0 => place,
                some => format!("{place}; unknown in {} of {}", some, value::count(done.len(), "job")),
            };
            Some(Tile::new(title, format!("≤ {} %", value::significant(100.0 * share, 2)), note))
        }
    }
}

fn residuals(rows: &[JobRow]) -> Option<Tile> {
    let (energy, one) = summary::worst(rows, |record| record.energy_residual.abs())?;
    let (identity, other) = summary::worst(rows, JobRecord::identity_residual)?;
    let note = if one.job == other.job {
        format!("energy, identities; both at {}", parameters_in_words(one))
    } else {
        format!("energy at {}; identities at {}", parameters_in_words(one), parameters_in_words(other))
    };
    let both = format!("{}, {}", residual_text(energy), residual_text(identity));
    Some(Tile::new("largest residuals", both, note))
}
