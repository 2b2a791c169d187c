//! The comparison as tables for programs.

use super::case::Case;
use super::compare::Comparison;
use super::done::DoneJob;
use super::reference::{Chain, FIGURES, figures};
use super::refinement::{Limit, Unclean};
use super::score::Score;
use crate::publish::table::{Column, FileColumns, Table};
use crate::publish::value::number;
use crate::report::export::further_names;
use crate::report::parameters;

/// A job of a case.
#[derive(Clone, Copy)]
struct Line<'a> {
    case: usize,
    job: &'a DoneJob<'a>,
    score: &'a Score,
    is_reference: bool,
}

/// The columns of every comparison. Grid parameters that are not among them follow.
#[rustfmt::skip]
fn of_job<'a>() -> Vec<Column<Line<'a>>> {
    vec![
        Column::new("case", "", "number of the physical case", |of| of.case.into()),
        Column::new("study", "", "name of the study", |of| of.job.row.study.as_str().into()),
        Column::new("job", "", "key of the job", |of| of.job.row.job.as_str().into()),
        Column::new("omega_rpm", "rpm", "rotation speed ω of the disk", |of| of.job.row.omega_rpm.into()),
        Column::new("mu", "", "local friction coefficient μ", |of| of.job.row.mu.into()),
        Column::new("elements", "", "elements in x, y and z", |of| of.job.numerics.elements.to_vec().into()),
        Column::new("element_size_m", "m", "cube root of the volume of an element", |of| of.job.numerics.element_size_m.into()),
        Column::new("nodes", "", "nodes of the pin", |of| of.job.numerics.nodes.into()),
        Column::new("safety_factor", "", "time step over its limit; empty where the step is given", |of| of.job.numerics.safety_factor.into()),
        Column::new("time_step_s", "s", "time step", |of| of.job.record.time_step_s.into()),
        Column::new("beta2", "", "β₂ of the time scheme", |of| of.job.numerics.beta2.into()),
        Column::new("beta_r_s", "s", "damping β_R", |of| of.job.numerics.beta_r_s.into()),
        Column::new("stop_early", "", "whether the run stops when its state is known", |of| of.job.numerics.stop_early.into()),
        Column::new("limit_s", "s", "largest simulated time", |of| of.job.numerics.limit_s.into()),
        Column::new("average_last_fraction", "", "last fraction of a run up to its limit that is averaged", |of| of.job.numerics.average_last_fraction.into()),
        Column::new("cycles", "", "limit cycles that must repeat", |of| of.job.numerics.cycles.into()),
        Column::new("tolerance", "", "largest spread of a figure over these cycles", |of| of.job.numerics.tolerance.into()),
        Column::new("drift_tolerance", "", "largest drift of its mean", |of| of.job.numerics.drift_tolerance.into()),
        Column::new("precision", "", "precision of the run", |of| of.job.numerics.precision.as_str().into()),
        Column::new("start", "", "what state the run starts from", |of| of.job.numerics.start.as_str().into()),
        Column::new("status", "", "how the run ended", |of| of.job.row.status().into()),
        Column::new("mu_star", "", "macroscopic friction coefficient μ*", |of| of.job.record.mu_star.into()),
        Column::new("mu_star_se", "", "its standard error", |of| of.job.record.mu_star_se.into()),
        Column::new("frequency_hz", "Hz", "fundamental frequency", |of| of.job.record.frequency_hz.into()),
        Column::new("stick_share", "", "share of the node-time in stick", |of| of.job.record.stick_share.into()),
        Column::new("slip_share", "", "share of the node-time in slip", |of| of.job.record.slip_share.into()),
        Column::new("separated_share", "", "share of the node-time separated", |of| of.job.record.separated_share.into()),
        Column::new("mu_star_error", "", "relative difference of μ* from the reference of the case", |of| of.score.mu_star_error.into()),
        Column::new("mu_star_resolution", "", "smallest difference that the errors of both can show", |of| of.score.mu_star_resolution.into()),
        Column::new("resolved", "", "whether the error is larger than that", |of| of.score.is_resolved().into()),
        Column::new("frequency_error", "", "relative difference of the frequency", |of| of.score.frequency_error.into()),
        Column::new("frequency_resolution", "", "smallest difference that can be shown", |of| of.score.frequency_resolution.into()),
        Column::new("shares_error", "", "largest difference of a share", |of| of.score.shares_error.into()),
        Column::new("shares_resolution", "", "smallest difference that can be shown", |of| of.score.shares_resolution.into()),
        Column::new("reference", "", "whether the job is the reference of its case", |of| of.is_reference.into()),
        Column::new("steps", "", "time steps", |of| of.job.record.steps.into()),
        Column::new("node_steps", "", "nodes × steps, the same cost on every machine", |of| of.score.node_steps.into()),
        Column::new("wall_s", "s", "run time", |of| of.score.wall_s.into()),
        Column::new("on_wall_front", "", "whether no other job is both faster and more accurate", |of| of.score.on_wall_front.into()),
        Column::new("on_node_step_front", "", "the same with node-steps instead of time", |of| of.score.on_node_step_front.into()),
    ]
}

