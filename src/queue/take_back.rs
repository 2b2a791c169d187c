use super::{Queue, QueueError, WorkerLock};

const TAKEN_BACK: &str = "taken back: the process that ran the job ended without finishing it";

const TAKE_BACK: &str = "UPDATE jobs SET state = 'pending', note = ?1 WHERE state = 'running'";

impl Queue {
    /// Sets jobs that an interrupted process left running back to pending, and returns how many.
    ///
    /// The lock is the proof that they are left: whoever ran them held it, and holds it no more.
    ///
    /// # Errors
    /// If the database cannot be written.
    ///
    /// # Panics
    /// If the lock is that of another database, which proves nothing about this one.
    pub async fn take_back(&mut self, lock: &WorkerLock) -> Result<u64, QueueError> {
        assert_eq!(lock.database(), self.path, "the worker lock belongs to another database");
        // A single statement that writes first needs no BEGIN IMMEDIATE.
        let taken = sqlx::query(TAKE_BACK).bind(TAKEN_BACK).execute(&mut self.connection).await?;
        Ok(taken.rows_affected())
    }
}
