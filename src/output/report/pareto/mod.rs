//! Error against run time: a comparison of jobs that differ in their numerics only with the finest of them.
//!
//! ```text
//! rows ──► compare (one case per physics) ──► reference (finest job, extrapolated: refinement)
//!                                                 │
//!          tables, page, plot ◄── score (errors, costs, fronts)
//! ```
//!
//! # Definitions
//! * A **physical case** is everything but mesh, integrator, time step, run control and detection.
//!   The damping β_R belongs to the model, and β₂ > ½ belongs to the integrator. If all jobs on the finest mesh of a case
//!   have the same β_R, the case has this β_R, and jobs with another one are compared with it: their error contains the
//!   difference of the models. If they have several β_R, each of them is a case.
//! * The **reference** is the finest finished job with the case's damping: finest mesh, then smallest β₂,
//!   smallest step, not stopped early, longest run, smallest tolerance. Its figures are extrapolated
//!   along the refinements of mesh and step if the order is clean ([`refinement`]).
//! * The **error** of μ* and of the frequency is relative to the reference, that of the shares the largest
//!   absolute difference of the three.
//! * An error is **resolved** when it exceeds √(se² + se_ref²) + u, the standard errors over cycles and the
//!   uncertainty u of the reference. The error that can be claimed for a job is its error, or the resolution
//!   (rounded up to two digits) if the error is not resolved. The Pareto front and the figure show this error.

mod compare;
mod page;
mod plot;
mod reference;
pub mod refinement;
mod score;
mod settings;
mod tables;

pub use compare::{Case, Comparison, ParetoError, compare};
pub use page::markdown;
pub use plot::chart;
pub use reference::{Chain, Direction, DoneJob, Reference, Target};
pub use score::{Score, on_front};
pub(super) use tables::described;

use crate::publish::{Folder, PublishError, html, markdown as as_markdown};
use std::path::{Path, PathBuf};

/// Writes the page `pareto.html`, `pareto.md`, `pareto.csv`, `refinement.csv` and one figure per case (`pareto.svg`, `pareto-2.svg`, …) into `out_dir`;
/// returns the files.
///
/// # Errors
/// The first file that could not be written.
pub fn write(comparison: &Comparison, out_dir: &Path, title: &str) -> Result<Vec<PathBuf>, PublishError> {
    let mut folder = Folder::create(out_dir, "pareto")?;
    let mut figures = Vec::new();
    for (index, case) in comparison.cases.iter().enumerate() {
        let name = if index == 0 { "pareto.svg".to_owned() } else { format!("pareto-{}.svg", index + 1) };
        let alternative = format!("{} over solver time {}", page::figure_title(), case.caption);
        let svg = plot::chart(case).svg(alternative.trim_end());
        folder.write_text(&name, &svg)?;
        figures.push((name, svg));
    }
    folder.write_table(&tables::jobs(comparison))?;
    folder.write_table(&tables::refinements(comparison))?;
    let page = page::page(comparison, &figures, title);
    folder.write_text("pareto.html", &html::of_page(&page))?;
    folder.write_text("pareto.md", &as_markdown::of_page(&page))?;
    folder.finish()
}
