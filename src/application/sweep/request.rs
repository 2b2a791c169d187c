//! What a report is asked to show: studies and measured points side by side, and the axes.

use super::bins;
use super::database::readable_study;
use super::difference::{Difference, InputDifference};
use super::error::SweepError;
use super::measured::MeasuredFile;
use super::rows::read_rows;
use super::selection::values;
use crate::publish::value;
use crate::queue::Queue;
use crate::report::columns::ExportColumn;
use crate::report::{FREQUENCY, JobRow, MU_STAR, Parameters, SCALARS, Scalar, View, parameter_names};
use crate::solver;
use crate::spec::JobSpec;
use crate::study::{DIRECTION, PARAMETERS, Spacing, Study, StudyError, nearest_name};
use indexmap::IndexSet;
use serde_json::Value;
use std::collections::HashMap;
use std::path::PathBuf;

/// The studies, files and axes of a report.
#[derive(Debug, Clone, Default)]
pub struct ReportRequest {
    /// Names of the studies; the first one is the reference of a comparison.
    pub studies: Vec<String>,
    /// Files of measured points.
    pub data: Vec<PathBuf>,
    /// The number of bins in which the rows of these files are averaged; none for the rows themselves.
    pub bins: Option<usize>,
    /// The study that shows what could move the first one nearer to the others.
    pub sensitivity: Option<String>,
    /// The parameter along the axis; the study's own choice if absent.
    pub x: Option<String>,
    /// The parameter of the curves; the study's own choice if absent.
    pub by: Option<String>,
    /// Further quantities; the study's own choice if empty.
    pub y: Vec<String>,
    /// Whether μ\* has a figure of its span over the other parameters and the studies.
    pub span: bool,
    /// How the axes of parameters are scaled; the study's own choice if absent, and otherwise as the values are given.
    pub scale: Vec<(String, Spacing)>,
}

/// What a report shows.
#[derive(Debug)]
pub struct ReportContent {
    /// Its title: the names of its sources.
    pub title: String,
    /// The names of its studies.
    pub studies: Vec<String>,
    /// Jobs and measured points.
    pub rows: Vec<JobRow>,
    /// How they are laid out.
    pub view: View,
    /// The study that shows what could move the first one nearer to the others, and its jobs.
    pub sensitivity: Option<(String, Vec<JobRow>)>,
    /// What was left out of files of measured points, and what looks wrong in them, in sentences.
    pub warnings: Vec<String>,
}

/// A study of the database as it was submitted.
struct StoredStudy {
    name: String,
    /// None if this version cannot read the study's document.
    study: Option<Study>,
}

/// Stands for the study or file of a row among the parameters.
const SOURCE: &str = "source";

impl ReportRequest {
    /// The usual report of one study.
    pub fn of_study(name: &str) -> Self {
        Self { studies: vec![name.to_owned()], ..Self::default() }
    }

    /// The names of the sources: the studies, and the stems of the files, with their endings if a study has the same name.
    fn sources(&self) -> Vec<String> {
        let mut names = self.studies.clone();
        for path in &self.data {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let taken = names.contains(&stem);
            names.push(if taken { path.display().to_string() } else { stem });
        }
        names
    }

    /// The title of the report, `A vs B`, or the name of its only study.
    pub fn title(&self) -> String {
        self.sources().join(" vs ")
    }

    /// The name of the report's usual folder.
    pub fn folder_name(&self) -> String {
        value::file_name_part(&self.sources().join("-vs-"))
    }

    /// How the rows of the only study are laid out.
    ///
    /// # Errors
    /// If the database cannot be read, and [`SweepError::NoSuchAxis`].
    pub(super) async fn view_of_study(&self, queue: &mut Queue, rows: &[JobRow]) -> Result<View, SweepError> {
        let studies = self.stored(queue).await?;
        self.view(&studies, rows)
    }

