//! Warnings about doubtful inputs of a study.

use super::output::log;
use crate::spec::JobSpec;
use crate::study::Study;

/// Logs what is doubtful about a study, and returns the number of warnings.
pub(crate) fn of_study(study: &Study) -> usize {
    let mut doubts = 0;
    for warning in study.warnings() {
        if warning.is_doubt() {
            doubts += 1;
            log(format_args!("warning: {warning}"));
        } else {
            // Nothing is wrong, so it need not stand out.
            log(format_args!("note: {}", warning.in_words()));
        }
    }
    doubts
}

/// Logs what is doubtful about one job of a study.
pub(crate) fn of_job(study: &Study, spec: &JobSpec) {
    for warning in &study.warnings_of(spec) {
        let word = if warning.is_doubt() { "warning" } else { "note" };
        log(format_args!("{word}: {}", warning.in_words()));
    }
}
