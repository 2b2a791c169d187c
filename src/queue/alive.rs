use super::take_back::Verdict;
use super::{Queue, QueueError};

/// The workers that are there now.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Alive {
    /// How many they are.
    pub workers: u64,
    /// How many threads they have together.
    pub threads: u64,
}

impl Queue {
    /// The workers that are there now and have not been asked to stop. Whose process cannot be seen from here is there as
    /// long as its last sign of life is no older than a lease.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn alive(&mut self) -> Result<Alive, QueueError> {
        let (now_ms, far_ms) = self.lease_window();
        let mut alive = Alive::default();
        for owner in self.owners().await? {
            let is_there = match owner.verdict() {
                Verdict::Alive => true,
                Verdict::Gone => false,
                Verdict::Elsewhere => {
                    let until_ms = self.lease_until(owner.heartbeat_ms);
                    until_ms > now_ms && until_ms <= far_ms
                }
            };
            if is_there && !owner.is_stopping() {
                alive.workers += 1;
                alive.threads += owner.threads;
            }
        }
        Ok(alive)
    }
}
