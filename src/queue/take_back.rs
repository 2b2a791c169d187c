//! Reclaims the jobs of workers that are gone: the jobs become pending again.
//!
//! These rules decide, in this order, whether a worker is gone:
//! 1. If the worker is on this boot of this machine, the table of processes decides. If its process exists, it keeps
//!    its jobs, however old its lease is: a stopped process continues later, a machine that slept wakes up, and a clock
//!    that jumps takes no jobs from anybody. If its process does not exist, its jobs are pending at once.
//! 2. If the worker is on an earlier boot of this machine, it is gone. This holds for a database file only: on a
//!    server, two machines may have the same name, and another boot may be another machine.
//! 3. A worker that the database does not know is gone.
//! 4. For any other worker, its heartbeats and the leases of its jobs decide, by the database's clock. A worker is
//!    silent if its last heartbeat is older than its own lease. A lease that ends further in the future than any clock
//!    error explains counts as expired: a clock that had jumped wrote it.
//!
//! A wrong decision loses nothing: a job that is run twice is recorded once, because outcomes are fenced by owner and
//! attempt.

use super::digest;
use super::engine::{Statement, query};
use super::error::QueueError;
use super::handle::Queue;
use super::owner::{Liveness, Owner};

/// The jobs that were taken back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TakenBack {
    /// Jobs that became pending.
    pub pending: u64,
    /// Jobs that failed because their processes died too often.
    pub failed: u64,
}

/// $4 is the time if the leases decide, and null otherwise. $6 is 1 for a crash, and 0 if the process had been asked to
/// stop.
const TAKE_BACK: &str = "
    UPDATE jobs
    SET state = CASE WHEN crashes + $6 >= $2 THEN 'failed' ELSE 'pending' END,
        crashes = crashes + $6, owner = NULL, lease_until_ms = NULL, note = $3
    WHERE owner = $1 AND state = 'running'
      AND ($4 IS NULL OR lease_until_ms <= $4 OR lease_until_ms > $5)
    RETURNING id, key, state, crashes";

const CRASHED: &str = "
    INSERT INTO results (job_id, attempt, error, started_ms, finished_ms, digest)
    SELECT id, attempt, $2, started_ms, $3, $4 FROM jobs WHERE id = $1";

/// Counts the jobs that were taken back. The worker has ended if it holds no more jobs and has sent no heartbeat since
/// $4.
const COUNT: &str = "
    UPDATE workers
    SET taken_back = taken_back + $3,
        ended_ms = CASE
            WHEN ended_ms IS NULL AND heartbeat_ms = $4
             AND NOT EXISTS (SELECT 1 FROM jobs AS j WHERE j.owner = workers.id AND j.state = 'running')
            THEN $2 ELSE ended_ms END
    WHERE id = $1";

const COUNT_ORPHANS: Statement = Statement::each(
    "
    SELECT COUNT(*) FROM jobs AS j INDEXED BY jobs_owner
    WHERE j.state = 'running' AND NOT EXISTS (SELECT 1 FROM workers AS w WHERE w.id = j.owner)",
    "
    SELECT COUNT(*) FROM jobs AS j
    WHERE j.state = 'running' AND NOT EXISTS (SELECT 1 FROM workers AS w WHERE w.id = j.owner)",
);

const TAKE_ORPHANS: &str = "
    UPDATE jobs SET state = 'pending', owner = NULL, lease_until_ms = NULL, note = $1
    WHERE state = 'running' AND NOT EXISTS (SELECT 1 FROM workers AS w WHERE w.id = jobs.owner)";

const ORPHANED: &str = "taken back: the database does not know the worker that owned the job";

const TAKEN_BACK: &str = "taken back: the process that ran the job ended without finishing it";

impl Queue {
    /// Takes back the jobs of workers that are gone: they become pending, or failed if their processes died too often
    /// in succession.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn take_back(&mut self) -> Result<TakenBack, QueueError> {
        let mut taken = TakenBack { pending: self.take_orphans().await?, failed: 0 };
        let owners = self.owners().await?;
        // This worker finishes its own jobs.
        let own = self.registration.as_ref().map(|own| own.id);
        let others: Vec<_> = owners.iter().filter(|owner| Some(owner.id) != own).collect();
        if others.is_empty() {
            return Ok(taken);
        }
        let now_ms = self.now_ms().await?;
        for owner in others {
            let liveness = owner.liveness();
            let is_suspect = match liveness {
                Liveness::Alive => false,
                Liveness::Gone => true,
                // Many workers check each other often, so the exclusive lock is taken only for a silent one.
                Liveness::Unknown => owner.is_silent(now_ms),
            };
            if is_suspect {
                self.take_from(owner, liveness, &mut taken).await?;
            }
        }
        Ok(taken)
    }

    /// Takes back the running jobs whose owner is no worker that the database knows. No lease of theirs is extended, and
    /// nobody would ever be found gone. Only a damaged or edited database has such jobs.
    async fn take_orphans(&mut self) -> Result<u64, QueueError> {
        let orphans: i64 = query(COUNT_ORPHANS).scalar(&mut self.connection).await?;
        if orphans == 0 {
            return Ok(0);
        }
        self.write(async |connection, _| query(TAKE_ORPHANS).bind(ORPHANED).run(connection).await).await
    }

    /// Whether jobs of other workers may soon become pending: another worker is gone, is stopping or has missed
    /// heartbeats.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn has_missing_workers(&mut self) -> Result<bool, QueueError> {
        let owners = self.owners().await?;
        let now_ms = self.now_ms().await?;
        let own = self.registration.as_ref().map(|own| own.id);
        let mut others = owners.iter().filter(|owner| Some(owner.id) != own);
        Ok(others.any(|owner| match owner.liveness() {
            Liveness::Alive => owner.is_stopping(),
            Liveness::Gone => true,
            Liveness::Unknown => owner.is_stopping() || owner.has_missed_heartbeats(now_ms),
        }))
    }

    async fn take_from(
        &mut self,
        owner: &Owner,
        liveness: Liveness,
        taken: &mut TakenBack,
    ) -> Result<(), QueueError> {
        let crash_limit = self.settings.crash_limit;
        let found = self
            .write(async |connection, now_ms| {
                let mut taken = TakenBack::default();
                let jobs: Vec<(i64, String, String, i64)> = query(TAKE_BACK)
                    .bind(owner.id)
                    .bind(crash_limit)
                    .bind(TAKEN_BACK)
                    .bind((liveness == Liveness::Unknown).then_some(now_ms))
                    .bind(owner.latest_plausible_ms(now_ms))
                    .bind(i64::from(!owner.is_stopping()))
                    .all(connection)
                    .await?;
                let count = jobs.len() as i64;
                for (id, key, state, crashes) in jobs {
                    if state == "pending" {
                        taken.pending += 1;
                        continue;
                    }
                    taken.failed += 1;
                    let error = format!(
                        "its process died {crashes} times without finishing it (killed, out of memory, a crash, a power \
                         cut); `tribosweep retry` tries it again"
                    );
                    let digest = digest::of_result(&key, None, Some(&error));
                    query(CRASHED).bind(id).bind(error).bind(now_ms).bind(digest).run(connection).await?;
                }
                let counted = query(COUNT).bind(owner.id).bind(now_ms).bind(count);
                counted.bind(owner.heartbeat_ms).run(connection).await?;
                Ok(taken)
            })
            .await?;
        taken.pending += found.pending;
        taken.failed += found.failed;
        Ok(())
    }
}
