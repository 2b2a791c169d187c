//! When the state of a running job is kept, and in what form it lies in the database.
//!
//! A checkpoint is of use to the very program that made it, for the very same job, and only if every bit of it is there:
//! then the result is the same bits as that of a run in one go. Any other job begins anew, and is right too.

use super::provenance;
use crate::queue::ClaimedJob;
use std::time::{Duration, Instant};

/// A checkpoint on its way to the database.
#[derive(Debug)]
pub struct Kept {
    /// The job's key.
    pub key: String,
    /// The attempt that is running.
    pub attempt: u32,
    /// What the next attempt is given.
    pub bytes: Vec<u8>,
}

/// How fast a job gets on in its lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    limit_s: f64,
    /// When the job was seen first, and its simulated time [s] then.
    first: Option<(Instant, f64)>,
    kept: Instant,
}

impl Pace {
    /// That of a job that simulates at most `limit_s`, and begins now.
    pub fn new(limit_s: f64) -> Self {
        Self { limit_s, first: None, kept: Instant::now() }
    }

    /// Looks at the job.
    pub fn look(&mut self, now: Instant, simulated_s: f64) {
        self.first.get_or_insert((now, simulated_s));
    }

    /// Whether the job is predicted to last two intervals or more, by its time limit.
    pub fn is_long(&self, now: Instant, simulated_s: f64, interval: Duration) -> bool {
        self.first.is_some_and(|(then, from_s)| {
            let pace = now.duration_since(then).as_secs_f64() / (simulated_s - from_s);
            // A job that has not moved yet says nothing: the pace is not a number.
            pace.is_finite() && pace * self.limit_s >= 2.0 * interval.as_secs_f64()
        })
    }

    /// Whether it is time to keep it; if so, the next interval begins.
    pub fn is_due(&mut self, now: Instant, simulated_s: f64, interval: Duration) -> bool {
        let is_due = now.duration_since(self.kept) >= interval && self.is_long(now, simulated_s, interval);
        if is_due {
            self.kept = now;
        }
        is_due
    }
}

/// Bytes of the digest in front.
const DIGEST: usize = 32;

/// Bytes of the time.
const TIME: usize = 8;

/// A checkpoint of a job and the time [s] that the job has taken so far, for the database.
pub(super) fn seal(job: &ClaimedJob, spent_s: f64, checkpoint: &[u8]) -> Vec<u8> {
    let mut sealed = vec![0; DIGEST];
    sealed.extend(spent_s.to_le_bytes());
    sealed.extend(checkpoint);
    let digest = digest(job, &sealed[DIGEST..]);
    sealed[..DIGEST].copy_from_slice(digest.as_bytes());
    sealed
}

/// What was sealed, if it is whole and of this job and program.
pub(super) fn open<'a>(job: &ClaimedJob, sealed: &'a [u8]) -> Option<(f64, &'a [u8])> {
    let (seal, kept) = sealed.split_first_chunk::<DIGEST>()?;
    if digest(job, kept) != *seal {
        return None;
    }
    let (spent_s, checkpoint) = kept.split_first_chunk::<TIME>()?;
    Some((f64::from_le_bytes(*spent_s), checkpoint))
}

fn digest(job: &ClaimedJob, kept: &[u8]) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    for part in [provenance::SOURCES, &job.key, &job.payload] {
        // Separated, so that none runs into the next.
        hasher.update(part.as_bytes()).update(&[0]);
    }
    hasher.update(kept).finalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: what is kept comes back as it was, and not at all if a bit of it, or a part, is not as it was.
    #[test]
    fn only_the_whole_is_opened() {
        let job = |key: &str, payload: &str| ClaimedJob {
            key: key.into(),
            payload: payload.into(),
            attempt: 1,
            cost: 1.0,
            batch: String::new(),
            checkpoint: None,
        };
        let own = job("a", "{}");
        let sealed = seal(&own, 2.5, b"state");
        assert_eq!(open(&own, &sealed), Some((2.5, &b"state"[..])));
        for other in [job("b", "{}"), job("a", "{ }"), job("a{", "}")] {
            assert_eq!(open(&other, &sealed), None);
        }
        for at in 0..sealed.len() {
            let mut broken = sealed.clone();
            broken[at] ^= 1;
            assert_eq!(open(&own, &broken), None, "byte {at}");
            assert_eq!(open(&own, &sealed[..at]), None, "{at} bytes");
        }
    }

    /// Protects: a job is kept at each interval if it is predicted to last two of them, and never otherwise; what has
    /// not moved is not predicted.
    #[test]
    fn long_jobs_are_kept_at_each_interval() {
        let interval = Duration::from_secs(10);
        let begun = Instant::now();
        let at = |seconds: u64| begun + Duration::from_secs(seconds);
        for (limit_s, is_long) in [(1.9, false), (2.0, true), (200.0, true)] {
            let mut pace = Pace { limit_s, first: None, kept: begun };
            pace.look(begun, 0.5);
            assert!(!pace.is_long(at(9), 0.5, interval));
            // A simulated second takes ten.
            let due: Vec<u64> =
                (1..=45).filter(|&s| pace.is_due(at(s), 0.5 + s as f64 / 10.0, interval)).collect();
            assert_eq!(due, if is_long { vec![10, 20, 30, 40] } else { vec![] }, "limit {limit_s} s");
        }
    }
}