    /// Whether the jobs are those of a Morris design, in its order.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn is_morris(&self, queue: &mut Queue) -> Result<bool, SweepError> {
        Ok(is_morris(&self.stored(queue).await?))
    }

    async fn stored(&self, queue: &mut Queue) -> Result<Vec<StoredStudy>, SweepError> {
        let mut studies = Vec::new();
        for name in &self.studies {
            let study = readable_study(queue, name).await?;
            studies.push(StoredStudy { name: name.clone(), study });
        }
        Ok(studies)
    }

    fn view(&self, studies: &[StoredStudy], rows: &[JobRow]) -> Result<View, SweepError> {
        let own = studies.iter().find_map(|stored| stored.study.as_ref()).map(Study::report);
        let own = own.cloned().unwrap_or_default();
        let mut known = parameter_names(rows.iter().map(|row| &row.parameters));
        if self.sources().len() > 1 {
            known.push(SOURCE);
        }
        let asked = |option, name: &Option<String>| match name {
            Some(name) if !known.contains(&name.as_str()) => Err(no_such_name(option, name, &known)),
            name => Ok(name.clone()),
        };
        // A name in the study's file may be that of a parameter that does not vary any more. It is then ignored.
        let (x, by) = (asked("--x", &self.x)?.or(own.x), asked("--by", &self.by)?.or(own.by));
        if self.by.is_some() && x == by {
            let name = by.unwrap_or_default();
            let message = "expected another parameter than that of the axis".to_owned();
            return Err(SweepError::NoSuchAxis { option: "--by", name, message });
        }
        // The two ways along a parameter are curves beside each other.
        let is_usual = by.is_none() && x.as_deref() != Some(DIRECTION) && !self.span;
        let by = if is_usual && known.contains(&DIRECTION) { Some(DIRECTION.to_owned()) } else { by };
        let quantities = if self.y.is_empty() { &own.y } else { &self.y };
        let mut y: Vec<&'static Scalar> = Vec::new();
        for name in quantities {
            let scalar = Scalar::find(name).ok_or_else(|| {
                let is_parameter = known.contains(&name.as_str());
                if is_parameter { not_a_result("--y", name) } else { no_such_quantity("--y", name) }
            })?;
            // These two have their figures in every report.
            if scalar != MU_STAR && scalar != FREQUENCY && !y.contains(&scalar) {
                y.push(scalar);
            }
        }
        let mut is_log = std::collections::BTreeMap::new();
        let given = studies.iter().rev().filter_map(|stored| stored.study.as_ref());
        let given = given.flat_map(|study| {
            study.varied().filter_map(|own| Some((own.name.to_owned(), study.spacing(own.name)?)))
        });
        for (name, spacing) in given.chain(own.scale).chain(self.scale.iter().cloned()) {
            is_log.insert(name, spacing == Spacing::Log);
        }
        if let Some((name, _)) = self.scale.iter().find(|(name, _)| !known.contains(&name.as_str())) {
            return Err(no_such_name("--scale", name, &known));
        }
        let is_morris = is_morris(studies);
        let notes = different_inputs(studies, &known)?;
        Ok(View { x, by, y, span: self.span, descriptions: descriptions(), is_log, is_morris, notes })
    }
}

/// Whether there is one study, and its points are a Morris design and no product of one with a grid.
fn is_morris(studies: &[StoredStudy]) -> bool {
    matches!(studies, [StoredStudy { study: Some(only), .. }] if only.is_morris())
}

fn no_such_name(option: &'static str, name: &str, known: &[&str]) -> SweepError {
    let is_parameter = PARAMETERS.iter().any(|parameter| parameter.name == name);
    let (problem, advice) = match nearest_name(name, known.iter().copied()) {
        _ if is_parameter => ("does not vary between these jobs", String::new()),
        _ if Scalar::find(name).is_some() => {
            ("this is a result; expected a parameter", "; results go to --y".to_owned())
        }
        Some(near) => ("no such name", format!("; did you mean `{near}`?")),
        None => ("no such name", String::new()),
    };
    let message = format!("{problem}{advice}\n  help: expected one of {}", known.join(", "));
    SweepError::NoSuchAxis { option, name: name.to_owned(), message }
}

fn not_a_result(option: &'static str, name: &str) -> SweepError {
    let message =
        "this is a parameter; expected a result. `report` takes parameters with --x and --by".to_owned();
    SweepError::NoSuchAxis { option, name: name.to_owned(), message }
}

