//! The columns of the export: name, group, meaning, how figures and tables show a column, and how it is read from a job. This is the only
//! list of them. The header, the cells, titles of axes, digits, `tribosweep columns`, `tribosweep show` and docs/reference.md come from it.

mod fixed;
mod shown;

pub use fixed::{FURTHER, PLAIN};
pub(super) use shown::{Digits, Last, Shown};

use super::row::{JobRow, RowState};
use crate::publish::table::{Column, Head};
use crate::units::name_and_unit;
use serde_json::Value;
use std::borrow::Cow;

/// A column of the export.
#[derive(Debug, Clone)]
pub struct ExportColumn {
    /// What it is about.
    pub group: Group,
    /// Its name, unique among the columns of an export, with its values.
    pub column: Column<JobRow>,
    /// How figures and tables show it, if it is a number of a run.
    pub(super) shown: Option<Shown>,
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

/// A number of a run.
const fn quantity(
    name: &'static str,
    group: Group,
    shown: Shown,
    meaning: &'static str,
    read: fn(&JobRow) -> Value,
) -> ExportColumn {
    let column = Column::new(name, name_and_unit(name).1, meaning, read);
    ExportColumn { group, column, shown: Some(shown) }
}

/// What is no number of a run: words, an input, or what only some runs have that are not periodic.
const fn detail(
    name: &'static str,
    group: Group,
    meaning: &'static str,
    read: fn(&JobRow) -> Value,
) -> ExportColumn {
    let column = Column::new(name, name_and_unit(name).1, meaning, read);
    ExportColumn { group, column, shown: None }
}

/// The fixed columns of these names, for a list in the program. One that does not exist is an error of the compiler, where the list is a
/// `const` or a `static`.
///
/// # Panics
/// If there is no such column.
pub const fn columns<const N: usize>(names: [&str; N]) -> [&'static ExportColumn; N] {
    let mut found = [&PLAIN[0]; N];
    let mut number = 0;
    while number < N {
        found[number] = column(names[number]);
        number += 1;
    }
    found
}

/// As [`columns`], for one name.
///
/// # Panics
/// If there is no such column.
pub const fn column(name: &str) -> &'static ExportColumn {
    let mut number = 0;
    while number < PLAIN.len() + FURTHER.len() {
        let own = if number < PLAIN.len() { &PLAIN[number] } else { &FURTHER[number - PLAIN.len()] };
        if let Cow::Borrowed(known) = own.column.head.name
            && is_same(known.as_bytes(), name.as_bytes())
        {
            return own;
        }
        number += 1;
    }
    panic!("the export has no column of that name")
}

/// Constants cannot compare texts otherwise.
const fn is_same(a: &[u8], b: &[u8]) -> bool {
    match (a, b) {
        ([], []) => true,
        ([a, rest_of_a @ ..], [b, rest_of_b @ ..]) => *a == *b && is_same(rest_of_a, rest_of_b),
        _ => false,
    }
}

/// The fixed columns, of a job or of its record.
pub fn fixed() -> impl Iterator<Item = &'static ExportColumn> {
    PLAIN.iter().chain(FURTHER)
}

impl ExportColumn {
    /// The fixed column of that name, of a job or of its record.
    pub fn find(name: &str) -> Option<&'static Self> {
        fixed().find(|own| own.column.head.name == name)
    }

    /// Its value for a job or for a measured point, which has what its file gives.
    pub fn value(&self, row: &JobRow) -> Value {
        match &row.state {
            RowState::Measured(point) if !matches!(self.group, Group::Job | Group::Input) => {
                match self.error_of() {
                    Some(name) => point.value(name).and_then(|own| own.error).into(),
                    None => point.value(&self.column.head.name).map(|own| own.value).into(),
                }
            }
            _ => self.column.value(row),
        }
    }

    /// Its symbol; empty without one.
    pub fn symbol(&self) -> &'static str {
        self.shown.map_or("", |shown| shown.symbol)
    }

    /// The name of the quantity whose statistical error it is; none if it is no such error.
    pub fn error_of(&self) -> Option<&'static str> {
        self.shown.map(|shown| shown.error_of).filter(|name| !name.is_empty())
    }

    /// As a column of a table that may have measured points.
    pub(super) fn into_column(self) -> Column<JobRow> {
        Column::made(self.column.head.clone(), move |row| self.value(row))
    }

    fn of_input(head: Head, read: impl Fn(&JobRow) -> Value + Send + Sync + 'static) -> Self {
        Self { group: Group::Input, column: Column::made(head, read), shown: None }
    }
}

/// The columns of the plain export: the fixed ones, and one for each of the `parameters` that is not among these.
pub fn plain<N: AsRef<str>>(parameters: &[N]) -> Vec<ExportColumn> {
    PLAIN.iter().cloned().chain(of_parameters(parameters)).collect()
}

/// All columns: those of the plain export, the rest of the record, the `inputs`, and `parameters` that are not among these.
///
/// An input or a parameter may have the name of a result, which it does not mean: its column is called `parameter_NAME`.
pub fn all(inputs: &[Head], parameters: &[String]) -> Vec<ExportColumn> {
    let of_input = |(index, input): (usize, &Head)| {
        let head = Head { name: unlike_results(&input.name).into(), ..input.clone() };
        ExportColumn::of_input(head, move |row| row.inputs.get(index).cloned().unwrap_or_default())
    };
    let inputs_left = inputs.iter().enumerate().filter(|(_, input)| !is_of_job(&input.name));
    let is_new = |name: &&String| !inputs.iter().any(|input| input.name == **name);
    fixed()
        .cloned()
        .chain(inputs_left.map(of_input))
        .chain(of_parameters(parameters.iter().filter(is_new)))
        .collect()
}

/// The head that stands for columns of quantities on the page of columns.
pub(super) fn any_quantity() -> Head {
    Head::new("QUANTITY", "", "the quantity, a column of the export")
}

/// What comes first and last in the data behind a figure.
static FIRST: [&ExportColumn; 3] = columns(["job", "omega_rpm", "mu"]);
static LAST: &ExportColumn = column("status");

/// The columns of the data behind a figure that shows these: a job's key, ω and μ come first, and its status last.
pub(super) fn selected(columns: &[&'static ExportColumn]) -> impl Iterator<Item = &'static ExportColumn> {
    FIRST.into_iter().chain(columns.iter().copied()).chain([LAST])
}

/// Whether a fixed column says it of every job. ω and μ are such parameters.
fn is_of_job(name: &str) -> bool {
    ExportColumn::find(name).is_some_and(|own| own.group == Group::Job)
}

/// Columns of the parameters that have no fixed column.
pub(super) fn of_parameters<'a, N: AsRef<str> + 'a>(
    names: impl IntoIterator<Item = &'a N>,
) -> impl Iterator<Item = ExportColumn> {
    names.into_iter().map(AsRef::as_ref).filter(|name| !is_of_job(name)).map(|name| {
        let name = name.to_owned();
        let head = Head::new(unlike_results(&name), "", "the grid parameter of that name");
        ExportColumn::of_input(head, move |row| row.parameter(&name))
    })
}

/// The column's name of a parameter that may have the name of a result.
pub(super) fn unlike_results(name: &str) -> String {
    if ExportColumn::find(name).is_some() { format!("parameter_{name}") } else { name.to_owned() }
}
