//! Protects: a damping ratio or a loss factor at a frequency is the β_R that gives it, and contradictions are refused.

use super::{assert_contains, parse, refusal};
use std::f64::consts::PI;
use tribosweep::study::{Study, job_key};

fn damped(damping: &str) -> Study {
    parse(&format!(r#"{{ "damping": {{ {damping} }} }}"#))
}

/// Damping in proportion to the stiffness has ζ = β_R ω / 2 at the angular frequency ω, and a loss factor η = β_R ω. The
/// tolerance is a few roundings.
#[test]
fn the_ratio_holds_at_its_frequency() {
    for (frequency_hz, ratio) in [(15_000.0, 0.02), (250.0, 0.3), (1.0e5, 0.0)] {
        let omega = 2.0 * PI * frequency_hz;
        let by_ratio = damped(&format!(r#""ratio": {ratio}, "frequency_hz": {frequency_hz}"#));
        let beta_r_s = by_ratio.base().numerics.beta_r_s;
        assert!((beta_r_s * omega / 2.0 - ratio).abs() <= 1e-15, "{beta_r_s}");
        let by_loss = damped(&format!(r#""loss_factor": {}, "frequency_hz": {frequency_hz}"#, 2.0 * ratio));
        assert_eq!(by_loss.base().numerics.beta_r_s, beta_r_s);
        // The job has only β_R, so it is the job of a study that gives β_R itself.
        let explicit = parse(&format!(r#"{{ "numerics": {{ "beta_r_s": {beta_r_s:e} }} }}"#));
        assert_eq!(job_key(by_ratio.base(), "1"), job_key(explicit.base(), "1"));
    }
}

/// Damping C = α_R M + β_R K has ζ(ω) = α_R/(2ω) + β_R ω/2 (Rayleigh): the same at both frequencies, less between them and more beyond. The
/// tolerance is a few roundings.
#[test]
fn the_ratio_holds_at_two_frequencies() {
    for (first_hz, second_hz, ratio) in [(5_000.0, 15_000.0, 0.02), (20_000.0, 800.0, 0.1)] {
        let text =
            format!(r#""ratio": {ratio}, "frequency_hz": {first_hz}, "second_frequency_hz": {second_hz}"#);
        let study = damped(&text);
        let numerics = &study.base().numerics;
        let at = |hz: f64| {
            let omega = 2.0 * PI * hz;
            numerics.alpha_r_per_s.unwrap() / (2.0 * omega) + numerics.beta_r_s * omega / 2.0
        };
        for hz in [first_hz, second_hz] {
            assert!((at(hz) / ratio - 1.0).abs() < 1.0e-14, "{} at {hz} Hz", at(hz));
        }
        assert!(at((first_hz * second_hz).sqrt()) < ratio && at(2.0 * first_hz.max(second_hz)) > ratio);
    }
    let varied = parse(
        r#"{ "damping": { "ratio": 0.02, "frequency_hz": 5e3 }, "grid": { "damping_second_frequency_hz": [1e4, 2e4] } }"#,
    );
    assert!(varied.expand("1").unwrap().iter().all(|job| job.spec.numerics.alpha_r_per_s > Some(0.0)));
    for (text, expected) in [
        (
            r#"{ "damping": { "ratio": 0.1, "frequency_hz": 5e3, "second_frequency_hz": 5e3 } }"#,
            "another frequency than damping.frequency_hz",
        ),
        (
            r#"{ "damping": { "ratio": 0.1, "second_frequency_hz": 5e3 } }"#,
            "the first frequency too: damping.frequency_hz",
        ),
        (
            r#"{ "damping": { "ratio": 0.1, "frequency_hz": 5e3, "second_frequency_hz": 9e3 }, "numerics": { "alpha_r_per_s": 3 } }"#,
            "each gives α_R",
        ),
        (
            r#"{ "damping": { "ratio": 0.1, "frequency_hz": 5e3 }, "numerics": { "alpha_r_per_s": 3 } }"#,
            "which would not hold then",
        ),
        (
            r#"{ "damping": { "beta2": 1, "at_time_step_s": 5e-8, "second_frequency_hz": 5e3 } }"#,
            "no second frequency beside beta2",
        ),
        (
            r#"{ "scene": { "disk": { "kind": "elastic" } }, "damping": { "ratio": 0.1, "frequency_hz": 5e3, "second_frequency_hz": 9e3 } }"#,
            "damping.second_frequency_hz = 9000",
        ),
        (r#"{ "numerics": { "alpha_r_per_s": -3 } }"#, "a damping rate >= 0 1/s"),
        (
            r#"{ "scene": { "disk": { "kind": "elastic" } }, "numerics": { "alpha_r_per_s": 3 } }"#,
            "0 with an elastic disk",
        ),
    ] {
        assert_contains(&refusal(text), &[expected]);
    }
}

/// The damping of the β₂ method is β_R = (β₂ − ½) Δt, and the job has only β_R. The tolerance is a rounding.
#[test]
fn a_scheme_has_its_damping_at_its_time_step() {
    for (beta2, time_step_s) in [(1.0, 5.5e-8), (0.6, 5.5e-8), (0.5, 1.0e-7)] {
        let by_scheme = damped(&format!(r#""beta2": {beta2}, "at_time_step_s": {time_step_s:e}"#));
        let numerics = &by_scheme.base().numerics;
        assert!((numerics.beta_r_s - (beta2 - 0.5) * time_step_s).abs() <= 1e-23, "{}", numerics.beta_r_s);
        assert_eq!((numerics.beta2, numerics.time_step_s), (0.5, None));
        let explicit = parse(&format!(r#"{{ "numerics": {{ "beta_r_s": {:e} }} }}"#, numerics.beta_r_s));
        assert_eq!(job_key(by_scheme.base(), "1"), job_key(explicit.base(), "1"));
    }
    let varied =
        parse(r#"{ "damping": { "at_time_step_s": 5.5e-8 }, "grid": { "damping_beta2": [0.5, 1] } }"#);
    let found: Vec<f64> = varied.expand("1").unwrap().iter().map(|job| job.spec.numerics.beta_r_s).collect();
    assert_eq!(found, [0.0, 0.5 * 5.5e-8]);
}

/// Protects: a study that was stored without a damping has that of its jobs, although the default is another one today; a damping
/// that the study gives in any way, or varies, stays.
#[test]
fn a_stored_study_keeps_its_damping() {
    let stored = |text: &str| {
        let study = Study::parse_stored(text, "x", Some(5.0e-8)).unwrap();
        study.expand("1").unwrap().iter().map(|job| job.spec.numerics.beta_r_s).collect::<Vec<_>>()
    };
    let plain = r#"{ "name": "x", "scene": { "contact": { "mu": 0.4 } } }"#;
    assert_eq!(stored(plain), [5.0e-8]);
    assert_eq!(parse(plain).base().numerics.beta_r_s, 2.75e-8);
    assert_eq!(stored(r#"{ "name": "x", "numerics": { "beta_r_s": 1e-8 } }"#), [1.0e-8]);
    assert_eq!(
        stored(r#"{ "name": "x", "damping": { "beta2": 1, "at_time_step_s": 5.5e-8 } }"#),
        [0.5 * 5.5e-8]
    );
    assert_eq!(stored(r#"{ "name": "x", "grid": { "beta_r_s": [0, 1e-8] } }"#), [0.0, 1.0e-8]);
    assert_eq!(
        stored(
            r#"{ "name": "x", "damping": { "at_time_step_s": 5.5e-8 }, "grid": { "damping_beta2": [0.5] } }"#
        ),
        [0.0]
    );
}

/// Protects: nobody has two dampings without a word, and a time step in the wrong unit is looked for in its own field.
#[test]
fn doubtful_dampings_are_named() {
    let warnings = |text: &str| {
        let all = parse(text).warnings();
        all.iter().map(|warning| format!("{}: {}", warning.kind, warning.in_words())).collect::<Vec<_>>()
    };
    let both = warnings(r#"{ "numerics": { "beta2": 1, "time_step_s": 5.5e-8 } }"#);
    assert_eq!(both.len(), 1, "{both:?}");
    assert_contains(
        &both[0],
        &["two_dampings: numerics.beta2", "(β₂ − ½) Δt = 2.75e-8 s", "β_R = 2.75e-8 s"],
    );
    assert!(warnings(r#"{ "numerics": { "beta2": 1, "beta_r_s": 0 } }"#).is_empty());
    assert!(warnings(r#"{ "numerics": { "beta2": 1, "beta_r_s": 5e-8 } }"#).is_empty());
    assert!(warnings(r#"{ "damping": { "beta2": 1, "at_time_step_s": 5.5e-8 } }"#).is_empty());
    let in_ns = warnings(r#"{ "damping": { "beta2": 1, "at_time_step_s": 55 } }"#);
    assert!(in_ns.iter().any(|text| text.contains("damping.at_time_step_s = 55")), "{in_ns:?}");
}

#[test]
fn damping_can_be_varied() {
    let study = parse(
        r#"{ "damping": { "frequency_hz": 15000 }, "grid": { "loss_factor": [0, 0.04], "omega_rpm": [2, 7] } }"#,
    );
    let jobs = study.expand("1").unwrap();
    let found: Vec<f64> = jobs.iter().map(|job| job.spec.numerics.beta_r_s).collect();
    let other = 0.02 / (PI * 15_000.0);
    assert_eq!(found, [0.0, 0.0, other, other]);
    let frequencies =
        parse(r#"{ "damping": { "ratio": 0.01 }, "grid": { "damping_frequency_hz": [1e4, 2e4] } }"#);
    let found: Vec<f64> =
        frequencies.expand("1").unwrap().iter().map(|job| job.spec.numerics.beta_r_s).collect();
    assert_eq!(found, [0.01 / (PI * 1.0e4), 0.01 / (PI * 2.0e4)]);
}

#[test]
fn contradictions_and_gaps_are_refused() {
    for (text, expected) in [
        (
            r#"{ "damping": { "ratio": 0.02, "frequency_hz": 15000 }, "numerics": { "beta_r_s": 5e-8 } }"#,
            "studies/x.json:1:82: numerics.beta_r_s = 0.00000005: expected either this or damping",
        ),
        (
            r#"{ "damping": { "ratio": 0.02, "loss_factor": 0.04, "frequency_hz": 15000 } }"#,
            "studies/x.json:1:46: damping.loss_factor = 0.04: expected either this or damping.ratio",
        ),
        (
            r#"{ "damping": { "frequency_hz": 15000 } }"#,
            "1:32: damping.frequency_hz = 15000: expected a damping ratio or a loss factor too",
        ),
        (r#"{ "damping": { "ratio": 0.02 } }"#, "1:25: damping.ratio = 0.02: expected the frequency too"),
        (r#"{ "damping": {} }"#, "1:14: damping = {}: expected a ratio or a loss_factor"),
        (r#"{ "damping": { "beta2": 1 } }"#, "1:25: damping.beta2 = 1: expected the time step too"),
        (
            r#"{ "damping": { "at_time_step_s": 5e-8 } }"#,
            "damping.at_time_step_s = 0.00000005: expected the scheme's β₂ too",
        ),
        (
            r#"{ "damping": { "beta2": 1.5, "at_time_step_s": 5e-8 } }"#,
            "damping.beta2 = 1.5: expected 0.5 <= β₂ <= 1",
        ),
        (
            r#"{ "damping": { "ratio": 0.02, "frequency_hz": 15000, "beta2": 1 } }"#,
            "damping.ratio = 0.02: expected either this with what belongs to it, or beta2",
        ),
        (
            r#"{ "damping": { "ratio": 2, "frequency_hz": 1 } }"#,
            "1:25: damping.ratio = 2: expected a fraction of critical",
        ),
        (
            r#"{ "damping": { "ratio": -0.1, "frequency_hz": 1 } }"#,
            "damping.ratio = -0.1: expected a fraction of critical",
        ),
        (
            r#"{ "damping": { "loss_factor": 2, "frequency_hz": 1 } }"#,
            "damping.loss_factor = 2: expected twice a",
        ),
        (
            r#"{ "damping": { "ratio": 0.1, "frequency_hz": 0 } }"#,
            "1:46: damping.frequency_hz = 0: expected a frequency > 0",
        ),
        (r#"{ "damping": { "zeta": 0.1 } }"#, "damping.zeta = 0.1: no such field"),
        (r#"{ "damping": { "ratio": null } }"#, "damping.ratio = null: expected a number"),
        (r#"{ "damping": 0.02 }"#, "1:14: damping = 0.02: expected an object"),
        (
            r#"{ "grid": { "damping_ratio": [0.01] } }"#,
            "1:31: damping.ratio = 0.01: expected the frequency too",
        ),
    ] {
        assert_contains(&refusal(text), &[expected]);
    }
    let grid = r#"{ "damping": { "frequency_hz": 15000 }, "grid": { "mu": [0.2, 0.4], "damping_ratio": [0.5, 1] } }"#;
    let expected = ["1:92: damping.ratio = 1: expected a fraction", "set by grid.damping_ratio[1]"];
    assert_contains(&refusal(grid), &expected);
}

/// Protects: a ratio of the holder is that of a rigid pin on each of its springs, in every job of a grid, and leaves the damping of the pin alone.
/// 2ζ√(k m) is the textbook's critical damping; the tolerance is a few roundings.
#[test]
fn a_ratio_damps_the_springs_of_the_holder() {
    let study = parse(
        r#"{ "scene": { "holder": { "mass_kg": 0.05, "stiffness_y_n_m": 2e6, "rotational_stiffness_x_nm_rad": 300, "inertia_x_kg_m2": 1e-5 },
                        "pin": { "size_m": [0.01, 0.012, 0.02], "density_kg_m3": 1400 } },
             "damping": { "holder_ratio": 0.03 }, "grid": { "holder_stiffness_y_n_m": [2e6, 8e6] } }"#,
    );
    let pin_kg: f64 = 1400.0 * 0.01 * 0.012 * 0.02;
    let jobs = study.expand("1").unwrap();
    for (job, stiffness_n_m) in jobs.iter().zip([2.0e6, 8.0e6_f64]) {
        let holder = &job.spec.scene.holder;
        let expected = 0.06 * (stiffness_n_m * (0.05 + pin_kg)).sqrt();
        assert!((holder.damping_y_n_s_m.unwrap() / expected - 1.0).abs() < 1e-14);
        let about = 0.06 * (300.0 * (1.0e-5 + pin_kg * (0.02 * 0.02 / 3.0 + 0.012 * 0.012 / 12.0))).sqrt();
        assert!((holder.rotational_damping_x_nm_s_rad.unwrap() / about - 1.0).abs() < 1e-14);
        assert_eq!((holder.damping_x_n_s_m, holder.rotational_damping_y_nm_s_rad), (None, None));
        assert_eq!(job.spec.numerics.beta_r_s, tribosweep::spec::JobSpec::default().numerics.beta_r_s);
    }
    for (text, expected) in [
        (
            r#"{ "damping": { "holder_ratio": 0.03 } }"#,
            "damping.holder_ratio = 0.03: expected no ratio without a spring of the holder",
        ),
        (
            r#"{ "damping": { "holder_ratio": 1 } }"#,
            "damping.holder_ratio = 1: expected a fraction of critical damping",
        ),
        (
            r#"{ "scene": { "holder": { "stiffness_y_n_m": 2e6, "damping_y_n_s_m": 5 } }, "damping": { "holder_ratio": 0.03 } }"#,
            "damping.holder_ratio = 0.03: expected either this or holder_damping_y_n_s_m, not both",
        ),
    ] {
        assert_contains(&refusal(text), &[expected]);
    }
}

/// Protects: a sliding speed is the disk's speed under the pin's centre, v = ωR, in every job of a grid.
#[test]
fn a_sliding_speed_gives_omega() {
    let study = parse(r#"{ "sliding_speed_m_s": 0.3, "grid": { "track_radius_m": [0.03, 0.06] } }"#);
    for (job, radius_m) in study.expand("1").unwrap().iter().zip([0.03, 0.06]) {
        let speed_m_s = job.spec.scene.disk.omega_rpm * 2.0 * PI / 60.0 * radius_m;
        assert!((speed_m_s / 0.3 - 1.0).abs() < 1e-14, "{speed_m_s}");
    }
    let settings = vec![("omega_rpm".to_owned(), "[5, 7]".to_owned())];
    let changes = tribosweep::study::Changes { settings, ..Default::default() };
    let set = Study::parse_changed(r#"{ "sliding_speed_m_s": 0.3 }"#, "x.json", &changes).unwrap();
    let rates = set.expand("1").unwrap().iter().map(|job| job.spec.scene.disk.omega_rpm).collect::<Vec<_>>();
    assert_eq!(rates, [5.0, 7.0], "a setting takes the place of the speed");
    for (text, expected) in [
        (
            r#"{ "sliding_speed_m_s": 0.3, "scene": { "disk": { "omega_rpm": 7 } } }"#,
            "sliding_speed_m_s = 0.3: expected either this or omega_rpm, not both",
        ),
        (
            r#"{ "sliding_speed_m_s": 0.3, "scene": { "program": { "omega_rpm": [[0, 1], [0.01, 5]] } } }"#,
            "scene.disk.omega_rpm",
        ),
        (
            r#"{ "sliding_speed_m_s": 0.3, "derive": { "load_n": "3 * omega_rpm" } }"#,
            "expected a value of omega_rpm in the study or its grid",
        ),
        (r#"{ "grid": { "sliding_speed_m_s": [0.1, 0.2] } }"#, "no such parameter"),
        (r#"{ "sliding_speed_m_s": 0 }"#, "sliding_speed_m_s = 0: expected a speed > 0 m/s"),
        (
            r#"{ "sliding_speed_m_s": 0.3, "grid": { "omega_rpm": [1, 2] } }"#,
            "not both: each gives the speed of the disk",
        ),
    ] {
        assert_contains(&refusal(text), &[expected]);
    }
}

/// Protects: a collet grips a length of the side that leaves the contact face free, on a mesh that has a row there, and a preset makes such a mesh.
#[test]
fn a_collet_needs_a_length_and_a_row() {
    let study = |more: &str| {
        format!(
            r#"{{ "scene": {{ "pin": {{ "shape": "cylinder", "diameter_m": 0.008, "size_m": [0.008, 0.008, 0.02] }}, "clamp": {{ "side": "collet"{more} }} }}, "preset": "draft" }}"#
        )
    };
    let spec = parse(&study(r#", "width_m": 0.012"#)).base().clone();
    let row_m = 0.02 / spec.scene.pin.elements[2] as f64;
    assert!((0.012 / row_m - (0.012 / row_m).round()).abs() < 1e-9, "{:?}", spec.scene.pin.elements);
    for (more, expected) in [
        (r#", "width_m": 0"#, "scene.clamp.width_m = 0: expected a length > 0 m that the collet holds"),
        (r#", "width_m": 0.03"#, "of at most 0.02 m, the pin's edge in z"),
        (
            r#", "width_m": 0.01 }, "holder": { "rotational_stiffness_x_nm_rad": 100"#,
            "scene.clamp.side = collet: expected another side with a holder that rotates, which carries the top face alone; for a chuck, give",
        ),
    ] {
        assert_contains(&refusal(&study(more)), &[expected]);
    }
}