/// A name that is no number of a record.
pub fn no_such_quantity(option: &'static str, name: &str) -> SweepError {
    if PARAMETERS.iter().any(|parameter| parameter.name == name) {
        return not_a_result(option, name);
    }
    let nearest = nearest_name(name, SCALARS.iter().map(|scalar| scalar.name));
    let advice = nearest.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    let is_text = ExportColumn::find(name).is_some();
    let problem = if is_text { "is no number" } else { "no such quantity" };
    let message = format!(
        "{problem}{advice}\n  help: expected a number of a result, such as mu_star, frequency_hz or stick_share; `tribosweep columns` \
         lists them"
    );
    SweepError::NoSuchAxis { option, name: name.to_owned(), message }
}

/// Refuses quantities in a study's file that no record has.
pub(super) fn check_quantities(study: &Study) -> Result<(), SweepError> {
    let names = SCALARS.iter().map(|scalar| scalar.name).collect::<Vec<_>>();
    let of_report =
        study.report().y.iter().enumerate().map(|(index, name)| (format!("report.y[{index}]"), name));
    let of_curves = study.growth().refine.iter().filter_map(|refine| refine.curves.as_ref());
    let of_curves = of_curves.map(|curves| ("refine.curves.of".to_owned(), &curves.of));
    let unknown = of_report.chain(of_curves).filter(|(_, name)| Scalar::find(name).is_none());
    let problems: Vec<_> = unknown
        .map(|(field, name)| {
            let nearest =
                nearest_name(name, names.iter().copied()).map(|name| format!("did you mean `{name}`?"));
            let all = format!("the quantities are {}", names.join(", "));
            study.problem(&field, "no such quantity", nearest.into_iter().chain([all]).collect())
        })
        .collect();
    // Points that depend on the speed of a machine would be others on every machine.
    let curves = study.growth().refine.as_ref().and_then(|refine| refine.curves.as_ref());
    let mut problems = problems;
    if curves.is_some_and(|curves| curves.of == "wall_s") {
        let message = "expected a quantity of the result, and not of the machine";
        problems.push(study.problem("refine.curves.of", message, Vec::new()));
    }
    if problems.is_empty() { Ok(()) } else { Err(StudyError::Invalid(problems).into()) }
}

/// The parameters that are numbers in words, for the titles of axes.
fn descriptions() -> std::collections::BTreeMap<String, String> {
    let numbers = PARAMETERS.iter().filter(|parameter| parameter.is_number());
    let in_words = numbers.map(|parameter| {
        let words = parameter.meaning;
        (parameter.name.to_owned(), words.split_once(", ").map_or(words, |(words, _)| words).to_owned())
    });
    in_words.collect()
}

/// Reads what a report shows.
///
/// # Errors
/// If the database has no such study or cannot be read, a file of measured points cannot be used, a source is given twice,
/// or an axis does not exist.
pub async fn read_report(queue: &mut Queue, request: &ReportRequest) -> Result<ReportContent, SweepError> {
    let sources = request.sources();
    if let Some(repeated) = (1..sources.len()).find(|&index| sources[..index].contains(&sources[index])) {
        return Err(SweepError::RepeatedSource(sources[repeated].clone()));
    }
    let files: Vec<MeasuredFile> = request
        .data
        .iter()
        .zip(&sources[request.studies.len()..])
        .map(|(path, name)| bins::read(path, name, request.bins))
        .collect::<Result<_, _>>()?;
    let studies = request.stored(queue).await?;
    let mut of_studies = Vec::new();
    for study in &request.studies {
        of_studies.push(read_rows(queue, study).await?);
    }
    // Every parameter that a grid or a file has is one of all jobs, so that equal points of different sources are found.
    let in_grids = parameter_names(of_studies.iter().flatten().map(|row| &row.parameters));
    let in_files = files.iter().flat_map(|file| file.parameters.iter().copied());
    let names: IndexSet<String> = in_grids.into_iter().chain(in_files).map(str::to_owned).collect();
    for (rows, stored) in of_studies.iter_mut().zip(&studies) {
        add_parameters(rows, stored, &names)?;
    }
    let mut rows: Vec<JobRow> = of_studies.into_iter().flatten().collect();
    let jobs = rows.len();
    let mut warnings = Vec::new();
    for mut file in files {
        warnings.append(&mut file.warnings);
        rows.extend(completed(file, &rows[..jobs], &names));
    }
    let view = request.view(&studies, &rows)?;
    let sensitivity = match &request.sensitivity {
        Some(name) => Some((name.clone(), read_rows(queue, name).await?)),
        None => None,
    };
    let studies = request.studies.clone();
    Ok(ReportContent { title: request.title(), studies, rows, view, sensitivity, warnings })
}

