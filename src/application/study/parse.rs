//! From the text of a study file to a checked study.

use super::axis::Axis;
use super::calibration;
use super::change::{Basins, Changes, Forms};
use super::conditions::Conditions;
use super::damping::OF_PIN;
use super::definition::Study;
use super::derive::Ties;
use super::error::{Problem, StudyError};
use super::file::StudyFile;
use super::grid::Grid;
use super::growth::{Continue, Growth};
use super::json::{Decoded, decode_all};
use super::limits::MAX_JOBS;
use super::locate::join;
use super::mesh_file;
use super::name::{EXPECTED, is_study_name, refused_name, similar_name};
use super::number_file;
use super::outline::Outline;
use super::parameter::{Parameter, unknown_help};
use super::plausibility::refused_strain;
use super::range;
use super::report_axes::ReportAxes;
use super::samples::{self, given::SamplesFile};
use super::source::{Change, GROWTH, SourceText, shorten};
use super::text::{STDIN, StudyText};
use super::validate::check_jobs;
use super::with_unit;
use crate::spec::{FieldError, JobSpec, MOST_HEIGHTS, MOST_POINTS, StabilityMethod};
use serde_json::{Map, Value, json};
use std::path::Path;

impl Study {
    /// Reads and checks a study file; `-` is standard input.
    ///
    /// # Errors
    /// The file cannot be read, or anything that [`Study::parse`] refuses.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        let StudyText { text, source_name } = StudyText::read(path)?;
        Self::parse(&text, &source_name)
    }

    /// Checks the text of a study file; `source_name` stands for the file in messages, and its stem
    /// is the study's name unless the text gives one. A height map's file is relative to its folder. It is read, and
    /// [`Study::document`] has the heights.
    ///
    /// # Errors
    /// Broken JSON, repeated keys, unknown fields or parameters, wrong types, unusable axes, more
    /// than [`MAX_JOBS`] jobs, or jobs that violate a limit of [`JobSpec::check`](crate::spec::JobSpec::check).
    pub fn parse(text: &str, source_name: &str) -> Result<Self, StudyError> {
        Self::parse_changed(text, source_name, &Changes::default())
    }

    /// As [`Study::parse`], with the changes that a command makes. The text may lack what the changes give: only the jobs of
    /// the changed study are checked against their limits.
    ///
    /// # Errors
    /// Those of [`Study::parse`], and changes with unknown, repeated or overlapping names or values of the wrong type.
    pub fn parse_changed(text: &str, source_name: &str, changes: &Changes) -> Result<Self, StudyError> {
        Self::read(text, source_name, changes, changes.is_of_modes, true)
    }

    /// As [`Study::parse`], for the document of a study in a database. It may be one of complex modes. A damping that it does not
    /// give is `beta_r_s` \[s\], that of its stored jobs: the default was another one in earlier versions.
    ///
    /// # Errors
    /// Those of [`Study::parse`].
    pub fn parse_stored(document: &str, name: &str, beta_r_s: Option<f64>) -> Result<Self, StudyError> {
        let read = |changes: &Changes| Self::read(document, name, changes, true, false);
        let study = read(&Changes::default())?;
        match beta_r_s.filter(|own| *own != study.base.numerics.beta_r_s && !study.gives_damping()) {
            Some(own) => {
                let settings = vec![("beta_r_s".to_owned(), own.to_string())];
                read(&Changes { settings, ..Changes::default() })
            }
            None => Ok(study),
        }
    }

    fn gives_damping(&self) -> bool {
        let beta_r_s = Parameter::named("beta_r_s");
        let is_meant = |varied: &'static Parameter| {
            varied == beta_r_s || varied.displaces().any(|other| other == beta_r_s)
        };
        OF_PIN.iter().any(|field| self.source.gives(field))
            || self.source.gives(&beta_r_s.field())
            || self.varied().any(is_meant)
    }

    fn read(
        text: &str,
        source_name: &str,
        changes: &Changes,
        allows_modes: bool,
        reads_files: bool,
    ) -> Result<Self, StudyError> {
        let (mut value, mut source) = SourceText::read(text, source_name)?;
        refuse(source.repeated_keys())?;
        refuse(long_lists(&value, &source))?;
        refuse(with_unit::in_study(&mut value, &source))?;
        for with_file in [
            number_file::with_heights,
            number_file::with_friction,
            mesh_file::with_mesh,
            samples::with_points,
        ] {
            if reads_files && let Some(text) = with_file(&value, &source)? {
                let (with_content, read) = SourceText::read(&text, source_name)?;
                (value, source) = (with_content, read.at_places_of(&source));
                refuse(with_unit::in_study(&mut value, &source))?;
            }
        }
        let template = StudyFile::template();
        let Decoded { value: file, mismatches } = decode_all::<StudyFile>(&value, &template);
        let mut problems: Vec<_> =
            mismatches.into_iter().map(|mismatch| source.mismatch("", mismatch)).collect();
        let Some(file) = file else { return Err(StudyError::Invalid(problems)) };
        let samples = file.samples.as_ref().map(SamplesFile::length);
        if let Err(error) = check_size(samples, file.grid.as_ref(), &source) {
            return Err(if problems.is_empty() { error } else { StudyError::Invalid(problems) });
        }
        let axes = axes(file.grid, &template, &source).unwrap_or_else(|found| {
            problems.extend(found);
            Vec::new()
        });
        let mut grid = Grid::of_axes(axes);
        match file.samples.map(|samples| samples.read(&template, &source)).transpose() {
            Ok(samples) => grid.samples = samples,
            Err(found) => problems.extend(found),
        }
        problems.extend(repeated_parameters(&grid, &source));
        if let Some(given) = &file.derive {
            problems.extend(Ties::problems(given, &grid.parameters().collect::<Vec<_>>(), &source));
        }
        match Conditions::read(file.include.as_deref(), file.exclude.as_deref(), &source) {
            Ok(conditions) => grid.set_conditions(conditions),
            Err(found) => problems.extend(found),
        }
        let mut outline = Outline { document: value, grid, source, allows_modes, is_new: reads_files };
        let name = outline.rename(changes).and_then(|()| outline.name());
        let name = name.and_then(|name| outline.allowed(name));
        if !problems.iter().any(|problem| problem.field == "name") {
            problems.extend(name.err().into_iter().flatten());
        }
        problems.extend(outline.set("--set", changes.preset, &changes.settings, Forms::AxesToo));
        if changes.is_of_modes && problems.is_empty() {
            outline.ask_for_modes()?;
        }
        let mut growth = Growth { refine: file.refine, continues: file.continues, calibrate: file.calibrate };
        if changes.is_of_modes {
            growth = Growth::default();
        } else if let Some(basins) = changes.basins.filter(|_| problems.is_empty()) {
            growth = outline.ask_for_basins(basins, changes.name.is_some())?;
        } else if let Some(own) = changes.calibration.as_ref().filter(|_| problems.is_empty()) {
            growth = outline.ask_for_calibration(own, growth.calibrate.as_ref(), changes.name.is_some())?;
        }
        // The jobs are judged only when every field has been read: a limit may depend on several of them.
        if problems.is_empty() {
            return Self::of(outline, file.report.unwrap_or_default(), growth);
        }
        // A problem of a field that the file does not give has no position; it comes last.
        problems.sort_by_key(|problem| (problem.position.is_none(), problem.position));
        Err(StudyError::Invalid(problems))
    }

    /// The study with all its jobs.
    pub(super) fn of(outline: Outline, report: ReportAxes, growth: Growth) -> Result<Self, StudyError> {
        outline.check_size()?;
        let name = outline.name().map_err(StudyError::Invalid)?;
        refuse(report.problems(&outline.source))?;
        let draft = outline.draft();
        let Outline { document, mut grid, source, allows_modes, is_new } = outline;
        let base = draft.resolve().spec;
        if grid.select(&base) == 0 {
            let field = if document.get("include").is_some() { "include" } else { "exclude" };
            let message = "expected conditions that leave at least one point";
            return Err(StudyError::Invalid(vec![source.problem(field, message)]));
        }
        refuse(growth.problems(&grid.parameters().collect::<Vec<_>>(), grid.size(), &source))?;
        refuse(
            growth.calibrate.as_ref().map_or_else(Vec::new, |own| calibration::problems(own, &grid, &source)),
        )?;
        let (specs, mut violations): (Vec<_>, Vec<_>) =
            grid.resolve(&draft).into_iter().map(|job| (job.spec, job.violations)).unzip();
        if !allows_modes {
            specs.iter().zip(&mut violations).for_each(|(spec, found)| found.extend(refused_modes(spec)));
        }
        if is_new {
            // Databases may have such jobs of older versions.
            specs.iter().zip(&mut violations).for_each(|(spec, found)| found.extend(refused_strain(spec)));
        }
        let description = document.get("description").and_then(Value::as_str).map(str::to_owned);
        let study = Self {
            name,
            description,
            base,
            document,
            grid,
            specs,
            report,
            growth,
            source,
            allows_modes,
            is_new,
        };
        refuse(check_jobs(&study, &violations))?;
        Ok(study)
    }
}

