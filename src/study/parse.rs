//! From the text of a study file to a checked study.

use super::axis::Axis;
use super::definition::Study;
use super::error::{Problem, StudyError};
use super::file::StudyFile;
use super::grid::Grid;
use super::json::{self, decode};
use super::limits::MAX_JOBS;
use super::locate::{Position, join};
use super::parameter::{Parameter, unknown_help};
use super::preset::Preset;
use super::source::SourceText;
use super::validate::check_jobs;
use crate::spec::JobSpec;
use jsonc_parser::errors::ParseError;
use serde_json::{Map, Value};
use std::path::Path;

impl Study {
    /// Reads and checks a study file.
    ///
    /// # Errors
    /// The file cannot be read, or anything that [`Study::parse`] refuses.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        let text = std::fs::read_to_string(path)
            .map_err(|reason| StudyError::Read { file: path.display().to_string(), reason })?;
        Self::parse(&text, &path.display().to_string())
    }

    /// Checks the text of a study file; `source_name` stands for the file in messages, and its stem
    /// is the study's name unless the text gives one.
    ///
    /// # Errors
    /// Broken JSON, repeated keys, unknown fields or parameters, wrong types, unusable axes, more
    /// than [`MAX_JOBS`] jobs, or jobs that violate a limit of [`JobSpec::check`].
    pub fn parse(text: &str, source_name: &str) -> Result<Self, StudyError> {
        let value: Value = serde_json::from_str(text).map_err(|error| not_json(source_name, &error))?;
        let source = SourceText::new(text, source_name).map_err(|error| not_located(source_name, &error))?;
        refuse(source.repeated_keys())?;
        let file: StudyFile =
            decode(&value, &StudyFile::template()).map_err(|mismatch| source.mismatch("", mismatch))?;

        let name = name(file.name, &source)?;
        let given =
            JobSpec { scene: file.scene, numerics: file.numerics, run: file.run, detection: file.detection };
        let base = with_preset(given, file.preset, &source);
        check_size(file.grid.as_ref(), &source)?;
        let grid = Grid { axes: axes(file.grid, &base, &source).map_err(StudyError::Invalid)? };
        let specs = grid.specs(&base);
        let study = Self { name, description: file.description, base, grid, specs, source };
        refuse(check_jobs(&study))?;
        Ok(study)
    }
}

/// The job with the preset's settings in all fields that the file does not give itself.
fn with_preset(given: JobSpec, preset: Option<Preset>, source: &SourceText) -> JobSpec {
    let Some(preset) = preset else { return given };
    let mut job = json::encode(&given);
    preset.apply(&given.scene, &mut job, |parameter| source.gives(&parameter.field()));
    json::decode_checked(&job)
}

fn refuse(problems: Vec<Problem>) -> Result<(), StudyError> {
    if problems.is_empty() { Ok(()) } else { Err(StudyError::Invalid(problems)) }
}

fn not_json(file: &str, error: &serde_json::Error) -> StudyError {
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
    StudyError::Syntax {
        file: file.to_owned(),
        // serde_json reports column 0 for an empty file; editors count from 1.
        position: Position { line: error.line(), column: error.column().max(1) },
        message: message.to_owned(),
    }
}

/// For a text that only one of the two readers takes for JSON; none is known.
fn not_located(file: &str, error: &ParseError) -> StudyError {
    StudyError::Syntax {
        file: file.to_owned(),
        position: Position { line: error.line_display(), column: error.column_display() },
        message: error.kind().to_string(),
    }
}

fn name(given: Option<String>, source: &SourceText) -> Result<String, StudyError> {
    let usable = |name: &str| {
        let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        !name.is_empty() && name.chars().all(allowed)
    };
    let expected = "expected a name of letters A-Z a-z, digits, _ and -";
    match given {
        Some(name) if usable(&name) => Ok(name),
        Some(_) => Err(source.problem("name", expected).into()),
        None => {
            let stem = Path::new(&source.file).file_stem().unwrap_or_default().to_string_lossy();
            if usable(&stem) {
                return Ok(stem.into_owned());
            }
            let help = "add \"name\": \"…\" to the file, or rename it";
            let problem = source.problem("name", expected).with_help(help);
            Err(Problem { value: Some(format!("{stem:?} (from the file's name)")), ..problem }.into())
        }
    }
}

fn axes(
    grid: Option<Map<String, Value>>,
    base: &JobSpec,
    source: &SourceText,
) -> Result<Vec<Axis>, Vec<Problem>> {
    let Some(grid) = grid else { return Ok(Vec::new()) };
    if grid.is_empty() {
        let help = "leave \"grid\" out for a single job, or add an axis such as \"mu\": [0.2, 0.4]";
        return Err(vec![source.problem("grid", "expected at least one parameter").with_help(help)]);
    }
    // A JSON map comes in no reliable order; the order of the file is that of the keys' positions.
    let mut entries: Vec<_> = grid.iter().collect();
    entries.sort_by_key(|(name, _)| source.key_position(&join("grid", name)));

    let template = json::encode(base);
    let mut axes: Vec<Axis> = Vec::new();
    let mut problems = Vec::new();
    for (name, given) in entries {
        let path = join("grid", name);
        let Some(parameter) = Parameter::find(name) else {
            let problem = source.problem_with_name(&path, "no such parameter");
            problems.push(Problem { help: unknown_help(name), ..problem });
            continue;
        };
        if let Some(other) = axes.iter().find(|axis| axis.parameter.overlaps(parameter)) {
            let other = other.parameter.name;
            let message = format!("sets the same field as grid.{other}; expected only one of the two");
            problems.push(source.problem_with_name(&path, message));
        }
        match Axis::read(parameter, given, &template, source) {
            Ok(axis) => axes.push(axis),
            Err(found) => problems.extend(found),
        }
    }
    if problems.is_empty() { Ok(axes) } else { Err(problems) }
}

/// Refuses a grid that is too large. This comes before any value is read: a few axes of a million values each would
/// take minutes to be refused.
fn check_size(grid: Option<&Map<String, Value>>, source: &SourceText) -> Result<(), StudyError> {
    let mut axes: Vec<_> = grid.into_iter().flatten().map(|(name, given)| (name, length(given))).collect();
    let points = axes.iter().fold(1, |n: u128, (_, length)| n.saturating_mul(*length as u128));
    if points <= MAX_JOBS as u128 {
        return Ok(());
    }
    axes.sort_by_key(|(name, _)| source.key_position(&join("grid", name)));
    let factors: Vec<_> = axes.iter().map(|(name, length)| format!("{name} {length}")).collect();
    Err(StudyError::TooManyJobs { file: source.file.clone(), points, factors: factors.join(" × ") })
}

/// Number of values of an axis as written. It is 1 for anything that is not an axis, and for a range that is too long
/// by itself: reading the axis gives a better message.
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
