//! Hostile but legal scenes. A case is a function of seed and index.
//!
//! Every parameter is drawn from its whole range, and often from the corners of it. A small part of the cases
//! gets one illegal value on purpose. Another small part gets one value far outside anything physical. These
//! cases must be refused.

use crate::random::Random;
use strum::VariantArray;
use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::spec::{
    Base, ClampSide, FrictionLaw, HeightMap, JobSpec, MOST_PAIRS, MuOfSpeed, Precision, Region, Roughness,
    Scene, Shape, StabilityMethod, Table, TopFace,
};

/// Largest number of nodes × steps of a case. With it 10 000 cases take minutes.
const MOST_NODE_STEPS: f64 = 1.5e5;

/// The job of case `index` of `seed`. Every job runs.
pub fn job(seed: u64, index: u64) -> JobSpec {
    let random = &mut Random::of_case(seed, index);
    let mut spec = JobSpec { stability: StabilityMethod::Simulate, ..JobSpec::default() };
    pin(random, &mut spec);
    contact(random, &mut spec);
    clamp(random, &mut spec);
    law(random, &mut spec);
    base(random, &mut spec);
    shape(random, &mut spec);
    surface(random, &mut spec);
    layer(random, &mut spec);
    holder(random, &mut spec);
    numerics(random, &mut spec);
    duration(random, &mut spec);
    program(random, &mut spec);
    if random.chance(0.3) {
        spec.numerics.precision = Precision::Single;
    }
    if random.chance(0.06) {
        spoil(random, &mut spec);
    } else if random.chance(0.04) {
        overdo(random, &mut spec);
    }
    spec
}

fn pin(random: &mut Random, spec: &mut JobSpec) {
    let pin = &mut spec.scene.pin;
    let edge_m = random.log_between(1.0e-4, 3.0e-2);
    pin.elements = std::array::from_fn(|_| if random.chance(0.4) { 1 } else { random.whole(1, 4) });
    if random.chance(0.12) {
        pin.elements = [1, 1, 1];
    }
    // The edges of an element are up to 50 times the shortest one, and exactly that in a third of the cases.
    let long = random.whole(0, 2);
    for axis in 0..3 {
        let stretch = if random.chance(0.5) { 1.0 } else { random.log_between(1.0, 50.0) };
        pin.size_m[axis] = edge_m * stretch * pin.elements[axis] as f64;
    }
    if random.chance(0.33) {
        let short = (long + random.whole(1, 2)) % 3;
        pin.size_m[short] = edge_m * pin.elements[short] as f64;
        pin.size_m[long] = 50.0 * edge_m * pin.elements[long] as f64;
    }
    pin.young_modulus_pa = random.log_between(1.0e6, 1.0e12);
    let any = random.between(-0.95, 0.499);
    pin.poisson_ratio = if random.chance(0.5) { random.pick(&[0.0, 0.3, 0.49, 0.499, 0.499]) } else { any };
    pin.density_kg_m3 = random.log_between(1.0e2, 3.0e4);
}

fn contact(random: &mut Random, spec: &mut JobSpec) {
    let any = random.between(0.0, 2.0);
    spec.scene.contact.mu = if random.chance(0.4) { random.pick(&[0.0, 0.4, 1.0, 2.0]) } else { any };
    let radius = spec.scene.pin.size_m[0] / 2.0;
    let far = random.log_between(1.0 + 1.0e-9, 1.0e3);
    spec.scene.disk.track_radius_m = radius * if random.chance(0.2) { 1.0 + 1.0e-9 } else { far };
    // The speed at the pin's centre covers five decades. Only V/F counts, so in half of the cases the load is
    // chosen around the pressure p = ρ c_s V that belongs to the speed.
    let speed_m_s = random.log_between(1.0e-3, 1.0e2);
    spec.scene.disk.omega_rpm = speed_m_s / spec.scene.disk.track_radius_m * 30.0 / std::f64::consts::PI;
    let load = &mut spec.scene.load;
    load.force_n = random.log_between(1.0e-12, 1.0e5);
    if random.chance(0.5) {
        let pin = &spec.scene.pin;
        let shear_modulus_pa = pin.young_modulus_pa / (2.0 * (1.0 + pin.poisson_ratio));
        let impedance = (shear_modulus_pa * pin.density_kg_m3).sqrt();
        let matching_n = speed_m_s * impedance * pin.size_m[0] * pin.size_m[1];
        load.force_n = matching_n * random.log_between(3.0e-3, 3.0e2);
    }
    spec.scene.top = random.pick(&[TopFace::TiedInZ, TopFace::FreeInZ]);
}

