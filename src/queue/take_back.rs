//! Jobs whose process is gone become pending again.
//!
//! Who is gone, in this order:
//! 1. An owner on this boot of this machine is asked for in the table of processes. If it is there, its jobs stay
//!    its own however old its lease is: a process that was stopped or a machine that slept comes back, and a clock
//!    that jumps takes nothing from anybody. If it is not, they are pending at once.
//! 2. An owner on an earlier boot of this machine is gone. (Of a file's machine: of those that share a server two may have
//!    the same name, and another boot is another machine.)
//! 3. Of any other owner nothing is known but its signs of life, which come before the end of its own lease, and the
//!    leases of its jobs, by the database's clock. One that ends
//!    further ahead than any clock is wrong counts as over too: it was written by a clock that had jumped, and would
//!    never end.
//!
//! Whatever is decided, nothing is lost by a mistake: a job that is run twice is recorded once, by the fence.

use super::engine::query;
use super::owner::{Owner, Verdict};
use super::{Queue, QueueError};

/// What was taken back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TakenBack {
    /// Jobs that are pending again.
    pub pending: u64,
    /// Jobs whose process died too often, which have failed.
    pub failed: u64,
}

/// $4 is set where the leases decide; $6 is 1 for a crash, and 0 where the process had been asked to stop.
const TAKE_BACK: &str = "
    UPDATE jobs
    SET state = CASE WHEN crashes + $6 >= $2 THEN 'failed' ELSE 'pending' END,
        crashes = crashes + $6, owner = NULL, lease_until_ms = NULL, note = $3
    WHERE owner = $1 AND state = 'running'
      AND ($4 IS NULL OR lease_until_ms <= $4 OR lease_until_ms > $5)
    RETURNING id, state, crashes";

const CRASHED: &str = "
    INSERT INTO results (job_id, attempt, error, started_ms, finished_ms)
    SELECT id, attempt, $2, started_ms, $3 FROM jobs WHERE id = $1";

/// The worker has ended if it has nothing left in hand and has not given a sign of life ($4) meanwhile.
const COUNT: &str = "
    UPDATE workers
    SET taken_back = taken_back + $3,
        ended_ms = CASE
            WHEN ended_ms IS NULL AND heartbeat_ms = $4
             AND NOT EXISTS (SELECT 1 FROM jobs AS j WHERE j.owner = workers.id AND j.state = 'running')
            THEN $2 ELSE ended_ms END
    WHERE id = $1";

const TAKEN_BACK: &str = "taken back: the process that ran the job ended without finishing it";

impl Queue {
    /// Sets the jobs of processes that are gone back to pending; those whose processes died too often in a row have
    /// failed.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn take_back(&mut self) -> Result<TakenBack, QueueError> {
        let mut taken = TakenBack::default();
        let owners = self.owners().await?;
        // Its own jobs are this process' to end.
        let own = self.registration.as_ref().map(|own| own.id);
        let others: Vec<_> = owners.iter().filter(|owner| Some(owner.id) != own).collect();
        if others.is_empty() {
            return Ok(taken);
        }
        let now_ms = self.now_ms().await?;
        for owner in others {
            let verdict = owner.verdict();
            let is_suspect = match verdict {
                Verdict::Alive => false,
                Verdict::Gone => true,
                // Many workers look at each other all the time: the tables are locked only for one that is silent.
                Verdict::Elsewhere => owner.is_silent(now_ms),
            };
            if is_suspect {
                self.take_from(owner, verdict, &mut taken).await?;
            }
        }
        Ok(taken)
    }

    /// Whether jobs may soon be pending again: somebody who may own some is gone or about to go, or has not given the
    /// signs of life that were due.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn misses_somebody(&mut self) -> Result<bool, QueueError> {
        let owners = self.owners().await?;
        let now_ms = self.now_ms().await?;
        let own = self.registration.as_ref().map(|own| own.id);
        let mut others = owners.iter().filter(|owner| Some(owner.id) != own);
        Ok(others.any(|owner| match owner.verdict() {
            Verdict::Alive => owner.is_stopping(),
            Verdict::Gone => true,
            Verdict::Elsewhere => owner.is_stopping() || owner.is_missed(now_ms),
        }))
    }

    async fn take_from(
        &mut self,
        owner: &Owner,
        verdict: Verdict,
        taken: &mut TakenBack,
    ) -> Result<(), QueueError> {
        let crash_limit = self.settings.crash_limit;
        let found = self
            .write(async |connection, now_ms| {
                let mut taken = TakenBack::default();
                let jobs: Vec<(i64, String, i64)> = query(TAKE_BACK)
                    .bind(owner.id)
                    .bind(crash_limit)
                    .bind(TAKEN_BACK)
                    .bind((verdict == Verdict::Elsewhere).then_some(now_ms))
                    .bind(owner.far_ms(now_ms))
                    .bind(i64::from(!owner.is_stopping()))
                    .all(connection)
                    .await?;
                let count = jobs.len() as i64;
                for (id, state, crashes) in jobs {
                    if state == "pending" {
                        taken.pending += 1;
                        continue;
                    }
                    taken.failed += 1;
                    let error = format!(
                        "its process died {crashes} times without finishing it (killed, out of memory, a crash, a power \
                         cut); `tribosweep retry` tries it again"
                    );
                    query(CRASHED).bind(id).bind(error).bind(now_ms).run(connection).await?;
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
