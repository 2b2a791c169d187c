//! One line per job, for other programs: CSV and JSON lines with the same fields.

use super::parameters::is_further;
use super::row::{JobRow, RowState};
use crate::analysis::JobRecord;
use crate::publish::value;
use serde::Serializer;
use serde::ser::SerializeMap;
use serde_json::Value;
use std::io::{self, Write};

/// The fields that every study has. Grid parameters other than ω and μ follow them.
pub const HEADER: [&str; 25] = [
    "study",
    "job",
    "omega_rpm",
    "mu",
    "status",
    "regime",
    "mu_star",
    "mu_star_se",
    "mu_star_contact",
    "frequency_hz",
    "stick_share",
    "slip_share",
    "separated_share",
    "n_over_f_min",
    "n_over_f_max",
    "sigma_n_max_pa",
    "slip_speed_max_m_s",
    "cycles",
    "simulated_s",
    "steps",
    "time_step_s",
    "energy_residual",
    "identity_residual",
    "wall_s",
    "error",
];

/// Number of the fields that come from the record: `regime` to `identity_residual`.
const RECORD_FIELDS: usize = 18;

/// Writes one CSV line per job below a header. A cell without a value is empty.
///
/// # Errors
/// Those of the writer.
pub fn csv<W: Write>(rows: &[JobRow], out: W) -> io::Result<()> {
    let mut export = Export::csv(owned(further_names(rows)), out)?;
    rows.iter().try_for_each(|row| export.write(row))?;
    export.finish()
}

/// Writes one JSON object per job and line, with the fields of [`csv()`]. Empty cells of the CSV are null.
///
/// # Errors
/// Those of the writer.
pub fn json_lines<W: Write>(rows: &[JobRow], out: W) -> io::Result<()> {
    let mut export = Export::json_lines(owned(further_names(rows)), out);
    rows.iter().try_for_each(|row| export.write(row))?;
    export.finish()
}

/// An export that is written row by row, so that the rows of a large study need not be in memory all at once.
pub struct Export<W: Write> {
    further: Vec<String>,
    lines: Lines<W>,
}

enum Lines<W: Write> {
    Csv(Box<::csv::Writer<W>>),
    Json { out: W, names: Vec<String> },
}

impl<W: Write> Export<W> {
    /// CSV, with `further` parameters besides ω and μ; writes the header.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn csv(further: Vec<String>, out: W) -> io::Result<Self> {
        let mut writer = ::csv::Writer::from_writer(out);
        writer.write_record(field_names(&further)).map_err(io_error)?;
        Ok(Self { further, lines: Lines::Csv(Box::new(writer)) })
    }

    /// JSON lines, with `further` parameters besides ω and μ.
    pub fn json_lines(further: Vec<String>, out: W) -> Self {
        let names = field_names(&further);
        Self { further, lines: Lines::Json { out, names } }
    }

    /// Writes a job.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&mut self, row: &JobRow) -> io::Result<()> {
        let fields = fields(row, &self.further);
        match &mut self.lines {
            Lines::Csv(writer) => writer.write_record(fields.iter().map(value::text)).map_err(io_error),
            Lines::Json { out, names } => {
                let mut line = serde_json::Serializer::new(&mut *out);
                let mut map = line.serialize_map(Some(names.len()))?;
                for (name, value) in names.iter().zip(fields) {
                    map.serialize_entry(name, &value)?;
                }
                map.end()?;
                out.write_all(b"\n")
            }
        }
    }

    /// Writes what is still buffered.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn finish(self) -> io::Result<()> {
        match self.lines {
            Lines::Csv(mut writer) => writer.flush(),
            Lines::Json { mut out, .. } => out.flush(),
        }
    }
}

/// The data behind a figure as CSV: for each of the rows its key, ω, μ, the given `columns` of the export, the status,
/// and further parameters.
pub(super) fn selection<'a>(
    rows: impl IntoIterator<Item = &'a JobRow>,
    further: &[&str],
    columns: &[&str],
) -> io::Result<Vec<u8>> {
    let further: Vec<String> = further.iter().map(|&name| name.to_owned()).collect();
    let names = field_names(&further);
    let selected = ["job", "omega_rpm", "mu"].iter().chain(columns).chain(&["status"]);
    let indices: Vec<usize> = selected
        .filter_map(|name| HEADER.iter().position(|own| own == name))
        .chain(HEADER.len()..names.len())
        .collect();
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    writer.write_record(indices.iter().map(|&index| &names[index])).map_err(io_error)?;
    for row in rows {
        let fields = fields(row, &further);
        writer.write_record(indices.iter().map(|&index| value::text(&fields[index]))).map_err(io_error)?;
    }
    writer.into_inner().map_err(|error| io::Error::other(error.to_string()))
}

/// The I/O error behind a CSV error, so that a caller can recognise a closed pipe.
pub(super) fn io_error(error: ::csv::Error) -> io::Error {
    match error.into_kind() {
        ::csv::ErrorKind::Io(source) => source,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// Names of the parameters other than ω and μ, in the order in which they first appear.
pub(super) fn further_names(rows: &[JobRow]) -> Vec<&str> {
    let mut names = Vec::new();
    for row in rows {
        add_further_names(&mut names, &row.parameters);
    }
    names
}

/// Adds to `names` the parameters of a job other than ω and μ, each name once.
pub(crate) fn add_further_names<'a, N>(names: &mut Vec<N>, parameters: &'a [(String, Value)])
where
    N: AsRef<str> + From<&'a str>,
{
    for (name, _) in parameters.iter().filter(|(name, _)| is_further(name)) {
        if !names.iter().any(|known| known.as_ref() == name) {
            names.push(N::from(name));
        }
    }
}

fn owned(names: Vec<&str>) -> Vec<String> {
    names.into_iter().map(str::to_owned).collect()
}

fn field_names(further: &[String]) -> Vec<String> {
    // A parameter may have the name of a result. Then both have a column.
    let unique = |name: &String| {
        if HEADER.contains(&name.as_str()) { format!("parameter_{name}") } else { name.clone() }
    };
    HEADER.iter().map(|&name| name.to_owned()).chain(further.iter().map(unique)).collect()
}

fn fields(row: &JobRow, further: &[String]) -> Vec<Value> {
    let error = match &row.state {
        RowState::Failed { error } => Value::from(error.as_str()),
        _ => Value::Null,
    };
    let mut fields: Vec<Value> = vec![
        row.study.as_str().into(),
        row.job.as_str().into(),
        row.omega_rpm.into(),
        row.mu.into(),
        row.status().into(),
    ];
    fields.extend(row.record().map_or([const { Value::Null }; RECORD_FIELDS], record_fields));
    fields.extend([row.wall_s.into(), error]);
    fields.extend(further.iter().map(|name| row.parameter(name)));
    fields
}

/// A number that is not finite becomes null, because JSON has no such numbers.
fn record_fields(record: &JobRecord) -> [Value; RECORD_FIELDS] {
    [
        record.regime.name().into(),
        record.mu_star.into(),
        record.mu_star_se.into(),
        record.mu_star_contact.into(),
        record.frequency_hz.into(),
        record.stick_share.into(),
        record.slip_share.into(),
        record.separated_share.into(),
        record.n_over_f_min.into(),
        record.n_over_f_max.into(),
        record.sigma_n_max_pa.into(),
        record.slip_speed_max_m_s.into(),
        record.cycles.into(),
        record.simulated_s.into(),
        record.steps.into(),
        record.time_step_s.into(),
        record.energy_residual.into(),
        record.identity_residual().into(),
    ]
}
