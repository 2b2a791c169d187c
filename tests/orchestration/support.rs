//! A separate database for each test, with a clock that the test sets.

use std::path::PathBuf;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, SqliteConnection};
use tempfile::TempDir;
use tribosweep::queue::{
    Claim, ClaimedJob, Clock, Counts, Exchanged, Finished, FinishedOutcome, Location, NewJob, NewStudy,
    Queue, Scope, Settings, Worker,
};

use crate::server::ServerDatabase;
pub use crate::server::block_on;

/// A clock that stands still until the test sets it.
#[derive(Debug, Default, Clone)]
pub struct TestClock(Arc<AtomicI64>);

impl TestClock {
    pub fn set(&self, now_ms: i64) {
        self.0.store(now_ms, Ordering::Relaxed);
    }

    pub fn clock(&self) -> Clock {
        let now_ms = Arc::clone(&self.0);
        Clock::Given(Arc::new(move || now_ms.load(Ordering::Relaxed)))
    }
}

/// The kind of database.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Engine {
    /// A `SQLite` file.
    Sqlite,
    /// A database on a PostgreSQL server.
    Postgres,
}

/// Declares that each of the named tests runs on both databases. A test is `async fn NAME(sandbox: &Sandbox)`.
macro_rules! on_both_databases {
    ($($(#[$attribute:meta])* $name:ident),* $(,)?) => {
        $(mod $name {
            $(#[$attribute])*
            #[test]
            fn in_a_file() {
                crate::orchestration::support::run_in(crate::orchestration::support::Engine::Sqlite, |sandbox| Box::pin(super::$name(sandbox)));
            }

            $(#[$attribute])*
            #[test]
            fn on_a_server() {
                crate::orchestration::support::run_in(crate::orchestration::support::Engine::Postgres, |sandbox| Box::pin(super::$name(sandbox)));
            }
        })*
    };
}

/// Runs a test on that kind of database. Does nothing but say so if there is no server.
pub fn run_in(engine: Engine, test: fn(&Sandbox) -> Pin<Box<dyn Future<Output = ()> + '_>>) {
    if let Some(sandbox) = Sandbox::of(engine) {
        block_on(test(&sandbox));
    }
}

pub struct Sandbox {
    pub folder: TempDir,
    pub clock: TestClock,
    pub engine: Engine,
    location: Location,
    server: Option<ServerDatabase>,
}

impl Sandbox {
    /// A file in a temporary folder.
    pub fn new() -> Self {
        let folder = TempDir::new().unwrap();
        let location = Location::File(folder.path().join("sweep.db"));
        Self { folder, clock: TestClock::default(), engine: Engine::Sqlite, location, server: None }
    }

    /// A database of that kind. `None`, with a message, if there is no server.
    pub fn of(engine: Engine) -> Option<Self> {
        let mut sandbox = Self { engine, ..Self::new() };
        if engine == Engine::Postgres {
            let server = ServerDatabase::new()?;
            sandbox.location = Location::parse(server.url().into());
            sandbox.server = Some(server);
        }
        Some(sandbox)
    }

    /// Another, empty database of the same kind.
    pub fn another(&self) -> Self {
        Self::of(self.engine).expect("there is a server, because this database is on it")
    }

    pub fn location(&self) -> Location {
        self.location.clone()
    }

    /// The file.
    pub fn database(&self) -> PathBuf {
        self.location.path().expect("the database is a file").to_owned()
    }

    /// A queue whose worker is this process.
    pub async fn open(&self) -> Queue {
        self.open_as(&Worker::this_process(1, "test", "provenance")).await
    }

    /// A queue of that worker.
    pub async fn open_as(&self, worker: &Worker) -> Queue {
        let mut queue = Queue::open(self.location(), self.clock.clock()).await.unwrap();
        queue.register(worker).await.unwrap();
        queue
    }

    /// As [`Self::open`], with settings.
    pub async fn open_with(&self, settings: Settings) -> Queue {
        let mut queue = Queue::open_with(self.location(), self.clock.clock(), settings).await.unwrap();
        queue.register(&Worker::this_process(1, "test", "provenance")).await.unwrap();
        queue
    }

    /// A connection that bypasses the queue, to read or to damage the tables.
    pub async fn raw(&self) -> SqliteConnection {
        let options = SqliteConnectOptions::new().filename(self.database()).create_if_missing(true);
        options.connect().await.unwrap()
    }

    /// Runs a statement that bypasses the queue.
    pub async fn run(&self, statement: &'static str) {
        match &self.server {
            None => drop(sqlx::query(statement).execute(&mut self.raw().await).await.unwrap()),
            Some(server) => drop(sqlx::query(statement).execute(&mut server.raw().await).await.unwrap()),
        }
    }

    /// The text that a statement returns, bypassing the queue.
    pub async fn text(&self, statement: &'static str) -> String {
        match &self.server {
            None => sqlx::query_scalar(statement).fetch_one(&mut self.raw().await).await.unwrap(),
            Some(server) => sqlx::query_scalar(statement).fetch_one(&mut server.raw().await).await.unwrap(),
        }
    }

    /// The number that a statement returns, bypassing the queue.
    pub async fn number(&self, statement: &'static str) -> i64 {
        match &self.server {
            None => sqlx::query_scalar(statement).fetch_one(&mut self.raw().await).await.unwrap(),
            Some(server) => sqlx::query_scalar(statement).fetch_one(&mut server.raw().await).await.unwrap(),
        }
    }
}

pub fn job(key: &str, cost: f64) -> NewJob {
    NewJob {
        key: key.into(),
        payload: format!("payload of {key}"),
        parameters: format!("parameters of {key}"),
        cost,
        batch: String::new(),
        priority: None,
        parent: None,
    }
}

/// A study of jobs of equal cost.
pub fn study(name: &str, keys: &[&str]) -> NewStudy {
    NewStudy {
        name: name.into(),
        document: format!("document of {name}"),
        jobs: keys.iter().map(|key| job(key, 1.0)).collect(),
        grows: false,
    }
}

pub fn of(name: &str) -> Scope {
    Scope::Study(name.into())
}

pub fn counts(pending: u64, running: u64, done: u64, failed: u64) -> Counts {
    Counts { pending, running, done, failed, cancelled: 0 }
}

/// Claims jobs without storing outcomes.
pub async fn claim(queue: &mut Queue, scope: Scope, limit: usize) -> Vec<ClaimedJob> {
    let claim = Claim { scope, limit, batch: None };
    queue.exchange(&[], &[claim]).await.unwrap().claimed.remove(0)
}

/// Stores one outcome without claiming. Returns whether it was accepted.
pub async fn finish(queue: &mut Queue, key: &str, attempt: u32, outcome: FinishedOutcome) -> bool {
    let finished = Finished { key: key.into(), attempt, outcome, wall_s: 2.5 };
    store(queue, finished).await.refused.is_empty()
}

/// Stores one outcome without claiming.
pub async fn store(queue: &mut Queue, finished: Finished) -> Exchanged {
    queue.exchange(&[finished], &[]).await.unwrap()
}

/// A worker on this machine whose process has ended.
pub fn dead_worker() -> Worker {
    let mut child = std::process::Command::new("true").spawn().unwrap();
    let worker =
        Worker { pid: child.id(), process_start: Some(1), ..Worker::this_process(1, "test", "provenance") };
    child.wait().unwrap();
    worker
}

/// A worker on another machine, whose process is not visible from here.
pub fn foreign_worker() -> Worker {
    Worker { host: "elsewhere".into(), ..Worker::this_process(1, "test", "provenance") }
}

pub fn labelled(record: &str, label: &str) -> FinishedOutcome {
    FinishedOutcome::Done { record: record.into(), label: label.into(), final_state: None }
}

pub fn done(record: &str) -> FinishedOutcome {
    labelled(record, "end")
}

pub fn failed(error: &str) -> FinishedOutcome {
    FinishedOutcome::Failed { error: error.into() }
}

pub fn keys(jobs: &[ClaimedJob]) -> Vec<&str> {
    jobs.iter().map(|job| job.key.as_str()).collect()
}
