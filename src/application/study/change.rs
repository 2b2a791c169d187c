//! Changes of a study by the command line: `--preset`, `--set`, `--basins`, `--free` and `--name`.

use super::axis::{Axis, check_type};
use super::calibrate::Calibration;
use super::derive::DERIVE;
use super::error::Problem;
use super::file::StudyFile;
use super::outline::Outline;
use super::parameter::{Kind, Parameter, unknown_help};
use super::preset::Preset;
use super::source::Change;
use super::with_unit;
use serde_json::Value;

/// What a command changes of a study before its jobs are made.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Changes {
    /// The study's name; without it a `preset` appends its own name to that of the study.
    pub name: Option<String>,
    /// A preset that takes precedence over the file and the grid.
    pub preset: Option<Preset>,
    /// Names of parameters with values as text. A value takes precedence over the preset, the file and the grid; a list or
    /// a range of values becomes an axis of the grid.
    pub settings: Vec<(String, String)>,
    /// Whether the jobs compute complex modes without a run. The study is then called `NAME-stability`.
    pub is_of_modes: bool,
    /// Random velocities from each point of the study, instead of what it says about further jobs. Without a `name`, the study is then
    /// called `NAME-basins`.
    pub basins: Option<Basins>,
    /// Measured points that rule out values of free parameters, instead of what the study says about further jobs. Without a `name`, the
    /// study is then called `NAME-calibration`.
    pub calibration: Option<Calibration>,
}

/// Random velocities to find the limit cycles that can be reached from a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Basins {
    /// How many jobs continue each point.
    pub kicks: u32,
    /// Root mean square of the velocities \[m/s\].
    pub kick_m_s: f64,
}

/// What values may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Forms {
    /// One value each.
    Single,
    /// One value, or the values of an axis.
    AxesToo,
}

/// A setting whose name and type have been checked.
struct Setting {
    parameter: &'static Parameter,
    place: String,
    text: String,
    value: Value,
    is_axis: bool,
}

impl Outline {
    /// Sets a preset, and then parameters (name, value as text), above everything that the study itself gives. `place`
    /// stands for the file in messages about the parameters. Returns what is wrong; then the outline is of no use.
    pub(super) fn set(
        &mut self,
        place: &str,
        preset: Option<Preset>,
        settings: &[(String, String)],
        forms: Forms,
    ) -> Vec<Problem> {
        let preset = preset.map(|preset| ("--preset", "preset", preset.name()));
        let settings = settings.iter().map(|(name, text)| (place, name.as_str(), text.as_str()));
        let template = StudyFile::template();
        let mut problems = Vec::new();
        let mut accepted: Vec<Setting> = Vec::new();
        let mut named: Vec<&Parameter> = Vec::new();
        for (place, name, text) in preset.into_iter().chain(settings) {
            let problem = |message: String| Problem::of_change(place, name, text, message);
            let Some(parameter) = Parameter::find(name) else {
                let help = match (name, forms) {
                    ("name", Forms::AxesToo) => vec![format!("use --name {text}")],
                    ("name", Forms::Single) => vec!["one job has no name, and nothing is stored".to_owned()],
                    _ => unknown_help(name),
                };
                problems.push(Problem { help, ..problem("no such parameter".into()) });
                continue;
            };
            if let Some(other) = named.iter().find(|other| other.overlaps(parameter)) {
                let message = format!("{} is already set; expected only one of the two", other.name);
                problems.push(problem(message));
            }
            named.push(parameter);
            let mut value = parse_value(parameter, text);
            if let Err(message) = with_unit::in_setting(&mut value, parameter.unit) {
                problems.push(problem(message).with_help(parameter.help()));
                continue;
            }
            let is_axis = forms == Forms::AxesToo && is_axis(parameter, &value);
            let value = if is_axis { value } else { parameter.normalise(value) };
            match if is_axis { Ok(()) } else { check_type(parameter, &value, &template) } {
                Ok(()) => accepted.push(Setting {
                    parameter,
                    place: place.to_owned(),
                    text: text.to_owned(),
                    value,
                    is_axis,
                }),
                Err(message) => {
                    let problem = problem(message).with_help(parameter.help());
                    problems.push(parameter.with_hint(problem, &value));
                }
            }
        }
        for setting in &accepted {
            self.source.changes.push(Change::of_parameter(setting.parameter, &setting.place, &setting.text));
            self.untie(setting.parameter);
            setting.parameter.displaces().for_each(|other| self.forget(other));
        }
        for setting in &accepted {
            problems.extend(self.apply(setting, forms, &template));
        }
        problems
    }

    /// Removes the tie of a parameter.
    fn untie(&mut self, parameter: &Parameter) {
        let Some(study) = self.document.as_object_mut() else { return };
        let Some(Value::Object(ties)) = study.get_mut(DERIVE) else { return };
        ties.retain(|name, _| Parameter::find(name).is_none_or(|own| !own.overlaps(parameter)));
        if ties.is_empty() {
            study.remove(DERIVE);
        }
    }

