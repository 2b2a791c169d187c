//! Error against run time: jobs that differ in their numerics only, measured by the finest of them.
//!
//! ```text
//! rows ──► case (one physical case each) ──► reference (finest job, extrapolated: refinement)
//!                                                 │
//!          front ◄── score (errors, costs) ◄──────┘──► early (what stopping early changes)
//!            └────────► page, csv, plot
//! ```
//!
//! # Definitions
//! * A **physical case** is everything but mesh, integrator, time step, run control and detection.
//!   The damping β_R is part of the model, β₂ > ½ of the integrator. When all jobs on a case's finest mesh
//!   have one β_R, that is the case's, and jobs with another damping are measured against it: their error
//!   contains the difference of the models. When they have several, each β_R is a case of its own.
//! * The **reference** is the finest finished job with the case's damping: finest mesh, then smallest β₂,
//!   smallest step, not stopped early, longest run, tightest tolerance. Its figures are extrapolated
//!   along the refinements of mesh and step where the order is clean ([`refinement`]).
//! * The **error** of μ* and of the frequency is relative to the reference, that of the shares the largest
//!   absolute difference of the three.
//! * An error is **resolved** when it exceeds √(se² + se_ref²) + u, the standard errors over cycles and the
//!   uncertainty u of the reference. What can be claimed for a job is its error, or the resolution
//!   (rounded up to two digits) where the error is not resolved; front and figure are made of that.

mod case;
mod compare;
mod csv;
mod done;
mod early;
mod error;
mod front;
mod page;
mod plot;
mod reference;
pub mod refinement;
mod score;
mod settings;

pub use case::Case;
pub use compare::{Comparison, compare};
pub use done::DoneJob;
pub use early::EarlyStop;
pub use error::ParetoError;
pub use front::on_front;
pub use page::markdown;
pub use reference::{Chain, Direction, Reference, Target};
pub use score::Score;

use crate::publish::Folder;
use crate::publish::PublishError;
use std::path::{Path, PathBuf};

/// Writes `pareto.md`, `pareto.csv`, `refinement.csv` and one figure a case (`pareto.svg`, `pareto-2.svg`, …) into `out_dir`;
/// returns the files.
///
/// # Errors
/// The first file that could not be written.
pub fn write(comparison: &Comparison, out_dir: &Path, title: &str) -> Result<Vec<PathBuf>, PublishError> {
    let mut folder = Folder::create(out_dir)?;
    let mut figures = Vec::new();
    for (index, case) in comparison.cases.iter().enumerate() {
        let name = if index == 0 { "pareto.svg".to_owned() } else { format!("pareto-{}.svg", index + 1) };
        let svg =
            plot::draw(case).map_err(|source| PublishError::Figure { path: out_dir.join(&name), source })?;
        folder.write_text(&name, &svg)?;
        figures.push(name);
    }
    folder.write_with("pareto.csv", |out| csv::write(comparison, out))?;
    folder.write_with("refinement.csv", |out| csv::write_refinement(comparison, out))?;
    folder.write_text("pareto.md", &page::page(comparison, &figures, title))?;
    Ok(folder.written)
}
