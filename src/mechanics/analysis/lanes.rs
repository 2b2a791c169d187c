//! Jobs advanced together, one in each lane.
//!
//! The jobs share a model and nothing else. A job's result has the same bits in any lane, with any companions
//! and for any number of lanes. The jobs need not begin together. A lane whose job has ended is at rest. It
//! costs as much as before, because its slots in the vectors remain. It can receive another job whenever the
//! lanes are between two audits.

use super::checkpoint::{self, Unreadable};
use super::drive::{IDLE, drive, follow};
use super::error::{JobError, step_count};
use super::lane::LaneAnalysis;
use super::nested::{Beginning, under_way};
use super::noted::Noted;
use super::record::{JobRecord, Outcome};
use super::sample::{NodeSample, Sample, Sampler};
use crate::solver::body::pin::History;
use crate::solver::energy::{Energies, EnergyLedger};
use crate::solver::lane::LaneState;
use crate::solver::{Drive, Model, PinMotion, RunNumber, StateOf, guard, step_of_lanes};
use crate::spec::{JobSpec, Precision, Program};
use std::sync::Arc;

/// Steps between two evaluations of the stored energies and of the divergence guard. Jobs begin only at these
/// times.
///
/// An evaluation costs two products with K, so with 16 steps all of them cost an eighth of a run. The
/// damping's work is sampled at the same steps: about four times per period of the fastest mode that damping
/// does not suppress.
pub const AUDIT_INTERVAL: u64 = 16;

/// Up to `L` jobs of one model, with fields of the number type `R`.
pub struct LanesOf<const L: usize, R: RunNumber> {
    model: Arc<Model>,
    state: StateOf<L, R>,
    ledger: EnergyLedger<L, R>,
    sampler: Sampler<L, R>,
    drives: [Drive; L],
    runs: [Option<Run>; L],
}

/// Lanes of one model, whatever their number and their precision.
pub trait AnyLanes: Send {
    /// The model that the lanes share.
    fn model(&self) -> &Model;

    /// Number of lanes.
    fn lanes(&self) -> usize;

    /// Number of jobs.
    fn jobs(&self) -> usize;

    /// The first lane without a job, if there is one.
    fn free_lane(&self) -> Option<usize>;

    /// Other lanes of the same model, 1, 2, 4 or 8, without a job and at the same step.
    fn empty_lanes(&self, lanes: usize) -> Box<dyn AnyLanes>;

    /// Takes the job out of a lane at any point of its run, and brings the lane to rest; returns `None` if there is no job.
    fn leave(&mut self, lane: usize) -> Option<LaneJob>;

    /// Puts a job into a lane. The job comes from lanes of the same model at the same step.
    ///
    /// # Panics
    /// If the lane has a job.
    fn join(&mut self, lane: usize, job: LaneJob);

    /// Puts a job into a lane, as [`LanesOf::begin`], from what it begins with.
    ///
    /// # Errors
    /// As [`LanesOf::begin`].
    ///
    /// # Panics
    /// As [`LanesOf::begin`], and if the motion is not one of the lanes' mesh.
    fn begin_from(
        &mut self,
        lane: usize,
        ticket: u64,
        spec: JobSpec,
        beginning: Beginning,
    ) -> Result<(), JobError>;

    /// Adds the eigenvalues that were computed before its run to the record of the job in a lane.
    fn note(&mut self, lane: usize, noted: Noted);

    /// Continues a job in a lane from its [`AnyLanes::checkpoint`]. The result has the same bits as that of an
    /// uninterrupted run.
    ///
    /// # Errors
    /// [`Unreadable`]. The lane is unchanged then.
    ///
    /// # Panics
    /// As [`LanesOf::begin`], and if [`LanesOf::begin`] returns an error.
    fn resume(&mut self, lane: usize, ticket: u64, spec: JobSpec, bytes: &[u8]) -> Result<(), Unreadable>;

    /// The checkpoint of a job; none if there is no such job.
    fn checkpoint(&self, ticket: u64) -> Option<Vec<u8>>;

    /// Simulated time \[s\] of every job, by its ticket. That on a coarser mesh counts by its cost.
    fn simulated(&self) -> Vec<(u64, f64)>;

