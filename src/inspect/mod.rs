//! One job looked into: what the paper's figures 2 to 5 and 8 show, of any job.
//!
//! ```text
//! spec ─► survey (first run: record, cycles) ─► capture (the same run again, watched) ─┬─► tables (CSV)
//!                                                                                      ├─► figures (SVG)
//!                                 phases, waves, spectrum, loops ◄─────────────────────┤
//!                                                                                      └─► fields (VTK)
//! ```
//!
//! A job's run is the same to the last bit whenever it is made. So it is made twice: the first time to learn when its
//! last limit cycles are, the second time to keep everything of just these. No state of a run has to be kept on the
//! chance that it belongs to them, and nothing that solves jobs knows of being watched.

mod capture;
mod envelope;
mod fields;
mod figures;
mod inspection;
mod low_pass;
mod nodes;
mod overlay;
mod page;
mod phases;
mod spectrum;
mod summary;
mod survey;
mod tables;
mod trace;
mod vtu;
mod waves;
mod write;

pub use capture::{Capture, FaceStep, Frame, NodeStep};
pub use figures::InspectionFigure;
pub use inspection::{Inspection, InspectionError, NodeFindings, Options};
pub use nodes::{NodeSelector, ObservedNode};
pub use overlay::write_overlay;
pub use page::PageHeader;
pub use phases::{Instants, Phase};
pub use spectrum::Spectrum;
pub use summary::Summary;
pub use survey::{Survey, Windows};
pub use trace::Trace;
pub use waves::{Change, Wave};
pub use write::{PAGE, write};
