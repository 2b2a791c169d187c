use std::time::Duration;

use sqlx::postgres::PgConnectOptions;
use sqlx::{Connection as _, PgConnection};

use super::connect::{self, ANSWER_TIMEOUT, Backend, ConnectError, SILENCE_LIMIT};
use super::error::classify;
use crate::queue::access::Access;
use crate::queue::error::QueueError;
use crate::queue::settings::Settings;

/// As [`ANSWER_TIMEOUT`], for transactions that change whole studies.
const LONG_ANSWER_TIMEOUT: Duration = Duration::from_mins(20);

/// The key of the advisory lock that writing transactions take, shared or exclusive: "trib" in ASCII, and a number.
const WRITE_LOCK: i64 = 0x7472_6962_0000_0001;

/// The largest message, in bytes, that fits into one TLS record of 16 kB with its overhead. sqlx sends one record at a
/// time and does not set TCP_NODELAY, so a second record waits until the server has acknowledged the first one.
/// (Measured: an exchange of 24 kB took 48 ms instead of 5.)
const TLS_RECORD_BYTES: usize = 16_000;

/// A session on the server.
#[derive(Debug)]
pub(in crate::queue) struct Session {
    options: PgConnectOptions,
    settings: Settings,
    /// None after the connection was lost.
    connection: Option<PgConnection>,
    backend: Backend,
    is_in_transaction: bool,
    answer_timeout: Duration,
    /// Whether the session has replaced a lost one. It is then not known whether the last transaction of the lost
    /// session was committed.
    pub is_in_doubt: bool,
}

impl Session {
    /// The longest message, in bytes, that is sent without a delay.
    pub fn max_message_bytes(&self) -> usize {
        if self.backend.is_encrypted { TLS_RECORD_BYTES } else { usize::MAX }
    }

    pub(super) async fn start(options: PgConnectOptions, settings: Settings) -> Result<Self, ConnectError> {
        let answer_timeout = settings.busy_timeout + ANSWER_TIMEOUT;
        let (connection, backend) = connect::connect(&options, settings).await?;
        let connection = Some(connection);
        Ok(Self {
            options,
            settings,
            connection,
            backend,
            is_in_transaction: false,
            answer_timeout,
            is_in_doubt: false,
        })
    }

    /// Sends a request and waits for the answer. After a connection error or a timeout, the connection is dropped.
    pub async fn request<T>(
        &mut self,
        ask: impl AsyncFnOnce(&mut PgConnection) -> Result<T, sqlx::Error>,
    ) -> Result<T, QueueError> {
        // The connection is taken out: if this future is dropped, nobody continues on a connection in an unknown state.
        let mut connection = match self.connection.take() {
            Some(connection) => connection,
            None if self.is_in_transaction => {
                return Err(QueueError::Unreachable("the connection was lost within a transaction".into()));
            }
            None => self.connect_again().await?,
        };
        let Ok(answer) = tokio::time::timeout(self.answer_timeout, ask(&mut connection)).await else {
            let waited_s = self.answer_timeout.as_secs();
            return Err(QueueError::Unreachable(format!("no answer within {waited_s} s")));
        };
        let answer = answer.map_err(classify);
        if !matches!(answer, Err(QueueError::Unreachable(_))) {
            self.connection = Some(connection);
        }
        answer
    }

    async fn connect_again(&mut self) -> Result<PgConnection, QueueError> {
        let (mut connection, backend) = connect::connect_again(&self.options, self.settings).await?;
        connect::end_session(&mut connection, &self.backend).await?;
        self.backend = backend;
        self.is_in_doubt = true;
        Ok(connection)
    }