/// Gives the rows of a study the parameters that its grid does not have, with the values of the jobs.
fn add_parameters(
    rows: &mut [JobRow],
    stored: &StoredStudy,
    names: &IndexSet<String>,
) -> Result<(), SweepError> {
    let is_missing = |row: &JobRow, name: &str| row.parameters.get(name).is_none();
    let is_incomplete = |row: &JobRow| names.iter().any(|name| is_missing(row, name));
    let Some(study) = stored.study.as_ref().filter(|_| rows.iter().any(is_incomplete)) else {
        return Ok(());
    };
    let jobs = study.expand(solver::VERSION)?;
    let specs: HashMap<&str, &JobSpec> = jobs.iter().map(|job| (job.key.as_str(), &job.spec)).collect();
    for row in rows {
        let missing: Vec<&str> =
            names.iter().map(String::as_str).filter(|name| is_missing(row, name)).collect();
        // An older version may have given the job another key; the parameters outside of the grid are those of all jobs.
        let spec = specs.get(row.job.as_str()).copied().unwrap_or_else(|| study.base());
        row.parameters.extend(values(spec, missing.into_iter())?);
    }
    Ok(())
}

/// The points of a file with all parameters: what the file does not say is taken from the jobs, if it is the same in all of
/// them, and otherwise not known.
fn completed(file: MeasuredFile, jobs: &[JobRow], names: &IndexSet<String>) -> Vec<JobRow> {
    let constant = |name: &String| {
        let mut all = jobs.iter().map(|row| row.parameters.get(name).unwrap_or(&Value::Null));
        let first = all.next()?;
        all.all(|value| value::text(value) == value::text(first)).then_some(first)
    };
    let usual: Vec<(&String, Value)> =
        names.iter().map(|name| (name, constant(name).cloned().unwrap_or_default())).collect();
    let complete = |row: JobRow| {
        let value = |(name, usual): &(&String, Value)| {
            let given = row.parameters.get(name).filter(|given| !given.is_null());
            ((*name).clone(), given.unwrap_or(usual).clone())
        };
        let parameters = Parameters::new(f64::NAN, f64::NAN, usual.iter().map(value).collect());
        JobRow { parameters, ..row }
    };
    file.rows.into_iter().map(complete).collect()
}

/// The inputs in which the studies differ, apart from the `varied` parameters, which tables and figures show: one sentence
/// for each study after the first.
fn different_inputs(studies: &[StoredStudy], varied: &[&str]) -> Result<Vec<String>, SweepError> {
    if studies.len() < 2 {
        return Ok(Vec::new());
    }
    let (read, unreadable): (Vec<_>, Vec<_>) = studies.iter().partition(|stored| stored.study.is_some());
    let mut notes: Vec<String> = unreadable
        .iter()
        .map(|stored| {
            let name = &stored.name;
            format!("This version cannot read the document of {name}, so its inputs are not compared.")
        })
        .collect();
    let mut jobs = Vec::new();
    for StoredStudy { name, study } in read {
        jobs.extend(
            study.as_ref().map(|study| study.expand(solver::VERSION)).transpose()?.map(|jobs| (name, jobs)),
        );
    }
    let Some(((first, reference), others)) = jobs.split_first() else { return Ok(notes) };
    for (name, own) in others {
        let difference = Difference::between(reference, own);
        let inputs = difference.inputs.iter().filter(|input| !varied.contains(&input.parameter.name));
        let words: Vec<String> = inputs.map(InputDifference::in_words).collect();
        notes.push(if words.is_empty() {
            format!("{first} and {name} have the same inputs apart from the parameters of their grids.")
        } else {
            format!("{first} → {name}: inputs outside of their grids differ: {}.", words.join("; "))
        });
    }
    Ok(notes)
}
