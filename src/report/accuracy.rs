//! What a report says about the errors of its results.

use super::discretisation::{Discretisation, MeshError, NOT_MEASURED};
use super::row::JobRow;
use crate::publish::value::{count, significant};

/// Sentences about the errors of the results of these jobs: of mesh and time step, of the averages, and the rule for
/// digits. Empty if there are no results.
pub(super) fn in_words(rows: &[JobRow]) -> Vec<String> {
    let done: Vec<&JobRow> = rows.iter().filter(|row| row.record().is_some()).collect();
    if done.is_empty() {
        return Vec::new();
    }
    let mut sentences = of_presets(&done);
    let unknown = done.iter().filter(|row| row.discretisation.error().is_none()).count();
    if unknown == done.len() {
        sentences.push(format!("Mesh and time step: {NOT_MEASURED}"));
    } else if unknown > 0 {
        sentences.push(format!("Mesh and time step of {unknown} of {} jobs: {NOT_MEASURED}", done.len()));
    }
    let errors = done.iter().filter_map(|row| row.record()).map(|record| record.mu_star_se.abs());
    let largest = errors.filter(|se| se.is_finite()).fold(0.0, f64::max);
    sentences.push(format!(
        "Statistics: the standard error of μ* over the cycles is at most {}.",
        significant(largest, 2)
    ));
    let unmeasured = if unknown > 0 {
        " Where the error of mesh and time step is not measured, μ* has three decimals at most and a frequency four digits."
    } else {
        ""
    };
    sentences.push(format!(
        "Digits: μ* and frequencies end at the digit in which the larger of the two errors begins.{unmeasured} jobs.csv has all digits."
    ));
    sentences
}

/// One sentence for each preset whose error was measured.
fn of_presets(done: &[&JobRow]) -> Vec<String> {
    let mut presets: Vec<(&MeshError, usize, usize)> = Vec::new();
    for row in done {
        let Some(error) = row.discretisation.error() else { continue };
        let indicative = usize::from(matches!(row.discretisation, Discretisation::Indicative(_)));
        match presets.iter_mut().find(|(known, ..)| *known == error) {
            Some((_, jobs, others)) => (*jobs, *others) = (*jobs + 1, *others + indicative),
            None => presets.push((error, 1, indicative)),
        }
    }
    let sentence = |(error, jobs, others): &(&MeshError, usize, usize)| {
        let which =
            if *jobs == done.len() { String::new() } else { format!(" of {jobs} of {} jobs", done.len()) };
        let note = match others {
            0 => String::new(),
            all if all == jobs => {
                " This is indicative only: scene, friction or speed of these jobs are others.".to_owned()
            }
            some => format!(
                " For {} it is indicative only, because of another scene, friction or speed.",
                count(*some, "job")
            ),
        };
        format!("Mesh and time step{which}: {error}{note}")
    };
    presets.iter().map(sentence).collect()
}
