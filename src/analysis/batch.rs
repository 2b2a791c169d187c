//! Jobs of one model in as many lanes as they need.

use super::checkpoint::Unreadable;
use super::error::JobError;
use super::lanes::{Ended, LanesOf};
use super::record::JobRecord;
use super::stability::{Structures, Verdict, judge};
use super::workload::Workload;
use crate::solver::{Model, RunNumber};
use crate::spec::{JobSpec, Precision};
use std::sync::Arc;

/// Jobs that share a model, advanced together.
///
/// There are 1, 2, 4 or 8 lanes. Their number changes as jobs begin and end, and the jobs then move to other
/// lanes. No job's result depends on this.
pub struct Batch {
    shared: JobSpec,
    widest: usize,
    lanes: AnyLanes,
    structures: Structures,
}

/// What became of a job that was to begin.
#[derive(Debug)]
pub enum Begun {
    /// It runs in a lane.
    Runs,
    /// The eigenvalues of steady sliding decided it, and it takes no lane.
    Decided(Box<JobRecord>),
}

enum AnyLanes {
    Double(LanesIn<f64>),
    Single(LanesIn<f32>),
}

/// Lanes in one precision.
enum LanesIn<R: RunNumber> {
    One(Box<LanesOf<1, R>>),
    Two(Box<LanesOf<2, R>>),
    Four(Box<LanesOf<4, R>>),
    Eight(Box<LanesOf<8, R>>),
}

/// Calls the same method for every number of lanes in one precision.
macro_rules! each_in {
    ($lanes:expr, $of:ident => $call:expr) => {
        match $lanes {
            LanesIn::One($of) => $call,
            LanesIn::Two($of) => $call,
            LanesIn::Four($of) => $call,
            LanesIn::Eight($of) => $call,
        }
    };
}

/// Calls the same method for every number of lanes.
macro_rules! each {
    ($lanes:expr, $of:ident => $call:expr) => {
        match $lanes {
            AnyLanes::Double(lanes) => each_in!(lanes, $of => $call),
            AnyLanes::Single(lanes) => each_in!(lanes, $of => $call),
        }
    };
}

impl AnyLanes {
    fn new(model: Model, precision: Precision) -> Self {
        let model = Arc::new(model);
        match precision {
            Precision::Double => Self::Double(LanesIn::One(Box::new(LanesOf::new(model)))),
            Precision::Single => Self::Single(LanesIn::One(Box::new(LanesOf::new(model)))),
        }
    }

    /// Moves the jobs to this number of lanes.
    fn fit(&mut self, lanes: usize) {
        match self {
            Self::Double(now) => now.fit(lanes),
            Self::Single(now) => now.fit(lanes),
        }
    }
}

impl<R: RunNumber> LanesIn<R> {
    fn fit(&mut self, lanes: usize) {
        if each_in!(self, now => now.lanes()) != lanes {
            *self = each_in!(self, from => Self::taken_over(from, lanes));
        }
    }

    fn taken_over<const L: usize>(from: &mut LanesOf<L, R>, lanes: usize) -> Self {
        match lanes {
            1 => Self::One(Box::new(LanesOf::taken_over(from))),
            2 => Self::Two(Box::new(LanesOf::taken_over(from))),
            4 => Self::Four(Box::new(LanesOf::taken_over(from))),
            _ => Self::Eight(Box::new(LanesOf::taken_over(from))),
        }
    }
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
        Ok(Self {
            shared: spec.shared_part(),
            widest: Workload::of(&model).widest(),
            lanes: AnyLanes::new(model, spec.numerics.precision),
            structures,
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
        each!(&self.lanes, lanes => Workload::of(lanes.model()))
    }

    /// RunNumber of jobs.
    pub fn jobs(&self) -> usize {
        each!(&self.lanes, lanes => lanes.jobs())
    }

    /// Begins a job, unless the eigenvalues of steady sliding decide it at once. Its owner identifies it by `ticket`.
    ///
    /// # Errors
    /// If the specification is not physical or asks for too many steps, or if a job without a run has no eigenvalues.
    ///
    /// # Panics
    /// If the job has another model, or if the batch is full.
    pub fn begin(&mut self, ticket: u64, spec: JobSpec) -> Result<Begun, JobError> {
        spec.check()?;
        assert!(self.takes(&spec), "a job of another model");
        let verdict = each!(&self.lanes, lanes => judge(&spec, lanes.model(), &self.structures))?;
        let stability = match verdict {
            Verdict::Decided(record) => return Ok(Begun::Decided(record)),
            Verdict::Undecided(stability) => stability,
        };
        self.make_room(&spec);
        each!(&mut self.lanes, lanes => {
            let lane = lanes.free_lane().expect("a lane was made");
            lanes.begin(lane, ticket, spec)?;
            if let Some(stability) = stability {
                lanes.note(lane, stability);
            }
        });
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
        self.make_room(&spec);
        each!(&mut self.lanes, lanes => {
            let lane = lanes.free_lane().expect("a lane was made");
            lanes.resume(lane, ticket, spec, checkpoint)
        })
    }

    /// The checkpoint of a job, for [`Batch::resume`] of the same program; none if there is no such job.
    pub fn checkpoint(&self, ticket: u64) -> Option<Vec<u8>> {
        each!(&self.lanes, lanes => lanes.checkpoint(ticket))
    }

    fn make_room(&mut self, spec: &JobSpec) {
        assert!(self.takes(spec), "a job of another model");
        assert!(self.jobs() < self.widest, "no more jobs than the widest");
        if each!(&self.lanes, lanes => lanes.free_lane()).is_none() {
            self.fit(self.jobs() + 1);
        }
    }

    /// Moves the jobs to as few lanes as possible. This is useful when no other job will come.
    pub fn narrow(&mut self) {
        self.fit(self.jobs());
    }

    /// Changes the number of lanes to the smallest that holds `jobs` jobs.
    fn fit(&mut self, jobs: usize) {
        self.lanes.fit(jobs.max(1).next_power_of_two().min(8));
    }

    /// Advances all jobs by a few steps and returns those that ended.
    pub fn advance(&mut self) -> Vec<Ended> {
        each!(&mut self.lanes, lanes => lanes.advance(&mut |_| {}))
    }

    /// Simulated time \[s\] of every job, by its ticket.
    pub fn simulated(&self) -> Vec<(u64, f64)> {
        each!(&self.lanes, lanes => lanes.simulated().collect())
    }
}
