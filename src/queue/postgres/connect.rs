//! Connections to the server and their settings.

use std::io::ErrorKind;
use std::time::Duration;

use sqlx::postgres::PgConnectOptions;
use sqlx::{ConnectOptions, PgConnection};

use super::error::classify;
use super::schema;
use crate::queue::error::QueueError;
use crate::queue::settings::Settings;

/// How long to wait for a connection.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

/// How long to wait for an answer, in addition to the time that the server itself waits for locks.
pub(super) const ANSWER_TIMEOUT: Duration = Duration::from_secs(15);

/// How long the server waits for a client that is silent in the middle of a transaction, and how long either side waits
/// for a network link that does not respond.
pub(super) const SILENCE_LIMIT: Duration = Duration::from_secs(15);

/// The server process of a session.
#[derive(Debug)]
pub(super) struct Backend {
    /// The process number. The server may use it again for a later session.
    pid: i32,
    /// When the process began, in the server's text form. Together with the number it identifies the session.
    started: String,
    pub is_encrypted: bool,
}

/// Why no connection could be made.
#[derive(Debug)]
pub(super) enum ConnectError {
    /// The connection cannot be encrypted as the URL demands. Waiting does not help.
    Encryption(sqlx::Error),
    /// Any other error.
    Other(QueueError),
}

/// Makes a connection with the settings of a session. Also returns what identifies the session on the server.
pub(super) async fn connect(
    options: &PgConnectOptions,
    settings: Settings,
) -> Result<(PgConnection, Backend), ConnectError> {
    let connecting = async {
        let mut connection = options.connect().await?;
        let silence_ms = SILENCE_LIMIT.as_millis();
        let silence_s = SILENCE_LIMIT.as_secs();
        // The timeouts for silent clients: without them, the session of a client that is gone would hold its locks
        // until the operating system gives the connection up, which takes a quarter of an hour.
        //
        // The planner settings: every statement here is written for its indexes and reads a few entries of them. The
        // planner does not know that. It has no statistics of jobs that were submitted a moment ago, and the statistics
        // of a busy queue are out of date. It would then sort all pending jobs for each claim (measured: 80 ms instead
        // of 3). JIT compilation would take longer than the statements.
        let set = format!(
            "SET search_path TO {schema};
             SET client_min_messages TO warning;
             SET lock_timeout TO {lock_ms};
             SET statement_timeout TO {statement_ms};
             SET idle_in_transaction_session_timeout TO {silence_ms};
             SET tcp_user_timeout TO {silence_ms};
             SET tcp_keepalives_idle TO {silence_s};
             SET tcp_keepalives_interval TO 5;
             SET tcp_keepalives_count TO 3;
             SET enable_seqscan TO off;
             SET enable_bitmapscan TO off;
             SET enable_hashjoin TO off;
             SET enable_mergejoin TO off;
             SET enable_sort TO off;
             SET jit TO off",
            schema = schema::NAME,
            // The server should not work on a statement whose answer the client no longer waits for.
            statement_ms = (settings.busy_timeout + ANSWER_TIMEOUT).as_millis(),
            lock_ms = settings.busy_timeout.as_millis(),
        );
        sqlx::raw_sql(sqlx::AssertSqlSafe(set)).execute(&mut connection).await?;
        // Not every system supports this. Without it, an abandoned statement runs until its own timeout.
        let check = format!("SET client_connection_check_interval TO {silence_ms}");
        let _ = sqlx::raw_sql(sqlx::AssertSqlSafe(check)).execute(&mut connection).await;
        let backend = "SELECT a.pid, CAST(a.backend_start AS TEXT), COALESCE(s.ssl, FALSE)
                       FROM pg_stat_activity AS a LEFT JOIN pg_stat_ssl AS s ON s.pid = a.pid
                       WHERE a.pid = pg_backend_pid()";
        let (pid, started, is_encrypted) = sqlx::query_as(backend).fetch_one(&mut connection).await?;
        Ok((connection, Backend { pid, started, is_encrypted }))
    };
    let Ok(connected) = tokio::time::timeout(CONNECT_TIMEOUT, connecting).await else {
        let reason = format!("no connection within {} s", CONNECT_TIMEOUT.as_secs());
        return Err(ConnectError::Other(QueueError::Unreachable(reason)));
    };
    connected.map_err(|error| connect_error(options, error))
}

/// sqlx reports missing and invalid certificate files as I/O errors of the connection.
fn connect_error(options: &PgConnectOptions, error: sqlx::Error) -> ConnectError {
    // With a Unix socket, a missing file means that the server is not there.
    let is_tcp = options.get_socket().is_none() && !options.get_host().starts_with('/');
    let is_encryption = match &error {
        sqlx::Error::Tls(_) => true,
        sqlx::Error::Io(source) => match source.kind() {
            ErrorKind::InvalidData => true,
            ErrorKind::NotFound | ErrorKind::PermissionDenied => is_tcp,
            _ => false,
        },
        _ => false,
    };
    if is_encryption { ConnectError::Encryption(error) } else { ConnectError::Other(classify(error)) }
}

/// As [`connect`], for a session that had a connection before. A certificate that was trusted before is expected to be
/// trusted again, so the worker, which holds results, waits also after an encryption error.
pub(super) async fn connect_again(
    options: &PgConnectOptions,
    settings: Settings,
) -> Result<(PgConnection, Backend), QueueError> {
    connect(options, settings).await.map_err(|error| match error {
        ConnectError::Encryption(error) => QueueError::Unreachable(error.to_string()),
        ConnectError::Other(error) => error,
    })
}

/// Makes the server end a lost session, if it still exists, and waits until the session has ended.
pub(super) async fn end_session(connection: &mut PgConnection, lost: &Backend) -> Result<(), QueueError> {
    let end = "SELECT pg_terminate_backend(pid, 10000) FROM pg_stat_activity
               WHERE pid = $1 AND CAST(backend_start AS TEXT) = $2";
    let ending = sqlx::query_scalar(end).bind(lost.pid).bind(&lost.started).fetch_optional(connection);
    match tokio::time::timeout(CONNECT_TIMEOUT + SILENCE_LIMIT, ending).await {
        Ok(Ok(None | Some(true))) => Ok(()),
        Ok(Ok(Some(false))) => Err(QueueError::Unreachable("the lost session has not ended yet".into())),
        Ok(Err(error)) => Err(classify(error)),
        Err(_) => Err(QueueError::Unreachable("no answer".into())),
    }
}
