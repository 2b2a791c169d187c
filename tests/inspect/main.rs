//! The inspection of a job: it shows the job's own run, and other programs can read its files.

#[path = "../support/browser.rs"]
#[expect(dead_code, reason = "reports are tested with more of it")]
mod chromium;
mod figures;
mod inspections;
mod page;
mod readers;
#[path = "../support/tools.rs"]
mod tools;

use std::ops::ControlFlow;
use tribosweep_mechanics::spec::JobSpec;
use tribosweep_output::inspect::{Inspection, Options};

/// 6 × 8 × 5 elements, 2 mm strip, 7 rpm, μ = 0.4: a stick–slip–separation cycle in half a second.
pub fn coarse() -> JobSpec {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    // With it every speed of these tests has a limit cycle of one period on this mesh.
    spec.numerics.beta_r_s = 5.0e-8;
    spec
}

/// Inspects a job.
///
/// # Panics
/// If the inspection fails.
pub fn inspect(spec: &JobSpec, options: &Options) -> Inspection {
    Inspection::run(spec, options, &mut |_| ControlFlow::Continue(())).unwrap()
}
