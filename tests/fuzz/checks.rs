//! What must hold of any text given as a study or as overrides; shared by the fuzz targets and the
//! mutation test of the ordinary suite.

use serde_json::Value;
use std::collections::HashSet;
use tribosweep::analysis::Workload;
use tribosweep::spec::JobSpec;
use tribosweep::study::{Study, StudyError, job_key, json_value};

/// Largest grid that is tried. Larger ones are legal but slow, and their texts are skipped.
const MAX_POINTS: f64 = 2000.0;

/// What the parser did with a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// It is a study.
    Accepted,
    /// It was refused, with a message.
    Refused,
    /// It has more grid points than are tried here.
    Skipped,
}

/// Parses `text` and checks what must hold of the study or of the refusal.
pub fn check_study(text: &str) -> Fate {
    if grid_points(text) > MAX_POINTS {
        return Fate::Skipped;
    }
    match Study::parse(text, "fuzzed.json") {
        Ok(study) => {
            check_jobs(&study);
            Fate::Accepted
        }
        Err(error) => {
            check_refusal(text, &error);
            Fate::Refused
        }
    }
}

/// Applies `overrides`, one `name=value` a line, to `study`.
pub fn check_overrides(study: &Study, overrides: &str) -> Fate {
    let pairs: Vec<_> = overrides
        .lines()
        .filter_map(|line| line.split_once('='))
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .collect();
    match study.single(&pairs) {
        Ok(spec) => {
            check_spec(&spec);
            Fate::Accepted
        }
        Err(error) => {
            assert!(!error.problems().is_empty() && !error.to_string().is_empty());
            Fate::Refused
        }
    }
}

/// Number of grid points of `text`; 0 if it cannot be read.
fn grid_points(text: &str) -> f64 {
    let Ok(value) = json_value(text, "fuzzed.json") else { return 0.0 };
    let Some(axes) = value.get("grid").and_then(Value::as_object) else { return 0.0 };
    let lengths = axes.values().map(|axis| match axis {
        Value::Array(list) => list.len() as f64,
        other => {
            let number = |name| other.get(name).and_then(Value::as_f64);
            let steps = || Some((number("to")? - number("from")?) / number("step")? + 1.0);
            number("count").or_else(steps).unwrap_or(1.0)
        }
    });
    // The parser refuses a count out of range before it makes values.
    let plausible = |length: f64| if (1.0..=1.0e6).contains(&length) { length } else { 1.0 };
    lengths.map(plausible).product()
}

fn check_jobs(study: &Study) {
    let jobs = study.expand("fuzz").expect("a study that was accepted can be expanded");
    assert!(!jobs.is_empty() && jobs.len() <= study.grid_size(), "{} jobs", jobs.len());
    let keys: HashSet<_> = jobs.iter().map(|job| &job.key).collect();
    assert_eq!(keys.len(), jobs.len(), "a key names one job");
    for job in jobs.iter().take(20) {
        if let Ok(workload) = Workload::estimate(&job.spec) {
            assert!(workload.node_steps(job.spec.run.limit_s) > 0.0, "{workload:?} of {:?}", job.spec);
        }
        check_spec(&job.spec);
    }
}

/// An accepted job is physical, is stored and read back as it is, and can be planned.
fn check_spec(spec: &JobSpec) {
    spec.check().expect("only physical jobs are accepted");
    let stored = serde_json::to_string(spec).expect("a job can be stored");
    let read: JobSpec = serde_json::from_str(&stored).expect("a stored job can be read");
    assert_eq!(&read, spec, "{stored}");
    assert_eq!(job_key(&read, "fuzz"), job_key(spec, "fuzz"));
    // Building the model takes too long for larger meshes.
    if spec.scene.pin.elements.iter().product::<usize>() <= 2 {
        // Refusals are fine; panics and endless loops are not.
        let _ = Workload::examine(spec);
    }
}

fn check_refusal(text: &str, error: &StudyError) {
    assert!(!error.to_string().is_empty());
    let lines = text.lines().count().max(1);
    for problem in error.problems() {
        assert!(!problem.message.is_empty() && !problem.field.is_empty(), "{problem:?}");
        if let Some(position) = problem.position {
            assert!((1..=lines).contains(&position.line) && position.column >= 1, "{problem}");
        }
    }
}
