//! Coefficients of friction that nothing uses.

use super::{Doubt, Shared, Warning, job_warnings, owned};
use crate::spec::{Contact, FrictionLaw, JobSpec};
use crate::study::definition::Study;
use strum::VariantArray;

/// A coefficient of friction: its field, its name in a contact, and its value there.
type Coefficient = (&'static str, &'static str, fn(&Contact) -> Option<f64>);

/// The coefficients that not every law uses.
const COEFFICIENTS: [Coefficient; 4] = [
    ("scene.contact.mu_static", "mu_static", |contact| contact.mu_static),
    ("scene.contact.speed_m_s", "speed_m_s", |contact| contact.speed_m_s),
    ("scene.contact.slope_s_m", "slope_s_m", |contact| contact.slope_s_m),
    ("scene.contact.length_m", "length_m", |contact| contact.length_m),
];

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
    for (field, name, value) in COEFFICIENTS {
        let uses = |law: &FrictionLaw| law.coefficients().contains(&name);
        let mut given = jobs.clone().enumerate().filter(|(_, job)| value(&job.scene.contact).is_some());
        let Some((first, _)) = given.next().filter(|_| !laws.iter().any(uses)) else { continue };
        let own: Vec<FrictionLaw> = FrictionLaw::VARIANTS.iter().copied().filter(uses).collect();
        let verb = if laws.len() == 1 { "does" } else { "do" };
        let doubt = Doubt {
            kind: "unused",
            fields: owned(&[field]),
            size: 0.0,
            message: format!("without effect: the friction {} {verb} not use it", in_words(&laws)),
            help: format!(
                "{name} belongs to the {}: give scene.contact.law, or leave {name} out",
                in_words(&own)
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
