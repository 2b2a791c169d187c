use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;

const SAVE: &str = "
    INSERT INTO checkpoints (job_id, attempt, bytes, saved_ms)
    SELECT id, attempt, $4, $5 FROM jobs WHERE key = $1 AND state = 'running' AND attempt = $2 AND owner = $3
    ON CONFLICT (job_id) DO UPDATE
    SET attempt = excluded.attempt, bytes = excluded.bytes, saved_ms = excluded.saved_ms";

/// A job that makes progress in each attempt is not the reason why its processes die.
const RESET_CRASHES: &str = "UPDATE jobs SET crashes = 0 WHERE key = $1 AND crashes > 0";

impl Queue {
    /// Stores a checkpoint of a running attempt in place of the previous one. Returns `false` if the worker has lost
    /// the job.
    ///
    /// The next attempt receives the bytes with its claim. They are deleted when the job ends.
    ///
    /// # Errors
    /// If the database cannot be written.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn save_checkpoint(
        &mut self,
        key: &str,
        attempt: u32,
        bytes: &[u8],
    ) -> Result<bool, QueueError> {
        let owner = self.registration().id;
        self.write_shared(async |connection, now_ms| {
            let saved = query(SAVE).bind(key).bind(attempt).bind(owner).bind(bytes).bind(now_ms);
            let is_saved = saved.run(connection).await? == 1;
            if is_saved {
                query(RESET_CRASHES).bind(key).run(connection).await?;
            }
            Ok(is_saved)
        })
        .await
    }
}
