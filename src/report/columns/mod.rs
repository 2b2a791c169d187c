//! The columns of the export: name, unit, meaning, and how a column is read from a job. This is the only list of them. The
//! header, the cells, `tribosweep columns`, `tribosweep show` and docs/columns.md come from it.

mod fixed;

pub use fixed::{FURTHER, PLAIN};

use super::parameters::is_further;
use super::row::JobRow;
use serde_json::Value;
use std::borrow::Cow;

/// A column of the export.
#[derive(Debug, Clone)]
pub struct Column {
    /// Its name in the header, unique among the columns of an export.
    pub name: Cow<'static, str>,
    /// The unit of its numbers; empty for text and for numbers without a unit.
    pub unit: Cow<'static, str>,
    /// What its values mean.
    pub meaning: Cow<'static, str>,
    /// What it is about.
    pub group: Group,
    source: Source,
}

/// What a column is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
pub enum Group {
    /// Which job it is.
    #[strum(serialize = "job")]
    Job,
    /// The figures that a sweep is made for.
    #[strum(serialize = "result")]
    Result,
    /// What happens in the contact.
    #[strum(serialize = "contact")]
    Contact,
    /// The two observed nodes.
    #[strum(serialize = "observed nodes")]
    Nodes,
    /// The motion of a holder.
    #[strum(serialize = "holder")]
    Holder,
    /// Energies of the run.
    #[strum(serialize = "energies")]
    Energies,
    /// How long the run was, and the window of its averages.
    #[strum(serialize = "run")]
    Run,
    /// Balances that would close in an exact solution.
    #[strum(serialize = "residuals")]
    Residuals,
    /// Steady sliding and its leading mode.
    #[strum(serialize = "stability")]
    Stability,
    /// The mesh and the contact solves of an elastic disk.
    #[strum(serialize = "elastic disk")]
    Disk,
    /// What the job was given.
    #[strum(serialize = "input")]
    Input,
}

impl Group {
    /// All of them, in the order in which a job is described.
    pub const ALL: [Self; 11] = [
        Self::Job,
        Self::Input,
        Self::Result,
        Self::Stability,
        Self::Contact,
        Self::Nodes,
        Self::Holder,
        Self::Energies,
        Self::Run,
        Self::Residuals,
        Self::Disk,
    ];

    /// Its name in words.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Where the values of a column are.
#[derive(Debug, Clone)]
enum Source {
    /// In the row, or in its record.
    Row(fn(&JobRow) -> Value),
    /// The grid parameter of this name.
    Parameter(String),
    /// The input of this number.
    Input(usize),
}

/// An input of a job, for a column of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputColumn {
    /// Its name.
    pub name: String,
    /// The unit of its numbers; empty for text and for numbers without a unit.
    pub unit: String,
    /// What it means.
    pub meaning: String,
}

impl Column {
    const fn of_row(
        name: &'static str,
        unit: &'static str,
        group: Group,
        meaning: &'static str,
        read: fn(&JobRow) -> Value,
    ) -> Self {
        Self {
            name: Cow::Borrowed(name),
            unit: Cow::Borrowed(unit),
            meaning: Cow::Borrowed(meaning),
            group,
            source: Source::Row(read),
        }
    }

    /// The fixed column of that name, of a job or of its record.
    pub fn find(name: &str) -> Option<&'static Self> {
        PLAIN.iter().chain(&FURTHER).find(|column| column.name == name)
    }

    /// Its value for a job; `inputs` are those of the export's [`InputColumn`]s. Null where the job has no value, and for a
    /// number that is not finite, because JSON has no such numbers.
    pub fn value(&self, row: &JobRow, inputs: &[Value]) -> Value {
        match &self.source {
            Source::Row(read) => read(row),
            Source::Parameter(name) => row.parameter(name),
            Source::Input(index) => inputs.get(*index).cloned().unwrap_or_default(),
        }
    }
}

/// The columns of the plain export: the fixed ones, and one for each of the `grid` parameters other than ω and μ.
pub fn plain(grid: &[String]) -> Vec<Column> {
    with_grid(PLAIN.to_vec(), grid)
}

/// All columns: those of the plain export, the rest of the record, the `inputs`, and `grid` parameters that are not among
/// these.
///
/// An input or a parameter may have the name of a result, which it does not mean: its column is called `parameter_NAME`. ω and
/// μ are plain columns already.
pub fn all(inputs: &[InputColumn], grid: &[String]) -> Vec<Column> {
    let mut columns: Vec<Column> = PLAIN.iter().chain(&FURTHER).cloned().collect();
    for (index, input) in inputs.iter().enumerate().filter(|(_, input)| is_further(&input.name)) {
        columns.push(Column {
            name: unlike_results(&input.name).into(),
            unit: input.unit.clone().into(),
            meaning: input.meaning.clone().into(),
            group: Group::Input,
            source: Source::Input(index),
        });
    }
    let is_new = |name: &&String| !inputs.iter().any(|input| input.name == **name);
    let grid: Vec<String> = grid.iter().filter(is_new).cloned().collect();
    with_grid(columns, &grid)
}

fn with_grid(mut columns: Vec<Column>, grid: &[String]) -> Vec<Column> {
    columns.extend(grid.iter().map(|name| Column {
        name: unlike_results(name).into(),
        unit: Cow::Borrowed(""),
        meaning: Cow::Borrowed("the grid parameter of that name"),
        group: Group::Input,
        source: Source::Parameter(name.clone()),
    }));
    columns
}

/// The column's name of a parameter that may have the name of a result.
fn unlike_results(name: &str) -> String {
    if Column::find(name).is_some() { format!("parameter_{name}") } else { name.to_owned() }
}
