use super::engine::query;
use super::owner::{Owner, Verdict};
use super::{Queue, QueueError};

/// A worker that is there, or that was lost with jobs in hand.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkerStatus {
    /// The machine that it is on.
    pub host: String,
    /// Its process there.
    pub pid: u32,
    /// How many threads it has.
    pub threads: u64,
    /// Whether it is there.
    pub presence: WorkerPresence,
    /// Jobs that it runs.
    pub running: u64,
    /// Jobs that it has finished, by its last sign of life.
    pub finished: u64,
    /// Jobs that it finished a second, in the last ten minutes before that.
    pub jobs_per_s: Option<f64>,
    /// Jobs that were taken back from it.
    pub taken_back: u64,
    /// When it began, in milliseconds since 1970-01-01 UTC.
    pub started_ms: i64,
    /// How long ago its last sign of life was, in milliseconds.
    pub silent_ms: i64,
}

/// Whether a worker is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorkerPresence {
    /// It is.
    Working,
    /// It is, and has been asked to stop.
    Stopping,
    /// It has ended, or has been silent for longer than a lease.
    Gone,
}

/// The workers that are there now, summed up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Alive {
    /// How many they are.
    pub workers: u64,
    /// How many threads they have together.
    pub threads: u64,
}

const LOST: &str = "
    SELECT id, host, pid, threads, finished, jobs_per_s, taken_back, started_ms, heartbeat_ms
    FROM workers WHERE ended_ms IS NULL OR taken_back > 0 ORDER BY id";

const RUNNING: &str = "
    SELECT owner, COUNT(*) FROM jobs WHERE state = 'running' GROUP BY owner";

type Columns = (i64, String, i64, i64, i64, Option<f64>, i64, i64, i64);

impl Queue {
    /// The workers that are there, and those from which jobs were taken back, the earliest first.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn workers(&mut self) -> Result<Vec<WorkerStatus>, QueueError> {
        let owners = self.owners().await?;
        let now_ms = self.now_ms().await?;
        let running: Vec<(i64, i64)> = query(RUNNING).all(&mut self.connection).await?;
        let rows: Vec<Columns> = query(LOST).all(&mut self.connection).await?;
        let status =
            |(id, host, pid, threads, finished, jobs_per_s, taken_back, started_ms, heartbeat_ms)| {
                let owner = owners.iter().find(|owner| owner.id == id);
                WorkerStatus {
                    host,
                    pid: i64::unsigned_abs(pid) as u32,
                    threads: i64::unsigned_abs(threads),
                    presence: owner.map_or(WorkerPresence::Gone, |owner| owner.presence(now_ms)),
                    running: running
                        .iter()
                        .find(|(owner, _)| *owner == id)
                        .map_or(0, |(_, jobs)| jobs.unsigned_abs()),
                    finished: i64::unsigned_abs(finished),
                    jobs_per_s,
                    taken_back: i64::unsigned_abs(taken_back),
                    started_ms,
                    silent_ms: now_ms - heartbeat_ms,
                }
            };
        Ok(rows.into_iter().map(status).collect())
    }

    /// The workers that are there now and have not been asked to stop. Whose process cannot be seen from here is there as
    /// long as its last sign of life is no older than a lease.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn alive(&mut self) -> Result<Alive, QueueError> {
        let owners = self.owners().await?;
        let now_ms = self.now_ms().await?;
        let there = owners.iter().filter(|owner| owner.presence(now_ms) == WorkerPresence::Working);
        Ok(there.fold(Alive::default(), |alive, owner| Alive {
            workers: alive.workers + 1,
            threads: alive.threads + owner.threads,
        }))
    }
}

impl Owner {
    fn presence(&self, now_ms: i64) -> WorkerPresence {
        let is_there = match self.verdict() {
            Verdict::Alive => true,
            Verdict::Gone => false,
            Verdict::Elsewhere => !self.is_silent(now_ms),
        };
        match (is_there, self.is_stopping()) {
            (false, _) => WorkerPresence::Gone,
            (true, true) => WorkerPresence::Stopping,
            (true, false) => WorkerPresence::Working,
        }
    }
}
