//! What a study takes, before it runs: time here, memory, disk.
//!
//! ```text
//! Plan (workloads) ─┐
//! states of jobs ───┼─► Forecast
//! Speed ────────────┘
//! ```

mod clamps;
mod memory;
mod speed;
mod time;

pub use clamps::OtherClamps;
pub use speed::Speed;
pub use time::TimeRange;

use super::error::SweepError;
use super::plan::Plan;
use crate::analysis::{Ending, Workload, earliest_end};
use crate::queue::{JobState, Queue};
use crate::spec::{Precision, StabilityMethod};
use crate::study::Job;
use indexmap::IndexMap;
use memory::memory_here_bytes;
use serde::Serialize;
use std::collections::HashMap;
use std::time::Duration;
use time::{Tasks, per_cost_s};

/// What a study takes.
#[derive(Debug, Clone, Serialize)]
pub struct Forecast {
    /// Number of jobs.
    pub jobs: usize,
    /// The states of the jobs that the database has; `None` without a database.
    #[serde(rename = "database")]
    pub known: Option<Known>,
    /// The jobs by mesh and time step, those that take longest first.
    pub groups: Vec<Group>,
    /// Number of threads.
    pub threads: usize,
    /// The time for the jobs that are left; `None` if none is left, or if modes are left.
    #[serde(rename = "time_s")]
    pub time: Option<TimeRange>,
    /// Whether modes without a run are left. How long they take is not forecast: it depends on what is in contact and, on an elastic
    /// disk, on the factors of a sparse matrix.
    pub has_modes_left: bool,
    /// What the time is based on.
    pub speed: Speed,
    /// Memory \[byte\] of the process at its largest, with one batch on each thread.
    pub memory_bytes: f64,
    /// The memory \[byte\] of this machine, if it is known.
    pub memory_here_bytes: Option<u64>,
    /// Disk space \[byte\] that the database grows by.
    pub results_bytes: f64,
    /// The jobs that are left and whose mesh error stays unknown because of their clamp; `None` if there are none.
    pub other_clamps: Option<OtherClamps>,
    /// Disk space \[byte\] of the states of running jobs, if they run so long that they are stored; otherwise 0.
    pub checkpoints_bytes: f64,
}

/// Jobs that the database has, by state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Known {
    /// Jobs that are done.
    pub done: usize,
    /// Jobs that have failed.
    pub failed: usize,
    /// Jobs that are pending or running.
    pub open: usize,
}

/// Jobs with the same mesh, precision and time step.
#[derive(Debug, Clone, Serialize)]
pub struct Group {
    /// What they take.
    #[serde(flatten)]
    pub workload: Workload,
    /// Number of jobs, done or not.
    pub jobs: usize,
    /// Longest time limit \[s\] of the jobs.
    pub limit_s: f64,
    /// Number of steps up to that limit.
    pub steps: u64,
    /// Number of jobs that a thread advances together.
    #[serde(rename = "jobs_together")]
    pub together: usize,
    /// Memory \[byte\] of a thread that advances them.
    #[serde(rename = "thread_memory_bytes")]
    pub memory_bytes: f64,
    /// Memory \[byte\] that their complex modes take on all threads together; 0 if none are computed.
    #[serde(rename = "modes_memory_bytes")]
    pub modes_bytes: f64,
    /// Their cost up to their limits, in node-steps.
    #[serde(skip)]
    node_steps: f64,
}

/// Memory of the process without jobs \[byte\], and while it writes the report.
const PROCESS_BYTES: f64 = 12.0e6;

/// Disk space of a new database, and of each job in it with its result \[byte\].
const DATABASE_BYTES: [f64; 2] = [90.0e3, 3.8e3];

/// Jobs that take longer than this store their states: two intervals of checkpoints.
const LONG_JOB: Duration = Duration::from_mins(2);

/// The range of seconds of a thread per unit of a job's cost, at the speed of the finished jobs in a database.
///
/// # Errors
/// If the database cannot be read.
pub async fn expected_s_per_cost(queue: &mut Queue) -> Result<[f64; 2], SweepError> {
    Ok(per_cost_s(Speed::read(queue).await?))
}

impl Known {
    fn count(jobs: &[Job], states: &HashMap<String, JobState>) -> Self {
        let mut known = Self::default();
        for job in jobs {
            match states.get(&job.key) {
                Some(JobState::Done) => known.done += 1,
                Some(JobState::Failed) => known.failed += 1,
                Some(JobState::Pending | JobState::Running) => known.open += 1,
                Some(JobState::Cancelled) | None => {}
            }
        }
        known
    }
}

