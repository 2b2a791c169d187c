//! What of a job has no effect on its result. Its key and the list of its inputs leave that out.

use crate::spec::{ClampSide, DiskKind, JobSpec, Shape, StabilityMethod, Start, Strains};

/// The fields of a job that have no effect, as JSON pointers; what is below such a field has none either. Coefficients that the friction
/// law does not use are no fields of [`crate::spec::Contact::in_use`].
pub(super) fn without_effect(spec: &JobSpec) -> Vec<&'static str> {
    let has_run = spec.stability != StabilityMethod::Modes;
    let rules: [(bool, &[&str]); 11] = [
        (spec.scene.pin.strains == Strains::Small, &["/scene/pin/material"]),
        (spec.scene.pin.shape == Shape::Cylinder, &["/scene/pin/size_m/0", "/scene/pin/size_m/1"]),
        // The file has them.
        (spec.scene.pin.shape == Shape::Mesh, &["/scene/pin/elements", "/scene/clamp"]),
        (spec.scene.clamp.side == ClampSide::WholeTop, &["/scene/clamp/width_m"]),
        (spec.scene.disk.kind == DiskKind::Rigid, &["/scene/disk/ring"]),
        (spec.numerics.time_step_s.is_some(), &["/numerics/safety_factor"]),
        (!has_run && !spec.modes_need_time_step(), &["/numerics/safety_factor", "/numerics/time_step_s"]),
        (
            !has_run,
            &[
                "/numerics/precision",
                "/run/limit_s",
                "/run/stop_early",
                "/run/average_last_fraction",
                "/run/window_s",
                "/detection",
                "/scene/load/ramp_s",
                "/accuracy",
            ],
        ),
        (has_run && !spec.eigenvalues_may_decide(), &["/stability"]),
        // Nothing looks for a steady state.
        (
            !spec.scene.program.is_constant(),
            &[
                "/run/stop_early",
                "/run/average_last_fraction",
                "/detection/cycles",
                "/detection/tolerance",
                "/detection/drift_tolerance",
                "/detection/decay_observation_s",
            ],
        ),
        (!has_start(spec), &["/run/start"]),
    ];
    rules.into_iter().filter(|(applies, _)| *applies).flat_map(|(_, fields)| fields).copied().collect()
}

/// Whether the start changes what a job does: there may be no coarser mesh or no motion to start from, and an accuracy has a run on a coarser
/// mesh in any case.
fn has_start(spec: &JobSpec) -> bool {
    let has_coarser = || !spec.coarser_elements().is_empty();
    let is_compared_anyway = spec.accuracy.is_some() && spec.has_run();
    match spec.run.start {
        Start::Rest => true,
        Start::Nested => (!is_compared_anyway || spec.starts_in_motion()) && has_coarser(),
        Start::Compared => !is_compared_anyway && has_coarser(),
    }
}
