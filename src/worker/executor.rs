//! Runs claimed jobs on a rayon pool and reports each one's end.

use super::interrupt::Interrupt;
use crate::analysis::{self, JobError, JobObserver};
use crate::queue::{ClaimedJob, Finished, FinishedOutcome};
use crate::spec::JobSpec;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;
use tokio::sync::mpsc::UnboundedSender;

/// How far a running job is.
#[derive(Debug, Default)]
pub struct JobClock {
    simulated_ns: AtomicU64,
}

impl JobClock {
    /// Simulated time [s].
    pub fn simulated_s(&self) -> f64 {
        self.simulated_ns.load(Ordering::Relaxed) as f64 * 1e-9
    }
}

/// The pool and the way back to the dispatcher.
pub struct Executor {
    pool: rayon::ThreadPool,
    results: UnboundedSender<Finished>,
    interrupt: Interrupt,
}

impl Executor {
    /// A pool of `threads` whose finished jobs go to `results`.
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub fn new(
        threads: usize,
        results: UnboundedSender<Finished>,
        interrupt: Interrupt,
    ) -> Result<Self, rayon::ThreadPoolBuildError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("solver-{i}"))
            .build()?;
        Ok(Self { pool, results, interrupt })
    }

    /// Starts a claimed job.
    pub fn start(&self, job: ClaimedJob) -> Arc<JobClock> {
        let clock = Arc::new(JobClock::default());
        let observed = Watch { clock: Arc::clone(&clock), interrupt: self.interrupt.clone() };
        let results = self.results.clone();
        self.pool.spawn(move || {
            let begun = Instant::now();
            let outcome = run(&job.payload, observed);
            let wall_s = begun.elapsed().as_secs_f64();
            // The dispatcher outlives its jobs; if it is gone, the process is ending and so is the claim.
            let _ = results.send(Finished { key: job.key, attempt: job.attempt, outcome, wall_s });
        });
        clock
    }
}

/// Solves one payload. A panic is a bug, but it must not take the sweep with it.
fn run(payload: &str, observer: Watch) -> FinishedOutcome {
    let solved = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| solve(payload, observer)));
    match solved {
        Ok(outcome) => outcome,
        Err(panic) => {
            let message = panic
                .downcast_ref::<String>()
                .map(String::as_str)
                .or_else(|| panic.downcast_ref::<&str>().copied())
                .unwrap_or("no message");
            FinishedOutcome::Failed { error: format!("internal error (please report it): {message}") }
        }
    }
}

fn solve(payload: &str, mut observer: Watch) -> FinishedOutcome {
    let spec: JobSpec = match serde_json::from_str(payload) {
        Ok(spec) => spec,
        Err(error) => return FinishedOutcome::Failed { error: format!("unreadable job: {error}") },
    };
    match analysis::solve(&spec, &mut observer) {
        Ok(record) => match serde_json::to_string(&record) {
            Ok(record) => FinishedOutcome::Done { record },
            Err(error) => FinishedOutcome::Failed { error: format!("unwritable record: {error}") },
        },
        Err(JobError::Interrupted) => FinishedOutcome::Released,
        Err(error) => FinishedOutcome::Failed { error: error.to_string() },
    }
}

/// Lets a job tell its time and hear the interrupt.
struct Watch {
    clock: Arc<JobClock>,
    interrupt: Interrupt,
}

impl JobObserver for Watch {
    fn progress(&mut self, simulated_s: f64) -> ControlFlow<()> {
        self.clock.simulated_ns.store((simulated_s * 1e9) as u64, Ordering::Relaxed);
        if self.interrupt.is_raised() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