/// Another friction law, with scales far below and far above what the run reaches.
fn law(random: &mut Random, spec: &mut JobSpec) {
    let speed_m_s = crate::stress::corners::speed_m_s(spec);
    let contact = &mut spec.scene.contact;
    if random.chance(0.5) {
        contact.law = random.pick(FrictionLaw::VARIANTS);
    }
    let any = random.between(0.0, 2.0);
    contact.mu_static = Some(if random.chance(0.3) { random.pick(&[0.0, 2.0]) } else { any });
    contact.speed_m_s = Some(speed_m_s * random.log_between(1.0e-6, 1.0e6));
    contact.slope_s_m =
        Some(if random.chance(0.5) { 0.0 } else { random.log_between(1.0e-3, 10.0) / speed_m_s });
    contact.length_m = Some(random.log_between(1.0e-12, 1.0));
    if contact.law == FrictionLaw::Table {
        let mut at_m_s = 0.0;
        let pairs = (0..random.whole(2, MOST_PAIRS)).map(|_| {
            let pair = [at_m_s, random.between(1.0e-3, 2.0)];
            at_m_s += speed_m_s * random.log_between(1.0e-3, 1.0e3);
            pair
        });
        contact.mu_of_speed = MuOfSpeed(pairs.collect());
    }
}

/// A base that is not flat, with gaps far below and above what the load closes.
fn base(random: &mut Random, spec: &mut JobSpec) {
    if random.chance(0.6) {
        return;
    }
    let pin = &mut spec.scene.pin;
    let [lx, ly, lz] = pin.size_m;
    let compression_m = spec.scene.load.force_n * lz / (pin.young_modulus_pa * lx * ly);
    let height_m = (compression_m * random.log_between(1.0e-6, 1.0e6)).min(0.1 * lz);
    let half_edge = 0.5 * lx.min(ly);
    match random.whole(0, 5) {
        4 => {
            let shortest_m = (lx + ly) * random.between(4.0, 10.0);
            pin.base.roughness = Some(Roughness {
                rms_m: height_m,
                seed: random.whole(0, 1000) as u64,
                hurst: random.between(0.01, 1.0),
                longest_m: Some(shortest_m * random.between(2.0, 256.0)),
                shortest_m: Some(shortest_m),
            });
        }
        5 => {
            let [columns, rows] = [random.whole(2, 9), random.whole(2, 9)];
            let row =
                |random: &mut Random| (0..columns).map(|_| random.between(-height_m, height_m)).collect();
            let heights_m = (0..rows).map(|_| row(random)).collect();
            pin.base.height_map = Some(HeightMap { file: None, spacing_m: lx.max(ly), heights_m });
        }
        0 => pin.base.crown_radius_m = Some(libm::hypot(lx, ly) * random.log_between(0.51, 1.0e6)),
        1 => pin.base.edge_radius_m = Some(half_edge * random.between(0.001, 1.0)),
        2 => {
            pin.base.chamfer_width_m = Some(half_edge * random.between(0.001, 1.0));
            pin.base.chamfer_height_m = Some(height_m);
        }
        _ => {
            pin.base.wave_height_m = Some(height_m);
            pin.base.wave_length_m = Some((lx + ly) * random.between(4.0, 10.0));
            pin.base.wave_direction_deg = Some(random.between(-360.0, 360.0));
        }
    }
}

/// A cylinder, a tilt, or regions of materials that are far stiffer or softer, heavier or lighter.
fn shape(random: &mut Random, spec: &mut JobSpec) {
    if random.chance(0.6) {
        return;
    }
    let pin = &mut spec.scene.pin;
    if random.chance(0.5) {
        let across = random.whole(3, 5);
        pin.shape = Shape::Cylinder;
        pin.elements[0] = across;
        pin.elements[1] = across;
        pin.diameter_m = Some(pin.size_m[0]);
        // The lengths of a base are those of the block.
        pin.base = Base::default();
    }
    if random.chance(0.5) {
        pin.tilt_x_deg = Some(random.pick(&[0.0, 1.0e-9, -0.01, 4.0, -30.0]));
        pin.tilt_y_deg = Some(random.between(-30.0, 30.0));
    }
    let layers = pin.elements[2];
    if layers > 1 && random.chance(0.5) {
        let above = random.whole(1, layers - 1);
        pin.regions = vec![Region {
            above_m: Some(pin.size_m[2] * above as f64 / layers as f64),
            group: None,
            young_modulus_pa: pin.young_modulus_pa * random.log_between(1.0e-3, 1.0e3),
            poisson_ratio: random.pick(&[0.0, 0.3, 0.49, -0.5]),
            density_kg_m3: pin.density_kg_m3 * random.log_between(1.0e-2, 1.0e2),
            plasticity: None,
        }];
    }
}

