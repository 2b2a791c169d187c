use std::collections::BTreeMap;

use super::engine::query;
use super::pace::Pace;
use super::{Queue, QueueError, process};

/// A process that is going to run jobs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Worker {
    /// The machine's name.
    pub host: String,
    /// What tells this boot of the machine from others, where the system tells.
    pub boot_id: Option<String>,
    /// The namespace in which the process number is valid, where the system tells.
    pub pid_namespace: Option<String>,
    /// The process number.
    pub pid: u32,
    /// When the process started, in ticks since the boot, where the system tells.
    pub process_start: Option<i64>,
    /// How many jobs it runs at a time.
    pub threads: usize,
    /// The program's version.
    pub version: String,
    /// What its results are made with, in any form; stored with each of them.
    pub provenance: String,
}

impl Worker {
    /// This process.
    pub fn this_process(threads: usize, version: &str, provenance: &str) -> Self {
        let pid = std::process::id();
        Self {
            host: process::host(),
            boot_id: process::boot_id(),
            pid_namespace: process::pid_namespace(),
            pid,
            process_start: process::start_of(pid),
            threads,
            version: version.to_owned(),
            provenance: provenance.to_owned(),
        }
    }
}

/// What a registered queue knows of its worker.
#[derive(Debug, Clone)]
pub(super) struct Registration {
    pub id: i64,
    pub worker: Worker,
    /// The attempts that it has in hand.
    pub held: BTreeMap<String, u32>,
    pub pace: Pace,
}

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
    /// Makes `worker` the owner of everything claimed through this queue from now on.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn register(&mut self, worker: &Worker) -> Result<(), QueueError> {
        let id = self.insert(worker).await?;
        let (worker, held) = (worker.clone(), BTreeMap::new());
        self.registration = Some(Registration { id, worker, held, pace: Pace::new() });
        Ok(())
    }

    /// One that was cut off for so long that it was forgotten comes back, as a new owner: it has lost what it had in
    /// hand.
    pub(super) async fn register_again(&mut self) -> Result<(), QueueError> {
        let worker = self.registration().worker.clone();
        self.registration_mut().id = self.insert(&worker).await?;
        Ok(())
    }

    async fn insert(&mut self, worker: &Worker) -> Result<i64, QueueError> {
        let now_ms = self.now_ms().await?;
        query(REGISTER)
            .bind(&worker.host)
            .bind(&worker.boot_id)
            .bind(&worker.pid_namespace)
            .bind(worker.pid)
            .bind(worker.process_start)
            .bind(i64::try_from(worker.threads).unwrap_or(i64::MAX))
            .bind(&worker.version)
            .bind(now_ms)
            .bind(self.lease_ms())
            .scalar(&mut self.connection)
            .await
    }

    /// The end of the work: whatever is still claimed is pending again.
    ///
    /// A process that is about to end because of an error calls this too, as far as the error lets it: jobs that it
    /// gives back did not crash.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn unregister(&mut self) -> Result<(), QueueError> {
        let Some(Registration { id, pace, .. }) = &self.registration else { return Ok(()) };
        let (id, finished) = (*id, pace.finished());
        self.write_own(async |connection, now_ms| {
            query(RELEASE_ALL).bind(id).bind(ENDED).run(connection).await?;
            query(END).bind(id).bind(now_ms).bind(finished).run(connection).await?;
            Ok(())
        })
        .await?;
        self.registration = None;
        Ok(())
    }

    /// Says that the worker has been asked to stop: if its process is ended before it has given its jobs back, that is
    /// no crash of theirs.
    ///
    /// # Errors
    /// If the database cannot be written.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn stopping(&mut self) -> Result<(), QueueError> {
        let id = self.registration().id;
        let stopping = query("UPDATE workers SET stopping_ms = $2 WHERE id = $1");
        let now_ms = self.now_ms().await?;
        stopping.bind(id).bind(now_ms).run(&mut self.connection).await?;
        Ok(())
    }

    /// # Panics
    /// If no worker is registered: a job without an owner could not be given back when its process dies.
    pub(super) fn registration(&self) -> &Registration {
        self.registration.as_ref().expect("jobs are run by a registered worker")
    }

    /// As [`Self::registration`].
    pub(super) fn registration_mut(&mut self) -> &mut Registration {
        self.registration.as_mut().expect("jobs are run by a registered worker")
    }
}