    /// Advances all jobs until just before the next audit, and returns those that ended on the way. Calls
    /// `observe` after every step of every job.
    fn advance(&mut self, observe: &mut dyn FnMut(&Moment<'_>)) -> Vec<Ended>;
}

/// One lane without a job.
pub fn one_lane(model: Model, precision: Precision) -> Box<dyn AnyLanes> {
    let model = Arc::new(model);
    match precision {
        Precision::Double => Box::new(LanesOf::<1, f64>::new(model)),
        Precision::Single => Box::new(LanesOf::<1, f32>::new(model)),
    }
}

/// A job on its way from one lane to another.
pub struct LaneJob {
    numbers: Vec<f64>,
    drive: Drive,
    run: Run,
}

/// Moves all jobs to other lanes of the same model, 1, 2, 4 or 8, at any point of their runs.
///
/// # Panics
/// If there are more jobs than lanes.
pub fn moved(from: &mut dyn AnyLanes, lanes: usize) -> Box<dyn AnyLanes> {
    let mut to = from.empty_lanes(lanes);
    let jobs: Vec<_> = (0..from.lanes()).filter_map(|lane| from.leave(lane)).collect();
    assert!(jobs.len() <= lanes, "{} jobs do not fit into {lanes} lanes", jobs.len());
    jobs.into_iter().enumerate().for_each(|(lane, job)| to.join(lane, job));
    to
}

/// The job in a lane.
struct Run {
    ticket: u64,
    steps: u64,
    stop_early: bool,
    /// How speed and load change in time; none if they are constant.
    program: Option<Program>,
    analysis: Box<LaneAnalysis>,
}

/// The data of a job after a step, for observers.
pub struct Moment<'a> {
    /// The number by which the job's owner identifies it.
    pub ticket: u64,
    /// The lane of the job.
    pub lane: usize,
    /// Totals and extremes of the step.
    pub sample: &'a Sample,
    /// The model that the lanes share.
    pub model: &'a Model,
    /// The nodes after the step.
    pub nodes: &'a dyn Nodes,
    /// The energies at the last audit.
    pub energies: &'a Energies,
}

/// The nodes of one job after a step, in either precision.
pub trait Nodes {
    /// A slave node during the step.
    fn slave(&self, slave: usize) -> NodeSample;
    /// Displacements \[m\] in the order node → component.
    fn u_m(&self) -> Vec<f64>;
    /// Velocities \[m/s\] over the step, in the same order.
    fn velocity_m_s(&self) -> Vec<f64>;
    /// What the elements of the pin keep of their past.
    fn history(&self) -> History<1, f64>;
    /// The gain of the stress smoothers, 1 − exp(−Δt/τ).
    fn stress_gain(&self) -> f64;
}

struct NodesOfLane<'a, const L: usize, R: RunNumber> {
    lanes: &'a LanesOf<L, R>,
    lane: usize,
}

impl<const L: usize, R: RunNumber> Nodes for NodesOfLane<'_, L, R> {
    fn slave(&self, slave: usize) -> NodeSample {
        let LanesOf { model, state, sampler, drives, .. } = self.lanes;
        sampler.node(slave, model, &drives[self.lane], state, self.lane)
    }

    fn u_m(&self) -> Vec<f64> {
        self.lanes.state.u.values().skip(self.lane).step_by(L).collect()
    }

    fn velocity_m_s(&self) -> Vec<f64> {
        self.lanes.state.p.values().skip(self.lane).step_by(L).collect()
    }

    fn history(&self) -> History<1, f64> {
        self.lanes.state.history.of_lane(self.lane)
    }

    fn stress_gain(&self) -> f64 {
        self.lanes.sampler.gain()
    }
}

/// A job that has ended.
#[derive(Debug)]
pub struct Ended {
    /// The number by which the job's owner identifies it.
    pub ticket: u64,
    /// The job's record, or the reason why it has none.
    pub result: Result<JobRecord, JobError>,
    /// The motion at its end, if that was a limit cycle or if other jobs may continue it.
    pub motion: Option<PinMotion>,
}

impl<const L: usize, R: RunNumber> LanesOf<L, R> {
    /// Empty lanes.
    pub fn new(model: Arc<Model>) -> Self {
        Self {
            state: StateOf::lanes_at_rest(&model),
            ledger: EnergyLedger::of_lanes(&model, AUDIT_INTERVAL),
            sampler: Sampler::new(&model),
            drives: [IDLE; L],
            runs: std::array::from_fn(|_| None),
            model,
        }
    }

