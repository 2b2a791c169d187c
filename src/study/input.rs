//! The inputs of a job: every parameter with the value that the job has.

use super::json::encode;
use super::parameter::{PARAMETERS, Parameter};
use crate::spec::{ClampSide, DiskKind, JobSpec, Shape, StabilityMethod, Start};
use serde_json::Value;

/// A parameter and its value in a job.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The parameter: name, description and unit.
    pub parameter: &'static Parameter,
    /// Its value in the job.
    pub value: Value,
}

/// The parameters that are the inputs of a job, each once: all that are fields of a job, and the mesh by its components.
pub fn input_parameters() -> impl Iterator<Item = &'static Parameter> {
    let is_input = |parameter: &&Parameter| parameter.part().is_some() && parameter.name != "elements";
    PARAMETERS.iter().filter(is_input)
}

/// All inputs of a job that have an effect, the defaults among them, each once: the mesh and the size by their components,
/// no ring of a rigid disk, no coefficient that the friction law does not use, no width of a clamp that holds the whole top, no safety factor beside a given time step, nothing
/// about the run of a job without one, and no method of stability where eigenvalues may not decide.
pub fn inputs(spec: &JobSpec) -> Vec<Input> {
    let mut spec = spec.clone();
    spec.scene.contact = spec.scene.contact.in_use();
    let job = encode(&spec);
    let is_run = spec.stability != StabilityMethod::Modes;
    let has_effect = |parameter: &&'static Parameter| match parameter.name {
        "time_step_s" | "safety_factor" if !is_run && !spec.modes_need_time_step() => false,
        "ramp_s" | "precision" if !is_run => false,
        _ if !is_run && matches!(parameter.part(), Some("run" | "detection")) => false,
        "stability" => !is_run || spec.eigenvalues_may_decide(),
        "start" => spec.run.start == Start::Rest || spec.coarser_elements().is_some(),
        "elements" | "nx" | "ny" | "nz" | "clamp_side" | "clamp_width_m"
            if spec.scene.pin.shape == Shape::Mesh =>
        {
            false
        }
        "size_x_m" | "size_y_m" => spec.scene.pin.shape != Shape::Cylinder,
        "clamp_width_m" => spec.scene.clamp.side != ClampSide::WholeTop,
        "safety_factor" => spec.numerics.time_step_s.is_none(),
        _ => spec.scene.disk.kind == DiskKind::Elastic || !parameter.pointer.starts_with("/scene/disk/ring/"),
    };
    let input = |parameter: &'static Parameter| {
        let value = job.pointer(parameter.pointer)?.clone();
        Some(Input { parameter, value })
    };
    input_parameters().filter(has_effect).filter_map(input).collect()
}
