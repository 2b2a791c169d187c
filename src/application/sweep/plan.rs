//! From a study to jobs in the queue.

use super::difference::Difference;
use super::error::SweepError;
use super::numerics::numerics;
use super::request::check_quantities;
use super::rows::StoredParameters;
use crate::analysis::{Ending, JobError, Workload};
use crate::publish::value;
use crate::queue::{NewJob, NewStudy, Queue, Replace, Replaced, Shard, Submitted};
use crate::solver;
use crate::spec::{DiskKind, JobSpec};
use crate::study::{Changes, Job, Refine, SharedKeys, Study, StudyText};
use indexmap::IndexMap;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use std::path::Path;

/// A study that has been read, expanded into jobs and checked: no job is refused before its first step.
#[derive(Debug)]
pub struct Plan {
    study: Study,
    jobs: Vec<Job>,
    /// For each job the key of its batch: jobs of one batch can be run together.
    batches: Vec<String>,
    /// What the jobs of each batch take.
    workloads: Vec<Workload>,
    /// For each job the number of its workload.
    workload_of: Vec<usize>,
    /// Jobs that are not points of the grid.
    further: Vec<NewJob>,
    document: String,
}

/// How a plan is submitted.
#[derive(Debug, Clone)]
pub struct Submission {
    /// The part of the jobs that is submitted. The default is all of them.
    pub shard: Shard,
    /// Jobs of a higher priority are run first. Without it, new jobs have priority 0, and jobs that exist keep theirs.
    pub priority: Option<i64>,
    /// Whether a study of the same name may be replaced. By default it may if no result goes out of view.
    pub replace: Replace,
}

impl Default for Submission {
    fn default() -> Self {
        Self { shard: Shard::WHOLE, priority: None, replace: Replace::default() }
    }
}

impl Plan {
    /// Reads and checks a study file; `-` is standard input.
    ///
    /// # Errors
    /// If the file cannot be read, and those of [`Plan::parse`].
    pub fn load(path: &Path) -> Result<Self, SweepError> {
        Self::load_changed(path, &Changes::default())
    }

    /// Reads and checks a study file with the changes of a command.
    ///
    /// # Errors
    /// If the file cannot be read, and those of [`Plan::parse_changed`].
    pub fn load_changed(path: &Path, changes: &Changes) -> Result<Self, SweepError> {
        // The file is read once: what is stored is what was checked, even if it is a pipe or edited meanwhile.
        let StudyText { text, source_name } = StudyText::read(path)?;
        Self::parse_changed(&text, &source_name, changes)
    }

    /// Checks the text of a study file. Messages call the file `source_name`, and its stem is the study's name unless
    /// the text gives one.
    ///
    /// # Errors
    /// Those of [`Study::parse`], and [`SweepError::RefusedJob`].
    pub fn parse(text: &str, source_name: &str) -> Result<Self, SweepError> {
        Self::parse_changed(text, source_name, &Changes::default())
    }

    /// As [`Plan::parse`], with the changes of a command. The document that is stored has them.
    ///
    /// # Errors
    /// Those of [`Study::parse_changed`], and [`SweepError::RefusedJob`].
    pub fn parse_changed(text: &str, source_name: &str, changes: &Changes) -> Result<Self, SweepError> {
        let study = Study::parse_changed(text, source_name, changes)?;
        check_quantities(&study)?;
        let jobs = study.expand(solver::VERSION)?;
        let batches: Vec<String> = jobs
            .par_iter()
            .map_init(|| SharedKeys::new(solver::VERSION), |keys, job| keys.key(job.spec.shared_part()))
            .collect();
        let (workloads, workload_of) = preflight(source_name, &jobs, &batches)
            .map_err(|refusal| refusal.with_doubts(study.warnings()))?;
        let (document, further) = (study.document(), Vec::new());
        Ok(Self { study, jobs, batches, workloads, workload_of, further, document })
    }

    /// Lets the study grow.
    pub(super) fn refine(&mut self, refine: Refine) {
        self.study.refine(refine);
        self.document = self.study.document();
    }

