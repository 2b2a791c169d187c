//! Values that look as if they were given in another unit.

use super::{Doubt, owned, short};
use crate::spec::JobSpec;
use crate::study::input::{Input, values_of};
use crate::study::parameter::PARAMETERS;
use crate::study::plausible::{HOLDER_MASS, LONGEST_M};
use std::f64::consts::PI;

/// Sliding speeds above this are suspected \[m/s\]; brakes of racing cars reach 100 m/s.
const FASTEST_M_S: f64 = 100.0;
/// Time limits are suspected that are longer than this \[s\] and than so many times of the slowest
/// waves, `Scene::vibration_time_s`.
const LONGEST_S: f64 = 1.0;
const LONGEST_TRANSITS: f64 = 1.0e5;

/// Holders that swing more slowly are suspected \[Hz\]. Soft arms of tribometers have some tens of Hz.
const SLOWEST_HOLDER_HZ: f64 = 1.0;

/// First the values of single fields, which [`PARAMETERS`] describes, and then those that look wrong beside others.
pub(super) fn doubts(spec: &JobSpec) -> Vec<Doubt> {
    let mut found = single_values(spec);
    let scene = &spec.scene;
    let (pin, disk) = (&scene.pin, &scene.disk);
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
    // A frequency of the holder is in doubt with its mass.
    if scene.holder.mass_kg.is_none_or(|mass_kg| HOLDER_MASS.doubt(mass_kg).is_none()) {
        holder(spec, &mut found);
    }
    // A time of the pin is in doubt with its material and its size.
    if found.is_empty() {
        overdamped(spec, &mut found);
        overdamped_by_mass(spec, &mut found);
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

/// Values of single fields that have an effect.
fn single_values(spec: &JobSpec) -> Vec<Doubt> {
    let with_range = PARAMETERS.iter().filter(|parameter| parameter.plausible.is_some());
    let of_input = |Input { parameter, value }: Input| {
        let range = parameter.plausible?;
        let (message, size) = range.doubt(value.as_f64()?)?;
        Some(doubt(vec![parameter.field()], size, message.to_owned(), range.help))
    };
    values_of(spec, with_range).into_iter().filter_map(of_input).collect()
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
        let fields = &[
            "damping.at_time_step_s",
            "damping.frequency_hz",
            "damping.loss_factor",
            "damping.ratio",
            "numerics.beta_r_s",
        ];
        let help =
            "time steps are in s (55 ns is 5.5e-8 s) and frequencies in Hz (1 kHz is 1000 Hz); ζ = π β_R f";
        add(found, fields, ratio, message, help);
    }
}

/// The same for damping in proportion to the mass: ζ = α_R/(4π f) is 1 at the frequency α_R/(4π), and larger below.
fn overdamped_by_mass(spec: &JobSpec, found: &mut Vec<Doubt>) {
    let critical_hz = spec.numerics.alpha_r_per_s.unwrap_or(0.0) / (4.0 * PI);
    let ratio = critical_hz / (0.16 / spec.scene.vibration_time_s());
    if ratio > 1.0 {
        let message = format!(
            "every vibration below {} Hz is damped more than critically, and so are the lowest ones of this pin",
            short(critical_hz)
        );
        let fields = &[
            "damping.second_frequency_hz",
            "damping.loss_factor",
            "damping.ratio",
            "numerics.alpha_r_per_s",
        ];
        add(found, fields, ratio, message, "α_R is in 1/s and frequencies are in Hz; ζ = α_R/(4π f)");
    }
}

/// A holder that swings more slowly than any tribometer's, as if its mass were in g or its stiffness in kN/mm.
fn holder(spec: &JobSpec, found: &mut Vec<Doubt>) {
    let pin = &spec.scene.pin;
    let pin_kg = pin.density_kg_m3 * pin.base_area_m2() * pin.extent_m()[2];
    let fields = ["scene.holder.stiffness_x_n_m", "scene.holder.stiffness_y_n_m"];
    for (way, field) in spec.scene.holder.directions().into_iter().zip(fields) {
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
            add(
                found,
                &[field, "scene.holder.mass_kg"],
                1.0 / frequency_hz,
                message,
                "1 kN/mm is 1e6 N/m, and 1 g is 0.001 kg",
            );
        }
    }
}

fn add(found: &mut Vec<Doubt>, fields: &[&str], size: f64, message: String, help: &str) {
    found.push(doubt(owned(fields), size, message, help));
}

fn doubt(fields: Vec<String>, size: f64, message: String, help: &str) -> Doubt {
    Doubt { kind: "unit", fields, size, message, help: help.to_owned() }
}