    /// Removes what the study says about a parameter.
    fn forget(&mut self, parameter: &Parameter) {
        self.untie(parameter);
        self.grid.axes.retain(|axis| !axis.parameter.overlaps(parameter));
        self.grid.samples =
            self.grid.samples.take().and_then(|samples| samples.without(|own| own.overlaps(parameter)));
        let (parent, name) = parameter.pointer.rsplit_once('/').unwrap_or_default();
        if let Some(Value::Object(fields)) = self.document.pointer_mut(parent) {
            fields.remove(name);
            // Without any field it would be a damping or an accuracy that says nothing.
            if fields.is_empty()
                && let Some(part @ ("damping" | "accuracy")) = parent.strip_prefix('/')
            {
                self.document.as_object_mut().map(|study| study.remove(part));
            }
        }
    }

    fn apply(&mut self, setting: &Setting, forms: Forms, template: &Value) -> Vec<Problem> {
        let Setting { parameter, value, .. } = setting;
        if parameter.name == "omega_rpm"
            && let Some(study) = self.document.as_object_mut()
        {
            // It says the same, and is no parameter itself.
            study.remove("sliding_speed_m_s");
        }
        // An axis of whole meshes with a single mesh is that mesh, of which a part is set now.
        while let Some(place) = self.grid.axes.iter().position(|axis| {
            axis.values.len() == 1
                && axis.parameter.overlaps(parameter)
                && !parameter.sets(&axis.parameter.field())
        }) {
            let axis = self.grid.axes.remove(place);
            axis.parameter.set(&mut self.document, &axis.values[0]);
        }
        let place = self.grid.axes.iter().position(|axis| axis.parameter == *parameter);
        let place = place.unwrap_or(self.grid.axes.len());
        self.grid.axes.retain(|axis| !parameter.sets(&axis.parameter.field()));
        self.grid.samples =
            self.grid.samples.take().and_then(|samples| samples.without(|own| parameter.sets(&own.field())));
        let place = place.min(self.grid.axes.len());
        if forms == Forms::AxesToo
            && let Some(axis) = self.grid.axes.iter().find(|axis| axis.parameter.overlaps(parameter))
        {
            let message =
                format!("grid.{0} varies the same field; expected {0} instead", axis.parameter.name);
            return vec![Problem::of_change(&setting.place, parameter.name, &setting.text, message)];
        }
        let of_samples = self.grid.samples.iter().flat_map(|samples| &samples.parameters);
        if let Some(other) = of_samples.into_iter().find(|other| other.overlaps(parameter)) {
            let message = format!("samples vary the same field; expected {0} instead", other.name);
            return vec![Problem::of_change(&setting.place, parameter.name, &setting.text, message)];
        }
        let list_is_absent = || {
            let (list, _) = parameter.pointer.rsplit_once('/').unwrap_or_default();
            parameter.is_entry() && self.document.pointer(list).is_none()
        };
        if setting.is_axis {
            return self.insert_axis(place, parameter, value, template);
        }
        if list_is_absent() {
            // A file cannot give one entry of a list without the others, which a preset may set.
            return self.insert_axis(place, parameter, &Value::from(vec![value.clone()]), template);
        }
        parameter.set(&mut self.document, value);
        Vec::new()
    }

    fn insert_axis(
        &mut self,
        place: usize,
        parameter: &'static Parameter,
        given: &Value,
        template: &Value,
    ) -> Vec<Problem> {
        match Axis::read(parameter, given, template, &self.source) {
            Ok(axis) => {
                self.grid.axes.insert(place, axis);
                Vec::new()
            }
            Err(problems) => problems,
        }
    }
}

/// Whether a value stands for the values of an axis.
fn is_axis(parameter: &Parameter, value: &Value) -> bool {
    match (value, parameter.kind) {
        (Value::Array(list), Kind::Counts) => list.first().is_none_or(Value::is_array),
        (value, _) => value.is_array() || value.is_object(),
    }
}

impl Parameter {
    /// A number of this parameter as a user writes it: with another unit of the same kind, or in that of the name.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn number(&self, text: &str) -> Result<f64, String> {
        let mut value = parse_value(self, text);
        with_unit::in_setting(&mut value, self.unit)?;
        value.as_f64().ok_or_else(|| format!("{text}: expected a number"))
    }
}

/// Reads the text of a value: counts as `12x15x10`, then JSON, otherwise a string.
fn parse_value(parameter: &Parameter, text: &str) -> Value {
    if matches!(parameter.kind, Kind::Counts) {
        let counts: Result<Vec<u64>, _> = text.split(['x', '×']).map(|n| n.trim().parse()).collect();
        if let Ok(counts) = counts {
            return Value::from(counts);
        }
    }
    serde_json::from_str(text).unwrap_or_else(|_| Value::from(text))
}
