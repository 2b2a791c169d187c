//! What reports are made of: values as text, tables, charts, pages, and folders of files. Nothing here knows of mechanics.
//!
//! * `value` – numbers as text, the same in CSV, tables, legends and axes.
//! * [`table`] – columns with units and meanings, and their only writer.
//! * [`chart`] – figures as data, and their drawing as SVG.
//! * [`page`] – sections of blocks, shown by `html` as one file for a browser, and by `markdown`.
//! * [`Sheet`] – drawings and a table of quantities.
//! * [`Folder`], [`write_atomically`] – files that readers never see half-written.

pub mod chart;
mod error;
mod folder;
pub mod html;
pub mod markdown;
pub mod page;
pub mod rounding;
mod sheet;
pub mod table;
pub mod value;

pub use error::PublishError;
pub use folder::{Folder, write_atomically};
pub use sheet::{Drawing, Sheet, SheetGroup, SheetLine};
