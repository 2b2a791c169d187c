//! Studies as data: a JSON file that names a base job and a grid of parameters to vary.
//!
//! ```text
//! text ──► locate (value, positions) ──► file (serde), axis (values) ──► outline ◄── change (--preset, --set, --name)
//!                                                                                  │
//!                        draft + values of a grid point ──► preset, damping, time_defaults ──► validate (every job)
//!                                                                                                │
//!                                                         single (one job) ◄── Study ──► expand (all jobs, keys)
//! ```
//!
//! An outline is what the study says; the command line changes it and nothing else. A draft is what the outline and a grid
//! point say about one job, with the knowledge of which fields are given. The rest is filled in for each job of its own.
//!
//! [`Study::parse`] finds everything that is wrong, so that every [`Study`] expands into usable jobs.
//! Messages name the file, line and column, the field, its value and what is expected.

mod axis;
mod calibrate;
mod calibration;
mod chains;
mod change;
mod conditions;
mod covered;
mod damping;
mod definition;
mod derive;
mod document;
mod draft;
mod effect;
mod error;
mod expand;
mod file;
mod grid;
mod grid_schema;
mod growth;
mod input;
mod json;
mod key;
mod limit_schema;
mod limits;
mod locate;
mod mesh_file;
mod name;
mod number_file;
mod origin;
mod outline;
mod parameter;
mod parse;
mod plausibility;
mod plausible;
mod preset;
mod range;
mod report_axes;
mod rows;
mod samples;
mod schema;
mod single;
mod source;
mod suggest;
mod text;
mod text_file;
mod time_defaults;
mod validate;
mod with_unit;

pub use calibrate::{Calibrate, Calibration, Discrepancy, DiscrepancyGiven, MeasuredPoint};
pub use calibration::{FreeParameter, sobol_points};
pub use chains::chains_of;
pub use change::{Basins, Changes};
pub use covered::is_set_by_presets;
pub use definition::Study;
pub use error::{Problem, StudyError};
pub use expand::Job;
pub use growth::{
    Boundaries, Continue, Curves, DIRECTION, Direction, Growth, KICK, MOST_WAVE_JOBS, Refine, Side,
};
pub use input::{Input, input_parameters, inputs};
pub use key::{SharedKeys, job_key};
pub use limits::MAX_JOBS;
pub use locate::Position;
pub use name::{is_study_name, refused_name, renamed};
pub use origin::Origin;
pub use parameter::{PARAMETERS, Parameter, is_numerics};
pub use plausibility::{About, Warning, job_warnings};
pub use preset::{Evidence, Preset, PresetEvidence};
pub use range::Spacing;
pub use report_axes::ReportAxes;
pub use schema::schema;
pub use single::SingleJob;
pub use suggest::{misspelt_name, nearest_name};
pub use text::{StudyText, json_value};
pub use text_file::read_text;
pub use with_unit::number_in;
