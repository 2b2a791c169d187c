use std::collections::BTreeMap;

use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::throughput::Throughput;
use super::worker::{Registration, Worker};

const REGISTER: &str = "
    INSERT INTO workers (host, boot_id, pid_namespace, pid, process_start, threads, version, started_ms,
                         heartbeat_ms, lease_ms)
    VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $8, $9)
    RETURNING id";

const RELEASE_ALL: &str = "
    UPDATE jobs SET state = 'pending', owner = NULL, lease_until_ms = NULL, note = $2
    WHERE owner = $1 AND state = 'running'";

const END: &str = "UPDATE workers SET ended_ms = $2, heartbeat_ms = $2, finished = $3 WHERE id = $1";

const ENDED: &str = "released: the process ended in order, but before the job did";

impl Queue {
    /// Makes `worker` the owner of every job that this queue claims from now on.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn register(&mut self, worker: &Worker) -> Result<(), QueueError> {
        let id = self.insert(worker).await?;
        let (worker, held) = (worker.clone(), BTreeMap::new());
        self.registration = Some(Registration { id, worker, held, throughput: Throughput::new() });
        Ok(())
    }

    /// Registers the worker as a new owner after its row was deleted: it was disconnected for so long that garbage
    /// collection removed it. It has lost the jobs that it had claimed.
    pub(super) async fn register_again(&mut self) -> Result<(), QueueError> {
        let worker = self.registration().worker.clone();
        self.registration_mut().id = self.insert(&worker).await?;
        Ok(())
    }

    async fn insert(&mut self, worker: &Worker) -> Result<i64, QueueError> {
        let lease_ms = self.settings.lease_ms();
        // In a transaction: outside of one, reading the first row hides the error of the commit, for instance of a full
        // disk, and the number is that of no worker.
        self.write_shared(async |connection, now_ms| {
            query(REGISTER)
                .bind(&worker.host)
                .bind(&worker.boot_id)
                .bind(&worker.pid_namespace)
                .bind(worker.pid)
                .bind(worker.process_start)
                .bind(i64::try_from(worker.threads).unwrap_or(i64::MAX))
                .bind(&worker.version)
                .bind(now_ms)
                .bind(lease_ms)
                .scalar(connection)
                .await
        })
        .await
    }

    /// Ends the registration. Jobs that the worker still holds are pending again.
    ///
    /// A process that ends because of an error should call this too, if the error permits it: the jobs that it gives
    /// back then do not count as crashed.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn unregister(&mut self) -> Result<(), QueueError> {
        let Some(Registration { id, throughput, .. }) = &self.registration else { return Ok(()) };
        let (id, finished) = (*id, throughput.finished());
        self.write_shared(async |connection, now_ms| {
            query(RELEASE_ALL).bind(id).bind(ENDED).run(connection).await?;
            query(END).bind(id).bind(now_ms).bind(finished).run(connection).await?;
            Ok(())
        })
        .await?;
        self.registration = None;
        Ok(())
    }

    /// Records that the worker has been asked to stop. If its process is killed before it has given its jobs back, the
    /// jobs do not count as crashed.
    ///
    /// # Errors
    /// If the database cannot be written.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn mark_stopping(&mut self) -> Result<(), QueueError> {
        let id = self.registration().id;
        let stopping = query("UPDATE workers SET stopping_ms = $2 WHERE id = $1");
        let now_ms = self.now_ms().await?;
        stopping.bind(id).bind(now_ms).run(&mut self.connection).await?;
        Ok(())
    }
}