/// A disk with run-out and waviness, with heights far below and above the compression of the pin.
fn surface(random: &mut Random, spec: &mut JobSpec) {
    if random.chance(0.7) {
        return;
    }
    let Scene { pin, disk, load, .. } = &mut spec.scene;
    let [lx, ly, lz] = pin.extent_m();
    let compression_m = load.force_n * lz / (pin.young_modulus_pa * lx * ly);
    let inner_m = disk.track_radius_m - 0.5 * lx;
    let shortest_m = 4.0 * ly / pin.elements[1] as f64;
    let most = (std::f64::consts::TAU * disk.track_radius_m / shortest_m).min(1.0e6) as usize;
    let mut height_m = |count: usize| {
        (compression_m * random.log_between(1.0e-6, 1.0e6)).min(0.1 * inner_m / count as f64).min(0.1 * lz)
    };
    disk.runout_m = Some(height_m(1));
    if most > 0 {
        let count = most.div_ceil(2);
        disk.waviness_height_m = Some(height_m(count));
        disk.waviness_count = Some(count as u32);
    }
}

/// A layer that is much softer or much stiffer than the pin, at pressures far below and above the mean one.
fn layer(random: &mut Random, spec: &mut JobSpec) {
    if random.chance(0.8) {
        return;
    }
    let Scene { pin, contact, load, .. } = &mut spec.scene;
    contact.stiffness_pa_m = Some(pin.young_modulus_pa / pin.size_m[2] * random.log_between(1.0e-2, 1.0e8));
    if random.chance(0.5) {
        contact.stiffness_exponent = Some(random.between(1.0, 10.0));
        let pressure_pa = load.force_n / (pin.size_m[0] * pin.size_m[1]);
        contact.stiffness_pressure_pa = Some((pressure_pa * random.log_between(1.0e-3, 1.0e3)).max(1.0e-20));
    }
}

/// A holder, with masses and stiffnesses far below and far above those of the pin.
fn holder(random: &mut Random, spec: &mut JobSpec) {
    if random.chance(0.7) {
        return;
    }
    let pin = &spec.scene.pin;
    let [lx, ly, lz] = pin.size_m;
    let pin_kg = pin.density_kg_m3 * lx * ly * lz;
    let pin_n_m = pin.young_modulus_pa * lx * ly / lz;
    let is_tied = spec.scene.top == TopFace::TiedInZ;
    let may_rotate = is_tied && spec.scene.clamp.side != ClampSide::Collet;
    let holder = &mut spec.scene.holder;
    holder.mass_kg = Some(if random.chance(0.2) { 0.0 } else { pin_kg * random.log_between(1.0e-3, 1.0e6) });
    let mut direction = || {
        let stiffness = if random.chance(0.2) { 0.0 } else { pin_n_m * random.log_between(1.0e-6, 1.0e2) };
        let damping = (pin_n_m * pin_kg).sqrt() * random.log_between(1.0e-6, 1.0);
        (Some(stiffness), random.chance(0.5).then_some(damping))
    };
    (holder.stiffness_y_n_m, holder.damping_y_n_s_m) = direction();
    (holder.stiffness_x_n_m, holder.damping_x_n_s_m) = direction();
    let along_z = direction();
    if is_tied {
        (holder.stiffness_z_n_m, holder.damping_z_n_s_m) = (Some(0.0), along_z.1);
    }
    if may_rotate && random.chance(0.5) {
        let (stiffness, inertia) = (pin_n_m * lx * ly, pin_kg * lz * lz);
        let mut about = || {
            let scale = if random.chance(0.2) { 0.0 } else { random.log_between(1.0e-6, 1.0e2) };
            let damping = (stiffness * inertia).sqrt() * random.log_between(1.0e-6, 1.0);
            let own = inertia * random.log_between(1.0e-3, 1.0e6);
            let (has_damping, has_own) = (random.chance(0.5), random.chance(0.5));
            (Some(stiffness * scale), has_damping.then_some(damping), has_own.then_some(own))
        };
        let (x, y) = (about(), about());
        let holder = &mut spec.scene.holder;
        (
            holder.rotational_stiffness_x_nm_rad,
            holder.rotational_damping_x_nm_s_rad,
            holder.inertia_x_kg_m2,
        ) = x;
        if random.chance(0.5) {
            (
                holder.rotational_stiffness_y_nm_rad,
                holder.rotational_damping_y_nm_s_rad,
                holder.inertia_y_kg_m2,
            ) = y;
        }
    }
}

