//! The comparison as tables: columns for programs, and those that only readers see.

use super::compare::{Case, Comparison};
use super::reference::{Chain, DoneJob, FIGURES, Figure};
use super::refinement::{Limit, Unclean};
use super::score::{Score, exceeds};
use super::settings::SETTINGS;
use crate::publish::table::{Column, FileColumns, Table};
use crate::publish::value::{self, MISSING, number};
use crate::report::columns::ExportColumn;
use crate::report::parameters::{self, MU, OMEGA, assignments, parameter_names};
use crate::report::row::JobNumerics;

/// Settings that follow from another one, which a reader sees.
const DERIVED: [&str; 2] = ["element_size_m", "nodes"];

/// Columns of the export that come before the settings and after them.
const OF_JOB: [&str; 4] = ["study", "job", OMEGA, MU];
#[rustfmt::skip]
const OF_RESULT: [&str; 10] =
    ["status", "mu_star", "mu_star_se", "frequency_hz", "stick_share", "slip_share", "separated_share", "time_step_s", "steps", "wall_s"];

/// A job of a case.
#[derive(Clone, Copy)]
struct Line<'a> {
    case: usize,
    job: &'a DoneJob<'a>,
    score: &'a Score,
    is_reference: bool,
}

#[rustfmt::skip]
fn of_score<'a>() -> [Column<Line<'a>>; 11] {
    [
        Column::new("mu_star_error", "", "relative difference of μ* from the reference of the case", |of| of.score.mu_star_error.into()),
        Column::new("mu_star_resolution", "", "smallest difference that the errors of both can show", |of| of.score.mu_star_resolution.into()),
        Column::new("resolved", "", "whether the error is larger than that", |of| of.score.is_resolved().into()),
        Column::new("frequency_error", "", "relative difference of the frequency", |of| of.score.frequency_error.into()),
        Column::new("frequency_resolution", "", "smallest difference that can be shown", |of| of.score.frequency_resolution.into()),
        Column::new("shares_error", "", "largest difference of a share", |of| of.score.shares_error.into()),
        Column::new("shares_resolution", "", "smallest difference that can be shown", |of| of.score.shares_resolution.into()),
        Column::new("reference", "", "whether the job is the reference of its case", |of| of.is_reference.into()),
        Column::new("node_steps", "", "nodes × steps, the same cost on every machine", |of| of.score.node_steps.into()),
        Column::new("on_wall_front", "", "whether no other job is both faster and more accurate", |of| of.score.on_wall_front.into()),
        Column::new("on_node_step_front", "", "the same with node-steps instead of time", |of| of.score.on_node_step_front.into()),
    ]
}

/// The columns of every comparison. Grid parameters that are not among them follow.
fn of_job<'a>() -> Vec<Column<Line<'a>>> {
    let of_export = |names: &'static [&'static str]| {
        let columns = names.iter().filter_map(|name| ExportColumn::find(name)).cloned();
        columns.map(|own| own.into_column().within(|of: &Line| of.job.row))
    };
    let settings = SETTINGS.iter().cloned().map(|own| own.within(|of: &Line| of.job.numerics));
    std::iter::once(Column::new("case", "", "number of the physical case", |of: &Line| of.case.into()))
        .chain(of_export(&OF_JOB))
        .chain(settings)
        .chain(of_export(&OF_RESULT))
        .chain(of_score())
        .collect()
}

fn lines_of<'a>(number: usize, case: &'a Case<'a>) -> impl Iterator<Item = Line<'a>> {
    case.jobs.iter().zip(&case.scores).enumerate().map(move |(index, (job, score))| Line {
        case: number,
        job,
        score,
        is_reference: index == case.reference.job,
    })
}

/// The jobs of all cases with their errors. Relative errors have a sign.
pub(super) fn jobs(comparison: &Comparison) -> Table {
    let mut columns = of_job();
    let jobs = comparison.cases.iter().flat_map(|case| &case.jobs);
    let names = parameter_names(jobs.map(|job| &job.row.parameters));
    let is_known = |name: &str| of_job::<'static>().iter().any(|column| column.head.name == name);
    columns.extend(names.into_iter().filter(|name| !is_known(name)).map(|name| {
        let (head, name) = (parameters::head(name), name.to_owned());
        Column::made(head, move |of: &Line| of.job.row.parameter(&name))
    }));
    let lines: Vec<Line> =
        (1..).zip(&comparison.cases).flat_map(|(number, case)| lines_of(number, case)).collect();
    Table::of("pareto", &columns, &lines)
}

/// What a reader sees of a job besides the settings that vary: numbers that are not resolved have a sign.
fn shown<'a>() -> [Column<Line<'a>>; 8] {
    [
        Column::new("Δt [µs]", "", "", |of| format!("{:.4}", of.job.record.time_step_s * 1.0e6).into()),
        Column::new("μ*", "", "", |of| {
            let not_periodic = if of.job.row.status() == "not_periodic" { "~" } else { "" };
            format!("{}{not_periodic}", value::fixed(of.job.record.mu_star, 5)).into()
        }),
        Column::new("error of μ*", "", "", |of| {
            percent(of.score.mu_star_error, of.score.mu_star_resolution).into()
        }),
        Column::new("error of f", "", "", |of| {
            let error = of.score.frequency_error.zip(of.score.frequency_resolution);
            error.map(|(error, resolution)| percent(error, resolution)).into()
        }),
        Column::new("error of shares", "", "", |of| {
            resolved(of.score.shares_error, of.score.shares_resolution, |x| format!("{x:.4}")).into()
        }),
        Column::new("time [s]", "", "", |of| of.score.wall_s.map(|wall_s| format!("{wall_s:.2}")).into()),
        Column::new("node-steps", "", "", |of| format!("{:.2e}", of.score.node_steps).into()),
        Column::new("front", "", "", |of| {
            let marks = [
                (of.is_reference, "reference"),
                (of.score.on_wall_front, "t"),
                (of.score.on_node_step_front, "n"),
            ];
            let marks = marks.into_iter().filter_map(|(holds, mark)| holds.then_some(mark));
            marks.collect::<Vec<_>>().join(" ").into()
        }),
    ]
}

