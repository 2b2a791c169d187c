use super::clock::Clock;
use super::engine::Connection;
use super::error::QueueError;
use super::location::Location;
use super::settings::Settings;
use super::worker::Registration;

/// One connection to the database of studies and jobs.
///
/// Each operation is in a file of its own, as an `impl Queue`.
#[derive(Debug)]
pub struct Queue {
    pub(super) connection: Connection,
    pub(super) clock: Clock,
    pub(super) location: Location,
    pub(super) settings: Settings,
    /// The worker that owns what this queue claims.
    pub(super) registration: Option<Registration>,
}

impl Queue {
    pub(super) fn new(connection: Connection, location: Location, clock: Clock, settings: Settings) -> Self {
        Self { connection, clock, location, settings, registration: None }
    }

    /// Where the database is.
    pub fn location(&self) -> &Location {
        &self.location
    }

    /// The settings that the queue was opened with.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Closes the connection and waits until it is closed.
    ///
    /// The last process that closes a `SQLite` database merges the write-ahead log into the database file. A queue that
    /// is dropped instead loses no data, but it may leave the log's files beside the database.
    ///
    /// # Errors
    /// If the database cannot be closed, e.g. on a full disk.
    pub async fn close(self) -> Result<(), QueueError> {
        self.connection.close().await
    }

    /// The registered worker.
    ///
    /// # Panics
    /// If no worker is registered: a job without an owner could not be taken back when its process dies.
    pub(super) fn registration(&self) -> &Registration {
        self.registration.as_ref().expect("jobs are run by a registered worker")
    }

    /// As [`Self::registration`].
    pub(super) fn registration_mut(&mut self) -> &mut Registration {
        self.registration.as_mut().expect("jobs are run by a registered worker")
    }
}
