//! Studies as data: a JSON file that names a base job and a grid of parameters to vary.
//!
//! ```text
//! text ──► locate (positions, repeated keys) ──► file (serde) ──► preset ──► axis (values) ──► validate (every job)
//!                                                                     │
//!                                              single (one job) ◄── Study ──► expand (all jobs, keys, costs)
//! ```
//!
//! [`Study::parse`] finds everything that is wrong, so that every [`Study`] expands into usable jobs.
//! Messages name the file, line and column, the field, its value and what is expected.

mod axis;
mod cost;
mod definition;
mod error;
mod expand;
mod file;
mod grid;
mod grid_schema;
mod input;
mod json;
mod key;
mod limits;
mod locate;
mod parameter;
mod parse;
mod preset;
mod range;
mod schema;
mod single;
mod source;
mod suggest;
mod validate;

pub use definition::Study;
pub use error::{Problem, StudyError};
pub use expand::Job;
pub use input::{Input, inputs};
pub use key::{SharedKeys, job_key};
pub use limits::MAX_JOBS;
pub use locate::Position;
pub use parameter::{PARAMETERS, Parameter};
pub use preset::{CaseEvidence, Evidence, Preset, PresetEvidence, ReferenceEvidence};
pub use schema::schema;
