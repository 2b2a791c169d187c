//! The solver threads.
//!
//! A thread without work requests a job. With the job begins a [`BatchRunner`]: it fills its lanes with other jobs of
//! the batch, and requests more whenever one ends.

use super::batch_runner::BatchRunner;
use super::channel::{Assignment, Report, WorkerChannel};
use super::interrupt::Interrupt;
use super::job::ParsedJob;
use super::options::WorkOptions;
use crate::analysis::Structures;
use std::sync::mpsc::{Sender, channel};
use tokio::sync::mpsc::UnboundedSender;

/// The threads and the channels to them.
pub struct Executor {
    // Dropped first: the threads end when their channels close.
    replies: Vec<Sender<Vec<Assignment>>>,
    _pool: rayon::ThreadPool,
}

impl Executor {
    /// Starts threads that send their reports to `reports`.
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub fn new(
        options: WorkOptions,
        reports: &UnboundedSender<Report>,
        interrupt: &Interrupt,
    ) -> Result<Self, rayon::ThreadPoolBuildError> {
        let WorkOptions { threads, checkpoint_interval, job_key, .. } = options;
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("solver-{i}"))
            .build()?;
        let stop = interrupt.clone();
        let structures = Structures::stopped_when(move || stop.is_raised());
        let replies = (0..threads).map(|thread| {
            let (sender, replies) = channel();
            let channel = WorkerChannel {
                thread,
                replies,
                reports: reports.clone(),
                interrupt: interrupt.clone(),
                checkpoint_interval,
                job_key,
                structures: structures.clone(),
            };
            pool.spawn(move || run_jobs(&channel));
            sender
        });
        Ok(Self { replies: replies.collect(), _pool: pool })
    }

    /// Answers a thread's request.
    pub fn reply(&self, thread: usize, jobs: Vec<Assignment>) {
        // A thread lives as long as its channel is open.
        let _ = self.replies[thread].send(jobs);
    }
}

/// The life of a thread: it runs jobs until the dispatcher ends.
fn run_jobs(channel: &WorkerChannel) {
    loop {
        channel.request(None, 1);
        let Ok(assignments) = channel.wait_for_reply() else { return };
        let mut jobs: Vec<_> =
            assignments.into_iter().filter_map(|assignment| ParsedJob::parse(assignment, channel)).collect();
        // A runner returns the jobs that do not match its batch.
        while let Some(first) = jobs.pop() {
            jobs.extend(BatchRunner::run(channel, first));
        }
    }
}
