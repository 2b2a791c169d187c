//! Jobs of one model in as many lanes as they need.

use super::checkpoint::Unreadable;
use super::continuation;
use super::error::{JobError, check_step};
use super::lanes::{AnyLanes, Ended, moved, one_lane};
use super::mode::ComplexMode;
use super::nested::{Beginning, CoarseStart, coarser, cost, is_same_width};
use super::record::JobRecord;
use super::stability::{Structures, Verdict, judge};
use super::workload::Workload;
use crate::solver::body::pin::BlockMesh;
use crate::solver::{Model, PinMotion};
use crate::spec::JobSpec;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Jobs that share a model, advanced together.
///
/// There are 1, 2, 4 or 8 lanes. Their number changes as jobs begin and end, and the jobs then move to other
/// lanes. No job's result depends on this.
pub struct Batch {
    shared: JobSpec,
    widest: usize,
    lanes: Box<dyn AnyLanes>,
    structures: Structures,
    /// The jobs that run on the coarser mesh from which they start.
    coarser: Option<CoarserBatch>,
}

/// What became of a job that was to begin.
#[derive(Debug)]
pub enum Begun {
    /// It runs in a lane.
    Runs,
    /// The eigenvalues of steady sliding decided it, and it takes no lane.
    Decided(Box<JobRecord>),
}

/// Where a job runs. A job that starts from a coarser mesh is there first.
#[derive(Clone, Copy)]
enum Stage {
    Own,
    Coarse,
}

impl Batch {
    /// A batch without jobs. Its jobs must share the model of `spec`.
    ///
    /// # Errors
    /// If the specification is not physical or the solver refuses the model. The solver would then refuse it
    /// for every job of the batch.
    pub fn new(spec: &JobSpec) -> Result<Self, JobError> {
        Self::sharing(spec, Structures::default())
    }

    /// As [`Batch::new`], with structures that other batches use too.
    ///
    /// # Errors
    /// As [`Batch::new`].
    pub fn sharing(spec: &JobSpec, structures: Structures) -> Result<Self, JobError> {
        spec.check()?;
        let model = Model::from_scene(&spec.scene, &spec.numerics)?;
        let mut widest = Workload::of(&model, spec.numerics.precision).widest();
        // Most jobs that ask for an accuracy spend most of their time on coarser meshes than the finest one.
        if widest == 1
            && spec.accuracy.is_some()
            && let Some(coarser) = coarser(spec)
        {
            widest = Workload::estimate(&coarser)?.widest();
        }
        Ok(Self {
            shared: spec.shared_part(),
            widest,
            lanes: one_lane(model, spec.numerics.precision),
            structures,
            coarser: None,
        })
    }

    /// Whether a job shares the model of this batch.
    pub fn takes(&self, spec: &JobSpec) -> bool {
        self.shared == spec.shared_part()
    }

    /// The largest number of jobs for which it pays off to advance them together.
    pub fn widest(&self) -> usize {
        self.widest
    }

    /// What the jobs take.
    pub fn workload(&self) -> Workload {
        Workload::of(self.lanes.model(), self.shared.numerics.precision)
    }

    /// Number of jobs.
    pub fn jobs(&self) -> usize {
        self.lanes.jobs() + self.coarser.as_ref().map_or(0, CoarserBatch::jobs)
    }

    /// Begins a job that continues no other one, as [`Batch::begin_after`].
    ///
    /// # Errors
    /// As [`Batch::begin_after`].
    ///
    /// # Panics
    /// As [`Batch::begin_after`].
    pub fn begin(&mut self, ticket: u64, spec: JobSpec) -> Result<Begun, JobError> {
        self.begin_after(ticket, spec, None)
    }

    /// Begins a job, unless the eigenvalues of steady sliding decide it at once. Its owner identifies it by `ticket`. If it
    /// continues another one, `parent` is the last motion of that one.
    ///
    /// A job that starts from a coarser mesh is judged after the run there, and only if that found no limit cycle.
    ///
    /// # Errors
    /// If the specification is not physical or asks for too many steps, if a job without a run has no eigenvalues, or if the
    /// motion is missing that the job continues.
    ///
    /// # Panics
    /// If the job has another model, or if the batch is full.
    pub fn begin_after(
        &mut self,
        ticket: u64,
        spec: JobSpec,
        parent: Option<PinMotion>,
    ) -> Result<Begun, JobError> {
        spec.check()?;
        assert!(self.takes(&spec), "a job of another model");
        assert!(self.jobs() < self.widest, "no more jobs than the widest");
        check_step(&spec, self.workload().time_step_s)?;
        if let Some(key) = spec.parent() {
            let model = self.lanes.model();
            let beginning = parent.and_then(|motion| continuation::beginning(&spec, model, motion));
            let parent = key.to_owned();
            let beginning = beginning.ok_or(JobError::NoParentMotion { parent })?;
            return self.begin_with(ticket, spec, beginning);
        }
        self.begin_with(ticket, spec, Beginning::REST)
    }

