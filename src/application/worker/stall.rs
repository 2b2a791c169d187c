//! A worker that waits for jobs which never come.

use std::time::{Duration, Instant};

/// How long a worker that is alone tries to get at unfinished jobs. Its tries are a fraction of a second apart.
const LIMIT: Duration = Duration::from_secs(5);

/// Notices that jobs are unfinished although nobody runs them, and that they cannot be claimed.
///
/// In a sound database this lasts for one look: the next claim takes them. In a damaged one an index may have jobs that its
/// table does not have, or the other way round, and the worker would look for them without end.
#[derive(Debug, Default)]
pub struct Stall {
    since: Option<Instant>,
    has_tried: bool,
}

impl Stall {
    /// A look found unfinished jobs that nobody runs, and this worker could not claim them. Whether that is so for too long.
    pub fn is_over_limit(&mut self) -> bool {
        self.is_over_limit_at(Instant::now())
    }

    /// A claim has returned no job.
    pub fn note_empty_claim(&mut self) {
        self.has_tried = true;
    }

    /// Whether claims have returned no job since the last reset. On a busy machine the threads may not have asked for any.
    pub fn has_tried(&self) -> bool {
        self.has_tried
    }

    /// A job was claimed, or somebody runs one, or nothing is left.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    fn is_over_limit_at(&mut self, now: Instant) -> bool {
        now.duration_since(*self.since.get_or_insert(now)) >= LIMIT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: only looks that find the same without a break for the whole limit are a stall.
    #[test]
    fn a_stall_lasts() {
        let begun = Instant::now();
        let mut stall = Stall::default();
        let at = |share: f64| begun + LIMIT.mul_f64(share);
        assert!(!stall.is_over_limit_at(begun));
        assert!(!stall.is_over_limit_at(at(0.9)));
        stall.note_empty_claim();
        assert!(stall.has_tried());
        stall.reset();
        assert!(!stall.has_tried());
        assert!(!stall.is_over_limit_at(at(1.1)));
        assert!(!stall.is_over_limit_at(at(2.0)));
        assert!(stall.is_over_limit_at(at(2.1)));
    }
}
