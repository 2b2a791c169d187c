use super::clock::Clock;
use super::engine::Connection;
use super::error::QueueError;
use super::handle::Queue;
use super::location::Location;
#[cfg(feature = "postgres")]
use super::postgres;
use super::settings::Settings;
use super::sqlite;

impl Queue {
    /// Opens the database at `location`. Creates its tables, and its file but not the folder, if they are missing.
    ///
    /// # Errors
    /// For a file: if the folder is missing, if the path contains something else or a newer schema, or if the
    /// file system or the `SQLite` library is not safe with several writers. For a server: if it does not answer or
    /// refuses the connection.
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
                Connection::Postgres(Box::new(postgres::open(server, settings).await?))
            }
            #[cfg(not(feature = "postgres"))]
            Location::Server(_) => return Err(no_postgres(location)),
        };
        Ok(Self::new(connection, location, clock, settings))
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
                let session = postgres::open_existing(server, settings).await?;
                Ok(Self::new(Connection::Postgres(Box::new(session)), location, clock, settings))
            }
            _ => Self::open_with(location, clock, settings).await,
        }
    }

    /// Opens the database at `location` if it exists; otherwise checks whether it can be created, and creates nothing.
    ///
    /// # Errors
    /// As [`Queue::open`].
    pub async fn open_if_exists(
        location: impl Into<Location>,
        clock: Clock,
    ) -> Result<Option<Self>, QueueError> {
        match Self::open_existing(location, clock, Settings::default()).await {
            Err(QueueError::NoDatabase { database }) => {
                database.path().map_or(Ok(None), |path| sqlite::check_new(path).map(|()| None))
            }
            opened => opened.map(Some),
        }
    }

    /// Opens the database at `location`, which must exist, for reading. A file may be read-only.
    ///
    /// # Errors
    /// As [`Queue::open_existing`]. Also if a read-only file cannot be read because it would have to be migrated, or
    /// because its write-ahead log would have to be merged.
    pub async fn open_to_read(location: impl Into<Location>, clock: Clock) -> Result<Self, QueueError> {
        let location = location.into();
        let settings = Settings::default();
        match &location {
            Location::File(path) if path.exists() => {
                let connection = Connection::Sqlite(sqlite::open_to_read(path, settings).await?);
                Ok(Self::new(connection, location, clock, settings))
            }
            _ => Self::open_existing(location, clock, settings).await,
        }
    }
}

fn check(location: &Location) -> Result<(), QueueError> {
    let Location::Server(server) = location else { return Ok(()) };
    server.check_scheme().map_err(|reason| QueueError::Server { database: location.clone(), reason })
}

#[cfg(not(feature = "postgres"))]
fn no_postgres(database: Location) -> QueueError {
    let reason =
        "this tribosweep was built without PostgreSQL; build it with the feature `postgres`".to_owned();
    QueueError::Server { database, reason }
}
