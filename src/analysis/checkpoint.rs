//! Where a job is in its run: enough to go on, in any lane and any other process, to the same bits.
//!
//! The numbers of its lane and the analysis as it stands. Of the same model and the same program only: the form has no
//! version of its own, and who keeps it has to see to that.

use super::lane::LaneAnalysis;
use thiserror::Error;

/// A checkpoint of another form, or of a job of another model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the checkpoint is not one of this job")]
pub struct Unreadable;

/// The bytes of what a lane has saved and what has been found so far.
pub(super) fn encode(numbers: &[f64], analysis: &LaneAnalysis) -> Vec<u8> {
    postcard::to_allocvec(&(numbers, analysis)).expect("numbers and their lists have a form in bytes")
}

/// Reads the bytes of a lane that saves so many numbers.
pub(super) fn decode(bytes: &[u8], numbers: usize) -> Result<(Vec<f64>, LaneAnalysis), Unreadable> {
    match postcard::from_bytes::<(Vec<f64>, LaneAnalysis)>(bytes) {
        Ok(read) if read.0.len() == numbers => Ok(read),
        _ => Err(Unreadable),
    }
}
