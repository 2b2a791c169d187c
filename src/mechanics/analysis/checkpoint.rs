//! Checkpoints: from a checkpoint, a job continues in any lane and any process, with the same bits as an
//! uninterrupted run.
//!
//! A checkpoint holds the numbers of the job's lane and the state of its analysis. It is valid only for the
//! same model and the same program. The format has no version of its own, so its owner must check this.

use super::lane::LaneAnalysis;
use thiserror::Error;

/// The checkpoint has another format, or it belongs to a job of another model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the checkpoint is not one of this job")]
pub struct Unreadable;

/// Encodes the numbers of a lane and the state of its analysis.
pub(super) fn encode(numbers: &[f64], analysis: &LaneAnalysis) -> Vec<u8> {
    postcard::to_allocvec(&(numbers, analysis)).expect("numbers and their lists have a form in bytes")
}

/// Decodes the checkpoint of a lane that has `numbers` numbers.
pub(super) fn decode(bytes: &[u8], numbers: usize) -> Result<(Vec<f64>, LaneAnalysis), Unreadable> {
    match postcard::from_bytes::<(Vec<f64>, LaneAnalysis)>(bytes) {
        Ok(read) if read.0.len() == numbers => Ok(read),
        _ => Err(Unreadable),
    }
}
