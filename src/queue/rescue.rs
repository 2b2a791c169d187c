//! What becomes of results when the database file is deleted, moved or replaced while a process works on it.

use std::path::PathBuf;

use super::engine::Connection;
use super::error::QueueError;
use super::finish::Finished;
use super::handle::Queue;

impl Queue {
    /// Checks that the database is still where it was opened. If it is not, all that was stored is put where it can be found,
    /// and the error says where. A server has no such place.
    ///
    /// # Errors
    /// [`QueueError::Displaced`].
    pub async fn ensure_place(&mut self) -> Result<(), QueueError> {
        match self.check_place() {
            Err(error) => Err(self.rescue(&[], error).await),
            Ok(()) => Ok(()),
        }
    }

    pub(super) fn check_place(&self) -> Result<(), QueueError> {
        match &self.connection {
            Connection::Sqlite(file) => file.check_place(),
            #[cfg(feature = "postgres")]
            Connection::Postgres(_) => Ok(()),
        }
    }

    /// After [`QueueError::Displaced`]: stores the outcomes of `finished` in the displaced file, gives back what its worker
    /// still runs, and puts all that the file has where it can be found. Returns the error with what became of it; any other
    /// error as it is.
    pub async fn rescue(&mut self, finished: &[Finished], error: QueueError) -> QueueError {
        let QueueError::Displaced { path, how, .. } = error else { return error };
        let ready = finished.iter().filter(|job| job.outcome.is_end()).count();
        let kept = match self.rescue_all(finished).await {
            Ok(place) => {
                let ready = match ready {
                    0 => String::new(),
                    1 => ", with 1 result that was ready,".to_owned(),
                    ready => format!(", with {ready} results that were ready,"),
                };
                format!(
                    ". Everything that was stored{ready} is in {}: move that file to where it shall be, or name it with --db, \
                     and start the same command again. Jobs that were running begin anew",
                    place.display()
                )
            }
            Err(error) => format!(
                ". It cannot be copied ({error}), so what was stored since then{} lost",
                match ready {
                    0 => " is".to_owned(),
                    ready => format!(", and {ready} results that were ready, are"),
                }
            ),
        };
        QueueError::Displaced { path, how, kept }
    }

    async fn rescue_all(&mut self, finished: &[Finished]) -> Result<PathBuf, QueueError> {
        if let Connection::Sqlite(file) = &mut self.connection {
            file.begin_rescue();
        }
        if self.registration.is_some() {
            self.exchange(finished, &[]).await?;
            self.unregister().await?;
        }
        match &mut self.connection {
            Connection::Sqlite(file) => file.rescue().await,
            #[cfg(feature = "postgres")]
            Connection::Postgres(_) => unreachable!("a server's database is not displaced"),
        }
    }
}
