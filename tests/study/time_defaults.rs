//! Protects: times that nobody gives fit the pin. `src/application/study/time_defaults.rs` has their values.

use super::random::Random;
use super::{assert_contains, parse, refusal};

/// Ordinary pins from rubber to steel and lead, of 1 to 30 mm. None may be refused for a time that its author did not
/// give, and the times leave room for several of the slowest vibrations: the observation of a decay spans at least 100
/// transits of shear waves over the height, which the job's check asks for, and the run at least three observations.
#[test]
fn ordinary_pins_need_no_times() {
    for case in 0..400 {
        let mut random = Random::of_case(11, case);
        let mut edge = || random.between(0.001, 0.03);
        let [x, y, z] = [edge(), edge(), edge()];
        let young = random.log_between(1.0e6, 4.0e11);
        let nu = random.between(0.0, 0.49);
        let density = random.between(900.0, 20_000.0);
        let side = random.pick(&["inner_side", "leading_end", "both_ends", "whole_top"]);
        // A load of the reference scene, or one that compresses a soft pin by a hundredth.
        let force = (0.01 * young * x * y).min(30.0);
        let study = parse(&format!(
            r#"{{ "scene": {{ "pin": {{ "size_m": [{x:e}, {y:e}, {z:e}], "young_modulus_pa": {young:e},
                "poisson_ratio": {nu:e}, "density_kg_m3": {density:e} }}, "clamp": {{ "side": "{side}" }},
                "load": {{ "force_n": {force:e} }} }} }}"#
        ));
        let job = study.base();
        let transit_s = z / (young / (2.0 * (1.0 + nu) * density)).sqrt();
        assert!(job.detection.decay_observation_s >= 100.0 * transit_s, "case {case}");
        assert!(job.run.limit_s >= 3.0 * job.detection.decay_observation_s, "case {case}");
        assert!(job.scene.load.ramp_s < 0.02 * job.run.limit_s, "case {case}");
    }
}

/// Protects: each job of a grid has the times of its own pin, and a time that the file or the grid gives is that time.
#[test]
fn times_follow_the_grid() {
    let jobs = |more: &str| {
        let text = format!(r#"{{ "grid": {{ "young_modulus_pa": [1e9, 1e7]{more} }} }}"#);
        parse(&text).expand("1").unwrap().into_iter().map(|job| job.spec).collect::<Vec<_>>()
    };
    let times: Vec<f64> = jobs("").iter().map(|job| job.run.limit_s).collect();
    assert_eq!(times, [0.04, 0.4]);
    let given = jobs(r#", "limit_s": [0.1], "ramp_s": [1e-4]"#);
    assert!(given.iter().all(|job| (job.run.limit_s, job.scene.load.ramp_s) == (0.1, 1.0e-4)));
    let observed: Vec<f64> = given.iter().map(|job| job.detection.decay_observation_s).collect();
    assert_eq!(observed, [0.008, 0.08]);
    // A given time that does not fit is still refused.
    let short = r#"{ "scene": { "pin": { "young_modulus_pa": 1e6 } }, "detection": { "decay_observation_s": 0.008 } }"#;
    assert_contains(&refusal(short), &["detection.decay_observation_s = 0.008: expected at least 8.06"]);
}
