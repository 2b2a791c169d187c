//! The comparison as CSV, one line per job.

use super::case::Case;
use super::compare::Comparison;
use super::done::DoneJob;
use super::reference::{FIGURES, figures};
use super::refinement::Unclean;
use super::score::Score;
use crate::publish::value::{number, text};
use crate::report::export::{further_names, io_error};
use crate::report::row::JobRow;
use std::io::{self, Write};

/// The fields of every line. Grid parameters that are not among them follow.
const HEADER: [&str; 40] = [
    "case",
    "study",
    "job",
    "omega_rpm",
    "mu",
    "elements",
    "element_size_m",
    "nodes",
    "safety_factor",
    "time_step_s",
    "beta2",
    "beta_r_s",
    "stop_early",
    "limit_s",
    "average_last_fraction",
    "cycles",
    "tolerance",
    "drift_tolerance",
    "precision",
    "start",
    "status",
    "mu_star",
    "mu_star_se",
    "frequency_hz",
    "stick_share",
    "slip_share",
    "separated_share",
    "mu_star_error",
    "mu_star_resolution",
    "resolved",
    "frequency_error",
    "frequency_resolution",
    "shares_error",
    "shares_resolution",
    "reference",
    "steps",
    "node_steps",
    "wall_s",
    "on_wall_front",
    "on_node_step_front",
];

/// Writes the comparison. Relative errors have a sign, and cells without a value are empty.
pub(super) fn write<W: Write>(comparison: &Comparison, out: W) -> io::Result<()> {
    let rows: Vec<JobRow> =
        comparison.cases.iter().flat_map(|case| &case.jobs).map(|job| job.row.clone()).collect();
    let further: Vec<&str> = further_names(&rows).into_iter().filter(|name| !HEADER.contains(name)).collect();
    let mut writer = ::csv::Writer::from_writer(out);
    writer.write_record(HEADER.iter().chain(&further)).map_err(io_error)?;
    for (number, case) in comparison.cases.iter().enumerate() {
        for (index, (job, score)) in case.jobs.iter().zip(&case.scores).enumerate() {
            let mut line = fields(number + 1, case, index, job, score);
            line.extend(further.iter().map(|name| text(&job.row.parameter(name))));
            writer.write_record(line).map_err(io_error)?;
        }
    }
    writer.flush()
}

/// Writes one line per case, chain of refinement and figure: sizes and values from coarse to fine, whether the
/// order is clean (or why not), order, limit and uncertainty.
pub(super) fn write_refinement<W: Write>(comparison: &Comparison, out: W) -> io::Result<()> {
    let mut writer = ::csv::Writer::from_writer(out);
    let header = [
        "case",
        "physics",
        "direction",
        "figure",
        "sizes",
        "values",
        "verdict",
        "order",
        "limit",
        "uncertainty",
    ];
    writer.write_record(header).map_err(io_error)?;
    for (index, case) in comparison.cases.iter().enumerate() {
        for chain in &case.reference.chains {
            for figure in 0..FIGURES {
                let Some(limit) = chain.limits[figure] else { continue };
                let values = chain.jobs.iter().filter_map(|&job| figures(&case.jobs[job])[figure]);
                let joined = |values: Vec<f64>| values.into_iter().map(number).collect::<Vec<_>>().join(" ");
                let line = [
                    (index + 1).to_string(),
                    case.caption.clone(),
                    chain.direction.name().to_owned(),
                    FIELD_NAMES[figure].to_owned(),
                    joined(chain.sizes.clone()),
                    joined(values.collect()),
                    limit.order.map_or_else(Unclean::name, |_| "clean").to_owned(),
                    limit.order.map_or_else(|_| String::new(), number),
                    number(limit.value),
                    number(limit.uncertainty),
                ];
                writer.write_record(line).map_err(io_error)?;
            }
        }
    }
    writer.flush()
}

/// Names of the figures, as in the export.
const FIELD_NAMES: [&str; FIGURES] =
    ["mu_star", "frequency_hz", "stick_share", "slip_share", "separated_share"];

fn fields(case_number: usize, case: &Case, index: usize, job: &DoneJob, score: &Score) -> Vec<String> {
    let (row, numerics, record) = (job.row, job.numerics, job.record);
    let optional = |value: Option<f64>| value.map_or_else(String::new, number);
    let [nx, ny, nz] = numerics.elements;
    vec![
        case_number.to_string(),
        row.study.clone(),
        row.job.clone(),
        number(row.omega_rpm),
        number(row.mu),
        format!("{nx}x{ny}x{nz}"),
        number(numerics.element_size_m),
        numerics.nodes.to_string(),
        optional(numerics.safety_factor),
        number(record.time_step_s),
        number(numerics.beta2),
        number(numerics.beta_r_s),
        numerics.stop_early.to_string(),
        number(numerics.limit_s),
        number(numerics.average_last_fraction),
        numerics.cycles.to_string(),
        number(numerics.tolerance),
        number(numerics.drift_tolerance),
        numerics.precision.clone(),
        numerics.start.clone(),
        row.status().to_owned(),
        number(record.mu_star),
        number(record.mu_star_se),
        optional(record.frequency_hz),
        number(record.stick_share),
        number(record.slip_share),
        number(record.separated_share),
        number(score.mu_star_error),
        number(score.mu_star_resolution),
        score.is_resolved().to_string(),
        optional(score.frequency_error),
        optional(score.frequency_resolution),
        number(score.shares_error),
        number(score.shares_resolution),
        (index == case.reference.job).to_string(),
        record.steps.to_string(),
        number(score.node_steps),
        optional(score.wall_s),
        score.on_wall_front.to_string(),
        score.on_node_step_front.to_string(),
    ]
}