    /// Adds jobs that are not points of the study's grid, but for those that the solver refuses.
    pub(super) fn extend(&mut self, further: &[(Job, Added)]) -> Result<(), SweepError> {
        let jobs = added_jobs(self.name(), further)?;
        self.further.extend(jobs.into_iter().map(|(job, _)| job));
        Ok(())
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// The study's name.
    pub fn name(&self) -> &str {
        self.study.name()
    }

    /// The study as it is stored: its text.
    pub fn document(&self) -> &str {
        &self.document
    }

    /// The jobs, in the order of the grid.
    pub fn jobs(&self) -> &[Job] {
        &self.jobs
    }

    /// For each job what its batch takes, in the order of the grid.
    pub fn workloads(&self) -> impl Iterator<Item = &Workload> {
        self.workload_of.iter().map(|&number| &self.workloads[number])
    }

    /// How this study differs from the one of the same name that it replaces, which is the first one of the comparison.
    ///
    /// # Errors
    /// If this version cannot read the old study.
    pub fn difference_from(&self, replaced: &Replaced) -> Result<Difference, SweepError> {
        let beta_r_s = replaced.parameters.as_deref().and_then(StoredParameters::beta_r_s);
        let old = Study::parse_stored(&replaced.document, self.name(), beta_r_s)?.expand(solver::VERSION)?;
        Ok(Difference::between(&old, &self.jobs))
    }

    /// What [`Plan::submit`] would replace; `None` if no study has the name. Nothing is changed.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn preview_replacement(&self, queue: &mut Queue) -> Result<Option<Replaced>, SweepError> {
        let further = self.further.iter().map(|job| job.key.as_str());
        let keys = self.jobs.iter().map(|job| job.key.as_str()).chain(further).collect();
        Ok(queue.preview_replacement(self.name(), &keys, &self.document).await?)
    }

    /// Submits all jobs to the database. Jobs that it has already are not added again.
    ///
    /// A study of the same name is replaced if no result goes out of view: if this study has all its jobs that are done.
    /// [`Plan::submit_with`] can replace any study.
    ///
    /// # Errors
    /// [`QueueError::ResultsWouldBeDropped`](crate::queue::QueueError::ResultsWouldBeDropped); if the database cannot be
    /// written. Then nothing has changed.
    pub async fn submit(&self, queue: &mut Queue) -> Result<Submitted, SweepError> {
        self.submit_with(queue, &Submission::default()).await
    }

    /// As [`Plan::submit`], in the way that `submission` describes.
    ///
    /// # Errors
    /// As [`Plan::submit`], and [`SweepError::GrowingShard`].
    ///
    /// # Panics
    /// If the shard's index is not below the number of shards.
    pub async fn submit_with(
        &self,
        queue: &mut Queue,
        submission: &Submission,
    ) -> Result<Submitted, SweepError> {
        if self.study.growth().is_any() && submission.shard != Shard::WHOLE {
            return Err(SweepError::GrowingShard);
        }
        let study = self.new_study(submission.priority)?;
        Ok(queue.submit_shard(&study, submission.shard, &submission.replace).await?)
    }

    /// The study in the form that the queue takes.
    fn new_study(&self, priority: Option<i64>) -> Result<NewStudy, SweepError> {
        let workload_of: Vec<&Workload> = self.workloads().collect();
        let mut jobs: Vec<NewJob> = self
            .jobs
            .par_iter()
            .zip(&self.batches)
            .zip(workload_of)
            .map_init(
                || SharedKeys::new(""),
                |cases, ((job, batch), workload)| {
                    Ok(NewJob { priority, ..new_job(job, batch, workload, cases, None)? })
                },
            )
            .collect::<Result<_, SweepError>>()?;
        jobs.extend(self.further.iter().map(|job| NewJob { priority, ..job.clone() }));
        let grows = self.study.growth().is_any();
        Ok(NewStudy { name: self.name().to_owned(), document: self.document.clone(), jobs, grows })
    }
}

/// That the program adds a job to those of the study's author.
#[derive(Debug, Clone)]
pub(super) struct Added {
    /// The number of the wave, from 1.
    pub wave: u64,
    /// Why it is added.
    pub why: String,
}

/// Added jobs in the form that the queue takes, with the reasons why they are added. Those that the solver would refuse before their
/// first step are left out.
pub(super) fn added_jobs<'a>(
    source_name: &str,
    further: &'a [(Job, Added)],
) -> Result<Vec<(NewJob, &'a str)>, SweepError> {
    let mut batches = SharedKeys::new(solver::VERSION);
    let mut cases = SharedKeys::new("");
    let jobs: Vec<Job> = further.iter().map(|(job, _)| job.clone()).collect();
    let keys: Vec<String> = jobs.iter().map(|job| batches.key(job.spec.shared_part())).collect();
    let planned: Vec<Option<Workload>> =
        if let Ok((workloads, workload_of)) = preflight(source_name, &jobs, &keys) {
            workload_of.into_iter().map(|number| Some(workloads[number].clone())).collect()
        } else {
            let one = |(job, key): (&Job, &String)| {
                let alone = preflight(source_name, std::slice::from_ref(job), std::slice::from_ref(key));
                alone.ok().map(|(mut workloads, _)| workloads.swap_remove(0))
            };
            jobs.iter().zip(&keys).map(one).collect()
        };
    let mut new = Vec::new();
    for (((job, added), batch), workload) in further.iter().zip(&keys).zip(planned) {
        if let Some(workload) = workload {
            new.push((new_job(job, batch, &workload, &mut cases, Some(added))?, added.why.as_str()));
        }
    }
    Ok(new)
}

