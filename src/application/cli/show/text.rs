//! A job as text: the only printer of a record in words for a terminal.

use super::parsed;
use crate::analysis::{AboveBand, ComplexMode, SlidingStability};
use crate::publish::table::{Column, Table, listed};
use crate::publish::value::{self, MISSING};
use crate::report::columns::{ExportColumn, Group, columns, fixed};
use crate::report::{JobRow, assignment};
use crate::spec::JobSpec;
use crate::study::{Input, inputs};
use crate::sweep::{StoredJob, StudyOfJob};
use serde_json::Value;

/// Significant digits of a result. Inputs have all of theirs.
const DIGITS: usize = 6;

/// The parts of a job's inputs, with their headings.
const PARTS: [(&str, &str); 6] = [
    ("scene", "Inputs: scene"),
    ("numerics", "Inputs: numerics"),
    ("run", "Inputs: run"),
    ("detection", "Inputs: detection"),
    ("stability", "Inputs: stability"),
    ("accuracy", "Inputs: accuracy"),
];

/// The columns that the head or the provenance of the text has.
static ELSEWHERE: [&ExportColumn; 6] = columns(["study", "job", "omega_rpm", "mu", "status", "wall_s"]);

/// Everything about a job of a database, for a terminal of `width` characters or for a file.
pub(super) fn of_job(job: &StoredJob, width: Option<usize>) -> String {
    let found = job.spec().and_then(|spec| Ok((spec, job.row()?)));
    let body = match &found {
        Ok((spec, row)) => of_inputs(spec, width) + &of_result(row, &Group::ALL, width),
        Err(error) => section("Inputs and result", &[[error.to_string()]], width),
    };
    let row = found.as_ref().ok().map(|(_, row)| row);
    listed(0, &head(job, row), width) + &body + &section("Provenance", &provenance(job), width)
}

/// Everything about a job that was solved and is in no database.
pub(crate) fn of_solved(spec: &JobSpec, row: &JobRow, width: Option<usize>) -> String {
    let head = [["job".to_owned(), row.job.clone()], ["state".to_owned(), format!("done: {}", row.status())]];
    listed(0, &head, width) + &of_inputs(spec, width) + &of_result(row, &Group::ALL, width)
}

/// Lines below a heading; nothing without lines.
fn section<L: AsRef<[String]>>(heading: &str, lines: &[L], width: Option<usize>) -> String {
    if lines.is_empty() { String::new() } else { format!("\n{heading}\n{}", listed(2, lines, width)) }
}

fn of_inputs(spec: &JobSpec, width: Option<usize>) -> String {
    let inputs = inputs(spec);
    let of_part = |(part, heading): (&str, &str)| {
        let own = inputs.iter().filter(|input| input.parameter.part() == Some(part));
        section(heading, &own.map(input_cells).collect::<Vec<_>>(), width)
    };
    PARTS.map(of_part).concat()
}

/// The record in these groups, or why it cannot be read; nothing of a job that has not ended.
pub(crate) fn of_result(row: &JobRow, groups: &[Group], width: Option<usize>) -> String {
    let Some(record) = row.record() else {
        return row
            .unreadable()
            .map_or_else(String::new, |reason| section("Result", &[[reason.to_owned()]], width));
    };
    let of_group = |group: &Group| section(heading(*group), &figures(row, *group), width);
    let modes = record.stability.as_ref().filter(|_| groups.contains(&Group::Stability)).map(modes);
    groups.iter().map(of_group).collect::<String>() + &modes.unwrap_or_default()
}

/// The heading of a group of figures.
fn heading(group: Group) -> &'static str {
    match group {
        Group::Job => "Job",
        Group::Input => "Inputs",
        Group::Result => "Result",
        Group::Stability => "Steady sliding",
        Group::Contact => "Contact, over the window",
        Group::Nodes => "Observed nodes, over the window",
        Group::Holder => "Holder, over the window",
        Group::Energies => "Energies, with their shares of the work of load and drive",
        Group::Run => "Run",
        Group::Residuals => "Residuals",
        Group::Disk => "Elastic disk",
    }
}

fn head(job: &StoredJob, row: Option<&JobRow>) -> Vec<[String; 2]> {
    let details = &job.details;
    let line = |name: &str, text: String| [name.to_owned(), text];
    let outcome = row.filter(|row| row.record().is_some() || row.unreadable().is_some()).map(JobRow::status);
    let state = details.state.as_str();
    let mut lines = vec![
        line("job", details.key.clone()),
        line("state", outcome.map_or_else(|| state.to_owned(), |outcome| format!("{state}: {outcome}"))),
    ];
    lines.extend(details.error.iter().map(|error| line("error", error.clone())));
    lines.extend(details.note.iter().map(|note| line("note", note.clone())));
    for StudyOfJob { study, parameters } in &job.studies {
        let point: Vec<String> = parameters.iter().map(|(name, value)| assignment(name, value)).collect();
        let point = if point.is_empty() { String::new() } else { format!(": {}", point.join(", ")) };
        lines.push(line("study", format!("{}{point}", study.name)));
    }
    if job.studies.is_empty() {
        lines.push(line("study", "none: `gc` deletes this job".to_owned()));
    }
    lines
}

