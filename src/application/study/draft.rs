//! The draft of a job: values of fields as JSON, and which of them are given.

use super::covered::is_set_by_presets;
use super::damping::DAMPERS;
use super::derive::Ties;
use super::file::StudyFile;
use super::parameter::{PARAMETERS, Parameter};
use super::preset::Preset;
use super::time_defaults;
use crate::spec::{FieldError, FrictionLaw, JobSpec, Limit};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::collections::HashSet;
use std::f64::consts::TAU;

/// The parts of a study that describe a job.
pub(super) const PARTS: [&str; 9] = [
    "preset",
    "damping",
    "sliding_speed_m_s",
    "scene",
    "numerics",
    "run",
    "detection",
    "stability",
    "accuracy",
];

/// A job before it has all its values: everything that a study says about it, before presets, damping and the defaults
/// that depend on other values give the rest.
#[derive(Debug, Clone)]
pub(super) struct Draft {
    /// All fields of a job with their values or defaults; `preset` and `damping` where they are given.
    values: Value,
    /// Names of the parameters whose fields are given.
    given: HashSet<&'static str>,
    /// Parameters that are tied to others.
    ties: Ties,
}

/// The job of a draft.
#[derive(Debug, Clone)]
pub(super) struct Resolved {
    pub spec: JobSpec,
    /// What makes the job unusable; empty for a good one.
    pub violations: Vec<FieldError>,
}

impl Draft {
    /// The draft that a study's object gives; its types have been checked.
    pub(super) fn of(study: &Value) -> Self {
        let parts: Map<String, Value> =
            PARTS.iter().filter_map(|&part| Some((part.to_owned(), study.get(part)?.clone()))).collect();
        let given = PARAMETERS
            .iter()
            .filter(|parameter| study.pointer(parameter.pointer).is_some_and(|value| !value.is_null()))
            .map(|parameter| parameter.name)
            .collect();
        let file = decode(&Value::Object(parts));
        let values = serde_json::to_value(file).expect("a study is plain data with string keys");
        let mut draft = Self { values, given, ties: Ties::of(study) };
        let tied: Vec<_> = draft.ties.parameters().collect();
        for parameter in tied {
            draft.mark(parameter);
        }
        draft
    }

    /// Says that a parameter is given.
    pub(super) fn mark(&mut self, parameter: &Parameter) {
        let set = PARAMETERS.iter().filter(|other| parameter.sets(&other.field()));
        self.given.extend(set.map(|other| other.name));
    }

    /// Gives a [marked](Self::mark) parameter a value of its type.
    pub(super) fn put(&mut self, parameter: &Parameter, value: &Value) {
        parameter.set(&mut self.values, value);
    }

    /// The job: what is given comes before the preset and the damping, and these before the defaults.
    pub(super) fn resolve(&self) -> Resolved {
        let mut tied = Cow::Borrowed(&self.values);
        let mut violations = Vec::new();
        if !self.ties.is_empty() {
            // What a preset or a default sets later is not known here.
            let has_table =
                tied.pointer("/scene/contact/law").is_some_and(|law| law == FrictionLaw::Table.name());
            let has_speed = tied.pointer("/sliding_speed_m_s").is_some_and(|speed| !speed.is_null());
            let has_ratio = tied.pointer("/damping/holder_ratio").is_some_and(|ratio| !ratio.is_null());
            let is_known = |own: &Parameter| {
                let is_set_later = is_set_by_presets(own)
                    || time_defaults::FIELDS.contains(&own.name)
                    || has_table && own.name == "mu"
                    || has_speed && own.name == "omega_rpm"
                    || has_ratio && DAMPERS.contains(&own.name);
                self.given.contains(own.name) || !is_set_later
            };
            violations.extend(self.ties.apply(tied.to_mut(), is_known).err().into_iter().flatten());
        }
        let StudyFile {
            preset,
            damping,
            sliding_speed_m_s,
            scene,
            numerics,
            run,
            detection,
            stability,
            accuracy,
            ..
        } = decode(&tied);
        let mut spec = JobSpec { scene, numerics, run, detection, stability, accuracy, continuation: None };
        let gives = |name: &str| self.given.contains(name);
        if let Some(speed_m_s) = sliding_speed_m_s {
            let rpm = rpm_of_sliding(speed_m_s, spec.scene.disk.track_radius_m, gives("omega_rpm"));
            violations.extend(rpm.map(|rpm| spec.scene.disk.omega_rpm = rpm).err());
        }
        if let Some(preset) = preset {
            preset.fill(&mut spec, gives);
        }
        if let Some(damping) = damping {
            violations.extend(damping.fill(&mut spec, gives).err());
        }
        if spec.accuracy.is_some() {
            let finest = Preset::finest_elements(&spec.scene.pin, &spec.scene.clamp);
            for (axis, name) in ["nx", "ny", "nz"].into_iter().enumerate() {
                if !gives(name) {
                    spec.scene.pin.elements[axis] = finest[axis];
                }
            }
        }
        // A job without damping is solved in another way.
        if let Some(preset) = preset.or(spec.accuracy.map(|_| Preset::Standard)) {
            preset.choose_way(&mut spec, gives);
        }
        // A table that nobody scales has its own coefficient of fast slip.
        if let Some(own) = spec.scene.contact.table_mu().filter(|_| !gives("mu")) {
            spec.scene.contact.mu = own;
        }
        time_defaults::fill(&mut spec, gives);
        let gives_omega = gives("omega_rpm") || sliding_speed_m_s.is_some();
        spec.scene.take_largest_of_program([gives_omega, gives("load_n")]);
        violations.extend(spec.check().err().into_iter().flat_map(|found| found.0));
        Resolved { spec, violations }
    }
}

/// The speed \[rpm\] of a disk that slides at this speed \[m/s\] under the centre of the pin.
fn rpm_of_sliding(speed_m_s: f64, track_radius_m: f64, gives_omega: bool) -> Result<f64, FieldError> {
    const FIELD: &str = "sliding_speed_m_s";
    let refused = |expected: String| {
        Err(FieldError { field: FIELD.to_owned(), value: speed_m_s.to_string(), expected })
    };
    if gives_omega {
        return refused("either this or omega_rpm, not both: each gives the speed of the disk".to_owned());
    }
    match Limit::of(FIELD).filter(|limit| !limit.holds(speed_m_s)) {
        Some(limit) => refused(limit.expected(speed_m_s)),
        None => Ok(speed_m_s / track_radius_m * 60.0 / TAU),
    }
}

/// Decodes values whose types have been checked.
fn decode(values: &Value) -> StudyFile {
    StudyFile::deserialize(values).expect("each value was checked for its type")
}
