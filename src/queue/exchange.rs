use super::{Claim, ClaimedJob, Finished, Queue, QueueError, claim, finish};

/// What an exchange gave back.
#[derive(Debug, Clone, PartialEq)]
pub struct Exchanged {
    /// Jobs to run now, claim by claim, each the dearest first.
    pub claimed: Vec<Vec<ClaimedJob>>,
    /// Keys of finished jobs that were not stored, because this worker does not run the attempt they name.
    pub refused: Vec<String>,
}

impl Queue {
    /// Stores all that finished and claims what to run next, in one transaction: a turn of the dispatcher.
    ///
    /// One transaction a turn, not one a job, is what makes thousands of jobs a second possible. Nothing
    /// claimed may start before this returns, and a job released here may be claimed again here: an
    /// interrupted caller claims nothing.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`] for a claim's scope, or if the database cannot be written; then
    /// nothing is stored or claimed, and `finished` is still the caller's to store.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn exchange(
        &mut self,
        finished: &[Finished],
        claims: &[Claim],
    ) -> Result<Exchanged, QueueError> {
        let now_ms = self.clock.now_ms();
        let lease =
            claim::Lease { owner: self.registration().id, now_ms, until_ms: self.lease_until(now_ms) };
        let provenance = self.registration().provenance.clone();
        self.write(async |connection| {
            let refused = finish::store(connection, finished, lease.owner, &provenance, now_ms).await?;
            let mut claimed = Vec::with_capacity(claims.len());
            for claim in claims {
                claimed.push(claim::take(connection, claim, lease).await?);
            }
            Ok(Exchanged { claimed, refused })
        })
        .await
    }
}
