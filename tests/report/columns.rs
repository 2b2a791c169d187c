//! The columns of the export: each figure of a record has one, and names mean one thing.

use crate::synthetic::row;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use tribosweep_mechanics::analysis::{JobRecord, Obstacle, Outcome};
use tribosweep_output::publish::table::Head;
use tribosweep_output::report::columns::{ExportColumn, all, fixed, plain};
use tribosweep_output::report::{RowState, SCALARS, Scalar, columns_of_files};

/// Gives every number in a value another one, and collects them. They are larger than those that are not in the record.
fn number_all(value: &mut Value, numbers: &mut BTreeSet<u64>) {
    match value {
        Value::Number(number) => {
            let next = 1000 + numbers.len() as u64;
            numbers.insert(next);
            *value = if number.is_f64() { json!(next as f64) } else { json!(next) };
        }
        Value::Array(values) => values.iter_mut().for_each(|value| number_all(value, numbers)),
        Value::Object(fields) => fields.values_mut().for_each(|value| number_all(value, numbers)),
        _ => {}
    }
}

fn inputs(names: &[&str]) -> Vec<Head> {
    names.iter().map(|name| Head::new((*name).to_owned(), "m", "…")).collect()
}

fn heads(columns: &[ExportColumn]) -> impl Iterator<Item = &Head> {
    columns.iter().map(|own| &own.column.head)
}

fn names(columns: &[ExportColumn]) -> Vec<&str> {
    heads(columns).map(|head| &*head.name).collect()
}

/// Protects: every number that a record stores is in a column of its own, whatever its kind of obstacle.
#[test]
fn every_number_of_a_record_has_a_column() {
    let unsteady = Obstacle::Unsteady { figure: "period".to_owned(), spread: 0.1, drift: 0.2 };
    for obstacle in [unsteady, Obstacle::FewCycles { found: 1, needed: 2 }] {
        // Modes and windows have tables of their own. Without a steady state there are no numbers that are computed from others. The error of
        // steady sliding is in the column `mu_star_mesh_error` of such a job.
        let (obstacle, stability, windows, sliding_mesh_error) = (Some(obstacle), None, Vec::new(), None);
        let mut record =
            JobRecord { obstacle, stability, windows, sliding_mesh_error, ..JobRecord::example() };
        record.start.iter_mut().for_each(|coarser| coarser.modes.clear());
        let mut stored = serde_json::to_value(record).unwrap();
        let mut numbers = BTreeSet::new();
        number_all(&mut stored, &mut numbers);
        let record: JobRecord = serde_json::from_value(stored).unwrap();
        let row = row(7.0, 0.4, RowState::Done(Box::new(record)));
        let values = all(&[], &[]).into_iter().map(|column| (column.value(&row).as_f64(), column));
        for number in numbers {
            let own = values.clone().filter(|(value, _)| *value == Some(number as f64));
            // The figure of both identities is the larger one of the two.
            let own = own.filter(|(_, column)| column.column.head.name != "identity_residual");
            assert_eq!(own.count(), 1, "{number}");
        }
    }
}

/// Protects: the columns of the plain export come first, no name occurs twice, and an input or a parameter with the name of
/// a result has a name of its own, the same in both exports. Each column has a meaning.
#[test]
fn names_are_unique() {
    let parameters = ["load_n", "cycles", "preset"].map(str::to_owned);
    let all = all(&inputs(&["omega_rpm", "mu", "load_n", "cycles", "time_step_s"]), &parameters);
    let plain = plain(&parameters);
    let fixed = plain.len() - parameters.len();
    assert_eq!(names(&all)[..fixed], names(&plain)[..fixed]);
    assert_eq!(names(&plain)[fixed..], ["load_n", "parameter_cycles", "preset"]);
    let further = ["load_n", "parameter_cycles", "parameter_time_step_s", "preset"];
    assert_eq!(names(&all)[all.len() - further.len()..], further);
    assert_eq!(names(&all).iter().collect::<BTreeSet<_>>().len(), all.len());
    assert!(heads(&all).all(|head| !head.meaning.is_empty()));
}

/// Protects: what figures and tables can show are numbers, and the program finds every column that it calls the error of a quantity.
#[test]
fn quantities_are_numbers() {
    // Only a steady state has an error by the mesh.
    let record = JobRecord { outcome: Outcome::Periodic, ..JobRecord::example() };
    let row = row(7.0, 0.4, RowState::Done(Box::new(record)));
    for scalar in SCALARS.iter() {
        let column = ExportColumn::find(scalar.name).unwrap_or_else(|| panic!("no column {}", scalar.name));
        assert!(column.value(&row).is_number(), "{}", scalar.name);
    }
    let of_errors: Vec<_> = fixed().filter_map(ExportColumn::error_of).collect();
    assert_eq!(of_errors, ["mu_star"]);
    assert!(of_errors.into_iter().all(|name| Scalar::find(name).is_some()));
}

/// Protects: the values of inputs are in their columns, beside those of the row.
#[test]
fn inputs_are_in_their_columns() {
    let columns = all(&inputs(&["mu", "size_x_m", "cycles"]), &[]);
    let mut row = row(7.0, 0.4, RowState::Pending);
    row.inputs = vec![json!(0.4), json!(0.012), json!(20)];
    let value = |name: &str| {
        let own = columns.iter().find(|own| own.column.head.name == name).unwrap();
        own.value(&row)
    };
    assert_eq!(value("size_x_m"), json!(0.012));
    assert_eq!(value("parameter_cycles"), json!(20));
    assert_eq!((value("cycles"), value("mu")), (Value::Null, json!(0.4)));
}

/// Protects: the page of columns has every table of a report once, no column of a table has the name of another one, and each column has a
/// meaning.
#[test]
fn other_tables_are_described() {
    let files = columns_of_files();
    let names: Vec<&String> = files.iter().flat_map(|own| &own.files).collect();
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
    for own in &files {
        let columns: BTreeSet<_> = own.heads.iter().map(|head| &head.name).collect();
        assert_eq!(columns.len(), own.heads.len(), "{:?}", own.files);
        assert!(own.heads.iter().all(|head| !head.meaning.is_empty()), "{:?}", own.files);
    }
}
