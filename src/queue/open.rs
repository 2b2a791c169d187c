use super::engine::Connection;
use super::{Clock, Location, Queue, QueueError, Settings, sqlite};

impl Queue {
    /// Opens the database at `location`; creates its tables, and a file but not its folder, if they are missing.
    ///
    /// # Errors
    /// If the folder is missing, the path holds something else or a newer schema, or the file system or
    /// the `SQLite` library cannot be trusted with several writers. If the server does not answer or let us in.
    pub async fn open(location: impl Into<Location>, clock: Clock) -> Result<Self, QueueError> {
        Self::open_with(location, clock, Settings::default()).await
    }

    /// As [`Queue::open`], with settings other than the default.
    ///
    /// # Errors
    /// As [`Queue::open`].
    pub async fn open_with(
        location: impl Into<Location>,
        clock: Clock,
        settings: Settings,
    ) -> Result<Self, QueueError> {
        let location = location.into();
        check(&location)?;
        let connection = match &location {
            Location::File(path) => Connection::Sqlite(sqlite::open(path, settings).await?),
            #[cfg(feature = "postgres")]
            Location::Server(server) => {
                Connection::Postgres(Box::new(super::postgres::open(server, settings).await?))
            }
            #[cfg(not(feature = "postgres"))]
            Location::Server(_) => return Err(no_postgres(location)),
        };
        Ok(Self::of(connection, location, clock, settings))
    }

    /// Opens the database at `location`, which must exist.
    ///
    /// # Errors
    /// [`QueueError::NoDatabase`] if there is none, otherwise as [`Queue::open`].
    pub async fn open_existing(
        location: impl Into<Location>,
        clock: Clock,
        settings: Settings,
    ) -> Result<Self, QueueError> {
        let location = location.into();
        check(&location)?;
        match &location {
            Location::File(path) if !path.exists() => Err(QueueError::NoDatabase { database: location }),
            #[cfg(feature = "postgres")]
            Location::Server(server) => {
                let session = super::postgres::open_existing(server, settings).await?;
                Ok(Self::of(Connection::Postgres(Box::new(session)), location, clock, settings))
            }
            _ => Self::open_with(location, clock, settings).await,
        }
    }

    /// Opens the database at `location`, which must exist, for what only reads: also where nothing can be written.
    ///
    /// # Errors
    /// As [`Queue::open_existing`]; where nothing can be written, also if that would be needed to read.
    pub async fn open_to_read(location: impl Into<Location>, clock: Clock) -> Result<Self, QueueError> {
        let location = location.into();
        let settings = Settings::default();
        match &location {
            Location::File(path) if path.exists() => {
                let connection = Connection::Sqlite(sqlite::open_to_read(path, settings).await?);
                Ok(Self::of(connection, location, clock, settings))
            }
            _ => Self::open_existing(location, clock, settings).await,
        }
    }

    fn of(connection: Connection, location: Location, clock: Clock, settings: Settings) -> Self {
        Self { connection, clock, location, settings, registration: None }
    }
}

fn check(location: &Location) -> Result<(), QueueError> {
    let Location::Server(server) = location else { return Ok(()) };
    server.check().map_err(|reason| QueueError::Server { database: location.clone(), reason })
}

#[cfg(not(feature = "postgres"))]
fn no_postgres(database: Location) -> QueueError {
    let reason =
        "this tribosweep was built without PostgreSQL; build it with the feature `postgres`".to_owned();
    QueueError::Server { database, reason }
}
