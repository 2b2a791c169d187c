//! The registry of parameters: what a grid or an override can set, by short name.

use super::damping;
use super::error::Problem;
use super::json::number_hint;
use super::plausible::{DENSITY, FRICTION, HOLDER_MASS, LENGTH, MODULUS, Plausible};
use super::preset::Preset;
use super::suggest;
use crate::spec::{
    ClampSide, DiskKind, DiskTimeStep, Element, FrictionLaw, MaterialLaw, Precision, Shape, StabilityMethod,
    Start, Strains, TargetSurface, TopFace,
};
use crate::units::name_and_unit;
use schemars::{Schema, SchemaGenerator};
use serde_json::{Map, Value};

/// The kind of values of a parameter: how they are written, whether ranges make sense, and their schema. Types are
/// checked by deserialising the job, not by the kind.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    /// A number.
    Number,
    /// A whole number.
    Count,
    /// Three whole numbers, `[nx, ny, nz]`.
    Counts,
    /// `true` or `false`.
    Flag,
    /// One of the names of an enumeration.
    Name(fn(&mut SchemaGenerator) -> Schema),
}

/// One parameter of a job.
#[derive(Debug)]
pub struct Parameter {
    /// Short name, unique.
    pub name: &'static str,
    /// JSON pointer into a study, and so into a [`JobSpec`](crate::spec::JobSpec): a job has every field that a parameter
    /// sets, except for `preset`, `damping` and `sliding_speed_m_s`, which stand for values of other fields.
    pub pointer: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// The unit at the end of its name; empty for numbers without a unit, names and flags.
    pub unit: &'static str,
    /// Its symbol, whose part behind a `_` is a subscript; empty without one.
    pub symbol: &'static str,
    /// Values outside are taken for those of another unit.
    pub(super) plausible: Option<&'static Plausible>,
    pub(super) kind: Kind,
}

const fn parameter(
    name: &'static str,
    pointer: &'static str,
    kind: Kind,
    meaning: &'static str,
) -> Parameter {
    let unit = name_and_unit(name).1;
    Parameter { name, pointer, meaning, unit, symbol: "", plausible: None, kind }
}

const CLAMP_SIDE: Kind = Kind::Name(SchemaGenerator::subschema_for::<ClampSide>);
const PIN_SHAPE: Kind = Kind::Name(SchemaGenerator::subschema_for::<Shape>);
const TOP_FACE: Kind = Kind::Name(SchemaGenerator::subschema_for::<TopFace>);
const FRICTION_LAW: Kind = Kind::Name(SchemaGenerator::subschema_for::<FrictionLaw>);
const DISK_KIND: Kind = Kind::Name(SchemaGenerator::subschema_for::<DiskKind>);
const TARGET: Kind = Kind::Name(SchemaGenerator::subschema_for::<TargetSurface>);
const PRESET: Kind = Kind::Name(SchemaGenerator::subschema_for::<Preset>);
const ELEMENT: Kind = Kind::Name(SchemaGenerator::subschema_for::<Element>);
const STRAINS: Kind = Kind::Name(SchemaGenerator::subschema_for::<Strains>);
const MATERIAL_LAW: Kind = Kind::Name(SchemaGenerator::subschema_for::<MaterialLaw>);
const PRECISION: Kind = Kind::Name(SchemaGenerator::subschema_for::<Precision>);
const STABILITY: Kind = Kind::Name(SchemaGenerator::subschema_for::<StabilityMethod>);
const START: Kind = Kind::Name(SchemaGenerator::subschema_for::<Start>);
const DISK_TIME_STEP: Kind = Kind::Name(SchemaGenerator::subschema_for::<DiskTimeStep>);