impl Outline {
    /// The study's name: as given, or the stem of the file's name.
    pub(super) fn name(&self) -> Result<String, Vec<Problem>> {
        name(self.document.get("name").and_then(Value::as_str).map(str::to_owned), &self.source)
    }

    /// The name, if the study can have it.
    fn allowed(&self, name: String) -> Result<String, Vec<Problem>> {
        let Some(message) = refused_name(&name).filter(|_| self.is_new) else { return Ok(name) };
        let problem = self.source.problem("name", message);
        let value = problem.value.clone().unwrap_or_else(|| shorten(&name));
        Err(vec![offer(&name, Problem { value: Some(value), ..problem })])
    }

    /// Gives the study another name, or appends that of the preset.
    fn rename(&mut self, changes: &Changes) -> Result<(), Vec<Problem>> {
        let (place, name) = match (&changes.name, changes.preset) {
            (Some(name), _) => ("--name", name.clone()),
            (None, Some(preset)) => ("--preset", format!("{}-{}", self.name()?, preset.name())),
            (None, None) if changes.settings.is_empty() => return Ok(()),
            // The changed study is written down, perhaps in a file of another name.
            (None, None) => ("", self.name()?),
        };
        if !place.is_empty() {
            self.source.changes.push(Change::of_name(place, &name));
        }
        if let Value::Object(fields) = &mut self.document {
            fields.insert("name".to_owned(), name.into());
        }
        Ok(())
    }

