//! Protects: a study file says whether eigenvalues or the run decide that sliding is stable. Modes without a run are for the
//! command `stability` alone.

use super::{assert_contains, parse, refusal};
use tribosweep::spec::{DiskKind, FrictionLaw, JobSpec, Precision, Shape, StabilityMethod};
use tribosweep::study::{Changes, Preset, Study, inputs, job_key};

fn method(text: &str) -> StabilityMethod {
    parse(text).base().stability
}

/// Changes that set parameters (name, value).
fn set(settings: &[(&str, &str)]) -> Changes {
    let settings = settings.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
    Changes { settings, ..Changes::default() }
}

#[test]
fn eigenvalues_decide_unless_the_study_says_otherwise() {
    assert_eq!(method("{}"), StabilityMethod::Simulate);
    assert_eq!(method(r#"{ "stability": "eigenvalues" }"#), StabilityMethod::Eigenvalues);
    assert_eq!(method(r#"{ "stability": "simulate" }"#), StabilityMethod::Simulate);
    let both = parse(r#"{ "grid": { "stability": ["simulate", "eigenvalues"] } }"#).expand("1").unwrap();
    assert_eq!(
        both.iter().map(|job| job.spec.stability.name()).collect::<Vec<_>>(),
        ["simulate", "eigenvalues"]
    );
    let changed = Study::parse_changed("{}", "x.json", &set(&[("stability", "simulate")])).unwrap();
    assert_eq!(changed.base().stability, StabilityMethod::Simulate);
    assert_contains(&changed.document(), &["\"stability\": \"simulate\""]);
}

#[test]
fn wrong_methods_are_refused_with_their_place() {
    for wrong in ["\"eigen\"", "3", "null", "[\"simulate\"]", "{ \"simulate\": null }"] {
        let text = format!("{{ \"stability\": {wrong} }}");
        assert_contains(&refusal(&text), &["studies/x.json:1:16: stability = ", "expected"]);
    }
    let typo = refusal(r#"{ "stability": "simulated" }"#);
    assert_contains(&typo, &["expected `eigenvalues` or `simulate`", "did you mean `simulate`?"]);
}

#[test]
fn modes_are_refused_with_advice() {
    let advice = "expected `eigenvalues` or `simulate`; the command `tribosweep stability` computes modes";
    let in_file = refusal(r#"{ "stability": "modes" }"#);
    assert_contains(&in_file, &["studies/x.json:1:16: stability = \"modes\": ", advice]);
    let in_grid = refusal(r#"{ "grid": { "stability": ["simulate", "modes"] } }"#);
    assert_contains(&in_grid, &["studies/x.json:1:39: stability = \"modes\": ", advice]);
    let set = Study::parse_changed("{}", "x.json", &set(&[("stability", "modes")])).unwrap_err().to_string();
    assert_contains(&set, &["--set: stability = \"modes\": ", advice]);
}

/// Protects: the study of the modes has the same points under another name, its document says what it is, and it is read
/// back from a database but not from a file.
#[test]
fn the_study_of_modes_has_the_points_of_the_study() {
    let text = r#"{ "grid": { "mu": [0.2, 0.4], "stability": ["simulate", "eigenvalues"] } }"#;
    let changes = Changes { is_of_modes: true, ..set(&[("omega_rpm", "[7, 20]")]) };
    let modes = Study::parse_changed(text, "x.json", &changes).unwrap();
    assert_eq!(modes.name(), "x-stability");
    let jobs = modes.expand("1").unwrap();
    assert_eq!(jobs.len(), 4);
    assert!(jobs.iter().all(|job| job.spec.stability == StabilityMethod::Modes));
    let names: Vec<_> = jobs[0].parameters.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["mu", "omega_rpm"]);
    let document = modes.document();
    assert_eq!(Study::parse_stored(&document, "x", None).unwrap().expand("1").unwrap(), jobs);
    assert_contains(&refusal(&document), &["stability = \"modes\""]);
}

/// Protects: what a job without a run does not use is not in its key, and not among its inputs. Otherwise the method is in
/// the key, unless every run goes to its limit.
#[test]
fn the_run_is_not_in_the_key_of_modes() {
    let key = |method, change: fn(&mut JobSpec)| {
        let mut spec = JobSpec { stability: method, ..JobSpec::default() };
        change(&mut spec);
        job_key(&spec, "1")
    };
    let run: [fn(&mut JobSpec); 7] = [
        |spec| spec.run.limit_s = 0.07,
        |spec| spec.run.stop_early = false,
        |spec| spec.detection.tolerance = 0.02,
        |spec| spec.numerics.safety_factor = 0.6,
        |spec| spec.numerics.time_step_s = Some(1.0e-7),
        |spec| spec.numerics.precision = Precision::Single,
        |spec| spec.scene.load.ramp_s = 0.001,
    ];
    for change in run {
        assert_eq!(key(StabilityMethod::Modes, change), key(StabilityMethod::Modes, |_| ()));
        for method in [StabilityMethod::Simulate, StabilityMethod::Eigenvalues] {
            assert_ne!(key(method, change), key(method, |_| ()));
        }
    }
    let physics: [fn(&mut JobSpec); 2] =
        [|spec| spec.scene.contact.mu = 0.3, |spec| spec.numerics.beta_r_s = 1.0e-7];
    for change in physics {
        assert_ne!(key(StabilityMethod::Modes, change), key(StabilityMethod::Modes, |_| ()));
    }
    let methods = [StabilityMethod::Simulate, StabilityMethod::Eigenvalues, StabilityMethod::Modes];
    for (i, one) in methods.into_iter().enumerate() {
        for other in methods.into_iter().skip(i + 1) {
            assert_ne!(key(one, |_| ()), key(other, |_| ()));
        }
    }
    let to_the_limit: fn(&mut JobSpec) = |spec| spec.run.stop_early = false;
    assert_eq!(key(StabilityMethod::Simulate, to_the_limit), key(StabilityMethod::Eigenvalues, to_the_limit));

    let names = |spec: &JobSpec| inputs(spec).iter().map(|input| input.parameter.name).collect::<Vec<_>>();
    assert!(names(&JobSpec::default()).contains(&"stability"));
    let modes = names(&JobSpec { stability: StabilityMethod::Modes, ..JobSpec::default() });
    assert!(modes.contains(&"stability") && modes.contains(&"beta_r_s"), "{modes:?}");
    assert!(!["limit_s", "tolerance", "safety_factor", "ramp_s"].iter().any(|name| modes.contains(name)));
}

/// Protects: modes are refused only where the equations of steady sliding do not hold, with the field and the reason; eigenvalues
/// decide only laws without a larger friction of slow slip; and presets choose them only for scenes on which they were measured.
#[test]
fn modes_cover_holders_laws_and_bases() {
    let spec = |change: &dyn Fn(&mut JobSpec)| {
        let mut spec = JobSpec { stability: StabilityMethod::Modes, ..JobSpec::default() };
        change(&mut spec);
        spec
    };
    let law = |law| {
        spec(&|spec| {
            let contact = &mut spec.scene.contact;
            (contact.law, contact.mu_static, contact.speed_m_s) = (law, Some(0.5), Some(0.1));
            contact.length_m = Some(1.0e-6);
        })
    };
    let holder = |stiffness_n_m| spec(&|spec| spec.scene.holder.stiffness_y_n_m = Some(stiffness_n_m));
    let crowned = spec(&|spec| spec.scene.pin.base.crown_radius_m = Some(5.0));
    let elastic = spec(&|spec| spec.scene.disk.kind = DiskKind::Elastic);
    let cylinder = spec(&|spec| {
        let pin = &mut spec.scene.pin;
        (pin.shape, pin.diameter_m, pin.elements) = (Shape::Cylinder, Some(0.01), [6, 6, 6]);
    });
    // A scene, the field that is refused, and whether eigenvalues may decide.
    let cases = [
        (spec(&|_| ()), None, true),
        (law(FrictionLaw::Regularised), None, true),
        (law(FrictionLaw::StaticKinetic), None, false),
        (law(FrictionLaw::Exponential), None, false),
        (law(FrictionLaw::PrakashClifton), Some("scene.contact.law"), false),
        (holder(1.0e6), None, true),
        (holder(0.0), Some("scene.holder.stiffness_y_n_m"), false),
        (crowned, None, true),
        (elastic, None, false),
        (cylinder, None, false),
    ];
    for (at, (spec, refused, may_decide)) in cases.into_iter().enumerate() {
        match (spec.check(), refused) {
            (Ok(()), None) => {}
            (Err(violations), Some(field)) => assert_contains(&violations.to_string(), &[field]),
            (found, _) => panic!("case {at}: {found:?}"),
        }
        assert_eq!(spec.eigenvalues_may_decide(), may_decide, "case {at}");
        let way = Preset::Standard.way(JobSpec { stability: StabilityMethod::Simulate, ..spec });
        let is_chosen = way.stability == StabilityMethod::Eigenvalues;
        assert_eq!(is_chosen, at == 0, "case {at}");
    }
}

/// Protects: modes alone are not refused for what only a run needs: the arc that the pin sweeps on an elastic disk, a ramp that fits
/// into the run, and its observation. The same study is refused as a run.
#[test]
fn modes_need_no_limits_of_a_run() {
    let elastic = r#"{ "scene": { "disk": { "kind": "elastic", "omega_rpm": 5000, "ring": { "track_arc_deg": 25 } } }, "grid": { "mu": [0.1] } }"#;
    let ramp = r#"{ "scene": { "load": { "ramp_s": 0.5 } }, "grid": { "mu": [0.1] } }"#;
    let observation = r#"{ "detection": { "decay_observation_s": 1e-5 }, "grid": { "mu": [0.1] } }"#;
    let modes = Changes { is_of_modes: true, ..Changes::default() };
    for (text, refused) in
        [(elastic, "track_arc_deg"), (ramp, "ramp_s"), (observation, "decay_observation_s")]
    {
        assert_contains(&refusal(text), &[refused]);
        let study = Study::parse_changed(text, "x.json", &modes).unwrap();
        let spec = &study.expand("1").unwrap()[0].spec;
        assert!(!spec.has_run() && spec.limit_of_run_s() == 0.0);
    }
}
