//! Jobs that a study does not have at first: at points between those of its grid, and jobs that continue others.

use super::definition::Study;
use super::expand::Job;
use super::growth::{DIRECTION, Direction, Growth, KICK, Refine};
use super::key::job_key;
use super::parameter::PARAMETERS;
use crate::spec::{Continuation, StabilityMethod, Start};
use indexmap::IndexMap;
use serde_json::{Value, json};

impl Study {
    /// How the study grows.
    pub fn growth(&self) -> &Growth {
        &self.growth
    }

    /// Lets the study add points where they are needed.
    pub fn refine(&mut self, refine: Refine) {
        if let Value::Object(fields) = &mut self.document {
            fields.insert("refine".to_owned(), json!(refine));
        }
        self.growth.refine = Some(refine);
    }

    /// The number of jobs that the study has in the end, at most; none if it does not grow.
    pub fn most_jobs(&self) -> Option<usize> {
        match self.growth() {
            Growth { refine: Some(refine), .. } => Some(refine.most_jobs.max(self.grid_size())),
            Growth { continues: Some(own), .. } => Some(match own.kicks {
                None => own.directions.len() * self.grid_size(),
                Some(kicks) => self.grid_size() * (1 + kicks as usize),
            }),
            Growth { calibrate: Some(own), .. } => {
                let each = self.axes().map(|(_, values)| values.len()).product::<usize>();
                Some(own.most_points(self.free_parameters().len()) * each)
            }
            Growth { refine: None, continues: None, calibrate: None } => None,
        }
    }

    /// The job at a point that the grid need not have: with these values of the parameters that the study varies. None if a limit or a
    /// condition of the study forbids it.
    pub fn job_at(&self, parameters: &[(String, Value)], solver_version: &str) -> Option<Job> {
        let mut draft = self.draft();
        let known = |name: &str| PARAMETERS.iter().find(|parameter| parameter.name == name);
        for (name, value) in parameters {
            if let Some(parameter) = known(name) {
                draft.mark(parameter);
                draft.put(parameter, value);
            }
        }
        let point: Vec<_> =
            parameters.iter().filter_map(|(name, value)| Some((known(name)?, value))).collect();
        if !self.grid.keeps(&point, &self.base) {
            return None;
        }
        let resolved = draft.resolve();
        let key = job_key(&resolved.spec, solver_version);
        let job = Job { key, spec: resolved.spec, parameters: parameters.to_vec() };
        resolved.violations.is_empty().then_some(job)
    }

    /// The first jobs of chains, made from the jobs of the grid; `jobs` unchanged if the study continues none.
    pub(super) fn roots(&self, jobs: Vec<Job>, solver_version: &str) -> Vec<Job> {
        let Some(continues) = &self.growth.continues else { return jobs };
        let Some(along) = &continues.along else {
            let with_kick = |job: &Job| job.continued(None, (KICK, 0.into()), solver_version);
            return jobs.iter().map(with_kick).collect();
        };
        let chains = chains_of(&jobs, along);
        let root = |direction: &Direction, chain: &Vec<&Job>| {
            let first = if *direction == Direction::Up { chain.first() } else { chain.last() };
            first.map(|job| job.continued(None, (DIRECTION, direction.name().into()), solver_version))
        };
        continues
            .directions
            .iter()
            .flat_map(|direction| chains.iter().filter_map(move |chain| root(direction, chain)))
            .collect()
    }
}

/// The jobs that differ in one parameter alone, from its smallest value to its largest; the groups in the order of their first jobs.
pub fn chains_of<'a>(jobs: &'a [Job], along: &str) -> Vec<Vec<&'a Job>> {
    let mut chains: IndexMap<String, Vec<&Job>> = IndexMap::new();
    for job in jobs {
        let rest: Vec<_> = job.parameters.iter().filter(|(name, _)| name != along).collect();
        chains.entry(serde_json::to_string(&rest).unwrap_or_default()).or_default().push(job);
    }
    let mut chains: Vec<Vec<&Job>> = chains.into_values().collect();
    for chain in &mut chains {
        chain.sort_by(|a, b| a.number(along).total_cmp(&b.number(along)));
    }
    chains
}

impl Job {
    /// The value of a parameter that is a number; NaN if it has none.
    pub fn number(&self, name: &str) -> f64 {
        let own = self.parameters.iter().find(|(own, _)| own == name);
        own.and_then(|(_, value)| value.as_f64()).unwrap_or(f64::NAN)
    }

    /// The job as one that begins where its parent ended, or at rest, and that others can continue. It runs in any case:
    /// eigenvalues say nothing about motions far from steady sliding. `own` is what tells its row from others.
    #[must_use]
    pub fn continued(
        &self,
        continuation: Option<Continuation>,
        own: (&str, Value),
        solver_version: &str,
    ) -> Self {
        let mut job = self.clone();
        job.spec.continuation = Some(Box::new(continuation.unwrap_or(Continuation::ROOT)));
        job.spec.stability = StabilityMethod::Simulate;
        // It begins in the motion of its parent, and a run on a coarser mesh can only be compared with it.
        if job.spec.run.start != Start::Compared {
            job.spec.run.start = Start::Rest;
        }
        job.key = job_key(&job.spec, solver_version);
        job.parameters.retain(|(name, _)| name != own.0);
        job.parameters.push((own.0.to_owned(), own.1));
        job
    }
}