    /// Makes it the study of the complex modes at its grid points.
    fn ask_for_modes(&mut self) -> Result<(), StudyError> {
        let name = format!("{}-stability", self.name().map_err(StudyError::Invalid)?);
        self.source.changes.push(Change::of_name("", &name));
        self.grid.axes.retain(|axis| axis.parameter.name != STABILITY);
        if let Value::Object(fields) = &mut self.document {
            // The command looks for boundaries of its own.
            fields.retain(|name, _| !GROWTH.contains(&name.as_str()));
            fields.insert("name".to_owned(), name.into());
            fields.insert(STABILITY.to_owned(), StabilityMethod::Modes.name().into());
        }
        Ok(())
    }

    /// Makes it the study of the limit cycles that can be reached from its points.
    fn ask_for_basins(
        &mut self,
        Basins { kicks, kick_m_s }: Basins,
        has_name: bool,
    ) -> Result<Growth, StudyError> {
        let own = self.name().map_err(StudyError::Invalid)?;
        let name = if has_name { own } else { format!("{own}-basins") };
        let text = format!("{kicks} of {kick_m_s} m/s");
        self.source
            .changes
            .extend([Change::of_name("--basins", &name), Change::of_growth("--basins", &text)]);
        if let Value::Object(fields) = &mut self.document {
            fields.insert("name".to_owned(), name.into());
            fields.retain(|name, _| !GROWTH.contains(&name.as_str()));
            fields.insert("continue".to_owned(), json!({ "kicks": kicks, "kick_m_s": kick_m_s }));
        }
        let continues = Continue { kicks: Some(kicks), kick_m_s: Some(kick_m_s), ..Continue::default() };
        Ok(Growth { continues: Some(continues), ..Growth::default() })
    }

    /// Refuses a grid that has become too large.
    fn check_size(&self) -> Result<(), StudyError> {
        let samples = self.grid.samples.as_ref().map(|samples| ("samples", samples.rows.len()));
        let axes = self.grid.axes.iter().map(|axis| (axis.parameter.name, axis.values.len()));
        limit_size(&samples.into_iter().chain(axes).collect::<Vec<_>>(), &self.source)
    }
}

/// The field and the parameter of [`StabilityMethod`].
const STABILITY: &str = "stability";

/// Why a study file cannot have this job, if it computes complex modes without a run.
fn refused_modes(spec: &JobSpec) -> Option<FieldError> {
    (spec.stability == StabilityMethod::Modes).then(|| FieldError {
        field: STABILITY.to_owned(),
        value: Value::from(StabilityMethod::Modes.name()).to_string(),
        expected: format!(
            "`{}`; the command `tribosweep stability` computes modes without a run",
            StabilityMethod::OF_FILES.join("` or `")
        ),
    })
}

