//! Exploration
use tribosweep::solver::energy::EnergyLedger;
use tribosweep::{
    analysis::{cycles::*, figures::*, sample::*, *},
    solver::*,
    spec::*,
    units::*,
};
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
    let limit = get("limit", 0.02);
    let m = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let drives = [Drive {
        mu: spec.scene.contact.mu,
        rate: rad_per_s_from_rpm(spec.scene.disk.omega_rpm),
        force_n: 30.0,
        ramp_s: spec.scene.load.ramp_s,
    }];
    let mut s = State::<1>::at_rest(&m);
    let mut led = EnergyLedger::new(&m, get("audit", 16.0) as u64);
    let mut sampler = Sampler::new(&m, 0);
    let mut cutter = CycleCutter::new(&m, spec.scene.load.ramp_s);
    let t0 = std::time::Instant::now();
    let steps = (limit / m.time_step_s()).ceil() as u64;
    let mut win = Figures::EMPTY;
    let mut cyc = vec![];
    for n in 0..steps {
        led.before_step(&m, &s);
        step(&m, &drives, &mut s);
        led.after_step(&m, &drives, &s);
        if led.audits(n) {
            guard::check(&m, &drives[0], &s, 0, led.energies(0)).unwrap();
        }
        let x = sampler.sample(&m, &drives[0], &s);
        if x.time_s >= 0.6 * limit {
            win.add(&x);
        }
        if let Some(c) = cutter.push(&x, led.energies(0)) {
            cyc.push(c);
        }
    }
    let el = t0.elapsed().as_secs_f64();
    println!(
        "dt {:.4e} limit {:.4e} steps {} wall {:.3} ns/node/step {:.1}",
        m.time_step_s(),
        m.time_step_limit_s(),
        steps,
        el,
        el * 1e9 / steps as f64 / m.mesh().node_count() as f64
    );
    println!(
        "mu* {:.4} contact {:.4} shares {:.3?} N/F {:.3}..{:.3} sigma {:.3e} slip {:.3} stickred {:.4} slipred {:.4}",
        win.mu_star(),
        win.mu_star_contact(),
        win.shares(),
        win.normal_min_n / 30.,
        win.normal_max_n / 30.,
        win.sigma_n_max_pa,
        win.slip_speed_max_m_s,
        win.stick_reduction(),
        win.slip_reduction()
    );
    println!("{:?} residual {:.3e}", led.energies(0), led.energies(0).relative_residual());
    for (i, nf) in win.nodes.iter().enumerate() {
        println!(
            "{} pp {:.3e} lift {:.3e} sig {:.3e} slip {:.3}",
            OBSERVED_NAMES[i],
            nf.y_peak_to_peak_m(),
            nf.lift_max_m,
            nf.sigma_n_max_pa,
            nf.slip_speed_max_m_s
        );
    }
    let w: Vec<_> = cyc.iter().filter(|c| c.start_s >= 0.6 * limit).collect();
    if w.len() > 1 {
        println!("cycles {} f {:.1}", w.len(), w.len() as f64 / (w.last().unwrap().end_s - w[0].start_s));
    }
    if a.iter().any(|s| s == "cyc") {
        for c in &cyc {
            let sh = c.figures.shares();
            println!(
                "{:.5} {:7.1} mu* {:.4} N {:.4} sh {:.3} {:.3} {:.3} sig {:.4e} amp {:.3}",
                c.start_s,
                1.0 / c.period_s(),
                c.figures.mu_star(),
                c.figures.normal_over_load(),
                sh[0],
                sh[1],
                sh[2],
                c.figures.sigma_n_max_pa,
                c.amplitude_n / 30.0
            );
        }
    }
}
