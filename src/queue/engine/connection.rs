#[cfg(test)]
use sqlx::SqliteConnection;

use crate::queue::access::Access;
use crate::queue::clock::{self, Clock};
use crate::queue::error::QueueError;
#[cfg(feature = "postgres")]
use crate::queue::postgres::Session;
use crate::queue::sqlite;

/// A connection to one of the databases.
#[derive(Debug)]
pub(in crate::queue) enum Connection {
    /// To a file.
    Sqlite(sqlite::File),
    /// To a server.
    #[cfg(feature = "postgres")]
    Postgres(Box<Session>),
}

impl Connection {
    /// Begins a transaction that writes. Returns the time in milliseconds since 1970-01-01 UTC.
    pub async fn begin(&mut self, access: Access, clock: &Clock) -> Result<i64, QueueError> {
        let database_ms = match self {
            Self::Sqlite(file) => {
                sqlite::begin(file).await?;
                None
            }
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => Some(session.begin(access).await?),
        };
        #[cfg(not(feature = "postgres"))]
        let _ = access;
        Ok(time(clock, database_ms))
    }

    /// Commits the transaction.
    pub async fn commit(&mut self) -> Result<(), QueueError> {
        match self {
            Self::Sqlite(file) => sqlite::commit(file).await,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.commit().await,
        }
    }

    /// Rolls the transaction back, unless the database has already done so.
    pub async fn roll_back(&mut self) {
        match self {
            Self::Sqlite(file) => sqlite::roll_back(file).await,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.roll_back().await,
        }
    }

    /// The time outside of a transaction, in milliseconds since 1970-01-01 UTC.
    pub async fn now_ms(&mut self, clock: &Clock) -> Result<i64, QueueError> {
        let database_ms = match self {
            Self::Sqlite(_) => None,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => Some(session.now_ms().await?),
        };
        Ok(time(clock, database_ms))
    }

    /// Whether the connection was lost and replaced since the last [`Self::clear_doubt`]. Then it is not known whether
    /// the last transaction was committed.
    pub fn is_in_doubt(&self) -> bool {
        match self {
            Self::Sqlite(_) => false,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.is_in_doubt,
        }
    }

    /// Declares that the caller has found out whether the last transaction was committed.
    pub fn clear_doubt(&mut self) {
        #[cfg(feature = "postgres")]
        if let Self::Postgres(session) = self {
            session.is_in_doubt = false;
        }
    }

    /// The longest message, in bytes, that is sent without a delay.
    pub fn max_message_bytes(&self) -> usize {
        match self {
            Self::Sqlite(_) => usize::MAX,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.max_message_bytes(),
        }
    }

    /// Frees the space of deleted rows.
    pub async fn compact(&mut self) -> Result<(), QueueError> {
        match self {
            Self::Sqlite(file) => sqlite::compact(file).await,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.compact().await,
        }
    }

    /// The size of the database in bytes.
    pub async fn size(&mut self) -> Result<u64, QueueError> {
        match self {
            Self::Sqlite(file) => sqlite::size(file).await,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.size().await,
        }
    }

    /// The connection to a file, for tests that look at query plans and counters.
    #[cfg(test)]
    pub fn sqlite(&mut self) -> &mut SqliteConnection {
        match self {
            Self::Sqlite(file) => file.connection(),
            #[cfg(feature = "postgres")]
            Self::Postgres(_) => panic!("the database is on a server"),
        }
    }

    /// Closes the connection and waits until it is closed.
    pub async fn close(self) -> Result<(), QueueError> {
        match self {
            Self::Sqlite(file) => file.close().await,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => {
                session.close().await;
                Ok(())
            }
        }
    }
}

fn time(clock: &Clock, database_ms: Option<i64>) -> i64 {
    match clock {
        Clock::Given(now_ms) => now_ms(),
        Clock::OfDatabase => database_ms.unwrap_or_else(clock::machine_ms),
    }
}