/// All parameters, in the order in which help and messages list them. What a field of a job is called, which unit and symbol it has, and which
/// values are plausible, is said here and nowhere else; `spec` has its type and its physical limits.
#[rustfmt::skip]
pub static PARAMETERS: &[Parameter] = &[
    parameter("omega_rpm", "/scene/disk/omega_rpm", Kind::Number, "rotation speed of the disk").symbol("ω"),
    parameter("mu", "/scene/contact/mu", Kind::Number, "local friction coefficient: the kinetic one, or that of the last speed of a table").symbol("μ").plausible(&FRICTION),
    parameter("load_n", "/scene/load/force_n", Kind::Number, "total normal load").symbol("F"),
    parameter("friction_law", "/scene/contact/law", FRICTION_LAW, "friction law"),
    parameter("mu_static", "/scene/contact/mu_static", Kind::Number, "friction coefficient without slip"),
    parameter("friction_speed_m_s", "/scene/contact/speed_m_s", Kind::Number, "slip speed that scales a friction law"),
    parameter("friction_slope_s_m", "/scene/contact/slope_s_m", Kind::Number, "rise of the friction coefficient with the slip speed"),
    parameter("friction_length_m", "/scene/contact/length_m", Kind::Number, "slip in which friction follows the normal force"),
    parameter("contact_stiffness_pa_m", "/scene/contact/stiffness_pa_m", Kind::Number, "stiffness of a layer between pin and disk"),
    parameter("contact_stiffness_exponent", "/scene/contact/stiffness_exponent", Kind::Number, "exponent of the layer's pressure over its depth"),
    parameter("contact_stiffness_pressure_pa", "/scene/contact/stiffness_pressure_pa", Kind::Number, "pressure at which the layer has the stiffness contact_stiffness_pa_m"),
    parameter("ramp_s", "/scene/load/ramp_s", Kind::Number, "duration of the load's linear ramp").symbol("t_F"),
    parameter("track_radius_m", "/scene/disk/track_radius_m", Kind::Number, "distance of the pin's centre from the axis").symbol("R").plausible(&LENGTH),
    parameter("runout_m", "/scene/disk/runout_m", Kind::Number, "amplitude of the disk's axial run-out"),
    parameter("waviness_height_m", "/scene/disk/waviness_height_m", Kind::Number, "amplitude of the disk's waviness"),
    parameter("waviness_count", "/scene/disk/waviness_count", Kind::Count, "waves of the disk in a revolution"),
    parameter("disk_kind", "/scene/disk/kind", DISK_KIND, "what the disk is made of"),
    parameter("disk_young_modulus_pa", "/scene/disk/ring/young_modulus_pa", Kind::Number, "Young's modulus of an elastic disk").symbol("E_d").plausible(&MODULUS),
    parameter("disk_poisson_ratio", "/scene/disk/ring/poisson_ratio", Kind::Number, "Poisson's ratio of an elastic disk").symbol("ν_d"),
    parameter("disk_density_kg_m3", "/scene/disk/ring/density_kg_m3", Kind::Number, "density of an elastic disk").symbol("ρ_d").plausible(&DENSITY),
    parameter("disk_inner_radius_m", "/scene/disk/ring/inner_radius_m", Kind::Number, "inner radius of an elastic disk").symbol("r_i").plausible(&LENGTH),
    parameter("disk_outer_radius_m", "/scene/disk/ring/outer_radius_m", Kind::Number, "outer radius of an elastic disk").symbol("r_o").plausible(&LENGTH),
    parameter("disk_thickness_m", "/scene/disk/ring/thickness_m", Kind::Number, "thickness of an elastic disk").symbol("h_d").plausible(&LENGTH),
    parameter("disk_element_size_m", "/scene/disk/ring/element_size_m", Kind::Number, "largest element of an elastic disk under the track"),
    parameter("disk_coarse_element_size_m", "/scene/disk/ring/coarse_element_size_m", Kind::Number, "largest element of an elastic disk elsewhere"),
    parameter("disk_element", "/scene/disk/ring/element", ELEMENT, "element of an elastic disk"),
    parameter("track_arc_deg", "/scene/disk/ring/track_arc_deg", Kind::Number, "arc of an elastic disk that the pin may sweep"),
    parameter("target", "/scene/disk/ring/target", TARGET, "how an elastic disk's surface is interpolated"),
    parameter("disk_clock", "/scene/disk/ring/clock", DISK_TIME_STEP, "whether an elastic disk has its own time step"),
    parameter("young_modulus_pa", "/scene/pin/young_modulus_pa", Kind::Number, "Young's modulus of the pin").symbol("E").plausible(&MODULUS),
    parameter("poisson_ratio", "/scene/pin/poisson_ratio", Kind::Number, "Poisson's ratio of the pin").symbol("ν"),
    parameter("density_kg_m3", "/scene/pin/density_kg_m3", Kind::Number, "density of the pin").symbol("ρ").plausible(&DENSITY),
    parameter("elements", "/scene/pin/elements", Kind::Counts, "elements in x, y and z, as [nx, ny, nz]"),
    parameter("nx", "/scene/pin/elements/0", Kind::Count, "elements in x, the radial direction").symbol("n_x"),
    parameter("ny", "/scene/pin/elements/1", Kind::Count, "elements in y, the sliding direction").symbol("n_y"),
    parameter("nz", "/scene/pin/elements/2", Kind::Count, "elements in z").symbol("n_z"),
    parameter("element", "/scene/pin/element", ELEMENT, "element of the pin; an upright block with another one than full is a general mesh"),
    parameter("strains", "/scene/pin/strains", STRAINS, "small or finite strains of the pin; an upright block with finite ones is a general mesh"),
    parameter("material", "/scene/pin/material", MATERIAL_LAW, "law of the material with finite strains"),
    parameter("yield_stress_pa", "/scene/pin/plasticity/yield_stress_pa", Kind::Number, "stress at which a pin of the material j2 yields").symbol("σ₀"),
    parameter("hardening_modulus_pa", "/scene/pin/plasticity/hardening_modulus_pa", Kind::Number, "linear isotropic hardening"),
    parameter("saturation_stress_pa", "/scene/pin/plasticity/saturation_stress_pa", Kind::Number, "saturation stress of the hardening"),
    parameter("saturation_strain", "/scene/pin/plasticity/saturation_strain", Kind::Number, "plastic strain at which 63 % of the saturation stress are reached"),
    parameter("kinematic_modulus_pa", "/scene/pin/plasticity/kinematic_modulus_pa", Kind::Number, "linear kinematic hardening"),
    parameter("rate_reference_per_s", "/scene/pin/plasticity/rate_reference_per_s", Kind::Number, "rate of plastic strain at which the yield stress doubles"),
    parameter("rate_exponent", "/scene/pin/plasticity/rate_exponent", Kind::Number, "exponent q of the dependence on the rate"),
    parameter("pin_shape", "/scene/pin/shape", PIN_SHAPE, "shape of the pin"),
    parameter("diameter_m", "/scene/pin/diameter_m", Kind::Number, "diameter of a cylindrical pin").symbol("d").plausible(&LENGTH),
    parameter("tilt_x_deg", "/scene/pin/tilt_x_deg", Kind::Number, "tilt of the pin about x, which lifts its trailing end"),
    parameter("tilt_y_deg", "/scene/pin/tilt_y_deg", Kind::Number, "tilt of the pin about y, which lifts its inner side"),
    parameter("size_x_m", "/scene/pin/size_m/0", Kind::Number, "edge of the pin in x, the radial direction").symbol("l_x").plausible(&LENGTH),
    parameter("size_y_m", "/scene/pin/size_m/1", Kind::Number, "edge of the pin in y, the sliding direction").symbol("l_y").plausible(&LENGTH),
    parameter("size_z_m", "/scene/pin/size_m/2", Kind::Number, "edge of the pin in z").symbol("h").plausible(&LENGTH),
    parameter("crown_radius_m", "/scene/pin/base/crown_radius_m", Kind::Number, "radius of a crowned base"),
    parameter("edge_radius_m", "/scene/pin/base/edge_radius_m", Kind::Number, "radius of rounded edges of the base"),
    parameter("chamfer_width_m", "/scene/pin/base/chamfer_width_m", Kind::Number, "width of a chamfer of the base"),
    parameter("chamfer_height_m", "/scene/pin/base/chamfer_height_m", Kind::Number, "height of the chamfer of the base"),
    parameter("wave_height_m", "/scene/pin/base/wave_height_m", Kind::Number, "amplitude of a wave on the base"),
    parameter("wave_length_m", "/scene/pin/base/wave_length_m", Kind::Number, "wavelength of the wave on the base"),
    parameter("wave_direction_deg", "/scene/pin/base/wave_direction_deg", Kind::Number, "direction of the wave on the base, from +x towards +y"),
    parameter("roughness_rms_m", "/scene/pin/base/roughness/rms_m", Kind::Number, "root mean square of a rough base's height"),
    parameter("roughness_seed", "/scene/pin/base/roughness/seed", Kind::Count, "number of a rough base among those of its spectrum"),
    parameter("roughness_hurst", "/scene/pin/base/roughness/hurst", Kind::Number, "Hurst exponent of a rough base"),
    parameter("roughness_longest_m", "/scene/pin/base/roughness/longest_m", Kind::Number, "longest wavelength of a rough base"),
    parameter("roughness_shortest_m", "/scene/pin/base/roughness/shortest_m", Kind::Number, "shortest wavelength of a rough base"),
    parameter("clamp_side", "/scene/clamp/side", CLAMP_SIDE, "where the clamp is"),
    parameter("clamp_width_m", "/scene/clamp/width_m", Kind::Number, "width of the clamp's strip, or length of a collet").symbol("w").plausible(&LENGTH),
    parameter("top", "/scene/top", TOP_FACE, "how the top face moves in z"),
    parameter("holder_mass_kg", "/scene/holder/mass_kg", Kind::Number, "mass of the holder").plausible(&HOLDER_MASS),
    parameter("holder_stiffness_x_n_m", "/scene/holder/stiffness_x_n_m", Kind::Number, "stiffness of the holder in x"),
    parameter("holder_stiffness_y_n_m", "/scene/holder/stiffness_y_n_m", Kind::Number, "stiffness of the holder in y, the sliding direction"),
    parameter("holder_stiffness_z_n_m", "/scene/holder/stiffness_z_n_m", Kind::Number, "0 for a holder whose mass moves with the load in z"),
    parameter("holder_damping_x_n_s_m", "/scene/holder/damping_x_n_s_m", Kind::Number, "damper of the holder in x"),
    parameter("holder_damping_y_n_s_m", "/scene/holder/damping_y_n_s_m", Kind::Number, "damper of the holder in y, the sliding direction"),
    parameter("holder_damping_z_n_s_m", "/scene/holder/damping_z_n_s_m", Kind::Number, "damper of the holder in z"),
    parameter("holder_rotational_stiffness_x_nm_rad", "/scene/holder/rotational_stiffness_x_nm_rad", Kind::Number, "rotational stiffness of the holder about x"),
    parameter("holder_rotational_stiffness_y_nm_rad", "/scene/holder/rotational_stiffness_y_nm_rad", Kind::Number, "rotational stiffness of the holder about y"),
    parameter("holder_rotational_damping_x_nm_s_rad", "/scene/holder/rotational_damping_x_nm_s_rad", Kind::Number, "rotational damper of the holder about x"),
    parameter("holder_rotational_damping_y_nm_s_rad", "/scene/holder/rotational_damping_y_nm_s_rad", Kind::Number, "rotational damper of the holder about y"),
    parameter("holder_inertia_x_kg_m2", "/scene/holder/inertia_x_kg_m2", Kind::Number, "moment of inertia of the holder about x"),
    parameter("holder_inertia_y_kg_m2", "/scene/holder/inertia_y_kg_m2", Kind::Number, "moment of inertia of the holder about y"),
    parameter("preset", "/preset", PRESET, "accuracy of mesh, time step and detection"),
    parameter("beta2", "/numerics/beta2", Kind::Number, "β₂ of the time scheme, 0.5 to 1").symbol("β₂"),
    parameter("beta_r_s", "/numerics/beta_r_s", Kind::Number, "stiffness-proportional damping β_R").symbol("β_R"),
    parameter("alpha_r_per_s", "/numerics/alpha_r_per_s", Kind::Number, "mass-proportional damping α_R of the pin").symbol("α_R"),
    parameter("damping_ratio", "/damping/ratio", Kind::Number, "damping ratio ζ at damping_frequency_hz, instead of beta_r_s"),
    parameter("loss_factor", "/damping/loss_factor", Kind::Number, "loss factor η = 2ζ at damping_frequency_hz, instead of beta_r_s"),
    parameter("damping_frequency_hz", "/damping/frequency_hz", Kind::Number, "frequency at which damping_ratio or loss_factor holds"),
    parameter("damping_second_frequency_hz", "/damping/second_frequency_hz", Kind::Number, "second frequency at which damping_ratio or loss_factor holds"),
    parameter("damping_beta2", "/damping/beta2", Kind::Number, "β₂ of a scheme that has the job's damping at damping_at_time_step_s, instead of beta_r_s"),
    parameter("holder_damping_ratio", "/damping/holder_ratio", Kind::Number, "damping ratio ζ of the holder's springs, instead of its dampers"),
    parameter("damping_at_time_step_s", "/damping/at_time_step_s", Kind::Number, "time step at which the scheme of damping_beta2 has the job's damping"),
    parameter("safety_factor", "/numerics/safety_factor", Kind::Number, "time step as a fraction of the stability limit"),
    parameter("time_step_s", "/numerics/time_step_s", Kind::Number, "time step, instead of safety_factor").symbol("Δt"),
    parameter("precision", "/numerics/precision", PRECISION, "precision of the run's numbers, on a rigid disk"),
    parameter("limit_s", "/run/limit_s", Kind::Number, "simulated time after which a run ends"),
    parameter("stop_early", "/run/stop_early", Kind::Flag, "stop once periodic or decayed"),
    parameter("average_last_fraction", "/run/average_last_fraction", Kind::Number, "last fraction of the run that is averaged"),
    parameter("start", "/run/start", START, "what a run starts from: rest, the limit cycle of a coarser mesh, or rest after a run there to compare with"),
    parameter("window_s", "/run/window_s", Kind::Number, "length of the windows of a run whose speed or load changes, about"),
    parameter("cycles", "/detection/cycles", Kind::Count, "consecutive limit cycles that must repeat"),
    parameter("tolerance", "/detection/tolerance", Kind::Number, "largest spread of a per-cycle figure over them"),
    parameter("drift_tolerance", "/detection/drift_tolerance", Kind::Number, "largest drift of its mean between their halves"),
    parameter("regime_threshold", "/detection/regime_threshold", Kind::Number, "share above which a contact state names the regime"),
    parameter("decay_observation_s", "/detection/decay_observation_s", Kind::Number, "shortest steady sliding in which a decay is measured"),
    parameter("accuracy_mu_star", "/accuracy/mu_star", Kind::Number, "largest error of μ* by the mesh, relative to μ*; the job goes from mesh to mesh until it is reached"),
    parameter("stability", "/stability", STABILITY, "whether eigenvalues or the run decide that sliding is stable"),
];

