//! What reports and inspections are made of: values as text, drawings, pages, folders whose files appear whole.
//!
//! * [`value`] – numbers and parameters as text, the same in CSV, tables, legends and axes.
//! * [`plot`] – axes, colours and what points tell, drawn as SVG.
//! * [`html`] – pages that are one file.
//! * [`Folder`] – a folder of files that are replaced as a whole.

mod error;
mod folder;
pub mod html;
pub mod plot;
pub mod value;

pub use error::PublishError;
pub use folder::Folder;
