//! Protects: a key identifies a result. Whatever can change the result changes the key, and nothing else does.

use super::parse;
use serde_json::{Value, json};
use tribosweep::spec::{
    Accuracy, Base, ClampSide, Contact, DiskKind, Element, FrictionLaw, HeightMap, Holder, JobSpec,
    MaterialLaw, MeshFile, MuOfSpeed, Plasticity, Precision, Region, Roughness, Shape, StabilityMethod,
    Start, Strains,
};
use tribosweep::study::{PARAMETERS, job_key};

fn key(spec: &JobSpec) -> String {
    job_key(spec, "1")
}

fn key_of(text: &str) -> String {
    parse(text).expand("1").unwrap().remove(0).key
}

fn with_elastic_disk() -> JobSpec {
    let mut spec = JobSpec::default();
    spec.numerics.time_step_s = Some(1.0e-8);
    spec.scene.disk.kind = DiskKind::Elastic;
    spec
}

/// A job in which every optional field is given.
pub fn full() -> JobSpec {
    let mut spec = with_elastic_disk();
    spec.numerics.alpha_r_per_s = Some(100.0);
    (spec.scene.pin.element, spec.scene.disk.ring.element) = (Element::Incompatible, Element::Incompatible);
    (spec.scene.pin.strains, spec.scene.pin.material) = (Strains::Finite, MaterialLaw::J2);
    let plasticity = Plasticity {
        yield_stress_pa: Some(3.0e8),
        hardening_modulus_pa: Some(1.0e8),
        saturation_stress_pa: Some(2.0e8),
        saturation_strain: Some(0.1),
        hardening_curve: vec![[0.01, 3.0e8], [0.1, 4.0e8]],
        kinematic_modulus_pa: Some(1.5e8),
        rate_reference_per_s: Some(1.0e3),
        rate_exponent: Some(4.0),
    };
    spec.scene.pin.plasticity = Some(plasticity.clone());
    spec.scene.pin.elements = [12, 15, 11];
    spec.scene.contact = Contact {
        mu: 0.4,
        law: FrictionLaw::Exponential,
        mu_static: Some(0.5),
        speed_m_s: Some(0.01),
        slope_s_m: Some(0.1),
        length_m: Some(1.0e-6),
        mu_of_speed: MuOfSpeed(vec![[0.001, 0.5], [1.0, 0.4]]),
        stiffness_pa_m: Some(1.0e13),
        stiffness_exponent: Some(2.0),
        stiffness_pressure_pa: Some(1.0e6),
    };
    spec.scene.pin.base = Base {
        crown_radius_m: Some(1.0),
        edge_radius_m: Some(0.001),
        chamfer_width_m: Some(0.002),
        chamfer_height_m: Some(1.0e-5),
        wave_height_m: Some(1.0e-6),
        wave_length_m: Some(0.006),
        wave_direction_deg: Some(30.0),
        roughness: Some(Roughness {
            rms_m: 1.0e-7,
            seed: 3,
            hurst: 0.7,
            longest_m: Some(0.008),
            shortest_m: Some(0.004),
        }),
        height_map: Some(HeightMap {
            file: Some("map.csv".to_owned()),
            spacing_m: 0.02,
            heights_m: vec![vec![1.0e-7, 2.0e-7], vec![3.0e-7, 5.0e-7]],
        }),
    };
    let pin = &mut spec.scene.pin;
    pin.shape = Shape::Cylinder;
    pin.diameter_m = Some(0.011);
    pin.tilt_x_deg = Some(0.1);
    pin.tilt_y_deg = Some(0.2);
    pin.regions = vec![Region {
        above_m: Some(0.005),
        group: Some("plate".to_owned()),
        young_modulus_pa: 2.0e9,
        poisson_ratio: 0.25,
        density_kg_m3: 3000.0,
        plasticity: Some(plasticity),
    }];
    pin.mesh = Some(Box::new(MeshFile {
        file: Some("pin.msh".to_owned()),
        length_unit_m: 0.001,
        contact: "base".to_owned(),
        load: "top".to_owned(),
        clamp: "side".to_owned(),
        content: Some("none".to_owned()),
        extent_m: Some([0.01, 0.02, 0.03]),
        nodes: Some(8),
        hexahedra: Some(1),
        contact_faces: Some(1),
        contact_edges_m: Some([0.01, 0.02]),
        bodies: vec!["plate".to_owned()],
    }));
    spec.scene.disk.runout_m = Some(1.0e-6);
    spec.scene.disk.waviness_height_m = Some(2.0e-6);
    spec.scene.disk.waviness_count = Some(30);
    spec.scene.holder = Holder {
        mass_kg: Some(0.1),
        stiffness_x_n_m: Some(1.0e7),
        stiffness_y_n_m: Some(2.0e7),
        stiffness_z_n_m: Some(1.0e5),
        damping_x_n_s_m: Some(1.0),
        damping_y_n_s_m: Some(2.0),
        damping_z_n_s_m: Some(3.0),
        rotational_stiffness_x_nm_rad: Some(4.0),
        rotational_stiffness_y_nm_rad: Some(5.0),
        rotational_damping_x_nm_s_rad: Some(6.0),
        rotational_damping_y_nm_s_rad: Some(7.0),
        inertia_x_kg_m2: Some(8.0),
        inertia_y_kg_m2: Some(9.0),
    };
    spec.run.window_s = Some(0.001);
    spec.accuracy = Some(Accuracy { mu_star: 0.01 });
    spec
}