/// Lists that are longer than any that a job may have. Reading them as data would take long and then be refused.
fn long_lists(value: &Value, source: &SourceText) -> Vec<Problem> {
    let map = "/scene/pin/base/height_map/heights_m";
    let count = |entry: &Value| entry.as_array().map_or(1, Vec::len);
    let lists = [
        ("/scene/program/omega_rpm", MOST_POINTS, "points"),
        ("/scene/program/force_n", MOST_POINTS, "points"),
        (map, MOST_HEIGHTS, "heights"),
    ];
    let too_long = |(pointer, most, what): (&str, usize, &str)| {
        let list = value.pointer(pointer)?.as_array()?;
        let length = if pointer == map { list.iter().map(count).sum() } else { list.len() };
        let field = pointer[1..].replace('/', ".");
        let problem = source.problem(&field, format!("expected at most {most} {what}"));
        (length > most).then(|| Problem { value: Some(format!("{length} {what}")), ..problem })
    };
    lists.into_iter().filter_map(too_long).collect()
}

fn refuse(problems: Vec<Problem>) -> Result<(), StudyError> {
    if problems.is_empty() { Ok(()) } else { Err(StudyError::Invalid(problems)) }
}

fn name(given: Option<String>, source: &SourceText) -> Result<String, Vec<Problem>> {
    match given {
        Some(name) if is_study_name(&name) => Ok(name),
        Some(name) => Err(vec![offer(&name, source.problem("name", EXPECTED))]),
        None => {
            let stem = Path::new(&source.file).file_stem().unwrap_or_default().to_string_lossy();
            if is_study_name(&stem) {
                return Ok(stem.into_owned());
            }
            if source.file == STDIN {
                let help = "add \"name\": \"…\" to the study, which has no file with a name";
                return Err(vec![source.problem("name", EXPECTED).with_help(help)]);
            }
            let help = "add \"name\": \"…\" to the file, or rename it";
            let problem = offer(&stem, source.problem("name", EXPECTED)).with_help(help);
            Err(vec![Problem { value: Some(format!("{stem:?} (from the file's name)")), ..problem }])
        }
    }
}

/// The problem of a name, with a name that a study can have.
fn offer(wrong: &str, problem: Problem) -> Problem {
    match similar_name(wrong) {
        Some(name) => problem.with_help(format!("`{name}` is possible; `description` takes any text")),
        None => problem,
    }
}

fn axes(
    grid: Option<Map<String, Value>>,
    template: &Value,
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
        match Axis::read(parameter, given, template, source) {
            Ok(axis) => axes.push(axis),
            Err(found) => problems.extend(found),
        }
    }
    if problems.is_empty() { Ok(axes) } else { Err(problems) }
}

/// Parameters of the samples that an axis sets, too.
fn repeated_parameters(grid: &Grid, source: &SourceText) -> Vec<Problem> {
    let of_samples = grid.samples.iter().flat_map(|samples| &samples.parameters);
    let repeated = of_samples.filter_map(|parameter| {
        let axis = grid.axes.iter().find(|axis| axis.parameter.overlaps(parameter))?;
        let message =
            format!("sets the same field as {} in samples; expected only one of the two", parameter.name);
        Some(source.problem_with_name(&axis.path(), message))
    });
    repeated.collect()
}

/// Refuses a grid that is too large. This comes before any value is read: a few axes of a million values each would
/// take minutes to be refused.
fn check_size(
    samples: Option<usize>,
    grid: Option<&Map<String, Value>>,
    source: &SourceText,
) -> Result<(), StudyError> {
    let mut axes: Vec<_> =
        grid.into_iter().flatten().map(|(name, given)| (name.as_str(), range::axis_length(given))).collect();
    axes.sort_by_key(|(name, _)| source.key_position(&join("grid", name)));
    axes.splice(0..0, samples.map(|count| ("samples", count)));
    limit_size(&axes, source)
}

fn limit_size(axes: &[(&str, usize)], source: &SourceText) -> Result<(), StudyError> {
    let points = axes.iter().fold(1, |n: u128, (_, length)| n.saturating_mul(*length as u128));
    if points <= MAX_JOBS as u128 {
        return Ok(());
    }
    let factors: Vec<_> = axes.iter().map(|(name, length)| format!("{name} {length}")).collect();
    Err(StudyError::TooManyJobs { file: source.file.clone(), points, factors: factors.join(" × ") })
}
