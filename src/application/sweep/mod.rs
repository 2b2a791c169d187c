//! A sweep from the study to the report: the application layer between the command line and the modules that do the
//! work. Other Rust programs can plan, solve and report studies with these functions.
//!
//! ```text
//! study ──► Plan ──► submit ──► queue ◄──► work
//!            └──► Forecast: what it takes here
//!                                 │
//!                                 ├──► read_rows ──► write_report
//!                                 ├──► export
//!                                 └──► Outlook, Trouble, Revision: the state of a study meanwhile
//! ```
//!
//! The functions that use the database are asynchronous. [`block_on`] runs them in a program without an asynchronous
//! runtime. Do not drop their futures before they are complete (no `select!`, no timeout around them): a transaction of
//! the database may be open.

mod bins;
mod calibrate;
mod database;
mod deep;
mod difference;
mod error;
mod export;
mod forecast;
mod growth;
mod header;
mod history;
mod measured;
mod measured_columns;
mod numerics;
mod outlook;
mod plan;
mod provenance;
mod rename;
mod report;
mod request;
mod rows;
mod selection;
mod sheet;
mod stability;
mod threshold;
mod transfer;
mod trouble;
mod work;

pub use bins::MOST_BINS;
pub use calibrate::{CalibrationData, read_calibration_data};
pub use database::{
    Purpose, block_on, document, load_study, open, open_to_change, open_to_read, study_name, with_open,
    with_queue,
};
pub use deep::{examine_deeply, unreadable_jobs};
pub use difference::{Difference, InputDifference};
pub use error::SweepError;
pub use export::{ExportColumns, Unreadable, columns, export, export_windows};
pub use forecast::{Forecast, Group, Known, OtherClamps, Speed, TimeRange, expected_s_per_cost};
pub use growth::{PLANNER, read_growth, read_implausibility};
pub use history::History;
#[cfg(feature = "cli")]
pub(crate) use history::described as columns_of_history;
pub use measured::MeasuredError;
pub use outlook::{Outlook, available_threads};
pub use plan::{Plan, Submission};
pub use rename::rename;
pub use report::{Revision, write_content, write_refreshing_report, write_report, write_stability_report};
pub use request::{ReportContent, ReportRequest, no_such_quantity, read_report};
pub use rows::{for_each_row, for_each_row_with_inputs, parameters_of, read_rows};
pub use selection::{
    SelectedJob, StoredJob, StudyOfJob, find_job, row_of_job, select_all, select_by_key, select_by_parameters,
};
pub use sheet::sheet_of_job;
pub use stability::{name_of_modes, plan_thresholds, read_stability, way_of, ways_to_thresholds};
pub use transfer::{Transfer, transfer};
pub use trouble::Trouble;
pub use work::{job_key, work};
