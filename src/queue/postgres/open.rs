//! Opening a database on a server.

use std::str::FromStr;

use sqlx::postgres::PgConnectOptions;

use super::connect::ConnectError;
use super::schema;
use super::session::Session;
use crate::queue::error::QueueError;
use crate::queue::location::{Location, Server};
use crate::queue::settings::Settings;

/// The oldest supported PostgreSQL. `pg_terminate_backend` can wait for the end of a session since version 14.
const OLDEST: i32 = 14;

/// Opens the database. Creates its tables if they are missing.
pub(in crate::queue) async fn open(server: &Server, settings: Settings) -> Result<Session, QueueError> {
    let mut session = start(server, settings).await?;
    let location = Location::Server(server.clone());
    session.request(async |connection| Ok(schema::migrate(connection, &location).await)).await??;
    Ok(session)
}

/// Opens the database, which must have tables.
pub(in crate::queue) async fn open_existing(
    server: &Server,
    settings: Settings,
) -> Result<Session, QueueError> {
    let mut session = start(server, settings).await?;
    let location = Location::Server(server.clone());
    let has_tables = session.request(schema::has_tables).await?;
    if !has_tables {
        return Err(QueueError::NoDatabase { database: location });
    }
    session.request(async |connection| Ok(schema::migrate(connection, &location).await)).await??;
    Ok(session)
}

async fn start(server: &Server, settings: Settings) -> Result<Session, QueueError> {
    let database = || Location::Server(server.clone());
    let refused = |reason: String| QueueError::Server { database: database(), reason };
    let options = PgConnectOptions::from_str(server.url()).map_err(|error| {
        refused(format!("the URL cannot be read ({error}); expected postgres://USER@HOST:PORT/DATABASE"))
    })?;
    let session = Session::start(options.application_name("tribosweep"), settings).await;
    let mut session = session.map_err(|error| match error {
        ConnectError::Encryption(error) => refused(unencrypted(&error)),
        ConnectError::Other(QueueError::Unreachable(reason)) => {
            QueueError::NoAnswer { database: database(), reason }
        }
        ConnectError::Other(QueueError::Database(error)) => {
            refused(format!("the server refuses the connection ({error})"))
        }
        ConnectError::Other(error) => error,
    })?;
    let version = "SELECT CAST(current_setting('server_version_num') AS INTEGER) / 10000";
    let version: i32 =
        session.request(async |connection| sqlx::query_scalar(version).fetch_one(connection).await).await?;
    if version < OLDEST {
        return Err(refused(format!("PostgreSQL {version} is too old; {OLDEST} or newer is needed")));
    }
    Ok(session)
}

/// Why a connection cannot be encrypted, and what would help.
fn unencrypted(error: &sqlx::Error) -> String {
    if error.to_string().contains("invalid peer certificate") {
        return format!(
            "the server's certificate is not trusted ({error}); name the site's certificate file with \
             `?sslmode=verify-full&sslrootcert=FILE`, or encrypt without checking the certificate with `?sslmode=require`"
        );
    }
    format!(
        "the connection cannot be encrypted as the URL demands ({error}); check the files that `sslrootcert`, `sslcert` \
         and `sslkey` in the URL or PGSSLROOTCERT, PGSSLCERT and PGSSLKEY name, or do not encrypt, with \
         `?sslmode=disable`"
    )
}
