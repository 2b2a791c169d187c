//! Protects: doubtful studies are accepted with a warning that names the reason, and ordinary ones have no warning.

use super::{assert_contains, parse, refusal, shipped};
use tribosweep::spec::StabilityMethod;
use tribosweep::spec::elasticity::LOCKING_POISSON_RATIO;
use tribosweep::study::{Study, Warning, job_warnings};

fn warnings(text: &str) -> Vec<Warning> {
    parse(text).warnings()
}

/// A study of a scene, with a time that serves heavy and soft pins.
fn of_scene(scene: &str) -> String {
    format!(r#"{{ "scene": {{ {scene} }}, "detection": {{ "decay_observation_s": 0.1 }} }}"#)
}

/// The only warning about a scene.
fn only(scene: &str) -> Warning {
    let mut found = warnings(&of_scene(scene));
    assert_eq!(found.len(), 1, "{scene}: {found:#?}");
    found.remove(0)
}

/// Protects: no study that comes with the program is doubtful.
#[test]
fn shipped_studies_are_not_doubtful() {
    for file in shipped::files() {
        let study = Study::load(&file).unwrap();
        assert_eq!(study.warnings(), [], "{}", file.display());
    }
    assert_eq!(warnings("{}"), []);
}

/// Protects: large strains are named with their size, from one per cent on and not below.
#[test]
fn large_strains_are_named() {
    // F/(E A) with A = 1.8e-4 m².
    let warning = only(r#""load": { "force_n": 30000 }"#);
    assert_eq!((warning.kind, warning.jobs), ("strain", 1));
    let expected = "studies/x.json:1:35: scene.load.force_n = 30000: the mean strain F/(E A) of the pin is 16.7 %; \
                    no material is linear elastic";
    assert_contains(&warning.to_string(), &[expected, "check the units of the load [N]"]);
    assert_contains(&warning.in_words(), &["scene.load.force_n = 30000: the mean strain"]);
    assert!(!warning.in_words().contains("x.json"));
    assert_contains(
        &only(r#""load": { "force_n": 1810 }"#).to_string(),
        &["1.01 %", "holds for small strains"],
    );
    assert_eq!(warnings(r#"{ "scene": { "load": { "force_n": 1790 } } }"#), []);
    // Large strains are computed where they are asked for, up to those that few materials bear.
    let finite = |force_n: u32| {
        format!(
            r#"{{ "scene": {{ "load": {{ "force_n": {force_n} }}, "pin": {{ "strains": "finite" }} }} }}"#
        )
    };
    assert_eq!(warnings(&finite(30_000)), []);
    assert_contains(&warnings(&finite(100_000))[0].to_string(), &["55.6 %", "few materials follow"]);
    // A soft pin: what the study gives is named, and not the load that it leaves out.
    let soft = only(r#""pin": { "young_modulus_pa": 1e7 }"#).to_string();
    assert_contains(&soft, &["1:43: scene.pin.young_modulus_pa = 1e7: the mean strain", "1.67 %"]);
}

/// Protects: a load under which the whole pin flows is named, and a yield stress that no metal has.
#[test]
fn yielding_pins_are_plausible() {
    let of = |force_n: u32, yield_stress_pa: &str| {
        warnings(&format!(
            r#"{{ "scene": {{ "load": {{ "force_n": {force_n} }}, "pin": {{ "strains": "finite", "material": "j2",
                "young_modulus_pa": 7e10, "plasticity": {{ "yield_stress_pa": {yield_stress_pa} }} }} }} }}"#
        ))
    };
    assert_eq!(of(17_000, "1e8"), []);
    // 1.8e-4 m² of 1e8 Pa bear 18 kN.
    assert_contains(
        &of(36_000, "1e8")[0].to_string(),
        &["the mean pressure is 2 times the yield stress", "the whole section flows"],
    );
    assert_contains(&of(100, "7e9")[0].to_string(), &["an elastic strain of 10 %", "check the units"]);
}

