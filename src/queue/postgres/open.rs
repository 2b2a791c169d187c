//! Sessions and their settings.

use std::str::FromStr;

use sqlx::postgres::PgConnectOptions;
use sqlx::{ConnectOptions, PgConnection};

use super::{Backend, PATIENCE, SILENCE, Session, schema};
use crate::queue::location::Server;
use crate::queue::{Location, QueueError, Settings};

/// The oldest server that has what is used here (13: ending a session and waiting for that is of 14).
const OLDEST: i32 = 14;

/// How long a connection may take.
const CONNECTING: std::time::Duration = std::time::Duration::from_secs(10);

/// Opens the database; creates its tables if they are missing.
pub(in crate::queue) async fn open(server: &Server, settings: Settings) -> Result<Session, QueueError> {
    let mut session = start(server, settings).await?;
    let location = Location::Server(server.clone());
    session.attempt(async |connection| Ok(schema::migrate(connection, &location).await)).await??;
    Ok(session)
}

/// Opens the database, which must have tables.
pub(in crate::queue) async fn open_existing(
    server: &Server,
    settings: Settings,
) -> Result<Session, QueueError> {
    let mut session = start(server, settings).await?;
    let location = Location::Server(server.clone());
    let has_tables = session.attempt(schema::has_tables).await?;
    if !has_tables {
        return Err(QueueError::NoDatabase { database: location });
    }
    session.attempt(async |connection| Ok(schema::migrate(connection, &location).await)).await??;
    Ok(session)
}

async fn start(server: &Server, settings: Settings) -> Result<Session, QueueError> {
    let database = || Location::Server(server.clone());
    let refused = |reason: String| QueueError::Server { database: database(), reason };
    let options = PgConnectOptions::from_str(server.url()).map_err(|error| {
        refused(format!("the URL cannot be read ({error}); expected postgres://USER@HOST:PORT/DATABASE"))
    })?;
    let mut session = Session::start(options.application_name("tribosweep"), settings).await.map_err(
        |error| match error {
            QueueError::Unreachable(reason) => QueueError::NoAnswer { database: database(), reason },
            QueueError::Database(error @ (sqlx::Error::Io(_) | sqlx::Error::Tls(_))) => {
                refused(unencrypted(&error))
            }
            QueueError::Database(error) => refused(format!("the server does not let us in ({error})")),
            other => other,
        },
    )?;
    let version = "SELECT CAST(current_setting('server_version_num') AS INTEGER) / 10000";
    let version: i32 =
        session.attempt(async |connection| sqlx::query_scalar(version).fetch_one(connection).await).await?;
    if version < OLDEST {
        return Err(refused(format!("PostgreSQL {version} is too old; {OLDEST} or newer is needed")));
    }
    Ok(session)
}

/// A connection with a session's settings, and what the server calls it.
pub(super) async fn connect(
    options: &PgConnectOptions,
    settings: Settings,
) -> Result<(PgConnection, Backend), QueueError> {
    let connecting = async {
        let mut connection = options.connect().await?;
        let silence_ms = SILENCE.as_millis();
        let silence_s = SILENCE.as_secs();
        // A session whose client is gone must not hold its locks until the system gives the connection up, which
        // takes a quarter of an hour.
        //
        // Every statement here is made for its indexes, and reads a few entries of them. The planner does not know: of
        // jobs that were submitted a moment ago it has no statistics, of a queue that is worked on wrong ones, and then
        // it sorts all pending jobs for each claim (measured: 80 ms instead of 3). What is to be compiled first is slower
        // than what is done here.
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
            // What nobody waits for any more is not to be worked on either.
            statement_ms = (settings.busy_timeout + PATIENCE).as_millis(),
            lock_ms = settings.busy_timeout.as_millis(),
        );
        sqlx::raw_sql(sqlx::AssertSqlSafe(set)).execute(&mut connection).await?;
        // Not on every system; without it, what nobody waits for is worked on until its own limit.
        let check = format!("SET client_connection_check_interval TO {silence_ms}");
        let _ = sqlx::raw_sql(sqlx::AssertSqlSafe(check)).execute(&mut connection).await;
        let backend = "SELECT a.pid, CAST(a.backend_start AS TEXT), COALESCE(s.ssl, FALSE)
                       FROM pg_stat_activity AS a LEFT JOIN pg_stat_ssl AS s ON s.pid = a.pid
                       WHERE a.pid = pg_backend_pid()";
        let (pid, started, is_encrypted) = sqlx::query_as(backend).fetch_one(&mut connection).await?;
        Ok((connection, Backend { pid, started, is_encrypted }))
    };
    match tokio::time::timeout(CONNECTING, connecting).await {
        Ok(connected) => connected.map_err(|error| connection_error(options, error)),
        Err(_) => Err(QueueError::Unreachable(format!("no connection within {} s", CONNECTING.as_secs()))),
    }
}