    /// Lanes without a job whose next step has this number.
    fn empty_at(model: &Arc<Model>, step: u64) -> Box<dyn AnyLanes> {
        let mut lanes = Self::new(Arc::clone(model));
        lanes.state.step = step;
        Box::new(lanes)
    }

    /// Puts a job into a lane. Its specification has been checked, and its model is that of the lanes.
    ///
    /// # Errors
    /// [`JobError::TooManySteps`].
    ///
    /// # Panics
    /// If the lane has a job.
    pub fn begin(&mut self, lane: usize, ticket: u64, spec: JobSpec) -> Result<(), JobError> {
        assert!(self.runs[lane].is_none(), "lane {lane} has a job");
        let steps = step_count(spec.run.limit_s, self.model.time_step_s())?;
        // A free lane is at rest.
        self.state.begun[lane] = self.state.step;
        self.drives[lane] = drive(&spec);
        let stop_early = spec.run.stop_early;
        let program = (!spec.scene.program.is_constant()).then(|| spec.scene.program.clone());
        let analysis = Box::new(LaneAnalysis::new(&self.model, spec));
        self.runs[lane] = Some(Run { ticket, steps, stop_early, program, analysis });
        Ok(())
    }

    /// The numbers that describe a lane, at any point of its job's run.
    fn save(&self, lane: usize) -> Vec<f64> {
        let mut saved = Vec::new();
        self.state.save_lane(lane, &mut saved);
        self.ledger.save_lane(lane, &mut saved);
        self.sampler.save_lane(lane, &mut saved);
        saved
    }

    /// Sets the numbers that describe a lane, in the order of [`Self::save`].
    fn load(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        self.state.load_lane(lane, saved);
        self.ledger.load_lane(lane, saved);
        self.sampler.load_lane(lane, saved);
    }

    /// Brings a lane to rest: all its numbers are zero.
    fn clear(&mut self, lane: usize) {
        self.load(lane, &mut std::iter::repeat(0.0));
        self.drives[lane] = IDLE;
    }

    /// Gives the lanes whose jobs have a program the speed and the load of the coming step.
    fn follow_programs(&mut self) {
        let dt = self.model.time_step_s();
        for lane in 0..L {
            if let Some(Run { program: Some(program), .. }) = &self.runs[lane] {
                let time_s = self.state.steps_done(lane) as f64 * dt;
                follow(program, &mut self.drives[lane], time_s, dt);
            }
        }
    }

    /// The result of the job in a lane, if it has just ended.
    fn result(&self, lane: usize, audited: bool) -> Option<Result<JobRecord, JobError>> {
        let run = self.runs[lane].as_ref()?;
        let energies = self.ledger.energies(lane);
        if audited
            && let Err(error) = guard::check(&self.model, &self.drives[lane], &self.state, lane, energies)
        {
            return Some(Err(error.into()));
        }
        if let Err(error) = guard::check_contact(&self.model, &self.state, lane) {
            return Some(Err(error.into()));
        }
        if let Err(error) = guard::check_step(&self.model, &self.state, lane) {
            return Some(Err(error.into()));
        }
        let steps = self.state.steps_done(lane);
        let settled = audited && run.stop_early && run.analysis.is_settled();
        if steps < run.steps && !settled {
            return None;
        }
        if let Err(error) = guard::check_finite(&self.model, &self.state, lane) {
            return Some(Err(error.into()));
        }
        let history = self.state.history.numbers();
        let plastic = self.model.pin().operator().plastic_totals(history, lane, L);
        let solves = self.state.target.solves_of(lane);
        let record = run.analysis.record(&self.model, steps, energies, solves, plastic);
        Some(match record.non_finite_number() {
            None => Ok(record),
            Some(figure) => Err(JobError::NotFinite { figure }),
        })
    }
}

