//! Exploration
use tribosweep::{analysis, spec::*};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let get = |k: &str, d: f64| {
        a.iter().find_map(|s| s.strip_prefix(&format!("{k}="))).map_or(d, |v| v.parse().unwrap())
    };
    let mut spec = JobSpec::default();
    match get("mesh", 12.0) as usize {
        6 => {
            spec.scene.pin.elements = [6, 8, 5];
        }
        18 => {
            spec.scene.pin.elements = [18, 22, 15];
        }
        24 => {
            spec.scene.pin.elements = [24, 30, 20];
        }
        _ => {}
    }
    spec.scene.clamp.width_m = get("clamp", if get("mesh", 12.0) == 6.0 { 0.002 } else { 0.001 });
    spec.scene.contact.mu = get("mu", 0.4);
    spec.scene.disk.omega_rpm = get("rpm", 7.0);
    spec.numerics.beta_r_s = get("br", 5e-8);
    spec.numerics.beta2 = get("b2", 0.5);
    if get("dt", 0.0) > 0.0 {
        spec.numerics.time_step_s = Some(get("dt", 0.0));
    }
    spec.scene.load.ramp_s = get("ramp", 5e-4);
    spec.run.limit_s = get("limit", 0.04);
    spec.run.stop_early = get("early", 1.0) > 0.0;
    let t = std::time::Instant::now();
    let r = analysis::solve(&spec, &mut analysis::Unobserved).unwrap();
    if a.iter().any(|s| s == "full") {
        println!("{r:#?}");
    } else {
        println!(
            "mu {} rpm {} {:?} {:?} mu* {:.5} se {:.1e} c {:.5} f {:?} sh {:.3} {:.3} {:.3} t {:.5} cyc {} x{} growth {:?} eres {:.1e} mid {:.1e} eid {:.1e} wall {:.2}",
            spec.scene.contact.mu,
            spec.scene.disk.omega_rpm,
            r.outcome,
            r.regime,
            r.mu_star,
            r.mu_star_se,
            r.mu_star_contact,
            r.frequency_hz.map(|f| (f * 10.).round() / 10.),
            r.stick_share,
            r.slip_share,
            r.separated_share,
            r.simulated_s,
            r.cycles,
            r.crossings_per_cycle,
            r.growth_rate_per_s,
            r.energy_residual,
            r.macroscopic_identity_residual,
            r.energy_identity_residual,
            t.elapsed().as_secs_f64()
        );
    }
}
