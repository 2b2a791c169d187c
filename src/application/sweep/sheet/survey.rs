//! The values that inputs and derived quantities have in the jobs.

use super::derived::{self, Derived};
use crate::spec::JobSpec;
use crate::study::{Parameter, inputs};
use serde_json::Value;
use std::collections::HashSet;

/// All inputs and derived quantities of the jobs that were added.
#[derive(Debug, Default)]
pub(super) struct Survey {
    /// The first job, which the drawings show.
    pub first: Option<JobSpec>,
    /// The inputs, in the order of the registry.
    pub inputs: Vec<InputValues>,
    /// The derived quantities, each with its smallest and largest value.
    pub derived: Vec<(Derived, [f64; 2])>,
}

/// An input and its different values.
#[derive(Debug)]
pub(super) struct InputValues {
    pub parameter: &'static Parameter,
    /// In the order of the jobs.
    pub values: Vec<Value>,
    known: HashSet<String>,
}

impl Survey {
    /// Adds a job.
    pub fn add(&mut self, spec: &JobSpec) {
        for input in inputs(spec) {
            let place = self.inputs.iter().position(|known| known.parameter == input.parameter);
            let place = place.unwrap_or_else(|| {
                let (parameter, values, known) = (input.parameter, Vec::new(), HashSet::new());
                self.inputs.push(InputValues { parameter, values, known });
                self.inputs.len() - 1
            });
            let entry = &mut self.inputs[place];
            if entry.known.insert(input.value.to_string()) {
                entry.values.push(input.value);
            }
        }
        for found in derived::of(spec) {
            match self.derived.iter_mut().find(|(known, _)| known.name == found.name) {
                Some((_, [low, high])) => (*low, *high) = (low.min(found.value), high.max(found.value)),
                None => self.derived.push((found, [found.value; 2])),
            }
        }
        if self.first.is_none() {
            self.first = Some(spec.clone());
        }
    }

    /// The values of an input by name; none if no job has it.
    pub fn values(&self, name: &str) -> &[Value] {
        let parameter = Parameter::named(name);
        let found = self.inputs.iter().find(|input| input.parameter == parameter);
        found.map_or(&[], |input| &input.values)
    }

    /// Whether an input has several values.
    pub fn varies(&self, name: &str) -> bool {
        self.values(name).len() > 1
    }
}