    pub async fn begin(&mut self, access: Access) -> Result<i64, QueueError> {
        let (lock, timeout) = match access {
            Access::Exclusive => ("pg_advisory_xact_lock", LONG_ANSWER_TIMEOUT),
            Access::Shared => ("pg_advisory_xact_lock_shared", self.settings.busy_timeout + ANSWER_TIMEOUT),
        };
        // One message with separate statements: a statement sees the rows as they were when it began, so the lock must
        // be held before the first real statement begins.
        let timeout_ms = timeout.as_millis();
        let begin =
            format!("BEGIN; SET LOCAL statement_timeout TO {timeout_ms}; SELECT {lock}({WRITE_LOCK}); {NOW}");
        self.is_in_transaction = false;
        self.answer_timeout = timeout;
        let begun = self.request(async |connection| time(connection, begin).await).await;
        self.is_in_transaction = begun.is_ok();
        if begun.is_err() {
            self.roll_back().await;
        }
        begun
    }

    pub async fn commit(&mut self) -> Result<(), QueueError> {
        let committed =
            self.request(async |connection| sqlx::raw_sql("COMMIT").execute(connection).await).await;
        self.leave_transaction();
        committed.map(drop)
    }

    pub async fn roll_back(&mut self) {
        // Without a connection there is nothing to roll back: the server has done it, or does it when it notices the
        // loss.
        if self.connection.is_none() {
            return self.leave_transaction();
        }
        let _ = self.request(async |connection| sqlx::raw_sql("ROLLBACK").execute(connection).await).await;
        self.leave_transaction();
    }

    fn leave_transaction(&mut self) {
        self.is_in_transaction = false;
        self.answer_timeout = self.settings.busy_timeout + ANSWER_TIMEOUT;
    }

    pub async fn now_ms(&mut self) -> Result<i64, QueueError> {
        self.request(async |connection| time(connection, NOW.to_owned()).await).await
    }

    /// Frees the space of deleted rows now. (The server's autovacuum would do it later.)
    pub async fn compact(&mut self) -> Result<(), QueueError> {
        self.answer_timeout = LONG_ANSWER_TIMEOUT;
        let statement_ms = (self.settings.busy_timeout + ANSWER_TIMEOUT).as_millis();
        let vacuum = [
            format!("SET statement_timeout TO {}", LONG_ANSWER_TIMEOUT.as_millis()),
            "VACUUM jobs, payloads, results, checkpoints, workers, study_jobs, study_pending".to_owned(),
            format!("SET statement_timeout TO {statement_ms}"),
        ];
        let mut done = Ok(());
        // In separate messages: several statements in one message are one transaction, and VACUUM is not allowed in
        // one.
        for statement in vacuum {
            let statement = sqlx::AssertSqlSafe(statement);
            let ran = self.request(async |connection| sqlx::raw_sql(statement).execute(connection).await);
            done = done.and(ran.await.map(drop));
        }
        self.leave_transaction();
        done
    }

    pub async fn size(&mut self) -> Result<u64, QueueError> {
        let size = "SELECT CAST(COALESCE(SUM(pg_total_relation_size(oid)), 0) AS BIGINT) FROM pg_class
                    WHERE relnamespace = current_schema()::regnamespace AND relkind = 'r'";
        let size: i64 =
            self.request(async |connection| sqlx::query_scalar(size).fetch_one(connection).await).await?;
        Ok(size.unsigned_abs())
    }

    pub async fn close(self) {
        if let Some(connection) = self.connection {
            // If this fails, the server notices by itself that the client is gone.
            let _ = tokio::time::timeout(SILENCE_LIMIT, connection.close()).await;
        }
    }
}

/// Milliseconds since 1970-01-01 UTC at the time of the statement. (`now()` would be the start of the transaction.)
const NOW: &str = "SELECT CAST(EXTRACT(EPOCH FROM clock_timestamp()) * 1000 AS BIGINT)";

/// Runs `statements`, of which the last one selects the time, and returns the time.
async fn time(connection: &mut PgConnection, statements: String) -> Result<i64, sqlx::Error> {
    use sqlx::Row as _;
    let rows = sqlx::raw_sql(sqlx::AssertSqlSafe(statements)).fetch_all(connection).await?;
    rows.last().ok_or(sqlx::Error::RowNotFound)?.try_get(0)
}