impl Parameter {
    /// The parameter called `name`.
    pub fn find(name: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.name == name)
    }

    /// The parameter that the program itself names so.
    ///
    /// # Panics
    /// If there is none.
    pub fn named(name: &str) -> &'static Self {
        Self::find(name).unwrap_or_else(|| panic!("there is no parameter {name}"))
    }

    const fn symbol(self, symbol: &'static str) -> Self {
        Self { symbol, ..self }
    }

    const fn plausible(self, range: &'static Plausible) -> Self {
        Self { plausible: Some(range), ..self }
    }

    /// The meaning, with what its values are in brackets: their unit or their kind.
    pub fn doc(&self) -> String {
        let values = match self.kind {
            Kind::Flag => "true or false",
            Kind::Name(_) => "name",
            _ if self.unit.is_empty() => "-",
            _ => self.unit,
        };
        format!("{} [{values}]", self.meaning)
    }

    /// Whether a value between two of its values is one, too.
    pub fn is_continuous(&self) -> bool {
        matches!(self.kind, Kind::Number)
    }

    /// Whether its values are single numbers.
    pub fn is_number(&self) -> bool {
        matches!(self.kind, Kind::Number | Kind::Count)
    }

    /// The path of the field that it sets, as in messages: `scene.pin.size_m[0]`.
    pub fn field(&self) -> String {
        let write = |path: String, step: &str| match step.parse::<usize>() {
            Ok(index) => format!("{path}[{index}]"),
            Err(_) => super::locate::join(&path, step),
        };
        self.pointer[1..].split('/').fold(String::new(), write)
    }

    /// The part of a job that it belongs to: `scene`, `numerics`, `run`, `detection`, `stability` or `accuracy`; none
    /// if it is not a field of a job.
    pub fn part(&self) -> Option<&'static str> {
        let part = self.pointer.split('/').nth(1)?;
        Some(part).filter(|part| {
            matches!(*part, "scene" | "numerics" | "run" | "detection" | "stability" | "accuracy")
        })
    }

    /// Whether it changes how the physical case is solved and not the case: everything but the scene, and the mesh of it. Damping in
    /// proportion to the mass belongs to the case.
    pub fn is_numerics(&self) -> bool {
        let is_scene = self.pointer.starts_with("/scene/") || self.name == "alpha_r_per_s";
        !is_scene || self.pointer.starts_with("/scene/pin/elements")
    }

    /// The name of the column that holds it in data of jobs. It is the parameter's name, except that the numbers of elements
    /// are named like the edges: `elements_x` beside `size_x_m`.
    pub fn column(&self) -> &'static str {
        match self.name {
            "nx" => "elements_x",
            "ny" => "elements_y",
            "nz" => "elements_z",
            name => name,
        }
    }

    /// A problem with a value that has the wrong type, with what to write instead if that can be seen.
    pub(super) fn with_hint(&self, mut problem: Problem, value: &Value) -> Problem {
        if let Some(text) = value.as_str().filter(|_| self.is_number()) {
            problem.help.splice(0..0, number_hint(text));
        }
        problem
    }

    /// A line of help: name and description.
    pub(super) fn help(&self) -> String {
        format!("`{}`: {}", self.name, self.doc())
    }

    /// Whether setting the parameter determines the field `path`.
    pub(super) fn sets(&self, path: &str) -> bool {
        path.strip_prefix(&self.field()).is_some_and(|rest| rest.is_empty() || rest.starts_with('['))
    }

    /// Whether both parameters set a common field, so that a job cannot have both.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.sets(&other.field()) || other.sets(&self.field())
    }

    /// The parameters that say the same in another way, so that setting this one later on sets them aside.
    pub(super) fn displaces(&self) -> impl Iterator<Item = &'static Self> {
        let names: &[&str] = match self.name {
            "preset" => Preset::COVERS,
            // The study's mesh would be the finest one.
            "accuracy_mu_star" => &["elements", "time_step_s"],
            "damping_ratio" => &["loss_factor", "damping_beta2", "damping_at_time_step_s", "beta_r_s"],
            "loss_factor" => &["damping_ratio", "damping_beta2", "damping_at_time_step_s", "beta_r_s"],
            "damping_frequency_hz" => &["damping_beta2", "damping_at_time_step_s", "beta_r_s"],
            "damping_second_frequency_hz" => {
                &["damping_beta2", "damping_at_time_step_s", "beta_r_s", "alpha_r_per_s"]
            }
            "alpha_r_per_s" => &["damping_second_frequency_hz"],
            "damping_beta2" | "damping_at_time_step_s" => &[
                "damping_ratio",
                "loss_factor",
                "damping_frequency_hz",
                "damping_second_frequency_hz",
                "beta_r_s",
            ],
            "beta_r_s" => &[
                "damping_ratio",
                "loss_factor",
                "damping_frequency_hz",
                "damping_second_frequency_hz",
                "damping_beta2",
                "damping_at_time_step_s",
            ],
            "safety_factor" => &["time_step_s"],
            "holder_damping_ratio" => &damping::DAMPERS,
            own if damping::DAMPERS.contains(&own) => &["holder_damping_ratio"],
            _ => &[],
        };
        names.iter().map(|name| Self::named(name))
    }

    /// Whether it sets an entry of a list and not a field.
    pub(super) fn is_entry(&self) -> bool {
        self.pointer.rsplit_once('/').is_some_and(|(_, last)| last.parse::<usize>().is_ok())
    }

    /// Puts `value` into a study or a serialised job. Objects that are absent are added; an entry of a list that is absent
    /// is not.
    pub(super) fn set(&self, job: &mut Value, value: &Value) {
        let (parent, last) = self.pointer.rsplit_once('/').unwrap_or(("", self.pointer));
        if job.pointer(parent).is_none() && !self.is_entry() {
            let mut object = &mut *job;
            for step in parent.split('/').skip(1) {
                let Value::Object(fields) = object else { return };
                object = fields.entry(step).or_insert_with(|| Value::Object(Map::new()));
            }
        }
        match job.pointer_mut(parent) {
            // Insert rather than replace: an optional field may be absent from the serialised job.
            Some(Value::Object(fields)) => _ = fields.insert(last.to_owned(), value.clone()),
            Some(Value::Array(entries)) => {
                if let Some(entry) = last.parse().ok().and_then(|i: usize| entries.get_mut(i)) {
                    *entry = value.clone();
                }
            }
            _ => {}
        }
    }

    /// One spelling for equal numbers: 7.0 for 7, 0 for -0, and 6 for a count 6.0 of a range.
    pub(super) fn normalise(&self, value: Value) -> Value {
        match (self.kind, value) {
            (Kind::Number, Value::Number(number)) => match number.as_f64() {
                Some(float) => Value::from(float + 0.0),
                None => Value::Number(number),
            },
            (Kind::Count, value) => whole(value),
            (Kind::Counts, Value::Array(entries)) => entries.into_iter().map(whole).collect(),
            (_, value) => value,
        }
    }
}

