//! From the text of a study file to a checked study.

use super::Study;
use super::axis::Axis;
use super::error::{Problem, StudyError};
use super::expand::MAX_JOBS;
use super::file::StudyFile;
use super::json::{self, decode};
use super::locate::{Position, join};
use super::origin::Origin;
use super::parameter::{Parameter, unknown_help};
use super::preset::Preset;
use super::validate::check_jobs;
use crate::spec::JobSpec;
use serde_json::{Map, Value};
use std::path::Path;

pub(super) fn parse(text: &str, source_name: &str) -> Result<Study, StudyError> {
    let value: Value = serde_json::from_str(text).map_err(|error| syntax(source_name, &error))?;
    let origin = Origin::new(text, source_name);
    refuse(origin.repeated_keys())?;
    let file: StudyFile =
        decode(&value, &StudyFile::template()).map_err(|mismatch| origin.mismatch("", mismatch))?;

    let name = name(file.name, &origin)?;
    let given =
        JobSpec { scene: file.scene, numerics: file.numerics, run: file.run, detection: file.detection };
    let base = with_preset(given, file.preset, &origin);
    check_size(file.grid.as_ref(), &origin)?;
    let axes = axes(file.grid, &base, &origin).map_err(StudyError::Invalid)?;
    let study = Study { name, description: file.description, base, axes, origin };
    refuse(check_jobs(&study))?;
    Ok(study)
}

/// The job with the preset's settings wherever the file gives nothing itself.
fn with_preset(given: JobSpec, preset: Option<Preset>, origin: &Origin) -> JobSpec {
    let Some(preset) = preset else { return given };
    let mut job = json::encode(&given);
    preset.apply(&given.scene, &mut job, |parameter| origin.places.by_path.contains_key(&parameter.field()));
    json::checked_job(&job)
}

fn refuse(problems: Vec<Problem>) -> Result<(), StudyError> {
    if problems.is_empty() { Ok(()) } else { Err(StudyError::Invalid(problems)) }
}

fn syntax(file: &str, error: &serde_json::Error) -> StudyError {
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
    StudyError::Syntax {
        file: file.to_owned(),
        // An empty file ends in column 0, which no editor has.
        position: Position { line: error.line(), column: error.column().max(1) },
        message: message.to_owned(),
    }
}

fn name(given: Option<String>, origin: &Origin) -> Result<String, StudyError> {
    let usable = |name: &str| {
        let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        !name.is_empty() && name.chars().all(allowed)
    };
    let expected = "expected a name of letters A-Z a-z, digits, _ and -";
    match given {
        Some(name) if usable(&name) => Ok(name),
        Some(_) => Err(origin.problem("name", expected).into()),
        None => {
            let stem = Path::new(&origin.file).file_stem().unwrap_or_default().to_string_lossy();
            if usable(&stem) {
                return Ok(stem.into_owned());
            }
            let help = "add \"name\": \"…\" to the file, or rename it";
            let problem = origin.problem("name", expected).with_help(help);
            Err(Problem { value: Some(format!("{stem:?} (from the file's name)")), ..problem }.into())
        }
    }
}

fn axes(
    grid: Option<Map<String, Value>>,
    base: &JobSpec,
    origin: &Origin,
) -> Result<Vec<Axis>, Vec<Problem>> {
    let Some(grid) = grid else { return Ok(Vec::new()) };
    if grid.is_empty() {
        let help = "leave \"grid\" out for a single job, or add an axis such as \"mu\": [0.2, 0.4]";
        return Err(vec![origin.problem("grid", "expected at least one parameter").with_help(help)]);
    }
    // A JSON map comes in no reliable order; the file's order is the order of the places.
    let mut entries: Vec<_> = grid.iter().collect();
    entries.sort_by_key(|(name, _)| origin.places.by_path.get(&join("grid", name)).map(|place| place.key));

    let template = json::encode(base);
    let mut axes: Vec<Axis> = Vec::new();
    let mut problems = Vec::new();
    for (name, given) in entries {
        let path = join("grid", name);
        let Some(parameter) = Parameter::find(name) else {
            let problem = origin.problem_with_name(&path, "no such parameter");
            problems.push(Problem { help: unknown_help(name), ..problem });
            continue;
        };
        if let Some(other) = axes.iter().find(|axis| axis.parameter.overlaps(parameter)) {
            let other = other.parameter.name;
            let message = format!("sets the same field as grid.{other}; expected only one of the two");
            problems.push(origin.problem_with_name(&path, message));
        }
        match Axis::read(parameter, given, &template, origin) {
            Ok(axis) => axes.push(axis),
            Err(found) => problems.extend(found),
        }
    }
    if problems.is_empty() { Ok(axes) } else { Err(problems) }
}

/// Before any value is looked at: a few axes of a million values each would take minutes to be refused.
fn check_size(grid: Option<&Map<String, Value>>, origin: &Origin) -> Result<(), StudyError> {
    let mut axes: Vec<_> = grid.into_iter().flatten().map(|(name, given)| (name, length(given))).collect();
    let points = axes.iter().fold(1, |n: u128, (_, length)| n.saturating_mul(*length as u128));
    if points <= MAX_JOBS as u128 {
        return Ok(());
    }
    axes.sort_by_key(|(name, _)| origin.places.by_path.get(&join("grid", name)).map(|place| place.key));
    let factors: Vec<_> = axes.iter().map(|(name, length)| format!("{name} {length}")).collect();
    Err(StudyError::TooManyJobs { file: origin.file.clone(), points, factors: factors.join(" × ") })
}

/// Number of values of an axis as written; 1 where it is not an axis or a range too long by itself, which
/// reading it tells better.
fn length(given: &Value) -> usize {
    match given {
        Value::Array(list) => list.len().max(1),
        _ => given
            .get("count")
            .and_then(Value::as_u64)
            .and_then(|count| usize::try_from(count).ok())
            .filter(|count| (1..=MAX_JOBS).contains(count))
            .unwrap_or(1),
    }
}
