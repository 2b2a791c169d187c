//! One job of a study, selected by `name=value` overrides.

use super::axis::Axis;
use super::change::Forms;
use super::definition::Study;
use super::error::{Problem, StudyError};
use super::grid::Grid;
use super::growth::Growth;
use super::json;
use super::outline::Outline;
use super::parameter::Parameter;
use super::preset::Preset;
use crate::spec::JobSpec;
use serde_json::Value;

/// Stands for the file in messages about overrides.
const SOURCE: &str = "--set";

/// Largest number of values that a message lists in full.
const MAX_LISTED: usize = 6;

/// The first values of a longer list that a message names; it names the last one, too.
const LISTED_OF_MORE: usize = 3;

/// One job of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct SingleJob {
    /// The job.
    pub spec: JobSpec,
    /// The parameters of the grid and those that were overridden, each once, with their values in this job. A parameter
    /// of the grid that nobody gives a value here, such as a preset, is left out.
    pub parameters: Vec<(String, Value)>,
    /// Names of the parameters of the grid that have the base job's value.
    pub left_open: Vec<&'static str>,
}

impl Study {
    /// The job with `overrides` (name, value) on top of the base job and the grid.
    ///
    /// Every parameter of the grid must be overridden or have a single value; other parameters may
    /// be overridden too. A value is read as JSON, or else as a string; `12x15x10` is a list of counts.
    ///
    /// # Errors
    /// Unknown, repeated or overlapping names, values of the wrong type, parameters of the grid that
    /// are left open, and violations of [`JobSpec::check`].
    pub fn single(&self, overrides: &[(String, String)]) -> Result<JobSpec, StudyError> {
        self.single_with_preset(None, overrides)
    }

    /// [`Study::single`] with the settings of a `preset`. The preset takes precedence over the file and the grid, and the
    /// overrides over the preset.
    ///
    /// # Errors
    /// Those of [`Study::single`].
    pub fn single_with_preset(
        &self,
        preset: Option<Preset>,
        overrides: &[(String, String)],
    ) -> Result<JobSpec, StudyError> {
        let (found, left_open) = self.select(SOURCE, preset, overrides);
        if left_open.is_empty() {
            return found.map(|mut study| study.specs.swap_remove(0));
        }
        let mut problems = match found {
            Err(StudyError::Invalid(problems)) => problems,
            _ => Vec::new(),
        };
        // A parameter whose value is refused is not open, and its problem is said.
        let is_given = |axis: &&Axis| overrides.iter().any(|(name, _)| name == axis.parameter.name);
        problems.extend(left_open.iter().filter(|axis| !is_given(axis)).map(|axis| self.left_open(axis)));
        Err(StudyError::Invalid(problems))
    }

    /// As [`Study::single_with_preset`], but parameters of the grid that are left open have the base job's value. `source`
    /// stands for the origin of the overrides in messages.
    ///
    /// # Errors
    /// Those of [`Study::single`] except for open parameters.
    pub fn single_on_base(
        &self,
        source: &str,
        preset: Option<Preset>,
        overrides: &[(String, String)],
    ) -> Result<SingleJob, StudyError> {
        let (found, left_open) = self.select(source, preset, overrides);
        let single = found?;
        let job = json::encode(&single.specs[0]);
        let at_point = single.grid.parameters_at(0);
        let in_grid = self.grid.parameters();
        let named = overrides.iter().filter_map(|(name, _)| Parameter::find(name));
        let mut parameters: Vec<(String, Value)> = Vec::new();
        for parameter in in_grid.chain(named) {
            // A job has no preset and no damping.
            let on_axis = || Some(&at_point.iter().find(|(name, _)| name == parameter.name)?.1);
            let value = job.pointer(parameter.pointer).or_else(on_axis);
            if let Some(value) = value.or_else(|| single.document.pointer(parameter.pointer))
                && !parameters.iter().any(|(known, _)| known == parameter.name)
            {
                parameters.push((parameter.name.to_owned(), value.clone()));
            }
        }
        let left_open = left_open.into_iter().map(|axis| axis.parameter.name).collect();
        Ok(SingleJob { spec: single.specs[0].clone(), parameters, left_open })
    }

    /// The study of the one job with these overrides, and the axes of the grid that they leave open. In these the job has
    /// the base job's value.
    fn select(
        &self,
        source: &str,
        preset: Option<Preset>,
        overrides: &[(String, String)],
    ) -> (Result<Self, StudyError>, Vec<Axis>) {
        let (document, grid, source_text) = (self.document.clone(), self.grid.clone(), self.source.clone());
        let (allows_modes, is_new) = (self.allows_modes, self.is_new);
        let mut outline = Outline { document, grid, source: source_text, allows_modes, is_new };
        let problems = outline.set(source, preset, overrides, Forms::Single);
        let of_samples = outline.grid.samples.iter().flat_map(|samples| {
            samples
                .parameters
                .iter()
                .enumerate()
                .map(|(at, parameter)| Axis::of_values(parameter, samples.values(at)))
        });
        let axes: Vec<Axis> = of_samples.chain(outline.grid.axes.iter().cloned()).collect();
        let (fixed, left_open) = axes.into_iter().partition(|axis| axis.values.len() == 1);
        // One job is not a part of the study's points, and no condition keeps it out.
        outline.grid = Grid::of_axes(fixed);
        let single = if problems.is_empty() {
            Self::of(outline, self.report.clone(), Growth::default())
        } else {
            Err(StudyError::Invalid(problems))
        };
        (single, left_open)
    }

    fn left_open(&self, axis: &Axis) -> Problem {
        let mut values: Vec<_> = axis.values.iter().map(Value::to_string).collect();
        let mut message = "expected one value for a single job".to_owned();
        if values.len() > MAX_LISTED {
            message = format!("{message}, of {}", values.len());
            values.splice(LISTED_OF_MORE..values.len() - 1, ["…".to_owned()]);
        }
        let name = axis.parameter.name;
        let problem = self.source.problem(&axis.path(), message);
        Problem { value: Some(format!("[{}]", values.join(", "))), ..problem }
            .with_help(format!("pick one with --set {name}={}", values[0].trim_matches('"')))
    }
}