/// JSON pointers of all numbers, names and flags below `value`.
fn leaves(value: &Value, pointer: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(fields) => {
            fields.iter().for_each(|(name, inner)| leaves(inner, &format!("{pointer}/{name}"), found));
        }
        Value::Array(entries) => {
            for (i, inner) in entries.iter().enumerate() {
                leaves(inner, &format!("{pointer}/{i}"), found);
            }
        }
        _ => found.push(pointer.to_owned()),
    }
}

/// Another valid value for a field; `None` for a name that has no alternative.
fn another(value: &Value, pointer: &str) -> Option<Value> {
    match value {
        Value::Bool(flag) => Some(Value::from(!flag)),
        Value::Number(number) if number.is_u64() => Some(Value::from(number.as_u64()? + 1)),
        Value::Number(number) => Some(Value::from(number.as_f64()? * (1.0 + f64::EPSILON))),
        _ => match pointer {
            "/scene/clamp/side" => Some(Value::from("both_ends")),
            "/scene/top" => Some(Value::from("free_in_z")),
            "/scene/disk/kind" => Some(Value::from("rigid")),
            "/scene/pin/element" | "/scene/disk/ring/element" => Some(Value::from("full")),
            "/scene/pin/strains" => Some(Value::from("small")),
            "/scene/pin/material" => Some(Value::from("neo_hookean")),
            "/scene/disk/ring/target" => Some(Value::from("ferguson")),
            "/scene/disk/ring/clock" => Some(Value::from("common")),
            "/run/start" => Some(Value::from("nested")),
            "/stability" => Some(Value::from("eigenvalues")),
            "/numerics/precision" => Some(Value::from("single")),
            "/scene/pin/base/height_map/file" => Some(Value::from("other.csv")),
            "/scene/pin/shape" => Some(Value::from("block")),
            "/scene/pin/regions/0/group" => Some(Value::from("other")),
            other if other.starts_with("/scene/pin/mesh/") => Some(Value::from("other")),
            "/scene/contact/law" => Some(Value::from("static_kinetic")),
            other => panic!("{other} = {value}: this test needs another value for it"),
        },
    }
}