    /// Begins a job on its coarser mesh, if it has one, or else on its own.
    fn begin_with(&mut self, ticket: u64, spec: JobSpec, beginning: Beginning) -> Result<Begun, JobError> {
        match self.coarser_of(&spec) {
            Some(coarser) => match coarser.begin(ticket, spec, beginning.motion) {
                Some(Prepared::GoesOn(ready)) => self.begin_own(*ready),
                Some(Prepared::Reached(record)) => Ok(Begun::Decided(record)),
                None => Ok(Begun::Runs),
            },
            None => self.begin_own(Ready { ticket, spec, beginning }),
        }
    }

    /// The batch on the coarser mesh of a job; none if it has none.
    fn coarser_of(&mut self, spec: &JobSpec) -> Option<&mut CoarserBatch> {
        coarser(spec)?;
        if self.coarser.is_none() {
            self.coarser = CoarserBatch::of(spec, self.structures.clone());
        }
        self.coarser.as_mut()
    }

    /// Begins a job on its own mesh, unless eigenvalues decide it.
    fn begin_own(&mut self, ready: Ready) -> Result<Begun, JobError> {
        let Ready { ticket, spec, beginning } = ready;
        let stability = match judge(&spec, self.lanes.model(), &beginning, &self.structures)? {
            Verdict::Decided(record) => return Ok(Begun::Decided(record)),
            Verdict::Undecided(stability) => stability,
        };
        let lane = self.free_lane();
        self.lanes.begin_from(lane, ticket, spec, beginning)?;
        if let Some(stability) = stability {
            self.lanes.note(lane, stability);
        }
        Ok(Begun::Runs)
    }

    /// Continues a job from its [`Batch::checkpoint`]. The result has the same bits as that of an
    /// uninterrupted run.
    ///
    /// # Errors
    /// [`Unreadable`]. The job has not begun then.
    ///
    /// # Panics
    /// As [`Batch::begin`].
    pub fn resume(&mut self, ticket: u64, spec: JobSpec, checkpoint: &[u8]) -> Result<(), Unreadable> {
        assert!(self.takes(&spec), "a job of another model");
        assert!(self.jobs() < self.widest, "no more jobs than the widest");
        let Some((stage, bytes)) = checkpoint.split_last() else { return Err(Unreadable) };
        if *stage == Stage::Coarse as u8 {
            let coarser = self.coarser_of(&spec).ok_or(Unreadable)?;
            return coarser.resume(ticket, spec, bytes);
        }
        let lane = self.free_lane();
        self.lanes.resume(lane, ticket, spec, bytes)
    }

    /// The checkpoint of a job, for [`Batch::resume`] of the same program; none if there is no such job.
    pub fn checkpoint(&self, ticket: u64) -> Option<Vec<u8>> {
        let own = self.lanes.checkpoint(ticket).map(|bytes| (bytes, Stage::Own));
        let coarse = || Some((self.coarser.as_ref()?.checkpoint(ticket)?, Stage::Coarse));
        let (mut bytes, stage) = own.or_else(coarse)?;
        // The last byte says where the job goes on.
        bytes.push(stage as u8);
        Some(bytes)
    }

    /// A lane without a job. If there is none, the jobs move to more lanes.
    fn free_lane(&mut self) -> usize {
        if self.lanes.free_lane().is_none() {
            self.fit(self.lanes.jobs() + 1);
        }
        self.lanes.free_lane().expect("a lane was made")
    }

    /// Moves the jobs to as few lanes as possible. This is useful when no other job will come.
    pub fn narrow(&mut self) {
        self.fit(self.lanes.jobs());
        self.coarser.iter_mut().for_each(CoarserBatch::narrow);
    }

    /// Changes the number of lanes to the smallest that holds `jobs` jobs.
    fn fit(&mut self, jobs: usize) {
        let lanes = jobs.max(1).next_power_of_two().min(8);
        if self.lanes.lanes() != lanes {
            self.lanes = moved(&mut *self.lanes, lanes);
        }
    }

