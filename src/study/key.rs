//! The key of a job: a hash of everything that determines its result.

use super::json::encode;
use crate::spec::{
    Clamp, ClampSide, Detection, DiskKind, FrictionLaw, JobSpec, Load, MeshFile, Numerics, Pin, Precision,
    RunControl, Shape, StabilityMethod, Start,
};
use serde_json::Value;
use std::collections::VecDeque;
use std::fmt::Write;

/// Length of a key. 128 bits suffice for a billion jobs without a collision.
const HEX_DIGITS: usize = 32;

/// The key of a job under a version of the solver: BLAKE3 of its canonical JSON, 32 hex digits.
///
/// In canonical JSON the fields are sorted, there is no space, and numbers have their shortest exact form, with 0 for
/// −0. Fields without effect do not enter. These have their defaults: coefficients that the friction law does not use; the
/// clamp's width where no strip uses it; an angle of 0; masses, inertias and dampers of 0; run-out and waviness of no height; the elements and the clamp
/// where the mesh comes from a file, of which a hash of its content enters; the
/// safety factor where the time step is given; the time step, the precision, the run, its detection and the load's ramp where
/// there is no run; the method of stability where eigenvalues may not decide; the start
/// where the mesh is too coarse for a coarser one; what looks for a steady state where the speed or the load changes. The ring of a rigid disk is left out. A new
/// `solver_version` changes every key, so that old results are not taken for new ones.
pub fn job_key(spec: &JobSpec, solver_version: &str) -> String {
    let mut spec = spec.clone();
    spec.scene.contact = spec.scene.contact.in_use();
    spec.scene.pin.size_m = spec.scene.pin.extent_m();
    if spec.scene.pin.shape == Shape::Mesh {
        spec.scene.pin.elements = Pin::default().elements;
        spec.scene.clamp = Clamp::default();
        reduce_mesh(&mut spec.scene.pin);
    }
    let holder = &mut spec.scene.holder;
    for nothing in [
        &mut holder.mass_kg,
        &mut holder.damping_x_n_s_m,
        &mut holder.damping_y_n_s_m,
        &mut holder.damping_z_n_s_m,
        &mut holder.rotational_damping_x_nm_s_rad,
        &mut holder.rotational_damping_y_nm_s_rad,
        &mut holder.inertia_x_kg_m2,
        &mut holder.inertia_y_kg_m2,
    ] {
        *nothing = nothing.filter(|value| *value != 0.0);
    }
    for angle in [&mut spec.scene.pin.tilt_x_deg, &mut spec.scene.pin.tilt_y_deg] {
        *angle = angle.filter(|angle| *angle != 0.0);
    }
    spec.scene.disk = spec.scene.disk.in_use();
    if spec.scene.clamp.side == ClampSide::WholeTop {
        spec.scene.clamp.width_m = Clamp::default().width_m;
    }
    if spec.numerics.time_step_s.is_some() {
        spec.numerics.safety_factor = Numerics::default().safety_factor;
    }
    if spec.stability == StabilityMethod::Modes {
        if !spec.modes_need_time_step() {
            spec.numerics.safety_factor = Numerics::default().safety_factor;
            spec.numerics.time_step_s = None;
        }
        spec.numerics.precision = Precision::Double;
        spec.run = RunControl::default();
        spec.detection = Detection::default();
        spec.scene.load.ramp_s = Load::default().ramp_s;
    } else if !spec.eigenvalues_may_decide() {
        spec.stability = StabilityMethod::Simulate;
    }
    if !spec.scene.program.is_constant() {
        let RunControl { limit_s, start, window_s, .. } = spec.run;
        spec.run = RunControl { limit_s, start, window_s, ..RunControl::default() };
        let regime_threshold = spec.detection.regime_threshold;
        spec.detection = Detection { regime_threshold, ..Detection::default() };
    }
    if spec.coarser_elements().is_none() {
        spec.run.start = Start::Rest;
    }
    let mut job = encode(&spec);
    if spec.scene.disk.kind == DiskKind::Rigid
        && let Some(disk) = job.pointer_mut("/scene/disk").and_then(Value::as_object_mut)
    {
        disk.remove("ring");
    }
    // Keys of jobs in double precision are those of versions without single precision: their results are the same.
    if spec.numerics.precision == Precision::Double
        && let Some(numerics) = job.pointer_mut("/numerics").and_then(Value::as_object_mut)
    {
        numerics.remove("precision");
    }
    // Keys of jobs that always run are those of versions without eigenvalues: their results are the same.
    if spec.stability == StabilityMethod::Simulate
        && let Some(job) = job.as_object_mut()
    {
        job.remove("stability");
    }
    // Likewise for runs that start from rest.
    if spec.run.start == Start::Rest
        && let Some(run) = job.pointer_mut("/run").and_then(Value::as_object_mut)
    {
        run.remove("start");
    }
    // Likewise for Coulomb's law, an ideal holder and a flat base.
    if spec.scene.holder.is_ideal()
        && let Some(scene) = job.pointer_mut("/scene").and_then(Value::as_object_mut)
    {
        scene.remove("holder");
    }
    if spec.scene.contact.law == FrictionLaw::Coulomb
        && let Some(contact) = job.pointer_mut("/scene/contact").and_then(Value::as_object_mut)
    {
        contact.remove("law");
    }
    if spec.scene.pin.base.is_flat()
        && let Some(pin) = job.pointer_mut("/scene/pin").and_then(Value::as_object_mut)
    {
        pin.remove("base");
    }
    // The version cannot be confused with the job's text: it is quoted, and the job begins with a brace.
    let mut text = Value::from(solver_version).to_string();
    write_canonical(&job, &mut text);
    blake3::hash(text.as_bytes()).to_hex()[..HEX_DIGITS].to_owned()
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
