//! Which measured error belongs to a job.

use super::evidence::{Evidence, PresetEvidence};
use super::settings::Preset;
use crate::spec::{DiskKind, JobSpec, Ring};

/// The error that was measured of a preset, for a job whose mesh, time step and detection are at least as fine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PresetError<'a> {
    /// What was measured of the preset.
    pub preset: &'a PresetEvidence,
    /// Whether it was measured on the job's own scene, at its μ, and between speeds around its own. Otherwise it is
    /// indicative: another scene has another error.
    pub on_this_scene: bool,
}

/// Relative tolerance when counts and fractions of presets are compared.
const ROUNDING: f64 = 1.0e-9;

impl Evidence {
    /// The error of the best preset that a job is at least as fine as, in mesh, time step and detection. None if there is
    /// no such preset, if the job gives the time step itself, and on an elastic disk, whose mesh was not varied.
    pub fn error_of(&self, spec: &JobSpec) -> Option<PresetError<'_>> {
        if spec.scene.disk.kind == DiskKind::Elastic || spec.numerics.time_step_s.is_some() {
            return None;
        }
        let preset = Preset::ALL.into_iter().rev().find(|preset| is_as_fine(spec, *preset))?;
        Some(PresetError { preset: self.of(preset)?, on_this_scene: self.was_measured_at(spec) })
    }

    /// Whether the errors were measured on the scene of a job: the reference scene with the same integrator, damping and μ, and at a
    /// speed between the slowest and the fastest one.
    fn was_measured_at(&self, spec: &JobSpec) -> bool {
        let mut reference = JobSpec::default();
        reference.scene.pin.elements = spec.scene.pin.elements;
        reference.scene.disk.omega_rpm = spec.scene.disk.omega_rpm;
        reference.scene.contact.mu = self.mu;
        let mut scene = spec.scene.clone();
        // A rigid disk does not use it.
        scene.disk.ring = Ring::default();
        let speeds = || self.reference.cases.iter().map(|case| case.omega_rpm);
        let omega = spec.scene.disk.omega_rpm;
        scene == reference.scene
            && (spec.numerics.beta2, spec.numerics.beta_r_s) == (reference.numerics.beta2, self.beta_r_s)
            && speeds().any(|speed| speed <= omega)
            && speeds().any(|speed| speed >= omega)
    }
}

fn is_as_fine(spec: &JobSpec, preset: Preset) -> bool {
    let JobSpec { scene, numerics, detection, .. } = spec;
    let wanted = preset.elements(&scene.pin, &scene.clamp);
    let at_most = |value: f64, limit: f64| value <= limit * (1.0 + ROUNDING);
    (0..3).all(|axis| scene.pin.elements[axis] >= wanted[axis])
        && at_most(numerics.safety_factor, preset.safety_factor())
        && at_most(detection.tolerance, preset.tolerance())
        && at_most(detection.drift_tolerance, preset.drift_tolerance())
}