/// A whole number without its decimal point. Any other value stays as it is, and the type check refuses it.
fn whole(value: Value) -> Value {
    match value.as_f64() {
        Some(float) if float.fract() == 0.0 && (0.0..1e15).contains(&float) => Value::from(float as u64),
        _ => value,
    }
}

/// Whether a parameter of that name is [one of the numerics](Parameter::is_numerics).
pub fn is_numerics(name: &str) -> bool {
    Parameter::find(name).is_some_and(Parameter::is_numerics)
}

/// Help for a parameter that does not exist.
pub(super) fn unknown_help(wrong: &str) -> Vec<String> {
    // A parameter is also recognised by the name of its field, which the rest of the file uses.
    let spellings = |parameter: &'static Parameter| {
        let field = parameter.field();
        let last = field.rsplit('.').next().unwrap_or_default().to_owned();
        (parameter.name, vec![parameter.name.to_owned(), last, field])
    };
    let nearest = suggest::nearest(wrong, PARAMETERS.iter().map(spellings));
    let suggestion = nearest.map(|name| suggest::question(wrong, name));
    suggestion.into_iter().chain(["`tribosweep parameters` lists all of them".to_owned()]).collect()
}

impl PartialEq for Parameter {
    fn eq(&self, other: &Self) -> bool {
        // Names are unique.
        self.name == other.name
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::Limit;

    /// Protects: no two parameters have the same symbol, and all are found by what names them in the program.
    #[test]
    fn symbols_are_unique() {
        for (number, parameter) in PARAMETERS.iter().enumerate() {
            let is_other = |other: &Parameter| other.symbol.is_empty() || other.symbol != parameter.symbol;
            assert!(PARAMETERS[..number].iter().all(is_other), "{}", parameter.symbol);
            assert!(parameter.displaces().all(|other| other != parameter), "{}", parameter.name);
        }
    }

    /// Protects: what is plausible is allowed, and there are allowed values that are not plausible. Otherwise a range would say nothing.
    #[test]
    fn ranges_are_within_limits() {
        let mut found = 0;
        for parameter in PARAMETERS {
            let Some(range) = parameter.plausible else { continue };
            let field = parameter.field();
            let limit = Limit::of(&field).or_else(|| Limit::of(&format!("{field}[]"))).unwrap();
            let values = || (-18..=18).map(|power| 10_f64.powi(power));
            assert!(values().filter(|x| range.doubt(*x).is_none()).all(|x| limit.holds(x)), "{field}");
            assert!(values().any(|x| range.doubt(x).is_some() && limit.holds(x)), "{field}");
            found += 1;
        }
        assert_eq!(found, 15);
    }
}
