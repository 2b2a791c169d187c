//! The form in which the state of a running job lies in the database.
//!
//! A checkpoint is used only by the program that made it, only for the same job, and only if every bit of it is intact.
//! Then the result has the same bits as that of an uninterrupted run. In any other case the job begins anew, which is
//! correct too.

use super::provenance;
use crate::queue::ClaimedJob;

/// A checkpoint on its way to the database.
#[derive(Debug)]
pub struct SealedCheckpoint {
    /// The job's key.
    pub key: String,
    /// The attempt that is running.
    pub attempt: u32,
    /// What the next attempt gets.
    pub bytes: Vec<u8>,
}

/// Bytes of the digest at the front.
const DIGEST_BYTES: usize = 32;

/// Bytes of the time that follows the digest.
const TIME_BYTES: usize = 8;

/// Seals the `state` of a job that has taken `spent_s` seconds so far.
pub fn seal(job: &ClaimedJob, spent_s: f64, state: &[u8]) -> SealedCheckpoint {
    let mut bytes = vec![0; DIGEST_BYTES];
    bytes.extend(spent_s.to_le_bytes());
    bytes.extend(state);
    let digest = digest(job, &bytes[DIGEST_BYTES..]);
    bytes[..DIGEST_BYTES].copy_from_slice(digest.as_bytes());
    SealedCheckpoint { key: job.key.clone(), attempt: job.attempt, bytes }
}

/// The time [s] and the state that were sealed; `None` if they are not intact or belong to another job or program.
pub fn open<'a>(job: &ClaimedJob, sealed: &'a [u8]) -> Option<(f64, &'a [u8])> {
    let (seal, content) = sealed.split_first_chunk::<DIGEST_BYTES>()?;
    if digest(job, content) != *seal {
        return None;
    }
    let (spent_s, state) = content.split_first_chunk::<TIME_BYTES>()?;
    Some((f64::from_le_bytes(*spent_s), state))
}

fn digest(job: &ClaimedJob, content: &[u8]) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    for part in [provenance::SOURCES, &job.key, &job.payload] {
        // A separator, so that no text can be moved from one part to the next.
        hasher.update(part.as_bytes()).update(&[0]);
    }
    hasher.update(content).finalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a checkpoint is opened exactly as it was sealed, and refused if a bit is changed, the end is missing, or
    /// it belongs to another job.
    #[test]
    fn only_intact_checkpoints_are_opened() {
        let job = |key: &str, payload: &str| ClaimedJob {
            key: key.into(),
            payload: payload.into(),
            attempt: 1,
            cost: 1.0,
            batch: String::new(),
            checkpoint: None,
            parent: None,
            parent_state: None,
            parent_is_damaged: false,
        };
        let own = job("a", "{}");
        let sealed = seal(&own, 2.5, b"state").bytes;
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
}
