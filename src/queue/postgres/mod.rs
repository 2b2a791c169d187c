//! A queue in PostgreSQL: a session that is made anew when it is lost.
//!
//! A link can be cut without a sign. What is asked of the server is therefore waited for only so long; then the
//! connection is dropped, and the next use makes another one. The server is told to end the old session first, so
//! that what it was doing is either done or not, and its locks are gone. (That needs a direct connection, or a pooler
//! that keeps a session to one client.)

pub(super) mod error;
mod examine;
mod open;
mod schema;

pub(super) use open::{open, open_existing};

use std::time::Duration;

use sqlx::postgres::PgConnectOptions;
use sqlx::{Connection as _, PgConnection};

use super::engine::Access;
use super::{QueueError, Settings};

/// How long an answer is waited for, beyond the time that the server itself waits for locks.
const PATIENCE: Duration = Duration::from_secs(15);

/// The same for what works on whole studies.
const LONG_PATIENCE: Duration = Duration::from_mins(20);

/// How long the server waits for a session whose client says nothing in the middle of a transaction, and for the other
/// side of a link to show that it is there.
const SILENCE: Duration = Duration::from_secs(15);

/// The key of the advisory lock that transactions take, shared or alone: "trib" in ASCII, and then a number.
const WRITING: i64 = 0x7472_6962_0000_0001;

/// A session on the server.
#[derive(Debug)]
pub(super) struct Session {
    options: PgConnectOptions,
    settings: Settings,
    /// None after it was lost.
    connection: Option<PgConnection>,
    backend: Backend,
    is_in_transaction: bool,
    patience: Duration,
    /// Whether the session is not the first one, and what the one before sent last may have been done or not.
    pub is_in_doubt: bool,
}

/// What serves a session.
#[derive(Debug)]
struct Backend {
    /// The number of the process …
    pid: i32,
    /// … and when it began: what the server calls the session.
    started: String,
    is_encrypted: bool,
}

/// What goes out in one record of TLS, which has 16 kB, less what is around it. sqlx sends record by record and leaves it
/// to the system to gather small packets (no TCP_NODELAY): the second waits until the other side confirms the first, and
/// that takes its time. Measured: a turn of 24 kB took 48 ms instead of 5.
const RECORD: usize = 16_000;

impl Session {
    /// Up to which length a message goes out at once.
    pub fn message_bytes(&self) -> usize {
        if self.backend.is_encrypted { RECORD } else { usize::MAX }
    }

    async fn start(options: PgConnectOptions, settings: Settings) -> Result<Self, QueueError> {
        let patience = settings.busy_timeout + PATIENCE;
        let (connection, backend) = open::connect(&options, settings).await?;
        let connection = Some(connection);
        Ok(Self {
            options,
            settings,
            connection,
            backend,
            is_in_transaction: false,
            patience,
            is_in_doubt: false,
        })
    }

    /// Asks the server. After an error of the connection, or without an answer, the connection is gone.
    pub async fn attempt<T>(
        &mut self,
        ask: impl AsyncFnOnce(&mut PgConnection) -> Result<T, sqlx::Error>,
    ) -> Result<T, QueueError> {
        // Taken out: whatever stops this half-way, nobody goes on with a connection in an unknown state.
        let mut connection = match self.connection.take() {
            Some(connection) => connection,
            None if self.is_in_transaction => {
                return Err(QueueError::Unreachable("the connection was lost within a transaction".into()));
            }
            None => self.connect_again().await?,
        };
        let Ok(answer) = tokio::time::timeout(self.patience, ask(&mut connection)).await else {
            let waited_s = self.patience.as_secs();
            return Err(QueueError::Unreachable(format!("no answer within {waited_s} s")));
        };
        let answer = answer.map_err(QueueError::from);
        if !matches!(answer, Err(QueueError::Unreachable(_))) {
            self.connection = Some(connection);
        }
        answer
    }

