//! The study of complex modes and how it grows.

use super::ladder::ladder;
use super::points::{further, read_stability};
use super::waves::next_wave;
use crate::queue::Queue;
use crate::solver;
use crate::spec::{Contact, JobSpec};
use crate::study::{Job, job_key};
use crate::sweep::error::SweepError;
use crate::sweep::plan::Plan;
use crate::sweep::rows::for_each_job;
use serde_json::Value;
use std::collections::{BTreeSet, HashMap};

/// The parameter over which thresholds are looked for.
const MU: &str = "mu";

/// A study of complex modes, with points between those of its grid.
#[derive(Debug)]
pub struct StabilitySweep {
    plan: Plan,
    /// The jobs of the grid.
    grid: Vec<Job>,
    has_thresholds: bool,
}

impl StabilitySweep {
    /// The sweep of a plan whose jobs compute modes without a run. If it looks for thresholds and the grid varies μ, points
    /// are added where the grid is too coarse.
    pub fn new(plan: Plan, finds_thresholds: bool) -> Self {
        let varies_mu = plan.study().varied().any(|parameter| parameter.name == MU);
        let grid = plan.jobs().to_vec();
        let mut sweep = Self { plan, grid, has_thresholds: finds_thresholds && varies_mu };
        if sweep.has_thresholds {
            let mus: Vec<f64> = sweep.grid.iter().map(mu).collect();
            let steps = ladder(&distinct(&mus));
            let firsts = sweep.firsts();
            let jobs = firsts.iter().flat_map(|first| steps.iter().map(|&mu| at(first, mu)));
            sweep.plan.extend(jobs.collect());
        }
        sweep
    }

    /// All points as a plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Whether it looks for thresholds.
    pub fn has_thresholds(&self) -> bool {
        self.has_thresholds
    }

    /// Adds the points that the database has of this study and that differ from those of the grid in μ alone: they were
    /// computed to find thresholds, and their results must not go out of view.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn add_stored(&mut self, queue: &mut Queue) -> Result<(), SweepError> {
        if queue.study(self.plan.name()).await?.is_none() {
            return Ok(());
        }
        let firsts = self.firsts();
        let by_rest: HashMap<String, &Job> = firsts.iter().map(|first| (rest(&first.spec), first)).collect();
        let mut stored = Vec::new();
        for_each_job(queue, self.plan.name(), |key, spec| {
            // A job of another version has another key, and is computed again.
            if let Some(first) = by_rest.get(&rest(&spec)) {
                let job = at(first, spec.scene.contact.mu);
                stored.extend(Some(job).filter(|job| job.key == key));
            }
        })
        .await?;
        self.plan.extend(stored);
        Ok(())
    }

    /// Adds points near the crossings that the results so far show. Returns their number.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn add_wave(&mut self, queue: &mut Queue) -> Result<usize, SweepError> {
        if !self.has_thresholds {
            return Ok(0);
        }
        let points = read_stability(queue, self.plan.name()).await?;
        let firsts = self.firsts();
        let mut jobs = Vec::new();
        for (series, wave) in next_wave(&points) {
            let first = firsts.iter().find(|first| {
                first.spec.scene.disk.omega_rpm == series.omega_rpm
                    && further(&first.parameters) == series.parameters
            });
            jobs.extend(first.iter().flat_map(|first| wave.iter().map(|&mu| at(first, mu))));
        }
        let before = self.plan.jobs().len();
        self.plan.extend(jobs);
        Ok(self.plan.jobs().len() - before)
    }

    /// Of the jobs of the grid that differ in μ alone, the first.
    fn firsts(&self) -> Vec<Job> {
        let mut known = BTreeSet::new();
        self.grid.iter().filter(|job| known.insert(rest(&job.spec))).cloned().collect()
    }
}

fn mu(job: &Job) -> f64 {
    job.spec.scene.contact.mu
}

fn distinct(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// The job with another μ.
fn at(job: &Job, mu: f64) -> Job {
    let mut job = job.clone();
    job.spec.scene.contact.mu = mu;
    for (_, value) in job.parameters.iter_mut().filter(|(name, _)| name == MU) {
        *value = Value::from(mu);
    }
    job.key = job_key(&job.spec, solver::VERSION);
    job
}

/// The key of everything but μ.
fn rest(spec: &JobSpec) -> String {
    let mut rest = spec.clone();
    rest.scene.contact.mu = Contact::default().mu;
    job_key(&rest, solver::VERSION)
}