fn clamp(random: &mut Random, spec: &mut JobSpec) {
    let pin = &spec.scene.pin;
    let side = random.pick(ClampSide::ALL);
    let axis = side.axis_across().unwrap_or(0);
    let row_m = pin.size_m[axis] / pin.elements[axis] as f64;
    let rows = random.whole(usize::from(side == ClampSide::Collet), pin.elements[axis]) as f64;
    let anything = random.chance(0.05);
    spec.scene.clamp.side = side;
    spec.scene.clamp.width_m = row_m * if anything { random.between(0.0, 6.0) } else { rows };
}

fn numerics(random: &mut Random, spec: &mut JobSpec) {
    let any = random.between(0.5, 1.0);
    spec.numerics.beta2 = if random.chance(0.6) { random.pick(&[0.5, 1.0]) } else { any };
    if !spec.scene.holder.is_ideal() {
        spec.numerics.beta2 = 0.5;
    }
    let pin = &spec.scene.pin;
    // `fraction` is the fraction of critical damping, ½β_Rω, of the lowest shear mode of the height or of the
    // highest mode.
    let modulus_pa = pin.young_modulus_pa / (2.0 * (1.0 + pin.poisson_ratio));
    let speed_m_s = (modulus_pa / pin.density_kg_m3).sqrt();
    let shortest_m =
        (0..3).map(|axis| pin.size_m[axis] / pin.elements[axis] as f64).fold(f64::INFINITY, f64::min);
    let omega =
        if random.chance(0.3) { 1.6 * speed_m_s / pin.size_m[2] } else { 3.5 * speed_m_s / shortest_m };
    let fraction = random.log_between(1.0e-6, 30.0);
    spec.numerics.beta_r_s = if random.chance(0.3) { 0.0 } else { 2.0 * fraction / omega };
    let any = random.between(0.05, 1.0);
    spec.numerics.safety_factor = if random.chance(0.6) { random.pick(&[0.7, 0.99, 1.0]) } else { any };
    if random.chance(0.2) {
        // The step is at the limit, close below it, far below it, or above it.
        let of_limit = random.pick(&[1.0, 1.0, 0.99, 0.1, 1.02]);
        spec.numerics.time_step_s = time_step_limit_s(spec).map(|limit_s| of_limit * limit_s);
    }
}

/// The program's own limit; none if the solver refuses the scene.
fn time_step_limit_s(spec: &JobSpec) -> Option<f64> {
    let numerics = tribosweep_mechanics::spec::Numerics { time_step_s: None, ..spec.numerics.clone() };
    Some(Model::from_scene(&spec.scene, &numerics).ok()?.time_step_limit_s())
}

fn duration(random: &mut Random, spec: &mut JobSpec) {
    let limit_s = time_step_limit_s(spec).unwrap_or(1.0e-7);
    let step_s = spec.numerics.time_step_s.unwrap_or(spec.numerics.safety_factor * limit_s);
    let nodes: f64 = spec.scene.pin.elements.iter().map(|&n| n as f64 + 1.0).product();
    let most = MOST_NODE_STEPS / nodes;
    let few = random.pick(&[1.0, 2.0, 15.0, 16.0, 17.0, 100.0]);
    let steps = if random.chance(0.1) { few } else { random.log_between(100.0, most) };
    spec.run.limit_s = steps * step_s;
    spec.run.stop_early = random.chance(0.7);
    let any = random.between(0.01, 0.99);
    spec.run.average_last_fraction = if random.chance(0.2) { random.pick(&[1.0e-6, 0.999_999]) } else { any };
    let any = random.between(0.0, 0.9) * spec.run.limit_s;
    spec.scene.load.ramp_s = if random.chance(0.4) { 0.0 } else { any };
    let detection = &mut spec.detection;
    detection.cycles = random.pick(&[2, 2, 5, 20, 10_000]);
    detection.tolerance = random.log_between(1.0e-6, 0.99);
    detection.drift_tolerance = random.log_between(1.0e-6, 0.99);
    detection.regime_threshold = random.pick(&[0.0, 0.03, 0.99]);
    let pin = &spec.scene.pin;
    let shear_speed_m_s =
        (pin.young_modulus_pa / (2.0 * (1.0 + pin.poisson_ratio)) / pin.density_kg_m3).sqrt();
    let shortest_s = 100.0 * pin.size_m[2] / shear_speed_m_s;
    detection.decay_observation_s = shortest_s * random.pick(&[1.000_001, 1.000_001, 1.0e3, 0.999]);
    if detection.decay_observation_s < shortest_s && random.chance(0.9) {
        detection.decay_observation_s = 1.1 * shortest_s;
    }
}

