//! What reports are made of: values as text, drawings, pages, and folders of files. Nothing here knows of mechanics.
//!
//! * `value` – numbers as text, the same in CSV, tables, legends and axes.
//! * `plot` – axes, colours and tooltips, drawn as SVG.
//! * `html` – pages that are one file.
//! * [`Sheet`] – drawings and a table of quantities.
//! * [`Folder`], [`write_atomically`] – files that readers never see half-written.
//!
//! `value`, `plot` and `html` are for this crate only. The signatures of the last two have types of plotters and maud, but
//! what they make are strings: SVG and HTML.

pub mod chart;
mod error;
mod folder;
pub(crate) mod html;
pub(crate) mod markdown;
pub mod page;
pub(crate) mod plot;
pub(crate) mod rounding;
mod sheet;
pub mod table;
pub(crate) mod value;

pub use error::{FigureError, PublishError};
pub use folder::{Folder, write_atomically};
pub use sheet::{Drawing, Sheet, SheetGroup, SheetLine};