    async fn connect_again(&mut self) -> Result<PgConnection, QueueError> {
        let (mut connection, backend) = open::connect_again(&self.options, self.settings).await?;
        open::end_session(&mut connection, &self.backend).await?;
        self.backend = backend;
        self.is_in_doubt = true;
        Ok(connection)
    }

    pub async fn begin(&mut self, access: Access) -> Result<i64, QueueError> {
        let (lock, patience) = match access {
            Access::Alone => ("pg_advisory_xact_lock", LONG_PATIENCE),
            Access::Shared => ("pg_advisory_xact_lock_shared", self.settings.busy_timeout + PATIENCE),
        };
        // In one message. A statement sees what was there when it began: the lock is to be had first.
        let patience_ms = patience.as_millis();
        let begin =
            format!("BEGIN; SET LOCAL statement_timeout TO {patience_ms}; SELECT {lock}({WRITING}); {NOW}");
        self.is_in_transaction = false;
        self.patience = patience;
        let begun = self.attempt(async |connection| time(connection, begin).await).await;
        self.is_in_transaction = begun.is_ok();
        if begun.is_err() {
            self.roll_back().await;
        }
        begun
    }

    pub async fn commit(&mut self) -> Result<(), QueueError> {
        let committed =
            self.attempt(async |connection| sqlx::raw_sql("COMMIT").execute(connection).await).await;
        self.end();
        committed.map(drop)
    }

    pub async fn roll_back(&mut self) {
        // A connection that is lost has taken its transaction with it.
        if self.connection.is_none() {
            return self.end();
        }
        let _ = self.attempt(async |connection| sqlx::raw_sql("ROLLBACK").execute(connection).await).await;
        self.end();
    }

    fn end(&mut self) {
        self.is_in_transaction = false;
        self.patience = self.settings.busy_timeout + PATIENCE;
    }

    pub async fn now_ms(&mut self) -> Result<i64, QueueError> {
        self.attempt(async |connection| time(connection, NOW.to_owned()).await).await
    }

    /// The server's own housekeeping would do it, some time.
    pub async fn compact(&mut self) -> Result<(), QueueError> {
        self.patience = LONG_PATIENCE;
        let statement_ms = (self.settings.busy_timeout + PATIENCE).as_millis();
        let vacuum = [
            format!("SET statement_timeout TO {}", LONG_PATIENCE.as_millis()),
            "VACUUM jobs, payloads, results, checkpoints, workers, study_jobs, study_pending".to_owned(),
            format!("SET statement_timeout TO {statement_ms}"),
        ];
        let mut done = Ok(());
        // One by one: several in one message are a transaction, in which nothing can be vacuumed.
        for statement in vacuum {
            let statement = sqlx::AssertSqlSafe(statement);
            let ran = self.attempt(async |connection| sqlx::raw_sql(statement).execute(connection).await);
            done = done.and(ran.await.map(drop));
        }
        self.end();
        done
    }

    pub async fn size(&mut self) -> Result<u64, QueueError> {
        let size = "SELECT CAST(COALESCE(SUM(pg_total_relation_size(oid)), 0) AS BIGINT) FROM pg_class
                    WHERE relnamespace = current_schema()::regnamespace AND relkind = 'r'";
        let size: i64 =
            self.attempt(async |connection| sqlx::query_scalar(size).fetch_one(connection).await).await?;
        Ok(size.unsigned_abs())
    }

    pub async fn close(self) {
        if let Some(connection) = self.connection {
            // The server notices by itself.
            let _ = tokio::time::timeout(SILENCE, connection.close()).await;
        }
    }
}

/// Milliseconds since 1970-01-01 UTC: now, not when the transaction began.
const NOW: &str = "SELECT CAST(EXTRACT(EPOCH FROM clock_timestamp()) * 1000 AS BIGINT)";

/// The time with which `statements` end.
async fn time(connection: &mut PgConnection, statements: String) -> Result<i64, sqlx::Error> {
    use sqlx::Row as _;
    let rows = sqlx::raw_sql(sqlx::AssertSqlSafe(statements)).fetch_all(connection).await?;
    rows.last().ok_or(sqlx::Error::RowNotFound)?.try_get(0)
}
