//! The differences between several sources as files.

use super::comparison::Comparison;
use super::export::io_error;
use crate::publish::value;
use std::io;

/// Contradictions about squeal (1: it squeals) and then all differences as CSV, one line each, with numbers in full and in the units of their names.
pub(super) fn csv(comparison: &Comparison, out: &mut Vec<u8>) -> io::Result<()> {
    let mut writer = ::csv::Writer::from_writer(out);
    let results = [
        "value",
        "error",
        "reference_value",
        "reference_error",
        "difference",
        "combined_error",
        "relative_difference",
        "interpolated",
    ];
    let head = ["source", "reference", "quantity"].into_iter();
    writer
        .write_record(head.chain(comparison.names.iter().map(String::as_str)).chain(results))
        .map_err(io_error)?;
    for found in &comparison.contradictions {
        let number = |squeals: bool| value::number(f64::from(u8::from(squeals)));
        let own = [found.source.clone(), comparison.reference.clone(), "squeals".to_owned()];
        let line = own.into_iter().chain(found.parameters.iter().map(value::text)).chain([
            number(found.squeals),
            String::new(),
            number(!found.squeals),
            String::new(),
            value::number(if found.squeals { 1.0 } else { -1.0 }),
            String::new(),
            String::new(),
            (if found.is_between { "yes" } else { "no" }).to_owned(),
        ]);
        writer.write_record(line).map_err(io_error)?;
    }
    for found in &comparison.differences {
        let optional = |x: Option<f64>| x.map_or_else(String::new, value::number);
        let own = [found.source.clone(), comparison.reference.clone(), found.scalar.name.to_owned()];
        let line = own.into_iter().chain(found.parameters.iter().map(value::text)).chain([
            value::number(found.value),
            optional(found.error),
            value::number(found.reference),
            optional(found.reference_error),
            value::number(found.difference()),
            optional(found.combined_error()),
            optional(found.relative()),
            (if found.interpolated { "yes" } else { "no" }).to_owned(),
        ]);
        writer.write_record(line).map_err(io_error)?;
    }
    writer.flush()
}