impl<const L: usize, R: RunNumber> AnyLanes for LanesOf<L, R> {
    fn model(&self) -> &Model {
        &self.model
    }
    fn lanes(&self) -> usize {
        L
    }
    fn free_lane(&self) -> Option<usize> {
        self.runs.iter().position(Option::is_none)
    }
    fn jobs(&self) -> usize {
        self.runs.iter().flatten().count()
    }
    fn empty_lanes(&self, lanes: usize) -> Box<dyn AnyLanes> {
        let new = match lanes {
            1 => LanesOf::<1, R>::empty_at,
            2 => LanesOf::<2, R>::empty_at,
            4 => LanesOf::<4, R>::empty_at,
            _ => LanesOf::<8, R>::empty_at,
        };
        new(&self.model, self.state.step)
    }
    fn leave(&mut self, lane: usize) -> Option<LaneJob> {
        let run = self.runs[lane].take()?;
        let job = LaneJob { numbers: self.save(lane), drive: self.drives[lane], run };
        self.clear(lane);
        Some(job)
    }
    fn join(&mut self, lane: usize, job: LaneJob) {
        assert!(self.runs[lane].is_none(), "lane {lane} has a job");
        self.load(lane, &mut job.numbers.into_iter());
        self.drives[lane] = job.drive;
        self.runs[lane] = Some(job.run);
    }

    fn begin_from(
        &mut self,
        lane: usize,
        ticket: u64,
        spec: JobSpec,
        beginning: Beginning,
    ) -> Result<(), JobError> {
        let Beginning { motion, start } = beginning;
        self.begin(lane, ticket, under_way(spec, start.as_ref()))?;
        if let Some(motion) = motion {
            self.state.begin_in_motion(&self.model, lane, &motion);
        }
        if let Some(run) = &mut self.runs[lane] {
            run.analysis.start_from(start);
        }
        Ok(())
    }
    fn note(&mut self, lane: usize, noted: Noted) {
        if let Some(run) = &mut self.runs[lane] {
            run.analysis.note(noted);
        }
    }
    fn resume(&mut self, lane: usize, ticket: u64, spec: JobSpec, bytes: &[u8]) -> Result<(), Unreadable> {
        let (numbers, analysis) = checkpoint::decode(bytes, self.save(lane).len())?;
        let spec = under_way(spec, analysis.start());
        self.begin(lane, ticket, spec.clone()).expect("a job that has begun before");
        self.load(lane, &mut numbers.into_iter());
        if let Some(run) = &mut self.runs[lane] {
            *run.analysis = analysis.of(spec);
        }
        Ok(())
    }
    fn checkpoint(&self, ticket: u64) -> Option<Vec<u8>> {
        let lane = self.runs.iter().position(|run| run.as_ref().is_some_and(|run| run.ticket == ticket))?;
        let analysis = &self.runs[lane].as_ref()?.analysis;
        Some(checkpoint::encode(&self.save(lane), analysis))
    }
    fn simulated(&self) -> Vec<(u64, f64)> {
        let dt = self.model.time_step_s();
        let runs = self.runs.iter().enumerate();
        let all = runs.filter_map(|(lane, run)| {
            let run = run.as_ref()?;
            let spent_s = run.analysis.spent_s();
            Some((run.ticket, spent_s + self.state.steps_done(lane) as f64 * dt))
        });
        all.collect()
    }
    fn advance(&mut self, observe: &mut dyn FnMut(&Moment<'_>)) -> Vec<Ended> {
        let mut ended = Vec::new();
        loop {
            let audited = self.ledger.audits(self.state.step);
            self.ledger.before_step_of_lanes(&self.model, &self.state);
            self.follow_programs();
            step_of_lanes(&self.model, &self.drives, &mut self.state);
            self.ledger.after_step_of_lanes(&self.model, &self.drives, &self.state);
            let samples = self.sampler.sample(&self.model, &self.drives, &self.state);
            for lane in 0..L {
                if let Some(run) = &mut self.runs[lane] {
                    run.analysis.push(&samples[lane], self.ledger.energies(lane));
                    observe(&Moment {
                        ticket: run.ticket,
                        lane,
                        sample: &samples[lane],
                        model: &self.model,
                        nodes: &NodesOfLane { lanes: self, lane },
                        energies: self.ledger.energies(lane),
                    });
                    if let Some(result) = self.result(lane, audited) {
                        let is_periodic =
                            result.as_ref().is_ok_and(|record| record.outcome == Outcome::Periodic);
                        let can_be_continued =
                            self.runs[lane].as_ref().is_some_and(|run| run.analysis.can_be_continued());
                        let keeps_motion = is_periodic || can_be_continued && result.is_ok();
                        let motion = keeps_motion.then(|| self.state.motion_of(&self.model, lane));
                        let run = self.runs[lane].take();
                        ended.extend(run.map(|run| Ended { ticket: run.ticket, result, motion }));
                        self.clear(lane);
                    }
                }
            }
            if self.ledger.audits(self.state.step) {
                return ended;
            }
        }
    }
}