/// A job in the form that the queue takes.
fn new_job(
    job: &Job,
    batch: &str,
    workload: &Workload,
    cases: &mut SharedKeys,
    added: Option<&Added>,
) -> Result<NewJob, SweepError> {
    let parameters = StoredParameters {
        omega_rpm: job.spec.scene.disk.omega_rpm,
        mu: job.spec.scene.contact.mu,
        grid: job.parameters.clone(),
        numerics: numerics(&job.spec, cases),
        wave: added.map(|own| own.wave),
        why: added.map(|own| own.why.clone()),
    };
    Ok(NewJob {
        key: job.key.clone(),
        payload: encode(&job.spec)?,
        parameters: encode(&parameters)?,
        // The time of modes does not depend on the steps of a run.
        cost: if job.spec.has_run() { workload.node_steps(Ending::of(&job.spec).likely_s) } else { 0.0 },
        batch: batch.to_owned(),
        priority: None,
        parent: job.spec.parent().map(str::to_owned),
    })
}

fn encode(value: &impl Serialize) -> Result<String, SweepError> {
    serde_json::to_string(value).map_err(SweepError::Encode)
}

/// Up to so many batches are examined. A study with more, such as a sweep over the modulus, would take minutes.
const EXAMINED: usize = 200;

/// A batch is examined in any case if its run has more steps than this share of what is allowed, by an estimate.
const MANY_STEPS: f64 = 0.1;

/// What the jobs take: the workload of each batch, and for each job its number. Refuses a study with a job that a worker
/// would refuse before its first step. One job of each batch shows whether the solver refuses the model.
fn preflight(
    source_name: &str,
    jobs: &[Job],
    batches: &[String],
) -> Result<(Vec<Workload>, Vec<usize>), SweepError> {
    let mut firsts: IndexMap<&str, &JobSpec> = IndexMap::new();
    let mut workload_of = Vec::with_capacity(jobs.len());
    for (job, batch) in jobs.iter().zip(batches) {
        let first = firsts.entry(batch);
        workload_of.push(first.index());
        first.or_insert(&job.spec);
    }
    let firsts: Vec<&JobSpec> = firsts.into_values().collect();
    let examines_all = firsts.len() <= EXAMINED;
    let mut workloads: Vec<Result<Workload, JobError>> = firsts
        .par_iter()
        .map(|spec| {
            let estimate = Workload::estimate(spec)?;
            let is_certain = spec.numerics.time_step_s.is_none()
                && spec.scene.disk.kind == DiskKind::Rigid
                && estimate.steps(spec.limit_of_run_s() / MANY_STEPS).is_ok();
            if examines_all || !is_certain { Workload::examine(spec) } else { Ok(estimate) }
        })
        .collect();
    let is_refused = |(job, &number): (&Job, &usize)| match &workloads[number] {
        Ok(workload) => workload.steps_of(&job.spec).is_err(),
        Err(_) => true,
    };
    let refused: Vec<bool> = jobs.iter().zip(&workload_of).map(is_refused).collect();
    let Some(first) = refused.iter().position(|&is_refused| is_refused) else {
        return Ok((workloads.into_iter().flatten().collect(), workload_of));
    };
    let job = &jobs[first];
    let workload = workloads.swap_remove(workload_of[first]);
    let Err(reason) = workload.and_then(|workload| workload.steps_of(&job.spec)) else {
        unreachable!("the job is refused");
    };
    let point: Vec<String> =
        job.parameters.iter().map(|(name, value)| format!("{name} = {}", value::text(value))).collect();
    Err(SweepError::RefusedJob {
        source_name: source_name.to_owned(),
        reason: Box::new(reason),
        point: point.join(", "),
        jobs: refused.iter().filter(|&&is_refused| is_refused).count(),
        of: jobs.len(),
        doubts: Vec::new(),
    })
}
