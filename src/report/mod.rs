//! Tables, figures and CSV from the records of a study's jobs.
//!
//! Everything here reads [`Row`]s: one job with its grid parameters and what is known of it. A
//! study that is still running reports like a finished one; what is missing is named.
//!
//! * [`export`] – one line a job, for other programs.
//! * [`tables`] – speed by friction coefficient, as Markdown and CSV.
//! * [`figure`] – curves against speed, maps over speed and friction, shares and residuals, as SVG.
//! * [`overview`] – a letter for every job, for a terminal.
//! * [`pareto`] – error against run time of jobs that differ in their numerics only.
//! * [`trouble`] – where in the grid jobs fail or do not become periodic, and why.
//! * [`write()`] – a folder with all of it and a page for a browser that has it all in itself.

pub mod export;
pub mod figure;
mod files;
mod html;
mod layout;
mod markdown;
mod origin;
pub mod overview;
mod page;
pub mod pareto;
mod row;
mod sign;
mod summary;
pub mod tables;
mod times;
mod tip;
pub mod trouble;

pub use files::{Report, write};
pub use origin::{Made, Maker, Origin};
pub use row::{JobNumerics, Row, RowState};
