use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::worker::Registration;

const EXTEND: &str = "UPDATE jobs SET lease_until_ms = $2 WHERE owner = $1 AND state = 'running'";

/// What the worker plans.
const EXTEND_PLANS: &str = "UPDATE plans SET lease_until_ms = $2 WHERE owner = $1";

/// A worker that was declared dead and sends a heartbeat is alive again.
const ALIVE: &str =
    "UPDATE workers SET heartbeat_ms = $2, finished = $3, jobs_per_s = $4, ended_ms = NULL WHERE id = $1";

const RUNNING: &str = "SELECT key FROM jobs WHERE owner = $1 AND state = 'running'";

const RELEASE: &str = "
    UPDATE jobs SET state = 'pending', owner = NULL, lease_until_ms = NULL, note = $3
    WHERE key = $2 AND owner = $1 AND state = 'running'";

const UNKNOWN: &str = "released: the worker that owned the job did not run it";

impl Queue {
    /// Sends a heartbeat: extends the leases of all jobs that the registered worker runs. Returns their number.
    ///
    /// If the number is smaller than the worker expects, jobs were taken back from it, and their outcomes will be
    /// refused.
    ///
    /// # Errors
    /// If the database cannot be written.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn heartbeat(&mut self) -> Result<u64, QueueError> {
        self.check_place()?;
        let lease_ms = self.settings.lease_ms();
        let registration = self.registration_mut();
        let (owner, finished) = (registration.id, registration.throughput.finished());
        let jobs_per_s = registration.throughput.jobs_per_s();
        // Single statements without the write lock: otherwise all workers would seem dead when one transaction holds
        // the exclusive lock for longer than a lease.
        let now_ms = self.now_ms().await?;
        let alive = query(ALIVE).bind(owner).bind(now_ms).bind(finished).bind(Some(jobs_per_s));
        if alive.run(&mut self.connection).await? == 0 {
            self.register_again().await?;
            return Ok(0);
        }
        let until_ms = now_ms.saturating_add(lease_ms);
        query(EXTEND_PLANS).bind(owner).bind(until_ms).run(&mut self.connection).await?;
        let extended = query(EXTEND).bind(owner).bind(until_ms);
        let extended = extended.run(&mut self.connection).await?;
        // After a lost answer the next exchange finds out what was claimed.
        if extended > self.registration().held.len() as u64 && !self.connection.is_in_doubt() {
            self.release_unknown().await?;
        }
        Ok(extended)
    }

    /// Gives back jobs that this worker owns in the database and does not know of. It would wait for itself without end.
    ///
    /// # Errors
    /// If the file is damaged: then their outcomes may have been refused because an index does not have them, and it would
    /// run them again and again.
    async fn release_unknown(&mut self) -> Result<(), QueueError> {
        if let damaged @ QueueError::Damaged(_) = self.contradiction().await? {
            return Err(damaged);
        }
        let Registration { id, held, .. } = self.registration();
        let (owner, held) = (*id, held.clone());
        self.write_shared(async |connection, _| {
            let running: Vec<String> = query(RUNNING).bind(owner).scalars(connection).await?;
            for key in running.iter().filter(|key| !held.contains_key(*key)) {
                query(RELEASE).bind(owner).bind(key).bind(UNKNOWN).run(connection).await?;
            }
            Ok(())
        })
        .await
    }
}