/// A signed relative error in percent, or the resolution if the error is not resolved.
fn percent(error: f64, resolution: f64) -> String {
    if exceeds(error, resolution) {
        return format!("{:+.3} %", 100.0 * error);
    }
    resolved(error, resolution, |x| format!("{:.3} %", 100.0 * x))
}

fn resolved(error: f64, resolution: f64, write: impl Fn(f64) -> String) -> String {
    match (error.is_finite(), exceeds(error, resolution)) {
        (false, _) => MISSING.to_owned(),
        (true, true) => write(error),
        (true, false) => format!("≤ {}", write(resolution)),
    }
}

/// The jobs of a case for a reader, with the settings that vary; and those that do not, in words.
pub(super) fn jobs_for_readers(case: &Case) -> (Table, String) {
    let settings = SETTINGS.iter().filter(|own| !DERIVED.contains(&&*own.head.name));
    let first = case.jobs[0].numerics;
    let is_constant =
        |own: &&Column<JobNumerics>| case.jobs.iter().all(|job| own.value(job.numerics) == own.value(first));
    let (constant, varying): (Vec<_>, Vec<_>) = settings.partition(is_constant);
    let in_words = assignments(constant.iter().map(|own| (&*own.head.name, own.value(first))));
    let varying = varying.into_iter().cloned().map(|own| own.within(|of: &Line| of.job.numerics));
    let columns: Vec<Column<Line>> = varying.chain(shown()).collect();
    (Table::of("pareto", &columns, &lines_of(0, case).collect::<Vec<_>>()), in_words)
}

/// A figure of a chain of refinement.
#[derive(Clone, Copy)]
struct Refined<'a> {
    number: usize,
    case: &'a Case<'a>,
    chain: &'a Chain,
    figure: Figure,
    limit: Limit,
}

fn joined(values: impl IntoIterator<Item = f64>) -> String {
    values.into_iter().map(number).collect::<Vec<_>>().join(" ")
}

#[rustfmt::skip]
fn of_refinement<'a>() -> [Column<Refined<'a>>; 10] {
    [
        Column::new("case", "", "number of the physical case", |of| of.number.into()),
        Column::new("physics", "", "the case in words", |of| of.case.caption.as_str().into()),
        Column::new("direction", "", "what is refined: mesh, time step (step), or both", |of| of.chain.direction.name().into()),
        Column::new("figure", "", "column whose convergence is shown", |of| of.figure.column.into()),
        Column::new("sizes", "m or s", "sizes from coarse to fine", |of| joined(of.chain.sizes.iter().copied()).into()),
        Column::new("values", "that of the column", "values from coarse to fine", |of| {
            joined(of.chain.jobs.iter().filter_map(|&job| of.figure.value(of.case.jobs[job].record))).into()
        }),
        Column::new("verdict", "", "clean if an order of convergence was found, otherwise why not", |of| of.limit.order.map_or_else(Unclean::name, |_| "clean").into()),
        Column::new("order", "", "that order", |of| of.limit.order.ok().into()),
        Column::new("limit", "that of the column", "value for the size 0", |of| of.limit.value.into()),
        Column::new("uncertainty", "that of the column", "its uncertainty", |of| of.limit.uncertainty.into()),
    ]
}

fn refined<'a>(number: usize, case: &'a Case<'a>) -> impl Iterator<Item = Refined<'a>> {
    case.reference.chains.iter().flat_map(move |chain| {
        let limits = FIGURES.into_iter().zip(chain.limits);
        limits.filter_map(move |(figure, limit)| Some(Refined { number, case, chain, figure, limit: limit? }))
    })
}

/// A line for each case, chain of refinement and figure.
pub(super) fn refinements(comparison: &Comparison) -> Table {
    let cases = (1..).zip(&comparison.cases);
    let lines: Vec<Refined> = cases.flat_map(|(number, case)| refined(number, case)).collect();
    Table::of("refinement", &of_refinement(), &lines)
}

/// The refinements of a case for a reader.
pub(super) fn refinements_for_readers(case: &Case) -> Table {
    let is_shown = |name: &str| ["direction", "figure", "verdict", "order", "uncertainty"].contains(&name);
    let columns: Vec<Column<Refined>> =
        of_refinement().into_iter().filter(|own| is_shown(&own.head.name)).collect();
    Table::of("refinement", &columns, &refined(0, case).collect::<Vec<_>>()).rounded(3)
}

/// The columns, for the page of columns.
pub(in crate::report) fn described() -> [FileColumns; 2] {
    let of_refinements = "A line is a figure along a chain of refinement.";
    [
        FileColumns::new(&["pareto.csv"], "A line is a job.", &of_job()),
        FileColumns::new(&["refinement.csv"], of_refinements, &of_refinement()),
    ]
}
