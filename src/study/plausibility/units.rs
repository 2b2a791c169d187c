//! Values that look as if they were given in another unit.

use super::{Doubt, short};
use crate::spec::{ClampSide, DiskKind, JobSpec, Shape};
use std::f64::consts::PI;

/// Softest material that is not taken for a mistake \[Pa\]. Gels begin above it.
const SOFTEST_PA: f64 = 1.0e4;
/// Stiffest \[Pa\]: diamond has 1.1e12 Pa.
const STIFFEST_PA: f64 = 1.5e12;
/// Lightest solid that is not taken for a mistake \[kg/m³\]. Cork and balsa are above it.
const LIGHTEST_KG_M3: f64 = 100.0;
/// Heaviest \[kg/m³\]: osmium has 22 600 kg/m³.
const HEAVIEST_KG_M3: f64 = 25_000.0;
/// Lengths from which on millimetres are suspected \[m\].
const LONGEST_M: f64 = 1.0;
/// Sliding speeds above this are suspected \[m/s\]; brakes of racing cars reach 100 m/s.
const FASTEST_M_S: f64 = 100.0;
/// Friction coefficients above this are suspected.
const ROUGHEST: f64 = 2.0;
/// Time limits are suspected that are longer than this \[s\] and than so many times of the slowest
/// waves, `Scene::vibration_time_s`.
const LONGEST_S: f64 = 1.0;
const LONGEST_TRANSITS: f64 = 1.0e5;

/// Holders that swing more slowly are suspected \[Hz\]. Soft arms of tribometers have some tens of Hz.
const SLOWEST_HOLDER_HZ: f64 = 1.0;

type Fields = &'static [&'static str];

pub(super) fn doubts(spec: &JobSpec) -> Vec<Doubt> {
    let mut found = Vec::new();
    let scene = &spec.scene;
    let (pin, disk, ring) = (&scene.pin, &scene.disk, &scene.disk.ring);
    let is_elastic = disk.kind == DiskKind::Elastic;

    young_modulus(&["scene.pin.young_modulus_pa"], pin.young_modulus_pa, &mut found);
    density(&["scene.pin.density_kg_m3"], pin.density_kg_m3, &mut found);
    length(&["scene.pin.size_m[0]"], pin.size_m[0], &mut found);
    length(&["scene.pin.size_m[1]"], pin.size_m[1], &mut found);
    length(&["scene.pin.size_m[2]"], pin.size_m[2], &mut found);
    if let Some(diameter_m) = pin.diameter_m.filter(|_| pin.shape == Shape::Cylinder) {
        length(&["scene.pin.diameter_m"], diameter_m, &mut found);
    }
    if is_elastic {
        young_modulus(&["scene.disk.ring.young_modulus_pa"], ring.young_modulus_pa, &mut found);
        density(&["scene.disk.ring.density_kg_m3"], ring.density_kg_m3, &mut found);
        length(&["scene.disk.ring.inner_radius_m"], ring.inner_radius_m, &mut found);
        length(&["scene.disk.ring.outer_radius_m"], ring.outer_radius_m, &mut found);
        length(&["scene.disk.ring.thickness_m"], ring.thickness_m, &mut found);
    }
    length(&["scene.disk.track_radius_m"], disk.track_radius_m, &mut found);
    if scene.clamp.side != ClampSide::WholeTop {
        length(&["scene.clamp.width_m"], scene.clamp.width_m, &mut found);
    }
    // The speed follows from a radius that is in doubt itself.
    let speed_m_s = disk.omega_rpm * 2.0 * PI / 60.0 * disk.track_radius_m;
    if speed_m_s > FASTEST_M_S && disk.track_radius_m < LONGEST_M {
        let message =
            format!("the disk's surface moves at {} m/s; expected revolutions per minute", short(speed_m_s));
        let help = "1 rad/s is 9.55 rpm, and 1 Hz is 60 rpm";
        add(&mut found, &["scene.disk.omega_rpm"], speed_m_s, message, help);
    }
    let base_m = pin.extent_m()[0].max(pin.extent_m()[1]);
    if disk.track_radius_m < base_m && base_m < LONGEST_M {
        let message = format!("less than the longest edge of the pin's base, {} m", short(base_m));
        let help = "expected the distance in metres of the pin's centre from the disk's axis";
        add(&mut found, &["scene.disk.track_radius_m"], base_m / disk.track_radius_m, message, help);
    }
    let mu = scene.contact.mu;
    if mu > ROUGHEST {
        let message = "an unusually large friction coefficient".to_owned();
        add(&mut found, &["scene.contact.mu"], mu, message, "expected a number, not per cent");
    }
    holder(spec, &mut found);
    // A time of the pin is in doubt with its material and its size.
    if found.is_empty() {
        overdamped(spec, &mut found);
    }
    let limit_s = spec.run.limit_s;
    let transits = limit_s / scene.vibration_time_s();
    if limit_s >= LONGEST_S && transits > LONGEST_TRANSITS {
        let message = format!(
            "{} times as long as the pin's slowest waves take through it; expected seconds",
            short(transits)
        );
        add(&mut found, &["run.limit_s"], transits, message, "1 ms is 0.001 s");
    }
    found
}