impl Forecast {
    /// What `plan` takes on this machine with so many threads. Jobs that are done or have failed in the database `queue` are
    /// not run again. Its finished jobs give the speed.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn new(plan: &Plan, queue: Option<&mut Queue>, threads: usize) -> Result<Self, SweepError> {
        let (states, speed) = match queue {
            None => (None, Speed::TYPICAL),
            Some(queue) => {
                let keys: Vec<&str> = plan.jobs().iter().map(|job| job.key.as_str()).collect();
                (Some(queue.states(&keys).await?), Speed::read(queue).await?)
            }
        };
        let is_left = |job: &Job| {
            let state = states.as_ref().and_then(|states| states.get(&job.key));
            !matches!(state, Some(JobState::Done | JobState::Failed))
        };
        let mut tasks = Tasks::default();
        let mut left = 0;
        let mut has_modes_left = false;
        for (job, workload) in plan.jobs().iter().zip(plan.workloads()) {
            if is_left(job) {
                left += 1;
                has_modes_left |= !job.spec.has_run();
                let earliest = earliest_end(&job.spec).and_then(|spec| Workload::estimate(&spec).ok());
                tasks.add(workload, earliest.as_ref().unwrap_or(workload), Ending::of(&job.spec));
            }
        }
        let threads = threads.min(plan.jobs().len()).max(1);
        let time = tasks.time(threads, speed).filter(|_| !has_modes_left);
        let groups = groups(plan, threads);
        let running = running(&groups, threads);
        let is_long = time.as_ref().is_some_and(|time| time.longest_job >= LONG_JOB);
        let lanes = |(group, runners): &(&Group, usize)| (group.together * runners) as f64;
        let checkpoints_bytes: f64 =
            running.iter().map(|group| lanes(group) * group.0.workload.checkpoint_bytes()).sum();
        let [empty, each] = DATABASE_BYTES;
        let memory_bytes: f64 = running
            .iter()
            .map(|(group, runners)| group.memory_bytes * *runners as f64 + group.modes_bytes)
            .sum();
        Ok(Self {
            jobs: plan.jobs().len(),
            known: states.as_ref().map(|states| Known::count(plan.jobs(), states)),
            results_bytes: if states.is_none() { empty } else { 0.0 } + each * f64::from(left),
            checkpoints_bytes: if is_long { checkpoints_bytes } else { 0.0 },
            memory_bytes: PROCESS_BYTES + memory_bytes,
            memory_here_bytes: memory_here_bytes(),
            other_clamps: OtherClamps::of(plan.jobs().iter().filter(|job| is_left(job))),
            groups,
            threads,
            time,
            has_modes_left,
            speed,
        })
    }

    /// Whether the jobs need more memory than this machine has.
    pub fn exceeds_memory(&self) -> bool {
        self.memory_here_bytes.is_some_and(|here| self.memory_bytes > here as f64)
    }
}

/// The jobs by mesh, precision and time step. Steps that agree in three digits count as the same.
fn groups(plan: &Plan, threads: usize) -> Vec<Group> {
    type Key = ([usize; 3], Precision, usize, String, String);
    // With the longest observation [s] of its jobs.
    let mut groups: IndexMap<Key, (Group, f64)> = IndexMap::new();
    for (job, workload) in plan.jobs().iter().zip(plan.workloads()) {
        let [step, limit] =
            [workload.time_step_s, workload.time_step_limit_s].map(|seconds| format!("{seconds:.2e}"));
        let key = (workload.elements, workload.precision, workload.disk_nodes, step, limit);
        let empty = || Group {
            workload: workload.clone(),
            jobs: 0,
            limit_s: 0.0,
            steps: 0,
            together: 1,
            memory_bytes: 0.0,
            modes_bytes: 0.0,
            node_steps: 0.0,
        };
        let (group, observation_s) = groups.entry(key).or_insert_with(|| (empty(), 0.0));
        group.jobs += 1;
        group.limit_s = group.limit_s.max(job.spec.run.limit_s);
        group.node_steps += workload.node_steps(job.spec.run.limit_s);
        let spares_runs = job.spec.eigenvalues_may_decide();
        if job.spec.stability == StabilityMethod::Modes
            || (job.spec.stability == StabilityMethod::Eigenvalues && spares_runs)
        {
            group.modes_bytes = workload.modes_bytes();
        }
        // Nothing is observed after the end of the run.
        *observation_s = observation_s.max(job.spec.observation_s().min(job.spec.run.limit_s));
    }
    let finished = |(mut group, observation_s): (Group, f64)| {
        group.together = group.workload.widest().min(group.jobs.div_ceil(threads));
        group.memory_bytes = group.workload.memory_bytes(group.together, observation_s);
        group.steps = group.workload.steps(group.limit_s).unwrap_or(u64::MAX);
        group
    };
    let mut groups: Vec<Group> = groups.into_values().map(finished).collect();
    groups.sort_by(|a, b| b.node_steps.total_cmp(&a.node_steps));
    groups
}

/// The groups that need most memory, and on how many threads they can run at once.
fn running(groups: &[Group], threads: usize) -> Vec<(&Group, usize)> {
    let mut largest: Vec<&Group> = groups.iter().collect();
    let memory_bytes = |group: &Group| group.memory_bytes + group.modes_bytes;
    largest.sort_by(|a, b| memory_bytes(b).total_cmp(&memory_bytes(a)));
    let mut free = threads;
    let mut running = Vec::new();
    for group in largest {
        let runners = group.jobs.div_ceil(group.together).min(free);
        free -= runners;
        if runners > 0 {
            running.push((group, runners));
        }
    }
    running
}
