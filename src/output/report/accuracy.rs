//! What a report says about the errors of its results.

use super::row::JobRow;
use crate::analysis::UnknownError;
use crate::publish::value::{count, significant};
use indexmap::IndexMap;

/// Sentences about the errors of the results of these jobs: of the mesh, of the averages, and the rule for digits. Empty if there are no
/// results.
pub(super) fn in_words(rows: &[JobRow]) -> Vec<String> {
    let records: Vec<_> = rows.iter().filter_map(JobRow::record).collect();
    if records.is_empty() {
        return Vec::new();
    }
    let mut sentences = of_mesh(rows);
    let errors = records.iter().map(|record| record.mu_star_se.abs());
    let largest = errors.filter(|se| se.is_finite()).fold(0.0, f64::max);
    sentences.push(format!(
        "Statistics: the standard error of μ* over the cycles is at most {}.",
        significant(largest, 2)
    ));
    let few = if records.iter().any(|record| record.mesh_error().is_err()) {
        " Where the mesh error is unknown, μ* has three decimals at most and a frequency four digits."
    } else {
        ""
    };
    sentences.push(format!(
        "Digits: μ* and frequencies end at the digit in which the larger of the two errors begins.{few} jobs.csv has all digits."
    ));
    sentences
}

/// Sentences about the errors by the mesh, and how many jobs reach what they ask for. Empty if there are no results.
pub(super) fn of_mesh(rows: &[JobRow]) -> Vec<String> {
    let records: Vec<_> = rows.iter().filter_map(JobRow::record).collect();
    let mut unknown: IndexMap<&str, usize> = IndexMap::new();
    let mut largest = [0.0_f64; 2];
    for error in records.iter().map(|record| record.mesh_error()) {
        match error {
            Ok(own) => {
                largest[0] = largest[0].max(own.mu_star);
                largest[1] = largest[1].max(own.frequency_hz.unwrap_or(0.0));
            }
            Err(why) => *unknown.entry(UnknownError::reason(why)).or_default() += 1,
        }
    }
    let jobs_unknown: usize = unknown.values().sum();
    let mut sentences = Vec::new();
    if jobs_unknown < records.len() {
        let of_frequency = match largest[1] {
            0.0 => String::new(),
            hz => format!(" and of a frequency at most {} Hz", significant(hz, 2)),
        };
        let known = records.len() - jobs_unknown;
        let jobs = if jobs_unknown > 0 {
            format!("where it is known ({known} of {}), ", count(records.len(), "job"))
        } else {
            String::new()
        };
        sentences.push(format!(
            "Mesh: {jobs}the error of μ* is at most {}{of_frequency}. Such bounds are chosen to hold for 95 % of jobs.",
            significant(largest[0], 2)
        ));
    }
    if jobs_unknown > 0 {
        let reasons: Vec<String> =
            unknown.iter().map(|(why, jobs)| format!("{why} ({})", count(*jobs, "job"))).collect();
        sentences.push(format!(
            "Mesh: the error of {jobs_unknown} of {} jobs is unknown: {}. Compare with a finer mesh before you use these numbers.",
            records.len(),
            reasons.join("; ")
        ));
    }
    sentences.extend(asked_in_words(rows));
    sentences
}

/// How many jobs reach the accuracy that they ask for; none if no job asks for one.
fn asked_in_words(rows: &[JobRow]) -> Option<String> {
    let asked = rows.iter().filter_map(|row| row.record()?.accuracy_reached);
    let [reached, others] =
        asked.fold(
            [0, 0],
            |[reached, others], is_reached| {
                if is_reached { [reached + 1, others] } else { [reached, others + 1] }
            },
        );
    let jobs = count(reached + others, "job");
    match (reached, others) {
        (0, 0) => None,
        (_, 0) => Some(format!("Accuracy: what is asked for is reached in all jobs that ask ({jobs}).")),
        _ => Some(format!(
            "Accuracy: what is asked for is not reached in {others} of {jobs}, which are listed under “Trouble”."
        )),
    }
}
