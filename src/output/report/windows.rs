//! The windows of runs whose speed or load changes in time, as a table.

use super::columns::unlike_results;
use super::layout::parameters_in_words;
use super::parameters::parameter_names;
use super::row::JobRow;
use crate::analysis::program::ProgramWindow;
use crate::publish::table::{Column, FileColumns, Format, Head, Table, TableWriter};
use std::io::{self, Write};

/// A window of a job.
#[derive(Clone, Copy)]
struct Subject<'a> {
    row: &'a JobRow,
    window: &'a ProgramWindow,
}

/// The columns, whatever a study varies.
#[rustfmt::skip]
fn fixed<'a>() -> Vec<Column<Subject<'a>>> {
    vec![
        Column::new("study", "", "name of the study", |of| of.row.study.as_str().into()),
        Column::new("job", "", "key of the job", |of| of.row.job.as_str().into()),
        Column::new("parameters", "", "the job in words", |of| parameters_in_words(of.row).into()),
        Column::new("start_s", "s", "beginning of the window", |of| of.window.time_s[0].into()),
        Column::new("end_s", "s", "its end", |of| of.window.time_s[1].into()),
        Column::new("direction", "", "where the program goes in it: start, hold, up, down or turn", |of| of.window.direction.name().into()),
        Column::new("omega_rpm", "rpm", "mean rotation speed ω in it", |of| of.window.omega_rpm.into()),
        Column::new("load_n", "N", "mean load F in it", |of| of.window.load_n.into()),
        Column::new("mu_star", "", "macroscopic friction coefficient μ* in it", |of| of.window.mu_star.into()),
        Column::new("mu_star_contact", "", "the same from the contact forces", |of| of.window.mu_star_contact.into()),
        Column::new("frequency_hz", "Hz", "rate of the cycles of N in it; empty if N hardly varies", |of| of.window.frequency_hz.into()),
        Column::new("n_amplitude", "", "half of the range of N over F", |of| of.window.n_amplitude.into()),
        Column::new("y_peak_to_peak_m", "m", "range of the displacement in y of the trailing edge's centre", |of| of.window.y_peak_to_peak_m.into()),
        Column::new("stick_share", "", "share of the node-time in stick", |of| of.window.stick_share.into()),
        Column::new("slip_share", "", "share of the node-time in slip", |of| of.window.slip_share.into()),
        Column::new("separated_share", "", "share of the node-time separated", |of| of.window.separated_share.into()),
        Column::new("mu", "", "local friction coefficient μ of the job", |of| of.row.parameters.mu().into()),
    ]
}

/// The columns of jobs with these parameters. A parameter that the window has, such as the load, is in it.
fn columns<'a, N: AsRef<str>>(parameters: &[N]) -> Vec<Column<Subject<'a>>> {
    let fixed = fixed();
    let own: Vec<&str> = fixed.iter().map(|column| &*column.head.name).collect();
    let is_new = |name: &&N| !own.contains(&name.as_ref());
    let of_parameter = |name: &N| {
        let name = name.as_ref().to_owned();
        let head = Head::new(unlike_results(&name), "", "the grid parameter of that name");
        Column::made(head, move |of: &Subject| of.row.parameter(&name))
    };
    let further: Vec<_> = parameters.iter().filter(is_new).map(of_parameter).collect();
    fixed.into_iter().chain(further).collect()
}

fn of_row(row: &JobRow) -> impl Iterator<Item = Subject<'_>> {
    let windows = row.record().map_or(&[][..], |record| &record.windows);
    windows.iter().map(move |window| Subject { row, window })
}

/// A line for each window of each job.
pub(super) fn table(rows: &[JobRow]) -> Table {
    let subjects: Vec<Subject> = rows.iter().flat_map(of_row).collect();
    let parameters = parameter_names(subjects.iter().map(|of| &of.row.parameters));
    Table::of("windows", &columns(&parameters), &subjects)
}

/// The columns, for the page of columns.
pub(super) fn described() -> FileColumns {
    FileColumns::new(
        &["windows.csv"],
        "A line is a window of a job whose speed or load changes in time.",
        &fixed(),
    )
}

/// All windows as CSV, job by job.
pub struct Windows<W: Write> {
    parameters: Vec<String>,
    lines: TableWriter<W>,
}

impl<W: Write> Windows<W> {
    /// Writes the header for jobs with these parameters.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn new(parameters: &[String], out: W) -> io::Result<Self> {
        let heads: Vec<Head> = columns(parameters).into_iter().map(|column| column.head).collect();
        Ok(Self { parameters: parameters.to_vec(), lines: TableWriter::new(Format::Csv, &heads, out)? })
    }

    /// Writes the windows of a job.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&mut self, row: &JobRow) -> io::Result<()> {
        if row.record().is_none_or(|record| record.windows.is_empty()) {
            return Ok(());
        }
        let columns = columns(&self.parameters);
        of_row(row).try_for_each(|of| self.lines.line(columns.iter().map(|column| column.value(&of))))
    }

    /// Writes what is still buffered.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn finish(self) -> io::Result<()> {
        self.lines.finish()?.flush()
    }
}
