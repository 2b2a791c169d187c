//! Warnings about doubtful inputs of a study.

use super::output::log;
use crate::spec::JobSpec;
use crate::study::{Study, Warning, job_warnings};

/// Logs what is doubtful about a study.
pub(crate) fn of_study(study: &Study) {
    for warning in study.warnings() {
        log(format_args!("warning: {warning}"));
    }
}

/// Logs what is doubtful about one job.
pub(crate) fn of_job(spec: &JobSpec) {
    for warning in job_warnings(spec).iter().map(Warning::in_words) {
        log(format_args!("warning: {warning}"));
    }
}