    /// Advances all jobs by a few steps and returns those that ended.
    pub fn advance(&mut self) -> Vec<Ended> {
        let mut ended = Vec::new();
        for (ticket, prepared) in self.coarser.as_mut().map(CoarserBatch::advance).unwrap_or_default() {
            let begun = match prepared {
                Prepared::GoesOn(ready) => self.begin_own(*ready),
                Prepared::Reached(record) => Ok(Begun::Decided(record)),
            };
            let result = match begun {
                Ok(Begun::Runs) => continue,
                Ok(Begun::Decided(record)) => Ok(*record),
                Err(error) => Err(error),
            };
            ended.push(Ended { ticket, result, motion: None });
        }
        if self.lanes.jobs() > 0 {
            // A lane without a job costs as much as one with a job. A job on the coarser mesh gets one when it is ready.
            if self.coarser.as_ref().is_some_and(|coarser| coarser.jobs() > 0) {
                self.fit(self.lanes.jobs());
            }
            ended.extend(self.lanes.advance(&mut |_| {}));
        }
        ended
    }

    /// Simulated time \[s\] of every job, by its ticket. That on a coarser mesh counts by its cost.
    pub fn simulated(&self) -> Vec<(u64, f64)> {
        self.lanes
            .simulated()
            .into_iter()
            .chain(self.coarser.iter().flat_map(CoarserBatch::simulated))
            .collect()
    }
}

/// Turns of a coarser batch in one turn of the batch: they take about the same time.
const TURNS: usize = 8;

/// Runs a job on its coarser mesh, if it has one. `progress` receives the time \[s\] that it could have simulated meanwhile,
/// and can interrupt the run.
///
/// # Errors
/// [`JobError::Interrupted`].
pub(super) fn prepared(
    spec: &JobSpec,
    structures: &Structures,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Prepared, JobError> {
    let at_rest = || Ready { ticket: 0, spec: spec.clone(), beginning: Beginning::REST };
    let Some(mut coarser) = CoarserBatch::of(spec, structures.clone()) else {
        return Ok(Prepared::GoesOn(Box::new(at_rest())));
    };
    if let Some(prepared) = coarser.begin(0, spec.clone(), None) {
        return Ok(prepared);
    }
    loop {
        if let Some((_, prepared)) = coarser.advance().pop() {
            return Ok(prepared);
        }
        let spent_s = coarser.simulated().map(|(_, spent_s)| spent_s).fold(0.0, f64::max);
        if progress(spent_s).is_break() {
            return Err(JobError::Interrupted);
        }
    }
}

/// The jobs of a batch that run on the coarser mesh.
struct CoarserBatch {
    batch: Box<Batch>,
    jobs: BTreeMap<u64, Preparing>,
}

/// A job on the coarser mesh.
struct Preparing {
    spec: JobSpec,
    coarse: JobSpec,
    /// The motion that the job continues on its own mesh.
    continued: Option<PinMotion>,
}

/// A job that can begin on its own mesh.
pub(super) struct Ready {
    pub ticket: u64,
    pub spec: JobSpec,
    pub beginning: Beginning,
}

/// What becomes of a job after its run on the coarser mesh.
pub(super) enum Prepared {
    /// It goes on on its own mesh.
    GoesOn(Box<Ready>),
    /// Its result on the coarser mesh is as exact as it asks for.
    Reached(Box<JobRecord>),
}

impl CoarserBatch {
    /// The batch on the coarser mesh of a job; none if the job starts from rest.
    pub fn of(spec: &JobSpec, structures: Structures) -> Option<Self> {
        let batch = Batch::sharing(&coarser(spec)?, structures).ok()?;
        Some(Self { batch: Box::new(batch), jobs: BTreeMap::new() })
    }

    /// Number of jobs.
    pub fn jobs(&self) -> usize {
        self.jobs.len()
    }

    /// Begins a job. Returns it if there is no run: the coarser mesh refuses it, or eigenvalues decide it.
    pub fn begin(&mut self, ticket: u64, spec: JobSpec, continued: Option<PinMotion>) -> Option<Prepared> {
        let job = Preparing { coarse: coarser(&spec)?, spec, continued };
        let result = match self.batch.begin(ticket, job.coarse.clone()) {
            Ok(Begun::Runs) => {
                self.jobs.insert(ticket, job);
                return None;
            }
            Ok(Begun::Decided(record)) => Ok(*record),
            Err(error) => Err(error),
        };
        Some(job.prepared(Ended { ticket, result, motion: None }))
    }

    /// Advances all jobs and returns those that ended, with their tickets.
    pub fn advance(&mut self) -> Vec<(u64, Prepared)> {
        for _ in 0..TURNS {
            let ended = self.batch.advance();
            if !ended.is_empty() {
                let prepared = |end: Ended| Some((end.ticket, self.jobs.remove(&end.ticket)?.prepared(end)));
                return ended.into_iter().filter_map(prepared).collect();
            }
        }
        Vec::new()
    }

    /// Moves the jobs to as few lanes as possible.
    pub fn narrow(&mut self) {
        self.batch.narrow();
    }

    /// The checkpoint of a job; none if there is no such job.
    pub fn checkpoint(&self, ticket: u64) -> Option<Vec<u8>> {
        let mut bytes = self.batch.checkpoint(ticket)?;
        let continued = self.jobs.get(&ticket)?.continued.as_ref();
        let motion = continued.map(continuation::to_bytes).unwrap_or_default();
        bytes.extend(&motion);
        bytes.extend((motion.len() as u64).to_le_bytes());
        Some(bytes)
    }

    /// Continues a job from its [`Self::checkpoint`].
    pub fn resume(&mut self, ticket: u64, spec: JobSpec, bytes: &[u8]) -> Result<(), Unreadable> {
        let (bytes, length) = bytes.split_last_chunk().ok_or(Unreadable)?;
        let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| Unreadable)?;
        let split = bytes.len().checked_sub(length).ok_or(Unreadable)?;
        let (bytes, motion) = bytes.split_at(split);
        let continued =
            if length == 0 { None } else { Some(continuation::from_bytes(motion).ok_or(Unreadable)?) };
        let job = Preparing { coarse: coarser(&spec).ok_or(Unreadable)?, spec, continued };
        self.batch.resume(ticket, job.coarse.clone(), bytes)?;
        self.jobs.insert(ticket, job);
        Ok(())
    }

    /// The time \[s\] of every job, by its ticket, that it could have simulated on its own mesh meanwhile.
    pub fn simulated(&self) -> impl Iterator<Item = (u64, f64)> + '_ {
        let spent = |(ticket, simulated_s): (u64, f64)| {
            let job = self.jobs.get(&ticket)?;
            let [own, coarse] = [&job.spec, &job.coarse].map(|spec| spec.scene.pin.elements);
            Some((ticket, cost(own, coarse) * simulated_s))
        };
        self.batch.simulated().into_iter().filter_map(spent)
    }
}

