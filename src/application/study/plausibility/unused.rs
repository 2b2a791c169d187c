//! Coefficients of friction that nothing uses.

use super::{Doubt, Shared, Warning, job_warnings, owned};
use crate::spec::{COEFFICIENTS, FrictionLaw, JobSpec};
use crate::study::definition::Study;
use strum::VariantArray;

/// The coefficients of some jobs that are not used by the law of any of `all` jobs, with the number of jobs that have each of them and the
/// index of the first.
fn unused<'a>(
    jobs: &(impl Iterator<Item = &'a JobSpec> + Clone),
    all: impl Iterator<Item = &'a JobSpec>,
) -> Vec<(Doubt, usize, usize)> {
    let mut laws: Vec<FrictionLaw> = Vec::new();
    for job in all {
        if !laws.contains(&job.scene.contact.law) {
            laws.push(job.scene.contact.law);
        }
    }
    let in_words = |laws: &[FrictionLaw]| {
        let names: Vec<&str> = laws.iter().map(|law| law.name()).collect();
        let word = if names.len() == 1 { "law" } else { "laws" };
        format!("{word} {}", names.join(", "))
    };
    let mut found = Vec::new();
    for coefficient in &COEFFICIENTS {
        let uses = |law: &FrictionLaw| law.uses(coefficient);
        let is_given = |job: &JobSpec| !(coefficient.values)(&job.scene.contact).is_empty();
        let mut given = jobs.clone().enumerate().filter(|(_, job)| is_given(job));
        let Some((first, _)) = given.next().filter(|_| !laws.iter().any(uses)) else { continue };
        let own: Vec<FrictionLaw> = FrictionLaw::VARIANTS.iter().copied().filter(uses).collect();
        let verb = if laws.len() == 1 { "does" } else { "do" };
        let doubt = Doubt {
            kind: "unused",
            fields: owned(&[coefficient.field]),
            size: 0.0,
            message: format!("without effect: the friction {} {verb} not use it", in_words(&laws)),
            help: format!(
                "{name} belongs to the {}: give scene.contact.law, or leave {name} out",
                in_words(&own),
                name = coefficient.name
            ),
        };
        found.push((doubt, 1 + given.count(), first));
    }
    found
}

impl Study {
    /// The coefficients of friction that the study gives and none of its jobs uses. A grid over laws may have what one of them uses.
    pub(super) fn unused(&self) -> Vec<Warning> {
        let found = unused(&self.specs.iter(), self.specs.iter()).into_iter();
        found.map(|(doubt, jobs, first)| self.warning(&Shared { doubt, worst: first, first, jobs })).collect()
    }

    /// What is doubtful about one job that was made of the study.
    pub fn warnings_of(&self, job: &JobSpec) -> Vec<Warning> {
        let own = std::iter::once(job);
        let unused = unused(&own.clone(), own.chain(&self.specs)).into_iter();
        job_warnings(job).into_iter().chain(unused.map(|(doubt, ..)| doubt.of_job(job))).collect()
    }
}
