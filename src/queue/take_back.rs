//! Jobs whose process is gone become pending again.
//!
//! Who is gone, in this order:
//! 1. An owner on this boot of this machine is asked for in the table of processes. If it is there, its jobs stay
//!    its own however old its lease is: a process that was stopped or a machine that slept comes back, and a clock
//!    that jumps takes nothing from anybody. If it is not, they are pending at once.
//! 2. An owner on an earlier boot of this machine is gone.
//! 3. Of any other owner nothing is known but its lease, by this machine's clock. A lease that ends further ahead
//!    than any clock is wrong counts as over too: it was written by a clock that had jumped, and would never end.
//!
//! Whatever is decided, nothing is lost by a mistake: a job that is run twice is recorded once, by the fence.

use sqlx::sqlite::SqliteRow;
use sqlx::{FromRow, Row};

use super::process::{self, Presence};
use super::{Queue, QueueError};

/// What was taken back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TakenBack {
    /// Jobs that are pending again.
    pub pending: u64,
    /// Jobs whose process died too often, which have failed.
    pub failed: u64,
}

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
    /// Its leases decide.
    Elsewhere,
}

/// No clock that anybody works with is wrong by more.
const FAR_AHEAD_MS: i64 = 24 * 3600 * 1000;

const OWNERS: &str = "
    SELECT id, host, boot_id, pid_namespace, pid, process_start, version, heartbeat_ms, threads, stopping_ms,
           ended_ms
    FROM workers
    WHERE ended_ms IS NULL OR id IN (SELECT owner FROM jobs INDEXED BY jobs_owner WHERE state = 'running')
    ORDER BY id";

/// ?4 is set where the leases decide; ?6 is 1 for a crash, and 0 where the process had been asked to stop.
const TAKE_BACK: &str = "
    UPDATE jobs
    SET state = CASE WHEN crashes + ?6 >= ?2 THEN 'failed' ELSE 'pending' END,
        crashes = crashes + ?6, owner = NULL, lease_until_ms = NULL, note = ?3
    WHERE owner = ?1 AND state = 'running'
      AND (?4 IS NULL OR lease_until_ms <= ?4 OR lease_until_ms > ?5)
    RETURNING id, state, crashes";

const CRASHED: &str = "
    INSERT INTO results (job_id, attempt, error, started_ms, finished_ms)
    SELECT id, attempt, ?2, started_ms, ?3 FROM jobs WHERE id = ?1";

const TAKEN_BACK: &str = "taken back: the process that ran the job ended without finishing it";

impl Queue {
    /// Sets the jobs of processes that are gone back to pending; those whose processes died too often in a row have
    /// failed.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn take_back(&mut self) -> Result<TakenBack, QueueError> {
        let mut taken = TakenBack::default();
        for owner in self.owners().await? {
            // Its own jobs are this process' to end.
            let is_own = self.registration.as_ref().is_some_and(|own| own.id == owner.id);
            let verdict = owner.verdict();
            if verdict != Verdict::Alive && !is_own {
                self.take_from(&owner, verdict, &mut taken).await?;
            }
        }
        Ok(taken)
    }

    /// All who may own running jobs.
    pub(super) async fn owners(&mut self) -> Result<Vec<Owner>, QueueError> {
        Ok(sqlx::query_as(OWNERS).fetch_all(&mut self.connection).await?)
    }

    /// Leases that end in between are valid.
    pub(super) fn lease_window(&self) -> (i64, i64) {
        let now_ms = self.clock.now_ms();
        (now_ms, self.lease_until(now_ms).saturating_add(FAR_AHEAD_MS))
    }

    async fn take_from(
        &mut self,
        owner: &Owner,
        verdict: Verdict,
        taken: &mut TakenBack,
    ) -> Result<(), QueueError> {
        let crash_limit = self.settings.crash_limit;
        let (now_ms, far_ms) = self.lease_window();
        let found = self.write(async |connection| {
            let mut taken = TakenBack::default();
            let jobs: Vec<(i64, String, u32)> = sqlx::query_as(TAKE_BACK)
                .bind(owner.id)
                .bind(crash_limit)
                .bind(TAKEN_BACK)
                .bind((verdict == Verdict::Elsewhere).then_some(now_ms))
                .bind(far_ms)
                .bind(i64::from(owner.stopping_ms.is_none()))
                .fetch_all(&mut *connection)
                .await?;
            for (id, state, crashes) in jobs {
                if state == "pending" {
                    taken.pending += 1;
                    continue;
                }
                taken.failed += 1;
                let error = format!(
                    "its process died {crashes} times without finishing it (killed, out of memory, a crash, a power cut); \
                     `tribosweep retry` tries it again"
                );
                let crashed = sqlx::query(CRASHED).bind(id).bind(error).bind(now_ms);
                crashed.execute(&mut *connection).await?;
            }
            if verdict == Verdict::Gone {
                let ended = sqlx::query("UPDATE workers SET ended_ms = ?2 WHERE id = ?1 AND ended_ms IS NULL");
                ended.bind(owner.id).bind(now_ms).execute(&mut *connection).await?;
            }
            Ok(taken)
        })
        .await?;
        taken.pending += found.pending;
        taken.failed += found.failed;
        Ok(())
    }
}

impl FromRow<'_, SqliteRow> for Owner {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            id: row.try_get("id")?,
            host: row.try_get("host")?,
            boot_id: row.try_get("boot_id")?,
            pid_namespace: row.try_get("pid_namespace")?,
            pid: row.try_get("pid")?,
            process_start: row.try_get("process_start")?,
            version: row.try_get("version")?,
            heartbeat_ms: row.try_get("heartbeat_ms")?,
            threads: row.try_get("threads")?,
            stopping_ms: row.try_get("stopping_ms")?,
            ended_ms: row.try_get("ended_ms")?,
        })
    }
}

impl Owner {
    /// Whether it has been asked to stop.
    pub(super) fn is_stopping(&self) -> bool {
        self.stopping_ms.is_some()
    }

    pub(super) fn verdict(&self) -> Verdict {
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