/// The jobs of all cases with their errors. Relative errors have a sign.
pub(super) fn jobs(comparison: &Comparison) -> Table {
    let mut columns = of_job();
    let names = further_names(comparison.cases.iter().flat_map(|case| &case.jobs).map(|job| job.row));
    let is_known = |name: &str| of_job::<'static>().iter().any(|column| column.head.name == name);
    columns.extend(names.into_iter().filter(|name| !is_known(name)).map(|name| {
        let (head, name) = (parameters::head(name), name.to_owned());
        Column::made(head, move |of: &Line| of.job.row.parameter(&name))
    }));
    let mut lines = Vec::new();
    for (number, case) in (1..).zip(&comparison.cases) {
        let jobs = case.jobs.iter().zip(&case.scores).enumerate();
        lines.extend(jobs.map(|(index, (job, score))| {
            let is_reference = index == case.reference.job;
            Line { case: number, job, score, is_reference }
        }));
    }
    Table::of("pareto", &columns, &lines)
}

/// A figure of a chain of refinement.
#[derive(Clone, Copy)]
struct Refined<'a> {
    number: usize,
    case: &'a Case<'a>,
    chain: &'a Chain,
    figure: usize,
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
        Column::new("direction", "", "what is refined: mesh or time step", |of| of.chain.direction.name().into()),
        Column::new("figure", "", "column whose convergence is shown", |of| FIELD_NAMES[of.figure].into()),
        Column::new("sizes", "m or s", "sizes from coarse to fine", |of| joined(of.chain.sizes.iter().copied()).into()),
        Column::new("values", "that of the column", "values from coarse to fine", |of| {
            joined(of.chain.jobs.iter().filter_map(|&job| figures(&of.case.jobs[job])[of.figure])).into()
        }),
        Column::new("verdict", "", "clean if an order of convergence was found, otherwise why not", |of| of.limit.order.map_or_else(Unclean::name, |_| "clean").into()),
        Column::new("order", "", "that order", |of| of.limit.order.ok().into()),
        Column::new("limit", "that of the column", "value for the size 0", |of| of.limit.value.into()),
        Column::new("uncertainty", "that of the column", "its uncertainty", |of| of.limit.uncertainty.into()),
    ]
}

/// A line for each case, chain of refinement and figure.
pub(super) fn refinements(comparison: &Comparison) -> Table {
    let mut lines = Vec::new();
    for (number, case) in (1..).zip(&comparison.cases) {
        for chain in &case.reference.chains {
            let figures = (0..FIGURES).filter_map(|figure| Some((figure, chain.limits[figure]?)));
            lines.extend(figures.map(|(figure, limit)| Refined { number, case, chain, figure, limit }));
        }
    }
    Table::of("refinement", &of_refinement(), &lines)
}

/// Names of the figures, as in the export.
const FIELD_NAMES: [&str; FIGURES] =
    ["mu_star", "frequency_hz", "stick_share", "slip_share", "separated_share"];

/// The columns, for the page of columns.
pub(in crate::report) fn described() -> [FileColumns; 2] {
    let of_refinements = "A line is a figure along a chain of refinement.";
    [
        FileColumns::new(&["pareto.csv"], "A line is a job.", &of_job()),
        FileColumns::new(&["refinement.csv"], of_refinements, &of_refinement()),
    ]
}
