//! Tables, figures and CSV from the records of a study's jobs.
//!
//! Everything here reads [`JobRow`]s: one job with its grid parameters and its state. A study that is still running is
//! reported like a finished one, and the report names what is missing.
//!
//! * [`export`] – one line per job, for other programs.
//! * [`tables`] – speed by friction coefficient, as Markdown and CSV.
//! * [`figure`] – curves against speed, maps over speed and friction, shares and residuals, as SVG.
//! * [`overview`] – a letter for every job, for a terminal.
//! * [`pareto`] – error against run time of jobs that differ in their numerics only.
//! * [`trouble`] – where in the grid jobs fail or do not become periodic, and why.
//! * [`write()`] – a folder with all of it, and a page for a browser that contains all of it.

pub mod export;
pub mod figure;
mod files;
mod glyph;
mod html;
mod input;
mod layout;
mod markdown;
pub mod overview;
mod page;
mod parameters;
pub mod pareto;
mod provenance;
mod row;
mod summary;
pub mod tables;
mod times;
mod tooltip;
pub mod trouble;

pub use files::write;
pub use input::Report;
#[cfg(feature = "cli")]
pub(crate) use parameters::assignment;
pub use provenance::{BuildInfo, Provenance, ResultGroup};
pub use row::{JobNumerics, JobRow, RowState};
