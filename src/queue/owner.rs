//! A worker as the database knows it, and what can be known of its process from here.

use super::engine::{Statement, query};
use super::process::{self, Presence};
use super::{Queue, QueueError};

/// A worker that has not ended in order, or owns jobs all the same.
#[derive(Debug)]
pub(super) struct Owner {
    pub id: i64,
    pub host: String,
    boot_id: Option<String>,
    pid_namespace: Option<String>,
    pub pid: u32,
    process_start: Option<i64>,
    pub version: String,
    pub heartbeat_ms: i64,
    pub threads: u64,
    stopping_ms: Option<i64>,
    ended_ms: Option<i64>,
}

/// What is known of an owner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    Alive,
    Gone,
    /// Its signs of life and its leases decide.
    Elsewhere,
}

/// The times between which a sign of life is neither too old nor ahead of any clock.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    pub now_ms: i64,
    lease_ms: i64,
}

/// No clock that anybody works with is wrong by more.
const FAR_AHEAD_MS: i64 = 24 * 3600 * 1000;

const OWNERS: Statement = Statement::each(
    "
    SELECT id, host, boot_id, pid_namespace, pid, process_start, version, heartbeat_ms, threads, stopping_ms,
           ended_ms
    FROM workers
    WHERE ended_ms IS NULL OR id IN (SELECT owner FROM jobs INDEXED BY jobs_owner WHERE state = 'running')
    ORDER BY id",
    "
    SELECT id, host, boot_id, pid_namespace, pid, process_start, version, heartbeat_ms, threads, stopping_ms,
           ended_ms
    FROM workers
    WHERE ended_ms IS NULL OR id IN (SELECT owner FROM jobs WHERE state = 'running')
    ORDER BY id",
);

type Columns = (
    i64,
    String,
    Option<String>,
    Option<String>,
    i64,
    Option<i64>,
    String,
    i64,
    i64,
    Option<i64>,
    Option<i64>,
);

impl Queue {
    /// All who may own running jobs.
    pub(super) async fn owners(&mut self) -> Result<Vec<Owner>, QueueError> {
        let owners: Vec<Columns> = query(OWNERS).all(&mut self.connection).await?;
        Ok(owners.into_iter().map(Owner::from_columns).collect())
    }

    /// The window of now.
    pub(super) async fn window(&mut self) -> Result<Window, QueueError> {
        Ok(Window { now_ms: self.now_ms().await?, lease_ms: self.lease_ms() })
    }
}

impl Window {
    /// Leases that end later are wrong: they were written by a clock that had jumped, and would never end.
    pub fn far_ms(self) -> i64 {
        self.now_ms.saturating_add(self.lease_ms).saturating_add(FAR_AHEAD_MS)
    }

    /// Whether a worker that gave this sign of life has been silent since, for as long as a lease.
    pub fn is_silent(self, heartbeat_ms: i64) -> bool {
        let until_ms = heartbeat_ms.saturating_add(self.lease_ms);
        until_ms <= self.now_ms || until_ms > self.far_ms()
    }
}

impl Owner {
    fn from_columns(columns: Columns) -> Self {
        let (id, host, boot_id, pid_namespace, pid, process_start, version, ..) = columns;
        let (.., heartbeat_ms, threads, stopping_ms, ended_ms) = columns;
        let (pid, threads) = (pid as u32, threads.unsigned_abs());
        Self {
            id,
            host,
            boot_id,
            pid_namespace,
            pid,
            process_start,
            version,
            heartbeat_ms,
            threads,
            stopping_ms,
            ended_ms,
        }
    }

    /// Whether it has been asked to stop.
    pub fn is_stopping(&self) -> bool {
        self.stopping_ms.is_some()
    }

    pub fn verdict(&self) -> Verdict {
        let here = (process::host(), process::boot_id(), process::pid_namespace());
        if self.ended_ms.is_some() {
            return Verdict::Gone;
        }
        let (Some(start), true) = (self.process_start, self.boot_id.is_some() && self.host == here.0) else {
            return Verdict::Elsewhere;
        };
        if self.boot_id != here.1 {
            return Verdict::Gone;
        }
        if self.pid_namespace != here.2 {
            return Verdict::Elsewhere;
        }
        match process::presence(self.pid, start) {
            Presence::Alive => Verdict::Alive,
            Presence::Gone => Verdict::Gone,
            Presence::Unknown => Verdict::Elsewhere,
        }
    }
}
