use super::engine::query;
use super::{Queue, QueueError};

const SAVE: &str = "
    INSERT INTO checkpoints (job_id, attempt, bytes, saved_ms)
    SELECT id, attempt, $4, $5 FROM jobs WHERE key = $1 AND state = 'running' AND attempt = $2 AND owner = $3
    ON CONFLICT (job_id) DO UPDATE
    SET attempt = excluded.attempt, bytes = excluded.bytes, saved_ms = excluded.saved_ms";

/// A job that gets further with each attempt is not what kills its processes.
const FORGIVE: &str = "UPDATE jobs SET crashes = 0 WHERE key = $1 AND crashes > 0";

impl Queue {
    /// Keeps where a running attempt is, instead of what was kept before; `false` if the worker lost the job.
    ///
    /// The next attempt is given the bytes with its claim. They vanish when the job ends.
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
        self.write_own(async |connection, now_ms| {
            let saved = query(SAVE).bind(key).bind(attempt).bind(owner).bind(bytes).bind(now_ms);
            let is_saved = saved.run(connection).await? == 1;
            if is_saved {
                query(FORGIVE).bind(key).run(connection).await?;
            }
            Ok(is_saved)
        })
        .await
    }
}