/// Protects: values that look like another unit are named with the unit that is expected, one warning for each.
#[test]
fn other_units_are_named() {
    for (scene, expected) in [
        (
            r#""pin": { "young_modulus_pa": 5e12 }"#,
            ["young_modulus_pa = 5e12: stiffer than diamond", "expected Pa"],
        ),
        (r#""pin": { "density_kg_m3": 2.5 }"#, ["density_kg_m3 = 2.5: lighter than cork", "expected kg/m³"]),
        (r#""pin": { "density_kg_m3": 30000 }"#, ["density_kg_m3 = 30000: heavier", "expected kg/m³"]),
        (r#""disk": { "track_radius_m": 91.4 }"#, ["track_radius_m = 91.4: a length of a metre", "mm"]),
        (
            r#""disk": { "track_radius_m": 0.009 }"#,
            ["track_radius_m = 0.009: less than the longest edge", "0.015 m"],
        ),
        (r#""contact": { "mu": 40 }"#, ["contact.mu = 40: an unusually large", "per cent"]),
        (r#""disk": { "omega_rpm": 70000, "track_radius_m": 0.02 }"#, ["omega_rpm = 70000: ", "147 m/s"]),
    ] {
        let found = warnings(&of_scene(scene));
        assert_eq!(
            found.iter().map(|warning| warning.kind).collect::<Vec<_>>(),
            ["unit"],
            "{scene}: {found:?}"
        );
        assert_contains(&found[0].to_string(), &expected);
    }
}

/// Protects: a modulus in GPa is the reason that is named first, although it also makes a time too short, and no
/// consequence of it becomes a warning.
#[test]
fn a_modulus_in_gpa_is_named_as_the_reason() {
    let gpa = |given: &str| format!(r#"{{ "scene": {{ "pin": {{ "young_modulus_pa": {given} }} }} }}"#);
    let named = |text: &str| -> String {
        match Study::parse(text, "studies/x.json") {
            Ok(study) => study.warnings().iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"),
            Err(error) => error.to_string(),
        }
    };
    for given in ["1", "210", "2400"] {
        let text = named(&gpa(given));
        let expected = format!(
            "studies/x.json:1:43: scene.pin.young_modulus_pa = {given}: softer than any gel, as if it were in GPa or MPa; \
             expected Pa"
        );
        assert!(text.starts_with(&expected), "{text}");
        assert!(!text.contains("surface waves"), "{text}");
        // What follows from it is refused, and says how far the pin would be compressed.
        assert!(
            text.contains("scene.load.force_n = 30: expected a mean strain F/(E A) of the pin far below 1"),
            "{text}"
        );
    }
    // What is refused anyway has no second message.
    let text = refusal(&gpa("-1"));
    assert_eq!(text.matches("young_modulus_pa").count(), 1, "{text}");
}

/// Protects: a disk that is fast compared with waves in the pin is named, whether the speed or the material is the reason.
#[test]
fn sliding_near_a_wave_speed_is_named() {
    // The surface waves of the reference pin run at 364 m/s, and 36 m/s are 3800 rpm.
    let warning = only(r#""disk": { "omega_rpm": 4000 }"#);
    assert_eq!(warning.kind, "speed");
    assert_contains(
        &warning.to_string(),
        &["omega_rpm = 4000: the disk's surface moves at 38.3 m/s, 10.5 %"],
    );
    assert_eq!(warnings(r#"{ "scene": { "disk": { "omega_rpm": 3700 } } }"#), []);
}

/// Protects: Poisson's ratios near ½ are named from the measured threshold on, for both bodies.
#[test]
fn nearly_incompressible_bodies_are_named() {
    let pin = |nu: f64| format!(r#"{{ "scene": {{ "pin": {{ "poisson_ratio": {nu} }} }} }}"#);
    assert_eq!(warnings(&pin(LOCKING_POISSON_RATIO - 0.001)), []);
    let found = warnings(&pin(LOCKING_POISSON_RATIO));
    assert_eq!(found.iter().map(|warning| warning.kind).collect::<Vec<_>>(), ["locking"]);
    let disk = only(r#""disk": { "kind": "elastic", "ring": { "poisson_ratio": 0.495 } }"#);
    assert_contains(&disk.to_string(), &["scene.disk.ring.poisson_ratio = 0.495: ", "too stiff"]);
}

/// Protects: damping that decides about the time step is named with its effect on it.
#[test]
fn damping_that_shortens_the_step_is_named() {
    // β_R c/h with c = 734 m/s and h = 1 mm: 0.75 halves the step.
    let damped = |beta_r_s: f64| warnings(&format!(r#"{{ "numerics": {{ "beta_r_s": {beta_r_s:e} }} }}"#));
    assert_eq!(damped(1.0e-6), []);
    let found = damped(2.0e-6);
    assert_eq!(found.len(), 1, "{found:?}");
    // 2e-6 × 733.8 / 0.001 = 1.468, and √(1 + 1.468²) − 1.468 = 0.308.
    assert_contains(&found[0].to_string(), &["beta_r_s = 2e-6: ", "30.8 %", "β_R c/h is 1.47"]);
    // What the study gives is named, with its own value.
    let found = warnings(
        r#"{ "damping": { "ratio": 0.1, "frequency_hz": 15000 }, "grid": { "damping_ratio": [0.01, 0.1] } }"#,
    );
    assert_eq!(found.len(), 1, "{found:?}");
    assert_contains(
        &found[0].to_string(),
        &["damping.ratio = 0.1: damping shortens", "set by grid.damping_ratio[1]"],
    );
    let job = job_warnings(parse(r#"{ "damping": { "loss_factor": 0.2, "frequency_hz": 15000 } }"#).base());
    assert!(job[0].in_words().starts_with("numerics.beta_r_s = "), "{job:?}");
}

/// Protects: a frequency of the damping in kHz is named as the reason, and not what follows from it.
#[test]
fn a_damping_frequency_in_khz_is_named() {
    let given = |frequency: f64| {
        warnings(&format!(r#"{{ "damping": {{ "loss_factor": 0.04, "frequency_hz": {frequency} }} }}"#))
    };
    assert_eq!(given(15_000.0), []);
    let found = given(15.0);
    assert_eq!(found.iter().map(|warning| warning.kind).collect::<Vec<_>>(), ["unit"]);
    // ζ = 0.02 at 15 Hz is 1 at 750 Hz, and the pin's lowest vibrations have some kHz.
    assert_contains(
        &found[0].to_string(),
        &["damping.frequency_hz = 15: every vibration above 750 Hz", "1 kHz is 1000 Hz"],
    );
}

/// Protects: damping is not blamed for a density in another unit.
#[test]
fn damping_is_in_order_if_the_material_is_not() {
    let found = warnings(r#"{ "scene": { "pin": { "density_kg_m3": 2.5e-4 } } }"#);
    let fields: Vec<_> = found.iter().map(|warning| warning.problem.field.as_str()).collect();
    assert_eq!(fields, ["scene.pin.density_kg_m3"]);
}

/// Protects: a strip that is a single row of nodes, or the whole face, is named, and an ordinary one is not.
#[test]
fn a_clamp_that_is_no_strip_is_named() {
    let clamp = |side: &str, width: f64| {
        warnings(&of_scene(&format!(r#""clamp": {{ "side": "{side}", "width_m": {width} }}"#)))
    };
    assert_eq!(clamp("inner_side", 0.002), []);
    assert_eq!(clamp("both_sides", 0.005), []);
    assert_eq!(clamp("whole_top", 0.0), []);
    for (side, width, expected) in [
        ("inner_side", 0.0, "only the outermost row of nodes"),
        ("inner_side", 0.0117, "the whole top face"),
        ("inner_side", 0.012, "the whole top face"),
        ("both_sides", 0.006, "the whole top face"),
        ("leading_end", 0.015, "the whole top face"),
    ] {
        let found = clamp(side, width);
        assert_eq!(found.iter().map(|warning| warning.kind).collect::<Vec<_>>(), ["clamp"], "{side} {width}");
        assert_contains(&found[0].to_string(), &["scene.clamp.width_m = ", expected]);
    }
    let moved = clamp("inner_side", 0.0022);
    assert_contains(&moved[0].to_string(), &["width_m = 0.0022: this mesh holds a strip of 0.002 m"]);
    // The rows of a cylinder are as regular along its height as those of a block.
    let cylinder = r#""pin": { "shape": "cylinder", "diameter_m": 0.008, "size_m": [0.008, 0.008, 0.01], "elements": [8, 8, 10] },"#;
    for pin in ["", cylinder] {
        let collet = of_scene(&format!(r#"{pin} "clamp": {{ "side": "collet", "width_m": 0.0022 }}"#));
        let message = warnings(&collet)[0].to_string();
        assert_contains(&message, &["width_m = 0.0022: this mesh holds a length of 0.002 m"]);
    }
    // Two doubts about one field are two warnings.
    let both = warnings(r#"{ "grid": { "clamp_width_m": [0, 0.002, 0.012] } }"#);
    assert_eq!(
        both.iter().map(|warning| (warning.kind, warning.jobs)).collect::<Vec<_>>(),
        [("clamp", 1); 2]
    );
    assert_contains(
        &refusal(r#"{ "scene": { "clamp": { "width_m": 2 } } }"#),
        &[
            "scene.clamp.width_m = 2: expected a width in metres (1 mm is 0.001 m) of at most 0.012 m, the pin's edge in x",
        ],
    );
}

/// Protects: a doubt of many jobs is one warning with their number, the first and the worst, at the worst one's place.
#[test]
fn a_grid_has_one_warning_of_a_kind() {
    let found = warnings("{ \"grid\": { \"mu\": [0.2, 0.4],\n \"load_n\": [30, 3000, 6000] } }");
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].jobs, 4);
    let expected = [
        "studies/x.json:2:23: scene.load.force_n = 6000.0: the mean strain F/(E A) of the pin is 3.33 %",
        "set by grid.load_n[2]",
        "in 4 of 6 jobs, first at mu = 0.2, load_n = 3000.0, the worst is mu = 0.2, load_n = 6000.0",
    ];
    assert_contains(&found[0].to_string(), &expected);
}

/// Protects: jobs on a rigid disk that repeat others are counted, exactly those with the same ω/F and nothing else different.
#[test]
fn grids_that_repeat_themselves_are_counted() {
    let repeats = |grid: &str| -> Option<Warning> {
        let found = warnings(&format!(r#"{{ "grid": {{ {grid} }} }}"#));
        assert!(found.iter().all(|warning| warning.kind == "repetition") && found.len() < 2, "{found:?}");
        found.into_iter().next()
    };
    // ω/F: ⅓, ⅙, ⅑; ⅔, ⅓, 2/9; 1, ½, ⅓: the diagonal repeats twice. Twice that for two μ.
    let found = repeats(r#""mu": [0.2, 0.4], "omega_rpm": [10, 20, 30], "load_n": [30, 60, 90]"#).unwrap();
    assert_eq!(found.jobs, 4);
    let expected = [
        "studies/x.json:1:58: grid.omega_rpm × load_n: 4 of 18 jobs repeat others",
        "depend on ω/F alone",
        "mu = 0.2, omega_rpm = 20.0, load_n = 60.0 repeats mu = 0.2, omega_rpm = 10.0, load_n = 30.0",
        "stresses, displacements and speeds are in proportion to F",
    ];
    assert_contains(&found.to_string(), &expected);
    // Not in proportion, or only one of the two, or an elastic disk.
    assert_eq!(repeats(r#""omega_rpm": [10, 20], "load_n": [30, 50]"#), None);
    assert_eq!(repeats(r#""omega_rpm": [10, 20], "clamp_side": ["inner_side", "outer_side"]"#), None);
    assert_eq!(repeats(r#""disk_kind": ["elastic"], "omega_rpm": [10, 20], "load_n": [30, 60]"#), None);
    // Values whose quotients differ by rounding only.
    assert_eq!(repeats(r#""omega_rpm": [0.1, 0.3], "load_n": [10, 30]"#).unwrap().jobs, 1);
    // The modulus joins the group: ω E/F and ρ/E.
    let found =
        repeats(r#""young_modulus_pa": [1e9, 2e9], "density_kg_m3": [2500, 5000], "load_n": [30, 60]"#)
            .unwrap();
    assert_eq!(found.jobs, 1);
    assert_contains(&found.to_string(), &["ω E/F and ρ/E", "density_kg_m3 = 5000.0, load_n = 60.0 repeats"]);
}

/// Protects: a job by itself has the same doubts as a study of it, without a place.
#[test]
fn a_job_has_the_doubts_of_its_study() {
    let study = parse(r#"{ "scene": { "load": { "force_n": 30000 }, "pin": { "density_kg_m3": 2.5 } } }"#);
    let of_study: Vec<_> = study.warnings().iter().map(Warning::in_words).collect();
    let of_job: Vec<_> = job_warnings(study.base()).iter().map(Warning::in_words).collect();
    assert_eq!(of_study.len(), 2);
    assert_eq!(
        of_job.iter().map(|words| words.split(": ").nth(1)).collect::<Vec<_>>(),
        of_study.iter().map(|words| words.split(": ").nth(1)).collect::<Vec<_>>()
    );
}

/// Protects: a diameter in mm, and a holder in g or kN/mm, are named as such, and a usual holder is not.
#[test]
fn diameters_and_holders_in_other_units_are_named() {
    let text =
        refusal(&of_scene(r#""pin": { "shape": "cylinder", "diameter_m": 8, "elements": [12, 12, 10] }"#));
    assert!(
        text.starts_with("studies/x.json:1:")
            && text.contains("scene.pin.diameter_m = 8: a length of a metre or more, as if it were in mm"),
        "{text}"
    );
    let warning = only(r#""holder": { "mass_kg": 8, "stiffness_y_n_m": 50 }"#);
    assert_eq!(warning.kind, "unit");
    // √(50/8)/2π Hz.
    assert_contains(&warning.to_string(), &["scene.holder.stiffness_y_n_m = 50: ", "swings at 0.398 Hz"]);
    let heavy = only(r#""holder": { "mass_kg": 20, "stiffness_y_n_m": 5e6 }"#).to_string();
    assert_contains(&heavy, &["scene.holder.mass_kg = 20: ", "as if it were in g", "1 g is 0.001 kg"]);
    assert_eq!(warnings(&of_scene(r#""holder": { "mass_kg": 0.08, "stiffness_y_n_m": 5e6 }"#)), []);
}

/// Protects: a limit of time in which the holder cannot swing once is named, with the time that it takes; a longer one is not.
#[test]
fn a_run_shorter_than_a_swing_of_the_holder_is_named() {
    let with = |limit_s: f64| {
        warnings(&format!(
            r#"{{ "scene": {{ "holder": {{ "mass_kg": 0.1, "stiffness_y_n_m": 1e4 }} }}, "run": {{ "limit_s": {limit_s} }} }}"#
        ))
    };
    // 2π √(0.1045 kg/1e4 N/m) with the mass of the pin, 4.5 g.
    let found = with(0.015);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_contains(
        &found[0].to_string(),
        &[
            "run.limit_s = 0.015: the run is at most 0.015 s long",
            "up to 0.0203 s",
            "hardly any run can become periodic",
        ],
    );
    assert_eq!(with(0.03).len(), 1);
    assert_eq!(with(0.045), []);
    // Friction that rises with the speed is slow without a holder, too, and there the warning would be wrong.
    let creeps = r#"{ "scene": { "contact": { "law": "regularised", "mu": 0.8, "speed_m_s": 0.5 }, "pin": { "young_modulus_pa": 5e6 },
        "load": { "force_n": 5 } }, "run": { "limit_s": 0.0015 } }"#;
    assert!(warnings(creeps).iter().all(|own| own.kind != "holder_time"), "{:?}", warnings(creeps));
}

/// Protects: who asks for a mesh error on a mesh that has no coarser one is told so, whether there is a run or only modes.
#[test]
fn an_error_without_a_coarser_mesh_is_named() {
    let study = |nz: u32| {
        parse(&format!(
            r#"{{ "scene": {{ "pin": {{ "elements": [12, 15, {nz}] }} }}, "run": {{ "start": "compared" }} }}"#
        ))
    };
    for method in [StabilityMethod::Simulate, StabilityMethod::Modes] {
        let kinds = |nz: u32| {
            let mut job = study(nz).base().clone();
            job.stability = method;
            job_warnings(&job).into_iter().map(|warning| warning.kind).collect::<Vec<_>>()
        };
        // Half as many elements are five and four.
        assert_eq!(kinds(10), [""; 0]);
        assert_eq!(kinds(8), ["mesh_error"], "{method:?}");
    }
}

/// Protects: elements of an elastic disk that are larger than the pin's base are named, and those of the shipped study are not.
#[test]
fn a_disk_with_few_elements_under_the_pin_is_named() {
    let of_size = |size_m: f64| {
        let ring = format!(r#""ring": {{ "element_size_m": {size_m}, "coarse_element_size_m": 0.05 }}"#);
        warnings(&of_scene(&format!(r#""disk": {{ "kind": "elastic", {ring} }}"#)))
    };
    let [warning] = of_size(0.013).try_into().unwrap();
    assert_eq!(warning.kind, "disk_mesh");
    assert_contains(
        &warning.to_string(),
        &["scene.disk.ring.element_size_m = 0.013: ", "larger than the pin's base of 0.012 m"],
    );
    assert_eq!(of_size(0.0025), []);
}

/// Protects: edges that a cylinder does not use are named where the study gives them, and a static coefficient below the kinetic one is.
#[test]
fn values_that_contradict_each_other_are_named() {
    let cylinder = |size: &str| {
        let pin = format!(
            r#""pin": {{ "shape": "cylinder", "diameter_m": 0.008, "elements": [12, 12, 10]{size} }}, "clamp": {{ "side": "whole_top" }}"#
        );
        warnings(&of_scene(&pin))
    };
    assert_eq!(cylinder(""), []);
    assert_eq!(cylinder(r#", "size_m": [0.008, 0.008, 0.012]"#), []);
    // Also the edges of the reference pin, if somebody gives them.
    let found = cylinder(r#", "size_m": [0.012, 0.015, 0.012]"#);
    assert_eq!(found.iter().map(|warning| warning.kind).collect::<Vec<_>>(), ["size"]);
    assert_contains(
        &found[0].to_string(),
        &["size_m = [0.012, 0.015, 0.012]: a cylinder uses the height", "0.008 m"],
    );

    let friction = |law: &str, mu_static: f64| {
        warnings(&of_scene(&format!(
            r#""contact": {{ "law": "{law}", "mu": 0.35, "mu_static": {mu_static}, "speed_m_s": 0.1 }}"#
        )))
    };
    assert_eq!(friction("exponential", 0.35), []);
    assert_contains(
        &friction("static_kinetic", 0.25)[0].to_string(),
        &["mu_static = 0.25: less than mu = 0.35", "exchanged"],
    );
    // Coulomb's law has no such coefficient: it has no effect, and the two are not exchanged.
    let kinds: Vec<_> = friction("coulomb", 0.25).iter().map(|warning| warning.kind).collect();
    assert_eq!(kinds, ["unused"; 2]);
}

/// Protects: what costs time and changes no result is no doubt about the result.
#[test]
fn cost_is_no_doubt() {
    let about = |text: &str| {
        warnings(text).iter().map(|warning| (warning.kind, warning.is_doubt())).collect::<Vec<_>>()
    };
    assert_eq!(about(r#"{ "numerics": { "beta_r_s": 2e-6 } }"#), [("damping", false)]);
    assert_eq!(
        about(r#"{ "grid": { "omega_rpm": [10, 20], "load_n": [30, 60] } }"#),
        [("repetition", false)]
    );
    assert_eq!(about(&of_scene(r#""load": { "force_n": 30000 }"#)), [("strain", true)]);
}

/// Protects: a load that would compress the pin to nothing is refused in a new study, and a database that has one is still read.
#[test]
fn a_pin_compressed_to_nothing_is_refused() {
    let study = |force: f64| format!(r#"{{ "name": "x", "scene": {{ "load": {{ "force_n": {force} }} }} }}"#);
    // E A of the reference pin is 180 kN.
    assert!(Study::parse(&study(179_000.0), "x").is_ok());
    assert_contains(&refusal(&study(181_000.0)), &["mean strain", "it is 1.01", "E = 1e9 Pa"]);
    assert!(Study::parse_stored(&study(181_000.0), "x", None).is_ok());
}

/// Protects: names that make trouble are refused before anything runs, with one that is possible; stored ones are read.
#[test]
fn bad_names_get_an_offer() {
    let named = |name: &str| format!(r#"{{ "name": "{name}" }}"#);
    assert_contains(&refusal(&named("Messung Ü")), &["name = \"Messung Ü\"", "`Messung-Ue` is possible"]);
    assert_contains(&refusal(&named(&"x".repeat(300))), &["300 letters", "at most 200"]);
    for name in ["-rf", "con", &"x".repeat(300)] {
        refusal(&named(name));
        assert!(Study::parse_stored(&named(name), name, None).is_ok(), "{name}");
    }
}

/// Protects: a coefficient that the friction law does not use is named, with the laws that use it; a grid over laws, one of which uses it, is
/// silent, and so is a job of such a grid.
#[test]
fn coefficients_without_effect_are_named() {
    let warning = only(r#""contact": { "mu": 0.4, "mu_static": 0.5 }"#);
    assert_eq!((warning.kind, warning.jobs), ("unused", 1));
    let expected = "scene.contact.mu_static = 0.5: without effect: the friction law coulomb does not use it";
    assert_contains(
        &warning.to_string(),
        &[expected, "the laws static_kinetic, exponential: give scene.contact.law"],
    );
    let of_laws = |laws: &str| {
        parse(&format!(
            r#"{{ "scene": {{ "contact": {{ "mu_static": 0.5, "speed_m_s": 0.02 }} }}, "grid": {{ "friction_law": {laws} }} }}"#
        ))
    };
    let study = of_laws(r#"["coulomb", "exponential"]"#);
    assert_eq!(study.warnings(), []);
    let job = study.single(&[("friction_law".to_owned(), "coulomb".to_owned())]).unwrap();
    assert_eq!(study.warnings_of(&job), []);
    let found = of_laws(r#"["coulomb", "regularised"]"#).warnings();
    assert_eq!(found.len(), 1, "{found:?}");
    assert_contains(
        &found[0].to_string(),
        &["mu_static = 0.5", "the friction laws coulomb, regularised do not use it"],
    );
    // In a grid, and in a single job that is given a coefficient.
    let found = warnings(r#"{ "grid": { "mu_static": [0.5, 0.6] } }"#);
    assert_eq!(found.iter().map(|warning| (warning.kind, warning.jobs)).collect::<Vec<_>>(), [("unused", 2)]);
    let study = parse("{}");
    let job = study.single(&[("mu_static".to_owned(), "0.5".to_owned())]).unwrap();
    assert_contains(
        &study.warnings_of(&job)[0].in_words(),
        &["scene.contact.mu_static = 0.5: without effect"],
    );
    // A slope of zero is one that its law uses.
    let law = r#""law": "exponential", "mu_static": 0.5, "speed_m_s": 0.05, "slope_s_m": 0"#;
    assert_eq!(warnings(&of_scene(&format!(r#""contact": {{ {law} }}"#))), []);
}
