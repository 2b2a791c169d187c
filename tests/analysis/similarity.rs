//! The similarity that `study::Study::warnings` uses: on a rigid disk jobs with the same ω E/F and ρ/E have the same result.

use crate::analysis::signals::coarse;
use tribosweep_mechanics::analysis::{JobRecord, Unobserved, solve};
use tribosweep_mechanics::spec::JobSpec;

fn record(change: impl Fn(&mut JobSpec)) -> JobRecord {
    let mut spec = coarse();
    spec.scene.disk.omega_rpm = 10.0;
    spec.scene.load.force_n = 10.0;
    spec.run.limit_s = 0.01;
    change(&mut spec);
    solve(&spec, &mut Unobserved).unwrap()
}

/// What is equal in similar jobs.
fn figures(record: &JobRecord) -> [Option<f64>; 9] {
    [
        Some(record.mu_star),
        Some(record.mu_star_se),
        record.frequency_hz,
        Some(record.stick_share),
        Some(record.slip_share),
        Some(record.separated_share),
        Some(record.n_over_f_min),
        Some(record.n_over_f_max),
        Some(record.simulated_s),
    ]
}

/// Protects: the warning about grids that repeat themselves is true. Twice the load at twice the speed, or twice the load
/// on twice the modulus with twice the density, gives the same figures to the last bit, because a factor of two is exact in
/// binary. Twice the load alone gives others.
#[test]
fn jobs_with_equal_groups_have_equal_results() {
    let one = record(|_| {});
    assert!(one.frequency_hz.is_some() && one.stick_share > 0.0 && one.separated_share > 0.0, "{one:?}");

    let faster = record(|spec| {
        spec.scene.disk.omega_rpm *= 2.0;
        spec.scene.load.force_n *= 2.0;
    });
    assert_eq!(figures(&faster), figures(&one));
    assert_eq!(faster.sigma_n_max_pa, 2.0 * one.sigma_n_max_pa);
    assert_eq!(faster.slip_speed_max_m_s, 2.0 * one.slip_speed_max_m_s);
    assert_eq!(faster.lift_max_m, 2.0 * one.lift_max_m);

    let stiffer = record(|spec| {
        spec.scene.pin.young_modulus_pa *= 2.0;
        spec.scene.pin.density_kg_m3 *= 2.0;
        spec.scene.load.force_n *= 2.0;
    });
    assert_eq!(figures(&stiffer), figures(&one));
    assert_eq!(stiffer.sigma_n_max_pa, 2.0 * one.sigma_n_max_pa);
    assert_eq!(stiffer.slip_speed_max_m_s, one.slip_speed_max_m_s);

    let loaded = record(|spec| spec.scene.load.force_n *= 2.0);
    assert_ne!(figures(&loaded), figures(&one));
}
