//! The measured errors of mesh, time step and detection, for reports.

use crate::publish::value::quantity;
use crate::report::{Discretisation, MeshError};
use crate::solver;
use crate::spec::JobSpec;
use crate::study::Evidence;
use std::sync::Arc;

/// The measured errors, with the forms in which rows share them.
pub(super) struct MeasuredErrors {
    evidence: Evidence,
    shared: Vec<Arc<MeshError>>,
}

impl MeasuredErrors {
    /// The errors that this version was built with.
    pub fn new() -> Self {
        let evidence = Evidence::measured();
        let measured_at = measured_at(&evidence);
        let shared = evidence
            .presets
            .iter()
            .map(|preset| {
                Arc::new(MeshError {
                    mu_star_relative: preset.mu_star_error,
                    frequency_relative: preset.frequency_error,
                    preset: preset.name.clone(),
                    measured_at: measured_at.clone(),
                })
            })
            .collect();
        Self { evidence, shared }
    }

    /// What is known about the error of a job.
    pub fn of(&self, spec: &JobSpec) -> Discretisation {
        let Some(found) = self.evidence.error_of(spec) else { return Discretisation::NotMeasured };
        let Some(error) = self.shared.iter().find(|error| error.preset == found.preset.name) else {
            return Discretisation::NotMeasured;
        };
        if found.on_this_scene {
            Discretisation::Measured(error.clone())
        } else {
            Discretisation::Indicative(error.clone())
        }
    }
}

/// What is known about the error that mesh, time step and detection of a job make.
pub fn discretisation_of(spec: &JobSpec) -> Discretisation {
    MeasuredErrors::new().of(spec)
}

/// Where the errors were measured, in words.
fn measured_at(evidence: &Evidence) -> String {
    let speeds: Vec<String> =
        evidence.reference.cases.iter().map(|case| case.omega_rpm.to_string()).collect();
    let speeds = match speeds.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => speeds.concat(),
    };
    let version = if evidence.solver_version == solver::VERSION {
        String::new()
    } else {
        format!(", by version {} of the solver", evidence.solver_version)
    };
    format!(
        "on {} at μ = {}, β_R = {} and {speeds} rpm{version} (against the limit of fine meshes, which is known to ± {:.1} %)",
        evidence.scene,
        evidence.mu,
        quantity(evidence.beta_r_s, "s"),
        100.0 * evidence.reference.mu_star_uncertainty
    )
}
