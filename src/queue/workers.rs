use super::engine::{columns, query};
use super::error::QueueError;
use super::handle::Queue;
use super::owner::{Liveness, Owner};
use serde::Serialize;

/// A worker that is active, or that was lost while it held jobs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorkerStatus {
    /// The machine's name.
    pub host: String,
    /// The process number on that machine.
    #[serde(rename = "process")]
    pub pid: u32,
    /// How many threads it has.
    pub threads: u64,
    /// Whether it is active.
    pub presence: WorkerPresence,
    /// Jobs that it runs.
    pub running: u64,
    /// Jobs that it had finished at its last heartbeat.
    pub finished: u64,
    /// Jobs that it finished per second, in the ten minutes before its last heartbeat.
    pub jobs_per_s: Option<f64>,
    /// Jobs that were taken back from it.
    pub taken_back: u64,
    /// When it began, in milliseconds since 1970-01-01 UTC.
    pub started_ms: i64,
    /// How long ago its last heartbeat was, in milliseconds.
    pub silent_ms: i64,
}

/// Whether a worker is active.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WorkerPresence {
    /// It is active.
    Working,
    /// It is active and has been asked to stop.
    Stopping,
    /// Its process is stopped (Ctrl-Z, SIGSTOP): it keeps its jobs until it continues or ends.
    Stopped,
    /// Its process has ended, or it has sent no heartbeat for longer than its lease.
    #[serde(rename = "lost")]
    Gone,
}

/// How many workers are active.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ActiveWorkers {
    /// The number of workers.
    pub workers: u64,
    /// The sum of their threads.
    pub threads: u64,
}

const WORKERS: &str = "
    SELECT id, host, pid, threads, finished, jobs_per_s, taken_back, started_ms, heartbeat_ms
    FROM workers WHERE ended_ms IS NULL OR taken_back > 0 ORDER BY id";

const RUNNING: &str = "
    SELECT owner, COUNT(*) FROM jobs WHERE state = 'running' GROUP BY owner";

columns! {
    struct WorkerColumns {
        id: i64,
        host: String,
        pid: i64,
        threads: i64,
        finished: i64,
        jobs_per_s: Option<f64>,
        taken_back: i64,
        started_ms: i64,
        heartbeat_ms: i64,
    }
}

impl Queue {
    /// The active workers and those from which jobs were taken back. The one that registered first comes first.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn workers(&mut self) -> Result<Vec<WorkerStatus>, QueueError> {
        let owners = self.owners().await?;
        let now_ms = self.now_ms().await?;
        let running: Vec<(i64, i64)> = query(RUNNING).all(&mut self.connection).await?;
        let workers: Vec<WorkerColumns> = query(WORKERS).all(&mut self.connection).await?;
        let status = |worker: WorkerColumns| {
            let owner = owners.iter().find(|owner| owner.id == worker.id);
            let own_jobs = running.iter().find(|(owner, _)| *owner == worker.id);
            WorkerStatus {
                host: worker.host,
                pid: worker.pid.unsigned_abs() as u32,
                threads: worker.threads.unsigned_abs(),
                presence: owner.map_or(WorkerPresence::Gone, |owner| owner.presence(now_ms)),
                running: own_jobs.map_or(0, |(_, jobs)| jobs.unsigned_abs()),
                finished: worker.finished.unsigned_abs(),
                jobs_per_s: worker.jobs_per_s,
                taken_back: worker.taken_back.unsigned_abs(),
                started_ms: worker.started_ms,
                silent_ms: now_ms.saturating_sub(worker.heartbeat_ms),
            }
        };
        Ok(workers.into_iter().map(status).collect())
    }

    /// What to do about workers that are stopped and hold jobs, a sentence each.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn stopped_workers(&mut self) -> Result<Vec<String>, QueueError> {
        Ok(self.workers().await?.iter().filter_map(WorkerStatus::advice).collect())
    }

    /// Counts the active workers that have not been asked to stop. A worker whose process is not visible from here is
    /// active if its last heartbeat is not older than its lease.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn active_workers(&mut self) -> Result<ActiveWorkers, QueueError> {
        let owners = self.owners().await?;
        let now_ms = self.now_ms().await?;
        let active = owners.iter().filter(|owner| owner.presence(now_ms) == WorkerPresence::Working);
        Ok(active.fold(ActiveWorkers::default(), |sum, owner| ActiveWorkers {
            workers: sum.workers + 1,
            threads: sum.threads + owner.threads.unsigned_abs(),
        }))
    }
}

impl WorkerStatus {
    /// What to do about a worker that is stopped and holds jobs, in a sentence; none of others.
    ///
    /// The time is in minutes, so that a line about it is not written again and again.
    pub fn advice(&self) -> Option<String> {
        if self.presence != WorkerPresence::Stopped || self.running == 0 {
            return None;
        }
        let Self { pid, running, .. } = self;
        let minutes = self.silent_ms / 60_000;
        let since =
            if minutes < 1 { "for less than a minute".to_owned() } else { format!("for {minutes} min") };
        let jobs = if *running == 1 { "1 job".to_owned() } else { format!("{running} jobs") };
        Some(format!(
            "process {pid} has been stopped {since} and holds {jobs}: continue it (`kill -CONT {pid}`) or end it \
             (`kill {pid}; kill -CONT {pid}`)"
        ))
    }
}

impl Owner {
    fn presence(&self, now_ms: i64) -> WorkerPresence {
        let is_active = match self.liveness() {
            Liveness::Alive => true,
            Liveness::Gone => false,
            Liveness::Unknown => !self.is_silent(now_ms),
        };
        match (is_active, self.is_stopping()) {
            (false, _) => WorkerPresence::Gone,
            (true, _) if self.is_stopped() => WorkerPresence::Stopped,
            (true, true) => WorkerPresence::Stopping,
            (true, false) => WorkerPresence::Working,
        }
    }
}
