//! The key of a job: a hash of everything that determines its result.

use super::effect::without_effect;
use super::json::encode;
use crate::spec::{Base, Holder, JobSpec, MeshFile, Pin, Shape};
use serde_json::Value;
use std::collections::VecDeque;
use std::fmt::Write;
use std::sync::LazyLock;

/// Length of a key. 128 bits suffice for a billion jobs without a collision.
const HEX_DIGITS: usize = 32;

/// The key of a job under a version of the solver: BLAKE3 of its canonical JSON, 32 hex digits.
///
/// The JSON has the fields that have an effect, without those that have the default value of the first version with them. In
/// canonical JSON the fields are sorted, there is no space, and numbers have their shortest exact form, with 0 for −0. A field that
/// a later version adds leaves the keys of jobs that do not use it as they are. A new `solver_version` changes every key, so that
/// old results are not taken for new ones.
pub fn job_key(spec: &JobSpec, solver_version: &str) -> String {
    static LEFT_OUT: LazyLock<Value> = LazyLock::new(|| encode(&left_out()));
    let mut job = encode(&without_synonyms(spec));
    for pointer in without_effect(spec) {
        if let Some(field) = job.pointer_mut(pointer) {
            *field = LEFT_OUT.pointer(pointer).cloned().unwrap_or_default();
        }
    }
    leave_out(&mut job, &LEFT_OUT);
    // The version cannot be confused with the job's text: it is quoted, and the job begins with a brace.
    let mut text = Value::from(solver_version).to_string();
    write_canonical(&job, &mut text);
    blake3::hash(text.as_bytes()).to_hex()[..HEX_DIGITS].to_owned()
}

/// A job whose values are left out of keys: the default values of the first version that had the field. A default value may change
/// later, and then its first value stays here, so that every key still stands for the same job.
fn left_out() -> JobSpec {
    let mut job = JobSpec::default();
    job.numerics.beta_r_s = 5.0e-8;
    job
}

/// The job in which what means the same is the same: an angle, a mass, an inertia or a damper of 0 is absent, and so is a surface
/// without height. A mesh from a file is a hash of its content.
fn without_synonyms(spec: &JobSpec) -> JobSpec {
    let mut spec = spec.clone();
    spec.scene.contact = spec.scene.contact.in_use();
    spec.scene.disk = spec.scene.disk.in_use();
    spec.scene.pin.size_m = spec.scene.pin.extent_m();
    if spec.scene.pin.shape == Shape::Mesh {
        reduce_mesh(&mut spec.scene.pin);
    }
    let (holder, pin, numerics) = (&mut spec.scene.holder, &mut spec.scene.pin, &mut spec.numerics);
    for nothing in [
        &mut holder.mass_kg,
        &mut holder.damping_x_n_s_m,
        &mut holder.damping_y_n_s_m,
        &mut holder.damping_z_n_s_m,
        &mut holder.rotational_damping_x_nm_s_rad,
        &mut holder.rotational_damping_y_nm_s_rad,
        &mut holder.inertia_x_kg_m2,
        &mut holder.inertia_y_kg_m2,
        &mut pin.tilt_x_deg,
        &mut pin.tilt_y_deg,
        &mut numerics.alpha_r_per_s,
    ] {
        *nothing = nothing.filter(|value| *value != 0.0);
    }
    if holder.is_ideal() {
        *holder = Holder::default();
    }
    if pin.base.is_flat() {
        pin.base = Base::default();
    }
    spec
}

/// Takes the fields out of `value` that have the same value in `left_out`. Null is the value of a field that is absent.
fn leave_out(value: &mut Value, left_out: &Value) {
    let (Value::Object(fields), Value::Object(others)) = (value, left_out) else { return };
    for (name, other) in others {
        leave_out(fields.entry(name).or_insert(Value::Null), other);
    }
    fields.retain(|name, value| {
        let other = &left_out[name.as_str()];
        let is_empty = other.is_object() && value.as_object().is_some_and(serde_json::Map::is_empty);
        value != other && !is_empty
    });
}

/// Leaves of a mesh from a file a hash of its nodes, elements, faces and regions: names, units and compression have no effect.
fn reduce_mesh(pin: &mut Pin) {
    let Pin { mesh: Some(mesh), regions, .. } = pin else { return };
    // A damaged mesh is refused before it has a result.
    let Some(content) = mesh.decoded() else { return };
    let region_of = |body: u32| {
        let name = mesh.bodies.get(body as usize);
        let region =
            regions.iter().position(|region| region.group.is_some() && region.group.as_ref() == name);
        region.unwrap_or(regions.len()) as u32
    };
    let hash = blake3::hash(&content.identity(region_of)).to_hex().to_string();
    **mesh = MeshFile { content: Some(hash), ..MeshFile::default() };
    for region in regions {
        region.group = None;
    }
}

/// Largest number of parts that are remembered: a search through them takes less time than to encode one job.
const MAX_REMEMBERED: usize = 64;

/// Keys of parts that many jobs share, such as [`JobSpec::shared_part`]. A part that was met recently is not encoded
/// again.
#[derive(Debug)]
pub struct SharedKeys {
    solver_version: &'static str,
    recent: VecDeque<(JobSpec, String)>,
}

impl SharedKeys {
    /// Keys under that version of the solver.
    pub fn new(solver_version: &'static str) -> Self {
        Self { solver_version, recent: VecDeque::new() }
    }

    /// The [`job_key`] of `part`.
    pub fn key(&mut self, part: JobSpec) -> String {
        if let Some((_, key)) = self.recent.iter().find(|(known, _)| *known == part) {
            return key.clone();
        }
        let key = job_key(&part, self.solver_version);
        self.recent.truncate(MAX_REMEMBERED - 1);
        self.recent.push_front((part, key.clone()));
        key
    }
}

/// Writes canonical JSON. The fields are sorted here, because whether `serde_json` keeps them sorted depends on a feature
/// that any other dependency can switch on.
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
