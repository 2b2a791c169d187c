use sqlx::Connection;

use super::{Claim, ClaimedJob, Finished, Queue, QueueError, claim, finish};

/// What an exchange gave back.
#[derive(Debug, Clone, PartialEq)]
pub struct Exchanged {
    /// Jobs to run now, the dearest first.
    pub claimed: Vec<ClaimedJob>,
    /// Keys of finished jobs that were not stored, because the job is not running the attempt they name.
    pub refused: Vec<String>,
}

impl Queue {
    /// Stores all that finished and claims what to run next, in one transaction: a turn of the dispatcher.
    ///
    /// One transaction a turn, not one a job, is what makes thousands of jobs a second possible. Nothing
    /// claimed may start before this returns, and a job released here may be claimed again here: an
    /// interrupted caller asks for [`Claim::nothing`].
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`] for the claim's scope, or if the database cannot be written; then
    /// nothing is stored or claimed, and `finished` is still the caller's to store.
    pub async fn exchange(&mut self, finished: &[Finished], claim: &Claim) -> Result<Exchanged, QueueError> {
        let now_ms = self.clock.now_ms();
        let mut transaction = self.connection.begin_with("BEGIN IMMEDIATE").await?;
        let mut refused = Vec::new();
        for job in finished {
            if !finish::store(&mut transaction, job, now_ms).await? {
                refused.push(job.key.clone());
            }
        }
        let claimed = claim::take(&mut transaction, claim, now_ms).await?;
        transaction.commit().await?;
        Ok(Exchanged { claimed, refused })
    }
}
