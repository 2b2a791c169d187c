//! A worker as the database knows it, and whether its process is alive as far as this process can see.

use super::engine::{Statement, columns, query};
use super::error::QueueError;
use super::handle::Queue;
use super::process::{self, Presence};

columns! {
    /// A worker that has not ended in order, or that still owns running jobs.
    #[derive(Debug)]
    pub(super) struct Owner {
        pub id: i64,
        pub host: String,
        boot_id: Option<String>,
        pid_namespace: Option<String>,
        pub pid: i64,
        process_start: Option<i64>,
        pub version: String,
        pub heartbeat_ms: i64,
        pub threads: i64,
        stopping_ms: Option<i64>,
        ended_ms: Option<i64>,
        lease_ms: i64,
        /// Then two machines may have the same name.
        is_on_server: bool,
    }
}

/// Whether an owner's process is alive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Liveness {
    Alive,
    Gone,
    /// The process is not visible from here: its heartbeats and its leases decide.
    Unknown,
}

/// No clock in use is wrong by more than this.
const MAX_CLOCK_ERROR_MS: i64 = 24 * 3600 * 1000;

const OWNERS: Statement = Statement::each(
    "
    SELECT id, host, boot_id, pid_namespace, pid, process_start, version, heartbeat_ms, threads, stopping_ms,
           ended_ms, lease_ms, FALSE AS is_on_server
    FROM workers
    WHERE ended_ms IS NULL OR id IN (SELECT owner FROM jobs INDEXED BY jobs_owner WHERE state = 'running')
    ORDER BY id",
    "
    SELECT id, host, boot_id, pid_namespace, pid, process_start, version, heartbeat_ms, threads, stopping_ms,
           ended_ms, lease_ms, TRUE AS is_on_server
    FROM workers
    WHERE ended_ms IS NULL OR id IN (SELECT owner FROM jobs WHERE state = 'running')
    ORDER BY id",
);

impl Queue {
    /// All workers that may own running jobs.
    pub(super) async fn owners(&mut self) -> Result<Vec<Owner>, QueueError> {
        query(OWNERS).all(&mut self.connection).await
    }
}

impl Owner {
    /// A lease that ends after this time is wrong: a clock that had jumped wrote it, and it would hardly ever end.
    pub fn latest_plausible_ms(&self, now_ms: i64) -> i64 {
        now_ms.saturating_add(self.lease_ms).saturating_add(MAX_CLOCK_ERROR_MS)
    }

    /// Whether it has ended, or has sent no heartbeat for as long as its own lease.
    pub fn is_silent(&self, now_ms: i64) -> bool {
        let until_ms = self.heartbeat_ms.saturating_add(self.lease_ms);
        self.ended_ms.is_some() || until_ms <= now_ms || until_ms > self.latest_plausible_ms(now_ms)
    }

    /// Whether two heartbeats are overdue. Heartbeats are sent eight times in a lease.
    pub fn has_missed_heartbeats(&self, now_ms: i64) -> bool {
        self.is_silent(now_ms) || self.heartbeat_ms.saturating_add(self.lease_ms / 4) <= now_ms
    }

    /// Whether it has been asked to stop.
    pub fn is_stopping(&self) -> bool {
        self.stopping_ms.is_some()
    }

    /// Whether its process is on this machine and is stopped. It keeps its jobs, because it may continue.
    pub fn is_stopped(&self) -> bool {
        self.liveness() == Liveness::Alive && process::is_stopped(self.pid as u32)
    }

    pub fn liveness(&self) -> Liveness {
        let here = (process::host(), process::boot_id(), process::pid_namespace());
        let (Some(start), true) = (self.process_start, self.boot_id.is_some() && self.host == here.0) else {
            return Liveness::Unknown;
        };
        if self.boot_id != here.1 {
            return if self.is_on_server { Liveness::Unknown } else { Liveness::Gone };
        }
        if self.pid_namespace != here.2 {
            return Liveness::Unknown;
        }
        match process::presence(self.pid as u32, start) {
            // The process is alive, but its work has ended: it holds no jobs any more.
            Presence::Alive if self.ended_ms.is_some() => Liveness::Gone,
            Presence::Alive => Liveness::Alive,
            Presence::Gone => Liveness::Gone,
            Presence::Unknown => Liveness::Unknown,
        }
    }
}
