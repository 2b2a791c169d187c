//! What the accuracy and the cost of a job depend on besides the physics.

use crate::report::JobNumerics;
use crate::spec::{Detection, JobSpec, Numerics, RunControl, StabilityMethod};
use crate::study::SharedKeys;

/// The numerics of a job, as reports compare them. `cases` makes the keys of physical cases.
pub(super) fn numerics(spec: &JobSpec, cases: &mut SharedKeys) -> JobNumerics {
    let JobSpec { scene, numerics, run, detection, stability: _, accuracy: _, continuation: _ } = spec;
    let elements = scene.pin.elements;
    JobNumerics {
        case: case_key(spec, cases),
        elements,
        element_size_m: scene.pin.element_volume_m3().cbrt(),
        nodes: scene.pin.node_count() as u64,
        beta2: numerics.beta2,
        beta_r_s: numerics.beta_r_s,
        alpha_r_per_s: numerics.alpha_r_per_s.unwrap_or(0.0),
        safety_factor: numerics.time_step_s.is_none().then_some(numerics.safety_factor),
        limit_s: run.limit_s,
        stop_early: run.stop_early,
        average_last_fraction: run.average_last_fraction,
        cycles: detection.cycles,
        tolerance: detection.tolerance,
        drift_tolerance: detection.drift_tolerance,
        precision: numerics.precision.name().to_owned(),
        start: run.start.name().to_owned(),
    }
}

/// The key of the physical case, which all jobs with the same physics share: the key of a job with this scene, a mesh of
/// one element, and everything else at its default.
fn case_key(spec: &JobSpec, cases: &mut SharedKeys) -> String {
    let mut case = JobSpec {
        scene: spec.scene.clone(),
        numerics: Numerics { alpha_r_per_s: spec.numerics.alpha_r_per_s, ..Numerics::default() },
        run: RunControl::default(),
        detection: Detection::default(),
        stability: StabilityMethod::default(),
        accuracy: None,
        continuation: None,
    };
    case.scene.pin.elements = [1, 1, 1];
    cases.key(case)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver;
    use crate::spec::DiskKind;
    use crate::study::input_parameters;
    use serde_json::Value;

    /// Protects: the parameters that are called numerics are those that do not change the physical case.
    #[test]
    fn numerics_are_what_does_not_change_the_case() {
        let mut cases = SharedKeys::new(solver::VERSION);
        let mut base = JobSpec::default();
        base.scene.disk.kind = DiskKind::Elastic;
        let job = serde_json::to_value(&base).unwrap();
        let mut case_of = |job: Value| case_key(&serde_json::from_value(job).unwrap(), &mut cases);
        let own = case_of(job.clone());
        let mut found = [0; 2];
        for parameter in input_parameters() {
            let mut changed = job.clone();
            let Some(value) = changed.pointer_mut(parameter.pointer) else { continue };
            *value = match value {
                Value::Bool(flag) => (!*flag).into(),
                Value::Number(count) if count.is_u64() => (count.as_u64().unwrap() + 1).into(),
                Value::Number(number) => (number.as_f64().unwrap() * (1.0 + f64::EPSILON)).into(),
                _ => continue,
            };
            assert_eq!(case_of(changed) == own, parameter.is_numerics(), "{}", parameter.name);
            found[usize::from(parameter.is_numerics())] += 1;
        }
        assert!(found[0] > 20 && found[1] > 10, "{found:?}");
    }
}