/// What is wrong with certificates and their files comes as an error of the connection, and waiting does not help.
fn connection_error(options: &PgConnectOptions, error: sqlx::Error) -> QueueError {
    use std::io::ErrorKind;
    // Of a socket in the file system it would mean that the server is not there.
    let has_files = options.get_socket().is_none() && !options.get_host().starts_with('/');
    match &error {
        sqlx::Error::Tls(_) => QueueError::Database(error),
        sqlx::Error::Io(source) if source.kind() == ErrorKind::InvalidData => QueueError::Database(error),
        sqlx::Error::Io(source)
            if has_files && matches!(source.kind(), ErrorKind::NotFound | ErrorKind::PermissionDenied) =>
        {
            QueueError::Database(error)
        }
        _ => error.into(),
    }
}

/// Why a connection cannot be encrypted, and what would help.
fn unencrypted(error: &sqlx::Error) -> String {
    let told = error.to_string();
    if told.contains("invalid peer certificate") {
        return format!(
            "the server's certificate is not trusted ({error}); name the file with the site's own by \
             `?sslmode=verify-full&sslrootcert=FILE`, or encrypt without looking at it by `?sslmode=require`"
        );
    }
    format!(
        "the connection cannot be encrypted as it is asked for ({error}); look at the files that `sslrootcert`, `sslcert` \
         and `sslkey` in the URL or PGSSLROOTCERT, PGSSLCERT and PGSSLKEY name, or do without by `?sslmode=disable`"
    )
}

/// What was trusted before will be again: a worker has results in hand, and waits.
pub(super) async fn connect_again(
    options: &PgConnectOptions,
    settings: Settings,
) -> Result<(PgConnection, Backend), QueueError> {
    connect(options, settings).await.map_err(|error| match error {
        QueueError::Database(error @ (sqlx::Error::Io(_) | sqlx::Error::Tls(_))) => {
            QueueError::Unreachable(error.to_string())
        }
        other => other,
    })
}

/// Ends a session that was lost, if the server still has it, and waits until it has ended.
pub(super) async fn end_session(connection: &mut PgConnection, lost: &Backend) -> Result<(), QueueError> {
    let end = "SELECT pg_terminate_backend(pid, 10000) FROM pg_stat_activity
               WHERE pid = $1 AND CAST(backend_start AS TEXT) = $2";
    let ending = sqlx::query_scalar(end).bind(lost.pid).bind(&lost.started).fetch_optional(connection);
    match tokio::time::timeout(CONNECTING + SILENCE, ending).await {
        Ok(Ok(None | Some(true))) => Ok(()),
        Ok(Ok(Some(false))) => {
            Err(QueueError::Unreachable("the session that was lost has not ended yet".into()))
        }
        Ok(Err(error)) => Err(error.into()),
        Err(_) => Err(QueueError::Unreachable("no answer".into())),
    }
}
