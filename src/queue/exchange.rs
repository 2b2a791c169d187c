use std::collections::BTreeMap;

use super::engine::{Access, Connection, query};
use super::transaction::transact;
use super::{Claim, ClaimedJob, Finished, FinishedOutcome, Queue, QueueError, claim, finish};

/// What an exchange gave back.
#[derive(Debug, Clone, PartialEq)]
pub struct Exchanged {
    /// Jobs to run now, claim by claim, each the dearest first.
    pub claimed: Vec<Vec<ClaimedJob>>,
    /// Keys of finished jobs that were not stored, because this worker does not run the attempt they name.
    pub refused: Vec<String>,
}

const IN_HAND: &str = "SELECT key, attempt FROM jobs WHERE owner = $1 AND state = 'running'";

const RECORDED: &str = "
    SELECT COUNT(*) FROM results AS r JOIN jobs AS j ON j.id = r.job_id WHERE j.key = $1 AND r.attempt = $2";

impl Queue {
    /// Stores all that finished and claims what to run next, in one transaction: a turn of the dispatcher.
    ///
    /// One transaction a turn, not one a job, is what makes thousands of jobs a second possible. Nothing
    /// claimed may start before this returns, and a job released here may be claimed again here: an
    /// interrupted caller claims nothing.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`] for a claim's scope, or if the database cannot be written; then
    /// nothing is stored or claimed, and `finished` is still the caller's to store. After
    /// [`QueueError::Unreachable`] it may have been done all the same: the next exchange finds out, and is to be given
    /// the same ends.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn exchange(
        &mut self,
        finished: &[Finished],
        claims: &[Claim],
    ) -> Result<Exchanged, QueueError> {
        let lease_ms = self.lease_ms();
        let registration = self.registration.as_mut().expect("jobs are run by a registered worker");
        let (owner, provenance, held) =
            (registration.id, &registration.worker.provenance, &registration.held);
        let exchanged =
            transact(&mut self.connection, &self.clock, Access::Shared, async |connection, now_ms| {
                let is_in_doubt = connection.is_in_doubt();
                if is_in_doubt {
                    let unknown = unknown(connection, owner, held).await?;
                    finish::store(connection, &unknown, owner, provenance, now_ms).await?;
                }
                let mut refused = finish::store(connection, finished, owner, provenance, now_ms).await?;
                if is_in_doubt {
                    refused = not_recorded(connection, finished, refused).await?;
                }
                let lease = claim::Lease { owner, now_ms, until_ms: now_ms.saturating_add(lease_ms) };
                let mut claimed = Vec::with_capacity(claims.len());
                for claim in claims {
                    claimed.push(claim::take(connection, claim, lease).await?);
                }
                Ok(Exchanged { claimed, refused })
            })
            .await?;
        self.connection.is_settled();
        for job in finished {
            registration.held.remove(&job.key);
        }
        for job in exchanged.claimed.iter().flatten() {
            registration.held.insert(job.key.clone(), job.attempt);
        }
        let is_counted = |job: &&Finished| job.outcome.is_end() && !exchanged.refused.contains(&job.key);
        registration.pace.count(finished.iter().filter(is_counted).count());
        Ok(exchanged)
    }
}

/// What the worker has in hand by the database and not by its own account: a claim whose answer was lost.
async fn unknown(
    connection: &mut Connection,
    owner: i64,
    held: &BTreeMap<String, u32>,
) -> Result<Vec<Finished>, QueueError> {
    let in_hand: Vec<(String, i64)> = query(IN_HAND).bind(owner).all(connection).await?;
    let is_known =
        |(key, attempt): &(String, i64)| held.get(key).is_some_and(|&own| i64::from(own) == *attempt);
    let unknown = in_hand.into_iter().filter(|job| !is_known(job));
    let unstarted = |(key, attempt): (String, i64)| Finished {
        key,
        attempt: attempt as u32,
        outcome: FinishedOutcome::Unstarted,
        wall_s: 0.0,
    };
    Ok(unknown.map(unstarted).collect())
}

/// Those of `refused` that were not stored before, in an exchange whose answer was lost.
async fn not_recorded(
    connection: &mut Connection,
    finished: &[Finished],
    refused: Vec<String>,
) -> Result<Vec<String>, QueueError> {
    let mut not_recorded = Vec::new();
    for job in finished.iter().filter(|job| refused.contains(&job.key)) {
        let recorded = query(RECORDED).bind(&job.key).bind(job.attempt);
        let recorded: i64 = recorded.scalar(connection).await?;
        if recorded == 0 {
            not_recorded.push(job.key.clone());
        }
    }
    Ok(not_recorded)
}