/// An input with its value as people write it.
fn input_cells(Input { parameter, value }: &Input) -> [String; 3] {
    [parameter.column().to_owned(), written(value, parameter.unit, None), parameter.meaning.to_owned()]
}

/// The figures of a group that the record has.
fn figures(row: &JobRow, group: Group) -> Vec<[String; 3]> {
    let is_elsewhere = |own: &ExportColumn| ELSEWHERE.iter().any(|other| std::ptr::eq(own, *other));
    let shown = fixed().filter(|own| own.group == group && !is_elsewhere(own));
    let cells = shown.map(|column| (column, column.value(row))).filter(|(_, value)| !value.is_null());
    let line = |(column, value): (&ExportColumn, Value)| {
        let head = &column.column.head;
        let share = share_of_input(row, group, &value);
        let text = written(&value, &head.unit, Some(DIGITS)) + &share;
        [head.name.to_string(), text, head.meaning.to_string()]
    };
    cells.map(line).collect()
}

/// The columns of a mode with its number.
fn mode_columns<'a>() -> [Column<(usize, &'a ComplexMode)>; 5] {
    [
        Column::new("mode", "", "", |(number, _)| (*number).into()),
        Column::new("frequency", "", "", |(_, mode)| value::quantity(mode.frequency_hz, "Hz").into()),
        Column::new("growth rate", "", "", |(_, mode)| {
            format!("{} 1/s", value::significant(mode.growth_rate_per_s, 4)).into()
        }),
        Column::new("damping ratio", "", "", |(_, mode)| value::significant_number(mode.damping_ratio, 3)),
        Column::new("residual", "", "", |(_, mode)| {
            let doubt = if mode.is_converged { "" } else { ", not converged" };
            format!("{:.1e}{doubt}", mode.residual).into()
        }),
    ]
}

/// The modes of steady sliding as a table.
fn modes(stability: &SlidingStability) -> String {
    let numbered: Vec<(usize, &ComplexMode)> = (1..).zip(&stability.modes).collect();
    let table = Table::of("modes", &mode_columns(), &numbered).text();
    let lines: String = table.lines().flat_map(|line| ["  ", line, "\n"]).collect();
    let band = value::quantity(stability.band_hz, "Hz");
    let above = match stability.above_band {
        AboveBand::Nothing => "; the mesh has no others".to_owned(),
        AboveBand::Damped => "; damping keeps all others from growing".to_owned(),
        AboveBand::CoarserRun => {
            "; others were not looked for, but a run on a coarser mesh, which carries them, decayed"
                .to_owned()
        }
        AboveBand::NotLookedAt => "; others were not looked for".to_owned(),
    };
    format!("\nModes of steady sliding below {band}{above}\n{lines}")
}

/// The share that an energy has of the energy put in, as text; empty for other figures.
fn share_of_input(row: &JobRow, group: Group, value: &Value) -> String {
    let put_in_j =
        row.record().map(|record| record.energy.load_work_j.abs() + record.energy.drive_work_j.abs());
    match (value.as_f64(), put_in_j) {
        (Some(energy_j), Some(put_in_j)) if group == Group::Energies && put_in_j > 0.0 => {
            format!(" ({} %)", value::significant(100.0 * energy_j / put_in_j, 3))
        }
        _ => String::new(),
    }
}

/// A value with its unit as people write it, with so many significant digits or with all that tell it from others.
fn written(value: &Value, unit: &str, digits: Option<usize>) -> String {
    match value {
        Value::Number(number) if number.is_f64() => {
            let x = number.as_f64().unwrap_or_default();
            let (factor, name) = value::multiple(unit, x);
            let scaled = x / factor;
            let text =
                digits.map_or_else(|| value::rounded(scaled), |digits| value::significant(scaled, digits));
            if name.is_empty() { text } else { format!("{text} {name}") }
        }
        Value::Null => MISSING.to_owned(),
        value if unit.is_empty() => value::text(value),
        value => format!("{} {unit}", value::text(value)),
    }
}

fn provenance(job: &StoredJob) -> Vec<[String; 2]> {
    let details = &job.details;
    let mut lines = Vec::new();
    let mut add = |name: &str, text: String| lines.push([name.to_owned(), text]);
    for own in &job.studies {
        add("submitted", format!("{} ({})", value::utc_second(own.study.submitted_ms), own.study.name));
    }
    let moment = |ms: Option<i64>| ms.map_or_else(|| MISSING.to_owned(), value::utc_second);
    add("started", moment(details.started_ms));
    add("finished", moment(details.finished_ms));
    add("run time", details.wall_s.map_or_else(|| MISSING.to_owned(), value::duration));
    add("attempt", details.attempt.to_string());
    add("crashes", details.crashes.to_string());
    add("priority", details.priority.to_string());
    let cost = match details.cost {
        0.0 => "none, because the job has no run".to_owned(),
        cost => format!("about {} node-steps, for the order of jobs", value::significant(cost, 3)),
    };
    add("cost", cost);
    add("batch", details.batch.clone());
    match details.provenance.as_deref().map(parsed) {
        Some(Value::Object(fields)) => {
            // Program, machine and threads, as the worker declared them.
            for (name, value) in fields.iter().filter(|(_, value)| !value.is_null()) {
                add(name, value::text(value));
            }
        }
        Some(other) => add("made with", value::text(&other)),
        None => {}
    }
    lines
}