/// Walks the serialised job, so that a field added later is covered without a change here.
#[test]
fn every_field_changes_the_key_even_by_one_ulp() {
    let job = serde_json::to_value(full()).unwrap();
    let mut pointers = Vec::new();
    leaves(&job, "", &mut pointers);
    // A preset, a damping and a sliding speed stand for values of other fields.
    let in_job = |pointer: &str| {
        !["/preset", "/sliding_speed_m_s"].contains(&pointer) && !pointer.starts_with("/damping/")
    };
    for parameter in PARAMETERS.iter().filter(|parameter| in_job(parameter.pointer)) {
        let is_walked = |pointer: &String| {
            pointer
                .strip_prefix(parameter.pointer)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        assert!(pointers.iter().any(is_walked), "{} is not among {pointers:?}", parameter.pointer);
    }
    for pointer in pointers {
        let mut changed = job.clone();
        let field = changed.pointer_mut(&pointer).unwrap();
        let Some(value) = another(field, &pointer) else { continue };
        *field = value;
        let changed: JobSpec = serde_json::from_value(changed).unwrap();
        assert_ne!(changed, full(), "{pointer}");
        // The safety factor has no effect where the time step is given, as it is in this job.
        if pointer == "/numerics/safety_factor" {
            assert_eq!(key(&changed), key(&full()), "{pointer}");
            let automatic = |spec: &JobSpec| {
                let mut spec = spec.clone();
                spec.numerics.time_step_s = None;
                key(&spec)
            };
            assert_ne!(automatic(&changed), automatic(&full()), "{pointer} of an automatic time step");
            continue;
        }
        // There are no eigenvalues and no coarser mesh for such a scene.
        if ["/stability", "/run/start"].contains(&pointer.as_str()) {
            assert_eq!(key(&changed), key(&full()), "{pointer}");
            continue;
        }
        // A cylinder has a diameter in place of these edges.
        if ["/scene/pin/size_m/0", "/scene/pin/size_m/1"].contains(&pointer.as_str()) {
            assert_eq!(key(&changed), key(&full()), "{pointer}");
            let block = |spec: &JobSpec| {
                let mut spec = spec.clone();
                spec.scene.pin.shape = Shape::Block;
                key(&spec)
            };
            assert_ne!(block(&changed), block(&full()), "{pointer} of a block");
            continue;
        }
        // The exponential law of this job uses neither the length nor the table.
        let user = [
            ("/scene/contact/length_m", FrictionLaw::PrakashClifton),
            ("/scene/contact/mu_of_speed/", FrictionLaw::Table),
        ];
        if let Some((_, law)) = user.into_iter().find(|(field, _)| pointer.starts_with(field)) {
            assert_eq!(key(&changed), key(&full()), "{pointer}");
            let with_law = |spec: &JobSpec| {
                let mut spec = spec.clone();
                spec.scene.contact.law = law;
                key(&spec)
            };
            assert_ne!(with_law(&changed), with_law(&full()), "{pointer} of a law that uses it");
            continue;
        }
        assert_ne!(key(&changed), key(&full()), "{pointer}");
    }
    assert_ne!(key(&full()), key(&JobSpec::default()), "a given time step is not the automatic one");
}

/// Protects: the time step is part of modes exactly where they depend on it, with β₂ > ½.
#[test]
fn the_time_step_counts_where_modes_depend_on_it() {
    let with = |beta2, safety_factor| {
        let mut spec = JobSpec { stability: StabilityMethod::Modes, ..JobSpec::default() };
        (spec.numerics.beta2, spec.numerics.safety_factor) = (beta2, safety_factor);
        key(&spec)
    };
    assert_eq!(with(0.5, 0.7), with(0.5, 0.35));
    assert_ne!(with(0.6, 0.7), with(0.6, 0.35));
}

/// Protects: a law of large strains is no part of a job with small ones, so that a grid can compare both.
#[test]
fn a_law_without_large_strains_does_not_change_the_key() {
    let pin = |fields: &str| key_of(&format!(r#"{{ "scene": {{ "pin": {{ {fields} }} }} }}"#));
    let law = r#""material": "st_venant_kirchhoff""#;
    assert_eq!(pin(law), pin(""));
    let finite = r#""strains": "finite""#;
    assert_ne!(pin(&format!("{finite}, {law}")), pin(finite));
    assert_ne!(pin(finite), pin(""));
}

/// Protects: a start and a method of stability that have no effect are no part of a job: a mesh that is too coarse for a
/// coarser one, and scenes without eigenvalues.
#[test]
fn ways_without_effect_do_not_change_the_key() {
    let with = |elements, start, stability, kind| {
        let mut spec = JobSpec { stability, ..JobSpec::default() };
        (spec.scene.pin.elements, spec.run.start, spec.scene.disk.kind) = (elements, start, kind);
        key(&spec)
    };
    let (simulate, rigid) = (StabilityMethod::Simulate, DiskKind::Rigid);
    let nested = |elements, start| with(elements, start, simulate, rigid);
    assert_eq!(nested([12, 15, 10], Start::Nested), nested([12, 15, 10], Start::Rest));
    assert_ne!(nested([12, 15, 11], Start::Nested), nested([12, 15, 11], Start::Rest));
    // Five elements are enough to compare with, and too few to start from.
    assert_eq!(nested([12, 15, 8], Start::Compared), nested([12, 15, 8], Start::Rest));
    assert_ne!(nested([12, 15, 10], Start::Compared), nested([12, 15, 10], Start::Rest));
    let modes = |start| with([24, 30, 20], start, StabilityMethod::Modes, rigid);
    assert_ne!(modes(Start::Nested), modes(Start::Rest));
    let asking = |start| {
        let mut spec = JobSpec { accuracy: Some(Accuracy { mu_star: 0.01 }), ..JobSpec::default() };
        (spec.scene.pin.elements, spec.run.start) = ([24, 30, 20], start);
        key(&spec)
    };
    assert_eq!(asking(Start::Compared), asking(Start::Rest));
    assert_ne!(asking(Start::Nested), asking(Start::Rest));
    // Modes have no accuracy, so that only their start asks for the coarser mesh.
    let modes_asking = |start| {
        let mut spec = JobSpec { accuracy: Some(Accuracy { mu_star: 0.01 }), ..JobSpec::default() };
        spec.stability = StabilityMethod::Modes;
        (spec.scene.pin.elements, spec.run.start) = ([24, 30, 20], start);
        key(&spec)
    };
    assert_ne!(modes_asking(Start::Compared), modes_asking(Start::Rest));
    let decided = |kind, stability| with([12, 15, 10], Start::Rest, stability, kind);
    let elastic = DiskKind::Elastic;
    assert_eq!(decided(elastic, StabilityMethod::Eigenvalues), decided(elastic, simulate));
    assert_ne!(decided(rigid, StabilityMethod::Eigenvalues), decided(rigid, simulate));
}

/// Protects: coefficients that a law does not use are no part of a job.
#[test]
fn unused_coefficients_do_not_change_the_key() {
    let with = |law, mu_static, length_m| {
        let mut spec = JobSpec::default();
        spec.scene.contact = Contact { law, mu_static, length_m, ..Contact::default() };
        key(&spec)
    };
    assert_eq!(with(FrictionLaw::Coulomb, Some(0.5), Some(1.0e-6)), key(&JobSpec::default()));
    let two = |mu_static, length_m| with(FrictionLaw::StaticKinetic, mu_static, length_m);
    assert_eq!(two(Some(0.5), Some(1.0e-6)), two(Some(0.5), None));
    assert_ne!(two(Some(0.5), None), two(Some(0.6), None));
}

/// Protects: an angle, a mass, an inertia or a damper of 0 is none, so that both are the same job. A field that is added to the holder
/// and forgotten among them is found.
#[test]
fn nothing_is_the_same_as_no_value() {
    let mut spec = JobSpec::default();
    spec.scene.holder.stiffness_x_n_m = Some(2.0e7);
    spec.scene.holder.stiffness_y_n_m = Some(2.0e7);
    let job = serde_json::to_value(&spec).unwrap();
    let is_absent = |pointer: &str| job.pointer(pointer).is_none_or(Value::is_null);
    let of_holder = PARAMETERS.iter().map(|parameter| parameter.pointer);
    // A stiffness of 0 lets the holder move, and none holds it.
    let of_holder =
        of_holder.filter(|pointer| pointer.starts_with("/scene/holder/") && !pointer.contains("stiffness"));
    let others = ["/scene/pin/tilt_x_deg", "/scene/pin/tilt_y_deg", "/numerics/alpha_r_per_s"];
    let pointers: Vec<&str> = of_holder.chain(others).collect();
    assert_eq!(pointers.len(), 11);
    for pointer in pointers {
        assert!(is_absent(pointer), "{pointer}");
        let with = |value: f64| {
            let mut changed = job.clone();
            let (parent, name) = pointer.rsplit_once('/').unwrap();
            changed.pointer_mut(parent).unwrap()[name] = json!(value);
            key(&serde_json::from_value(changed).unwrap())
        };
        assert_eq!(with(0.0), key(&spec), "{pointer}");
        assert_ne!(with(1.0), key(&spec), "{pointer}");
    }
}

/// Protects: run-out and waviness of no height, and roughness of no height, are no part of a job.
#[test]
fn surfaces_without_height_do_not_change_the_key() {
    let mut spec = JobSpec::default();
    spec.scene.disk.runout_m = Some(0.0);
    spec.scene.disk.waviness_height_m = Some(0.0);
    spec.scene.disk.waviness_count = Some(30);
    spec.scene.pin.base.roughness = Some(Roughness::default());
    assert_eq!(key(&spec), key(&JobSpec::default()));
    spec.scene.disk.waviness_height_m = Some(1.0e-6);
    assert_ne!(key(&spec), key(&JobSpec::default()));
}

/// Protects: every number of a program is a part of the key, what looks for a steady state is not, and a job without a program has
/// the key of before, also if it is written as an empty object.
#[test]
fn a_program_changes_the_key() {
    let with = |omega: &str, rest: &str| {
        key_of(&format!(
            r#"{{ "scene": {{ "program": {{ "omega_rpm": {omega} }} }}, "run": {{ "limit_s": 0.04 {rest} }} }}"#
        ))
    };
    let own = with("[[0, 1], [0.01, 9]]", "");
    for other in [
        "[[0, 1], [0.02, 9]]",
        "[[0, 2], [0.01, 9]]",
        "[[0, 1], [0.01, 8]]",
        "[[0, 1], [0.01, 9], [0.02, 9]]",
    ] {
        assert_ne!(with(other, ""), own, "{other}");
    }
    assert_ne!(with("[[0, 1], [0.01, 9]]", r#", "window_s": 0.001"#), own);
    assert_eq!(with("[[0, 1], [0.01, 9]]", r#", "stop_early": false, "average_last_fraction": 0.2"#), own);
    assert_eq!(key_of(r#"{ "scene": { "program": {} } }"#), key(&JobSpec::default()));
}

/// Protects: the precision is part of a job.
#[test]
fn the_precision_changes_the_key() {
    let mut single = JobSpec::default();
    single.numerics.precision = Precision::Single;
    assert_ne!(key(&single), key(&JobSpec::default()));
}

#[test]
fn the_solver_version_changes_the_key() {
    assert_ne!(job_key(&full(), "1"), job_key(&full(), "2"));
    let expand = |version| parse("{}").expand(version).unwrap().remove(0).key;
    assert_eq!(expand("1"), job_key(&JobSpec::default(), "1"));
    assert_ne!(expand("1"), expand("2"));
}

#[test]
fn the_spelling_of_a_number_does_not_change_the_key() {
    let mu = |text: &str| key_of(&format!(r#"{{ "scene": {{ "disk": {{ "omega_rpm": {text} }} }} }}"#));
    assert_eq!(mu("7"), mu("7.0"));
    assert_eq!(mu("7"), mu("0.7e1"));
    let in_grid = |text: &str| key_of(&format!(r#"{{ "grid": {{ "omega_rpm": [{text}] }} }}"#));
    assert_eq!(in_grid("7"), mu("7.0"));
    let beta_r = |text: &str| key_of(&format!(r#"{{ "numerics": {{ "beta_r_s": {text} }} }}"#));
    assert_eq!(beta_r("0.0"), beta_r("-0.0"));
    assert_eq!(beta_r("0"), beta_r("-0.0"));
    assert_ne!(beta_r("0.0"), beta_r("7"));
}

#[test]
fn how_and_where_a_job_is_written_does_not_change_the_key() {
    let plain = key_of(r#"{ "scene": { "contact": { "mu": 0.2 }, "load": { "force_n": 20 } } }"#);
    let reordered = r#"{ "description": "d", "scene": { "load": { "force_n": 20 }, "contact": { "mu": 0.2 } }, "name": "n" }"#;
    assert_eq!(key_of(reordered), plain);
    assert_eq!(key_of(r#"{ "grid": { "load_n": [20], "mu": [0.2] } }"#), plain);
    let default_written =
        r#"{ "scene": { "contact": { "mu": 0.2 }, "load": { "force_n": 20, "ramp_s": 5e-4 } } }"#;
    assert_eq!(key_of(default_written), plain);
    let range = parse(r#"{ "grid": { "mu": { "from": 0.1, "to": 0.6, "count": 6 } } }"#);
    let listed = parse(r#"{ "grid": { "mu": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6] } }"#);
    let keys = |study: &tribosweep::study::Study| {
        study.expand("1").unwrap().into_iter().map(|job| job.key).collect::<Vec<_>>()
    };
    assert_eq!(keys(&range), keys(&listed));
}

#[test]
fn the_width_of_a_whole_top_clamp_does_not_change_the_key() {
    let with = |side, width_m| {
        let mut spec = JobSpec::default();
        spec.scene.clamp.side = side;
        spec.scene.clamp.width_m = width_m;
        key(&spec)
    };
    assert_eq!(with(ClampSide::WholeTop, 0.001), with(ClampSide::WholeTop, 0.005));
    assert_ne!(with(ClampSide::BothEnds, 0.001), with(ClampSide::BothEnds, 0.005));
    assert_ne!(with(ClampSide::WholeTop, 0.001), with(ClampSide::InnerSide, 0.001));
}

#[test]
fn the_ring_of_a_rigid_disk_does_not_change_the_key() {
    let with = |kind, young_modulus_pa| {
        let mut spec = JobSpec::default();
        spec.scene.disk.kind = kind;
        spec.scene.disk.ring.young_modulus_pa = young_modulus_pa;
        key(&spec)
    };
    assert_eq!(with(DiskKind::Rigid, 2.1e11), with(DiskKind::Rigid, 7.0e10));
    assert_ne!(with(DiskKind::Elastic, 2.1e11), with(DiskKind::Elastic, 7.0e10));
    assert_ne!(with(DiskKind::Rigid, 2.1e11), with(DiskKind::Elastic, 2.1e11));
}

/// Protects: a key has the fields that have an effect and not the values that keys leave out, so that a new field changes no key of a
/// job that does not use it. A default value that has changed since is in the key, and its first value still is not.
#[test]
fn a_key_has_what_is_not_left_out() {
    let hash = |text: &str| blake3::hash(text.as_bytes()).to_hex()[..32].to_owned();
    assert_eq!(key(&JobSpec::default()), hash(r#""1"{"numerics":{"beta_r_s":2.75e-8}}"#));
    let mut spec = with_elastic_disk();
    spec.scene.contact.mu = 0.2;
    spec.numerics.safety_factor = 0.5;
    spec.numerics.beta_r_s = 5.0e-8;
    let text =
        r#""1"{"numerics":{"time_step_s":1e-8},"scene":{"contact":{"mu":0.2},"disk":{"kind":"elastic"}}}"#;
    assert_eq!(key(&spec), hash(text));
}

/// Protects: a job has the same key whether a default value is given or left out, also beside fields that have other values.
#[test]
fn a_given_default_does_not_change_the_key() {
    let defaults = serde_json::to_value(JobSpec::default()).unwrap();
    let others = serde_json::to_value(full()).unwrap();
    let key_of_json = |job: &Value| key(&serde_json::from_value(job.clone()).unwrap());
    let mut given = 0;
    for parameter in PARAMETERS.iter().filter(|parameter| parameter.part().is_some()) {
        let name = parameter.name;
        let (parent, field) = parameter.pointer.rsplit_once('/').unwrap();
        // A field without a default value is absent from a job that does not give it.
        let Some(default) = defaults.pointer(parameter.pointer).filter(|value| !value.is_null()) else {
            continue;
        };
        let text = json!({ "grid": { name: [default] } }).to_string();
        assert_eq!(key_of(&text), key(&JobSpec::default()), "{name}");
        given += 1;
        // An entry of a list cannot be left out.
        let mut left_out = others.clone();
        let Some(Value::Object(fields)) = left_out.pointer_mut(parent) else { continue };
        fields.remove(field);
        let mut with_default = left_out.clone();
        with_default.pointer_mut(parent).unwrap()[field] = default.clone();
        assert_eq!(key_of_json(&left_out), key_of_json(&with_default), "{name}");
    }
    // 45 fields have a default value today.
    assert!(given > 40, "{given}");
}

/// Protects: keys are stored, and values that they leave out must stay what they are under a version of the solver. Where a default value
/// changes, its first value is left out of keys still (`left_out` of src/application/study/key.rs), and the new text belongs here.
#[test]
fn the_defaults_are_known() {
    let text = concat!(
        r#"{"detection":{"cycles":20,"decay_observation_s":0.008,"drift_tolerance":0.001,"regime_threshold":0.03,"tolerance":0.01},"#,
        r#""numerics":{"beta2":0.5,"beta_r_s":2.75e-8,"precision":"double","safety_factor":0.7},"#,
        r#""run":{"average_last_fraction":0.4,"limit_s":0.04,"start":"rest","stop_early":true},"#,
        r#""scene":{"clamp":{"side":"inner_side","width_m":0.001},"contact":{"law":"coulomb","mu":0.4},"#,
        r#""disk":{"kind":"rigid","omega_rpm":7.0,"ring":{"clock":"own","coarse_element_size_m":0.012,"density_kg_m3":7800.0,"#,
        r#""element_size_m":0.0025,"inner_radius_m":0.07,"outer_radius_m":0.12,"poisson_ratio":0.3,"target":"bilinear","#,
        r#""thickness_m":0.085,"track_arc_deg":25.0,"young_modulus_pa":210000000000.0},"track_radius_m":0.0914},"#,
        r#""holder":{},"load":{"force_n":30.0,"ramp_s":0.0005},"pin":{"base":{},"density_kg_m3":2500.0,"elements":[12,15,10],"#,
        r#""poisson_ratio":0.3,"size_m":[0.012,0.015,0.01],"young_modulus_pa":1000000000.0},"top":"tied_in_z"},"#,
        r#""stability":"simulate"}"#,
    );
    let expected: Value = serde_json::from_str(text).unwrap();
    let defaults = serde_json::to_value(JobSpec::default()).unwrap();
    assert_eq!((tribosweep::solver::VERSION, defaults), ("10", expected));
}