impl Preparing {
    fn prepared(self, end: Ended) -> Prepared {
        if let Ok(record) = &end.result
            && record.accuracy_reached == Some(true)
        {
            return Prepared::Reached(Box::new(end.result.expect("it is a record")));
        }
        let [from, to] = [&self.coarse, &self.spec].map(|spec| {
            let pin = &spec.scene.pin;
            BlockMesh::new(pin.extent_m(), pin.elements)
        });
        let width_m = |spec: &JobSpec| Model::clamp_width_on_mesh_m(&spec.scene).ok();
        let record = end.result.ok();
        let start = CoarseStart {
            elements: self.coarse.scene.pin.elements,
            outcome: record.as_ref().map(|record| record.outcome),
            only_compared: !self.spec.starts_in_motion(),
            regime: record.as_ref().map(|record| record.regime),
            same_clamp: width_m(&self.coarse)
                .zip(width_m(&self.spec))
                .map(|(coarse, own)| is_same_width(coarse, own)),
            simulated_s: record.as_ref().map_or(0.0, |record| record.simulated_s),
            modes: if self.spec.has_run() { Vec::new() } else { modes(record.as_ref()) },
            mu_star: record.as_ref().map(|record| record.mu_star),
            frequency_hz: record.as_ref().and_then(|record| record.frequency_hz),
            start: record.and_then(|record| record.start).map(Box::new),
        };
        let motion = end.motion.filter(|_| start.is_used()).map(|motion| motion.interpolated(&from, &to));
        let beginning = Beginning { motion: self.continued.or(motion), start: Some(start) };
        Prepared::GoesOn(Box::new(Ready { ticket: end.ticket, spec: self.spec, beginning }))
    }
}

fn modes(record: Option<&JobRecord>) -> Vec<ComplexMode> {
    let stability = record.and_then(|record| record.stability.as_ref());
    stability.map_or_else(Vec::new, |stability| stability.modes.clone())
}