/// A speed and a load that change in time, with steps and with stretches of less than a time step.
fn program(random: &mut Random, spec: &mut JobSpec) {
    if random.chance(0.7) {
        return;
    }
    let limit_s = spec.run.limit_s;
    let mut table = |largest: f64, least: f64| {
        let count = random.whole(2, 6);
        let mut times: Vec<f64> = (0..count).map(|_| limit_s * random.between(0.0, 1.0)).collect();
        times.sort_by(f64::total_cmp);
        if random.chance(0.3) {
            times[1] = times[0];
        }
        let mut value = || if random.chance(0.2) { least } else { largest * random.log_between(1.0e-6, 1.0) };
        let mut points: Vec<[f64; 2]> = times.iter().map(|time_s| [*time_s, value()]).collect();
        let at = random.whole(0, count - 1);
        points[at][1] = largest;
        Some(Table(points))
    };
    let omega = table(spec.scene.disk.omega_rpm, 0.0);
    let force = table(spec.scene.load.force_n, 1.0e-3 * spec.scene.load.force_n);
    let scene = &mut spec.scene;
    match random.whole(0, 2) {
        // Run-out and waviness are for constant speeds.
        _ if !scene.disk.is_plane() => scene.program.force_n = force,
        0 => scene.program.omega_rpm = omega,
        1 => scene.program.force_n = force,
        _ => (scene.program.omega_rpm, scene.program.force_n) = (omega, force),
    }
    spec.scene.take_largest_of_program([false; 2]);
}

/// Sets one value that is not legal.
fn spoil(random: &mut Random, spec: &mut JobSpec) {
    let scene = &mut spec.scene;
    match random.whole(0, 14) {
        0 => scene.load.force_n = random.pick(&[0.0, -0.0, -30.0]),
        1 => scene.pin.poisson_ratio = random.pick(&[0.5, 0.6, -1.0]),
        2 => scene.pin.young_modulus_pa = random.pick(&[0.0, -1.0e9]),
        3 => scene.pin.density_kg_m3 = 0.0,
        4 => scene.pin.size_m[random.whole(0, 2)] = 0.0,
        5 => scene.pin.elements[random.whole(0, 2)] = random.pick(&[0, 1001]),
        6 => scene.contact.mu = -0.1,
        7 => scene.disk.omega_rpm = random.pick(&[0.0, -7.0]),
        8 => scene.disk.track_radius_m = 0.4 * scene.pin.size_m[0],
        9 => scene.load.ramp_s = random.pick(&[-1.0e-9, spec.run.limit_s]),
        10 => spec.numerics.beta2 = random.pick(&[0.499, 1.001]),
        11 => spec.numerics.beta_r_s = -1.0e-12,
        12 => spec.numerics.safety_factor = random.pick(&[0.0, 1.02]),
        13 => scene.program.force_n = Some(Table(vec![[0.0, scene.load.force_n]])),
        _ => spec.run.limit_s = random.pick(&[0.0, 101.0]),
    }
}

/// Sets one value that no pin has, up to the ends of the floating-point range.
fn overdo(random: &mut Random, spec: &mut JobSpec) {
    let exponent = random.between(15.0, 308.0) * random.pick(&[-1.0, 1.0]);
    let value = 10_f64.powf(exponent);
    let scene = &mut spec.scene;
    match random.whole(0, 8) {
        0 => scene.pin.young_modulus_pa = value,
        1 => scene.pin.density_kg_m3 = value,
        2 => scene.pin.size_m[random.whole(0, 2)] = value,
        3 => scene.load.force_n = value,
        4 => scene.disk.omega_rpm = value,
        5 => scene.disk.track_radius_m = value.abs().max(scene.pin.size_m[0]),
        6 => scene.contact.mu = value,
        7 => spec.numerics.beta_r_s = value,
        _ => spec.numerics.time_step_s = Some(value),
    }
}