/// Damping under which nothing vibrates. ζ = π β_R f is 1 at the frequency 1/(π β_R), and the lowest vibrations of the pin have
/// about 0.16/t with the time of [`Scene::vibration_time_s`](crate::spec::Scene::vibration_time_s).
fn overdamped(spec: &JobSpec, found: &mut Vec<Doubt>) {
    let critical_hz = 1.0 / (PI * spec.numerics.beta_r_s);
    let ratio = 0.16 / spec.scene.vibration_time_s() / critical_hz;
    if ratio > 1.0 {
        let message = format!(
            "every vibration above {} Hz is damped more than critically, and so are all of this pin's",
            short(critical_hz)
        );
        let fields: Fields =
            &["damping.frequency_hz", "damping.loss_factor", "damping.ratio", "numerics.beta_r_s"];
        add(found, fields, ratio, message, "frequency_hz is in Hz (1 kHz is 1000 Hz), and ζ = π β_R f");
    }
}

/// A holder that swings more slowly than any tribometer's, as if its mass were in g or its stiffness in kN/mm.
fn holder(spec: &JobSpec, found: &mut Vec<Doubt>) {
    let pin = &spec.scene.pin;
    let pin_kg = pin.density_kg_m3 * pin.base_area_m2() * pin.extent_m()[2];
    let fields: [Fields; 2] = [
        &["scene.holder.stiffness_x_n_m", "scene.holder.mass_kg"],
        &["scene.holder.stiffness_y_n_m", "scene.holder.mass_kg"],
    ];
    for (way, fields) in spec.scene.holder.directions().into_iter().zip(fields) {
        // A damper alone has no frequency.
        let Some(way) = way.filter(|way| way.stiffness_n_m > 0.0) else { continue };
        let frequency_hz = (way.stiffness_n_m / (way.mass_kg + pin_kg)).sqrt() / (2.0 * PI);
        if frequency_hz < SLOWEST_HOLDER_HZ {
            let message = format!(
                "with a mass of {} kg the holder swings at {} Hz, as if the stiffness were in kN/mm or the mass in g; expected N/m \
                 and kg",
                short(way.mass_kg),
                short(frequency_hz)
            );
            add(found, fields, 1.0 / frequency_hz, message, "1 kN/mm is 1e6 N/m, and 1 g is 0.001 kg");
        }
    }
}

fn young_modulus(fields: Fields, modulus_pa: f64, found: &mut Vec<Doubt>) {
    let help = "1 GPa is 1e9 Pa, and 1 MPa (1 N/mm²) is 1e6 Pa";
    if modulus_pa < SOFTEST_PA {
        let message = "softer than any gel, as if it were in GPa or MPa; expected Pa".to_owned();
        add(found, fields, 1.0 / modulus_pa, message, help);
    } else if modulus_pa > STIFFEST_PA {
        add(found, fields, modulus_pa, "stiffer than diamond (1.1e12 Pa); expected Pa".to_owned(), help);
    }
}

fn density(fields: Fields, density_kg_m3: f64, found: &mut Vec<Doubt>) {
    let help = "1 g/cm³ is 1000 kg/m³";
    if density_kg_m3 < LIGHTEST_KG_M3 {
        let message = "lighter than cork, as if it were in g/cm³; expected kg/m³".to_owned();
        add(found, fields, 1.0 / density_kg_m3, message, help);
    } else if density_kg_m3 > HEAVIEST_KG_M3 {
        let message = "heavier than osmium (22 600 kg/m³); expected kg/m³".to_owned();
        add(found, fields, density_kg_m3, message, help);
    }
}

fn length(fields: Fields, length_m: f64, found: &mut Vec<Doubt>) {
    if length_m >= LONGEST_M {
        let message = "a length of a metre or more, as if it were in mm; expected m".to_owned();
        add(found, fields, length_m, message, "1 mm is 0.001 m");
    }
}

fn add(found: &mut Vec<Doubt>, fields: Fields, size: f64, message: String, help: &str) {
    found.push(Doubt { kind: "unit", fields, size, message, help: help.to_owned() });
}
