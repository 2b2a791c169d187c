//! The inputs of a job: every parameter with the value that the job has.

use super::effect::without_effect;
use super::json::{at, encode};
use super::parameter::{PARAMETERS, Parameter};
use crate::spec::JobSpec;
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

/// All inputs of a job that have an effect, the defaults among them, each once: the mesh and the size by their components.
pub fn inputs(spec: &JobSpec) -> Vec<Input> {
    values_of(spec, input_parameters())
}

/// Of these parameters those that the job has and that have an effect, with their values.
pub(super) fn values_of(spec: &JobSpec, parameters: impl Iterator<Item = &'static Parameter>) -> Vec<Input> {
    let unused = without_effect(spec);
    let mut spec = spec.clone();
    spec.scene.contact = spec.scene.contact.in_use();
    let pairs = spec.scene.contact.mu_of_speed.0.iter();
    let pairs: Vec<String> = pairs.map(|[speed_m_s, mu]| format!("{speed_m_s}: {mu}")).collect();
    let table = if pairs.is_empty() { String::new() } else { format!("table {{{}}}", pairs.join(", ")) };
    let job = encode(&spec);
    let is_below = |pointer: &str, field: &str| {
        pointer.strip_prefix(field).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    };
    let input = |parameter: &'static Parameter| {
        let has_effect = !unused.iter().any(|field| is_below(parameter.pointer, field));
        let value = at(&job, parameter.pointer).filter(|_| has_effect)?.clone();
        // No parameter has pairs for values, so the law has those of its table.
        let is_table = parameter.name == "friction_law" && !table.is_empty();
        Some(Input { parameter, value: if is_table { Value::from(table.as_str()) } else { value } })
    };
    parameters.filter_map(input).collect()
}
