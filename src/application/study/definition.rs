//! A study that has been read and checked.

use super::document;
use super::draft::Draft;
use super::error::Problem;
use super::grid::Grid;
use super::growth::Growth;
use super::parameter::Parameter;
use super::range::Spacing;
use super::report_axes::ReportAxes;
use super::source::SourceText;
use crate::spec::JobSpec;
use serde_json::Value;

/// A study that has been read and checked: every job of its grid is physical.
#[derive(Debug, Clone)]
pub struct Study {
    pub(super) name: String,
    pub(super) description: Option<String>,
    pub(super) base: JobSpec,
    /// What the file says, with the changes of the command line.
    pub(super) document: Value,
    pub(super) grid: Grid,
    /// The job of every grid point, made once for the check and for the expansion.
    pub(super) specs: Vec<JobSpec>,
    pub(super) report: ReportAxes,
    pub(super) growth: Growth,
    pub(super) source: SourceText,
    pub(super) allows_modes: bool,
    pub(super) is_new: bool,
}

impl Study {
    /// The study's name: `[A-Za-z0-9_-]+`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the study is for, in its author's words.
    pub fn description(&self) -> Option<&str> {
        self.description.as_deref()
    }

    /// The text of the study file, or of one that says the same as the file with the changes of [`Study::parse_changed`].
    pub fn document(&self) -> String {
        document::text(&self.document, &self.grid, &self.source)
    }

    /// The draft of the job without the values of the grid.
    pub(super) fn draft(&self) -> Draft {
        Draft::of(&self.document)
    }

    /// The job without the values of the grid.
    pub fn base(&self) -> &JobSpec {
        &self.base
    }

    /// The parameters of `samples.zip`, whose values move together; none for other samples.
    pub fn zipped(&self) -> &[&'static Parameter] {
        match &self.grid.samples {
            Some(samples) if samples.written().get("zip").is_some() => &samples.parameters,
            _ => &[],
        }
    }

    /// The grid's parameters and their values, in the order of the file.
    pub fn axes(&self) -> impl Iterator<Item = (&'static Parameter, &[Value])> {
        self.grid.axes.iter().map(|axis| (axis.parameter, axis.values.as_slice()))
    }

    /// All parameters that the study varies: those of its samples, then those of its grid.
    pub fn varied(&self) -> impl Iterator<Item = &'static Parameter> {
        self.grid.parameters()
    }

    /// Number of its samples; none without `samples`.
    pub fn samples(&self) -> Option<usize> {
        self.grid.samples.as_ref().map(|samples| samples.rows.len())
    }

    /// Whether its points are a Morris design, and no product of one with a grid.
    pub fn is_morris(&self) -> bool {
        let design = self.document.pointer("/samples/design").and_then(Value::as_str);
        design == Some("morris") && self.grid.axes.iter().all(|axis| axis.values.len() == 1)
    }

    /// Axes and quantities of the report.
    pub fn report(&self) -> &ReportAxes {
        &self.report
    }

    /// How the values of a parameter are spaced, as the file gives them: by a range or by a distribution. Returns `None` for a list
    /// of values, and for a parameter that does not vary.
    pub fn spacing(&self, parameter: &str) -> Option<Spacing> {
        let range = self.document.get("grid").and_then(|grid| grid.get(parameter));
        let of_range = |range: &serde_json::Map<String, Value>| match range.get("spacing") {
            Some(spacing) if spacing == "log" => Spacing::Log,
            _ => Spacing::Linear,
        };
        let of_design = |of: &serde_json::Map<String, Value>| {
            let name = of.keys().next()?.as_str();
            match name {
                "log_uniform" => Some(Spacing::Log),
                "uniform" | "normal" | "truncated_normal" => Some(Spacing::Linear),
                _ => None,
            }
        };
        let design = self.document.pointer("/samples/of").and_then(|of| of.get(parameter));
        let design = design.and_then(Value::as_object).and_then(of_design);
        range.and_then(Value::as_object).map(of_range).or(design)
    }

    /// A problem with the value of a field such as `report.y[0]`, at its place in the file, with lines of advice.
    pub fn problem(&self, field: &str, message: &str, help: Vec<String>) -> Problem {
        Problem { help, ..self.source.problem(field, message) }
    }

    /// Number of grid points; 1 without a grid.
    ///
    /// [`Study::expand`] may return fewer jobs, because it returns equal jobs only once.
    pub fn grid_size(&self) -> usize {
        self.grid.size()
    }
}
