//! The key of a job: a hash of everything that determines its result.

use super::json::encode;
use crate::spec::{Clamp, ClampSide, DiskKind, JobSpec, Numerics};
use serde_json::Value;
use std::fmt::Write;

/// 128 bits: no two of a billion jobs collide.
const HEX_DIGITS: usize = 32;

/// The key of a job under a version of the solver: BLAKE3 of its canonical JSON, 32 hex digits.
///
/// Canonical means: fields sorted, no space, numbers in their shortest exact form, 0 for −0, and
/// fields that have no effect replaced: the clamp's width where no strip uses it, the safety factor where
/// the time step is given; or left out: the ring of a rigid disk. A new `solver_version` changes every key, so that
/// old results are not taken for new ones.
pub fn job_key(spec: &JobSpec, solver_version: &str) -> String {
    let mut spec = spec.clone();
    if spec.scene.clamp.side == ClampSide::WholeTop {
        spec.scene.clamp.width_m = Clamp::default().width_m;
    }
    if spec.numerics.time_step_s.is_some() {
        spec.numerics.safety_factor = Numerics::default().safety_factor;
    }
    let mut job = encode(&spec);
    if spec.scene.disk.kind == DiskKind::Rigid
        && let Some(disk) = job.pointer_mut("/scene/disk").and_then(Value::as_object_mut)
    {
        disk.remove("ring");
    }
    let mut text = String::new();
    write_canonical(&job, &mut text);
    // The version cannot run into the job: it is quoted and the job begins with a brace.
    let hash = blake3::hash(format!("{}{text}", Value::from(solver_version)).as_bytes());
    hash.to_hex()[..HEX_DIGITS].to_owned()
}

/// Sorts the fields itself: whether `serde_json` keeps them sorted depends on a feature that any
/// other dependency can switch on.
fn write_canonical(value: &Value, out: &mut String) {
    match value {
        Value::Object(fields) => {
            let mut fields: Vec<_> = fields.iter().collect();
            fields.sort_by_key(|(name, _)| *name);
            write_joined(out, ['{', '}'], fields, |(name, value), out| {
                let _ = write!(out, "{}:", Value::from(name.as_str()));
                write_canonical(value, out);
            });
        }
        Value::Array(entries) => write_joined(out, ['[', ']'], entries, write_canonical),
        Value::Number(number) if number.as_f64() == Some(0.0) && number.is_f64() => out.push_str("0.0"),
        other => _ = write!(out, "{other}"),
    }
}

fn write_joined<T>(
    out: &mut String,
    [open, close]: [char; 2],
    items: impl IntoIterator<Item = T>,
    write_item: impl Fn(T, &mut String),
) {
    out.push(open);
    for (i, item) in items.into_iter().enumerate() {
        if i > 0 {
            out.push(',');
        }
        write_item(item, out);
    }
    out.push(close);
}
