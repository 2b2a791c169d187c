//! One connection to one of the databases, and statements for both: what is different between them is here, in
//! `sqlite`, in `postgres`, and in the few statements that come in two dialects.

mod query;
mod statement;

pub(super) use query::query;
pub(super) use statement::Statement;

use sqlx::{Connection as _, SqliteConnection};

use super::{Clock, QueueError, clock, sqlite};

/// A connection.
#[derive(Debug)]
pub(super) enum Connection {
    /// To a file.
    Sqlite(SqliteConnection),
    /// To a server.
    #[cfg(feature = "postgres")]
    Postgres(Box<super::postgres::Session>),
}

/// Beside whom a transaction may write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Access {
    /// Alone: it changes what others may have in hand. (On `SQLite` all do.)
    Alone,
    /// Beside others of its kind: it claims what nobody has, or changes what its own worker has.
    Shared,
}

impl Connection {
    /// Begins a transaction that writes, and gives the time.
    pub async fn begin(&mut self, access: Access, clock: &Clock) -> Result<i64, QueueError> {
        let database_ms = match self {
            Self::Sqlite(connection) => {
                sqlite::begin(connection).await?;
                None
            }
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => Some(session.begin(access).await?),
        };
        #[cfg(not(feature = "postgres"))]
        let _ = access;
        Ok(time(clock, database_ms))
    }

    /// Ends a transaction and keeps what it wrote.
    pub async fn commit(&mut self) -> Result<(), QueueError> {
        match self {
            Self::Sqlite(connection) => sqlite::commit(connection).await,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.commit().await,
        }
    }

    /// Ends a transaction as if it had not been, as far as that has not happened already.
    pub async fn roll_back(&mut self) {
        match self {
            Self::Sqlite(connection) => sqlite::roll_back(connection).await,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.roll_back().await,
        }
    }

    /// The time, outside of transactions.
    pub async fn now_ms(&mut self, clock: &Clock) -> Result<i64, QueueError> {
        let database_ms = match self {
            Self::Sqlite(_) => None,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => Some(session.now_ms().await?),
        };
        Ok(time(clock, database_ms))
    }

    /// Whether it was lost and made anew since this was last forgotten: what was sent last may have been done or not.
    pub fn is_in_doubt(&self) -> bool {
        match self {
            Self::Sqlite(_) => false,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.is_in_doubt,
        }
    }

    /// Up to which length a message is not delayed.
    pub fn message_bytes(&self) -> usize {
        match self {
            Self::Sqlite(_) => usize::MAX,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.message_bytes(),
        }
    }

    /// What was in doubt has been settled.
    pub fn is_settled(&mut self) {
        #[cfg(feature = "postgres")]
        if let Self::Postgres(session) = self {
            session.is_in_doubt = false;
        }
    }

    /// Gives the space back that was deleted from.
    pub async fn compact(&mut self) -> Result<(), QueueError> {
        match self {
            Self::Sqlite(connection) => sqlite::compact(connection).await,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.compact().await,
        }
    }

    /// The size of the database in bytes.
    pub async fn size(&mut self) -> Result<u64, QueueError> {
        match self {
            Self::Sqlite(connection) => sqlite::size(connection).await,
            #[cfg(feature = "postgres")]
            Self::Postgres(session) => session.size().await,
        }
    }

    /// The connection to a file, to look at what the library does.
    #[cfg(test)]
    pub fn sqlite(&mut self) -> &mut SqliteConnection {
        match self {
            Self::Sqlite(connection) => connection,
            #[cfg(feature = "postgres")]
            Self::Postgres(_) => panic!("the database is on a server"),
        }
    }

    /// Closes the connection and waits for it.
    pub async fn close(self) -> Result<(), QueueError> {
        match self {
            Self::Sqlite(connection) => Ok(connection.close().await?),
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
