use std::collections::BTreeMap;

use super::access::Access;
use super::claim::{self, Claim, ClaimedJob};
use super::engine::{Connection, query};
use super::error::QueueError;
use super::finish::{self, Finished, FinishedOutcome};
use super::handle::Queue;
use super::transaction::transact;

/// The answer to an exchange.
#[derive(Debug, Clone, PartialEq)]
pub struct Exchanged {
    /// The claimed jobs, one list per claim, each in the order of claims: expensive jobs first within a priority.
    pub claimed: Vec<Vec<ClaimedJob>>,
    /// Keys of finished jobs whose outcome was refused, because this worker does not run the attempt that they name.
    pub refused: Vec<String>,
}

const RUNNING: &str = "SELECT key, attempt FROM jobs WHERE owner = $1 AND state = 'running'";

const RECORDED: &str = "
    SELECT COUNT(*) FROM results AS r JOIN jobs AS j ON j.id = r.job_id WHERE j.key = $1 AND r.attempt = $2";

impl Queue {
    /// Stores the outcomes of finished attempts and claims the next jobs, in one transaction.
    ///
    /// One transaction for many jobs makes thousands of jobs per second possible. A claimed job may start only after
    /// this returns. A job that is released here may be claimed again in the same exchange, so a caller that was
    /// interrupted must not claim.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`] for a claim's scope, or if the database cannot be written. Then nothing is
    /// stored or claimed, and the caller must keep `finished` and pass it again. After [`QueueError::Unreachable`] it
    /// is unknown whether the transaction was committed. The next exchange resolves this if it is given the same
    /// outcomes again.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn exchange(
        &mut self,
        finished: &[Finished],
        claims: &[Claim],
    ) -> Result<Exchanged, QueueError> {
        let lease_ms = self.settings.lease_ms();
        let registration = self.registration.as_mut().expect("jobs are run by a registered worker");
        let (owner, provenance, held) =
            (registration.id, &registration.worker.provenance, &registration.held);
        let exchanged =
            transact(&mut self.connection, &self.clock, Access::Shared, async |connection, now_ms| {
                let is_in_doubt = connection.is_in_doubt();
                if is_in_doubt {
                    let unknown = claimed_unknowingly(connection, owner, held).await?;
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
            .await;
        let exchanged = match exchanged {
            Ok(exchanged) => exchanged,
            Err(error) => return self.naming_holder(Err(error)).await,
        };
        self.connection.clear_doubt();
        for job in finished {
            registration.held.remove(&job.key);
        }
        for job in exchanged.claimed.iter().flatten() {
            registration.held.insert(job.key.clone(), job.attempt);
        }
        let is_counted = |job: &&Finished| job.outcome.is_end() && !exchanged.refused.contains(&job.key);
        registration.throughput.add(finished.iter().filter(is_counted).count());
        Ok(exchanged)
    }
}

/// Jobs that the worker owns in the database but does not know of: they are from a claim whose answer was lost.
async fn claimed_unknowingly(
    connection: &mut Connection,
    owner: i64,
    held: &BTreeMap<String, u32>,
) -> Result<Vec<Finished>, QueueError> {
    let running: Vec<(String, i64)> = query(RUNNING).bind(owner).all(connection).await?;
    let is_known =
        |(key, attempt): &(String, i64)| held.get(key).is_some_and(|&own| i64::from(own) == *attempt);
    let unknown = running.into_iter().filter(|job| !is_known(job));
    let unstarted = |(key, attempt): (String, i64)| Finished {
        key,
        attempt: attempt as u32,
        outcome: FinishedOutcome::Unstarted,
        wall_s: 0.0,
    };
    Ok(unknown.map(unstarted).collect())
}

/// Those of `refused` that were not already stored by an exchange whose answer was lost.
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
