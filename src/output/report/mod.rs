//! Tables, figures and CSV from the records of a study's jobs.
//!
//! Everything here reads [`JobRow`]s: one job with its grid parameters and its state. A study that is still running is
//! reported like a finished one, and the report names what is missing.
//!
//! * [`export`] – one line per job, for other programs, with [`columns`].
//! * [`tables`] – speed by friction coefficient, as Markdown and CSV.
//! * [`figure`] – curves against speed, maps over speed and friction, shares and residuals, as SVG.
//! * [`overview`] – a letter for every job, for a terminal.
//! * [`pareto`] – error against run time of jobs that differ in their numerics only.
//! * [`Findings`] – boundaries, minima, branches and basins of studies that grow, and the region of a calibration.
//! * [`trouble`] – where in the grid jobs fail or do not become periodic, and why.
//! * [`write_stability`] – the linear stability of steady sliding: maps, branches of modes, thresholds.
//! * [`write()`] – a folder with all of it, and a page for a browser that contains all of it.

mod accuracy;
mod calibration;
pub mod columns;
mod comparison;
mod comparison_files;
mod described;
mod digits;
mod dimension;
mod explore;
pub mod export;
pub mod figure;
mod files;
mod findings_table;
mod glyph;
mod growth;
mod input;
mod inspections;
mod layout;
mod measurement;
pub mod overview;
mod page;
mod parameters;
pub mod pareto;
mod program;
mod provenance;
mod reference_curves;
mod row;
mod scalar;
pub mod sensitivity;
mod spectra;
mod stability;
mod stability_point;
mod summary;
pub mod tables;
mod times;
mod tooltip;
pub mod trouble;
mod verdict;
mod view;
mod windows;
mod words;

pub use calibration::{Calibration, Check, Datum, Fit, Free, Nearest};
pub use described::columns_of_files;
pub use files::{Written, write, write_compared};
pub use growth::{Basin, BranchPoint, Crossing, Endpoint, Findings, Minimum, basins};
pub use input::Report;
pub use inspections::{FoundInspection, INSPECTIONS, inspections};
pub use measurement::{MeasuredValue, Measurement};
#[cfg(feature = "cli")]
pub use parameters::assignment;
pub use parameters::{Parameters, parameter_names};
pub use program::chart as program_chart;
pub use provenance::{Provenance, ResultGroup};
pub use row::{JobNumerics, JobRow, RowState};
pub use scalar::{FREQUENCY, MU_STAR, SCALARS, Scalar};
pub use stability::{
    Along, MODE_NUMBER, PAGE as STABILITY_PAGE, SHAPES, ShownModes, modes_table, nearest_in_words,
    thresholds_table, unknown_errors, write_stability,
};
pub use stability_point::StabilityPoint;
pub use view::View;
pub use windows::Windows;
