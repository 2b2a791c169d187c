//! The study of complex modes and how it grows.

use super::along::{parameters_at, position, rest, ways};
use super::ladder::ladder;
use super::points::{id, read_stability};
use super::waves::next_wave;
use crate::queue::{Queue, Rows};
use crate::report::Along;
use crate::solver;
use crate::study::Job;
use crate::sweep::error::SweepError;
use crate::sweep::plan::Plan;
use crate::sweep::rows::{for_each_row, parameters_of};
use std::collections::BTreeMap;

/// A study of complex modes, with points between those of its grid.
#[derive(Debug)]
pub struct StabilitySweep {
    plan: Plan,
    /// The jobs of the grid.
    grid: Vec<Job>,
    /// What thresholds are thresholds of; none if they are not looked for.
    along: Option<Along>,
}

impl StabilitySweep {
    /// The sweep of a plan whose jobs compute modes without a run. Points are added along the parameter of the thresholds that are
    /// looked for: between those of the grid if it is μ and an axis of the grid, and near thresholds.
    pub fn new(plan: Plan, along: Option<Along>) -> Self {
        let grid = plan.jobs().to_vec();
        let mut sweep = Self { plan, grid, along };
        let is_axis = sweep.plan.study().axes().any(|(parameter, _)| parameter.name == MU);
        if let Some(along) = sweep.along.clone().filter(|along| along.is_mu() && is_axis) {
            let mus: Vec<f64> = sweep.grid.iter().map(|job| job.spec.scene.contact.mu).collect();
            let steps = ladder(&distinct(&mus));
            let jobs = sweep.series(&along).into_values().flat_map(|anchors| {
                steps.iter().filter_map(|&mu| sweep.at(&along, &anchors, mu)).collect::<Vec<_>>()
            });
            let jobs = jobs.collect();
            sweep.plan.extend(jobs);
        }
        sweep
    }

    /// All points as a plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What thresholds are thresholds of; none if they are not looked for.
    pub fn along(&self) -> Option<&Along> {
        self.along.as_ref()
    }

    /// Adds the points that the database has of this study and that lie between those of its grid: they were computed to find
    /// thresholds, and their results must not go out of view.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn add_stored(&mut self, queue: &mut Queue) -> Result<(), SweepError> {
        if queue.study(self.plan.name()).await?.is_none() {
            return Ok(());
        }
        let mut ways = ways(self.plan.study());
        if !ways.iter().any(Along::is_mu) {
            ways.push(Along::mu());
        }
        let ways: Vec<_> = ways
            .into_iter()
            .map(|along| {
                let series = self.series(&along);
                (along, series)
            })
            .collect();
        let mut stored = Vec::new();
        for_each_row(queue, self.plan.name(), Rows::All, |_, row| {
            for (along, series) in &ways {
                let own = id(&rest(along, &row.parameters));
                let at = position(along, &row.parameters);
                let (Some(anchors), Some(at)) = (series.get(&own), at) else { continue };
                // A job of another version has another key, and is computed again.
                stored.extend(self.at(along, anchors, at).filter(|job| job.key == row.job));
            }
            Ok(())
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
        let Some(along) = self.along.clone() else { return Ok(0) };
        let points = read_stability(queue, self.plan.name()).await?;
        let series = self.series(&along);
        let jobs = next_wave(&along, &points).into_iter().flat_map(|(own, wave)| {
            let anchors = series.get(&id(&own));
            wave.into_iter().filter_map(|at| self.at(&along, anchors?, at)).collect::<Vec<_>>()
        });
        let jobs = jobs.collect();
        let before = self.plan.jobs().len();
        self.plan.extend(jobs);
        Ok(self.plan.jobs().len() - before)
    }

    /// The jobs of the grid by their series, in the order of their places along it.
    fn series(&self, along: &Along) -> BTreeMap<String, Vec<(f64, &Job)>> {
        let mut found: BTreeMap<String, Vec<(f64, &Job)>> = BTreeMap::new();
        for job in &self.grid {
            let own = parameters_of(job);
            if let Some(at) = position(along, &own) {
                found.entry(id(&rest(along, &own))).or_default().push((at, job));
            }
        }
        for anchors in found.values_mut() {
            Along::sort(anchors, |_| true);
        }
        found
    }

    /// The job at a place of a series; none if the study forbids it.
    fn at(&self, along: &Along, anchors: &[(f64, &Job)], x: f64) -> Option<Job> {
        self.plan.study().job_at(&parameters_at(along, anchors, x)?, solver::VERSION)
    }
}

/// The parameter of the friction coefficient.
const MU: &str = "mu";

fn distinct(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}
