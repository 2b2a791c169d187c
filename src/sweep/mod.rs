//! A sweep from the study to the report: the application layer between the command line and the modules that do the
//! work. Other Rust programs can plan, solve and report studies with these functions.
//!
//! ```text
//! study ──► Plan ──► submit ──► queue ◄──► work
//!                                 │
//!                                 ├──► read_rows ──► write_report
//!                                 ├──► export
//!                                 └──► Outlook, Trouble, Revision: the state of a study meanwhile
//! ```
//!
//! The functions that use the database are asynchronous. [`block_on`] runs them in a program without an asynchronous
//! runtime. Do not drop their futures before they are complete (no `select!`, no timeout around them): a transaction of
//! the database may be open.

mod database;
mod error;
mod export;
mod history;
mod numerics;
mod outlook;
mod plan;
mod provenance;
mod report;
mod rows;
mod selection;
mod transfer;
mod trouble;
mod work;

pub use database::{block_on, load_study, open, open_to_change, open_to_read, study_name};
pub use error::SweepError;
pub use export::{ExportFormat, export};
pub use history::History;
pub use outlook::{Outlook, available_threads};
pub use plan::Plan;
pub use report::{Revision, write_refreshing_report, write_report};
pub use rows::{for_each_row, read_rows};
pub use selection::{SelectedJob, StoredJob, find_job, select_by_key, select_by_parameters};
pub use transfer::{Transfer, transfer};
pub use trouble::Trouble;
pub use work::work;
