//! One job in detail: what the paper's figures 2 to 5 and 8 show, for any job.
//!
//! ```text
//! spec ─► survey (first run: record, cycles) ─► capture (the same run again, watched) ─┬─► tables (CSV)
//!                                                                                      ├─► figures (SVG)
//!                                 phases, waves, spectrum, loops ◄─────────────────────┤
//!                                                                                      └─► fields (VTK)
//! ```
//!
//! The shape of a complex mode of steady sliding becomes fields of the same kind, over one period of its vibration.
//!
//! Every run of a job has the same result to the last bit. So the job is run twice: the first run finds the times of the
//! last limit cycles, and the second run records everything within them. No run has to record states that may turn out
//! to be useless, and the code that solves jobs does not know that it is observed.

mod capture;
mod energies;
mod envelope;
mod fields;
mod figures;
mod grid;
mod inspection;
mod limit;
mod loops;
mod low_pass;
mod mode_shapes;
mod nodes;
mod overlay;
mod page;
mod phases;
mod spectra;
mod spectrum;
mod summary;
mod survey;
mod tables;
mod trace;
mod vtu;
mod waves;
mod write;

pub use capture::{Audit, Capture, FaceStep, Frame, NodeStep};
pub use figures::{InspectionFigure, Picture, figures};
pub use inspection::{Inspection, InspectionError, NodeFindings, Options};
pub use loops::{AuditedFriction, LoopEnergies, LoopSummary};
pub use mode_shapes::write_mode;
pub use nodes::{NodeSelector, ObservedNode};
#[cfg(feature = "cli")]
pub use overlay::columns_of_files;
pub use overlay::write_overlay;
pub use page::{PageHeader, of as page};
pub use phases::{Instants, Phase};
pub use spectra::JobSpectrum;
pub use spectrum::Spectrum;
pub use summary::Summary;
pub use survey::{Survey, TimeWindows};
pub use trace::Trace;
pub use waves::{Change, Wave};
pub use write::{PAGE, has_spectrum, key_of, write};
