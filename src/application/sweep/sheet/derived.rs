//! Quantities that follow from the inputs of a job.

use crate::spec::JobSpec;
use crate::spec::elasticity::{pressure_wave_speed_m_s, shear_wave_speed_m_s};
use crate::units::rad_per_s_from_rpm;

/// A quantity that follows from the inputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Derived {
    pub symbol: &'static str,
    /// What it is; unique.
    pub name: &'static str,
    pub value: f64,
    /// Its unit; empty for a number without one.
    pub unit: &'static str,
}

/// The name of the sliding speed, which a drawing also shows.
pub(super) const SLIDING_SPEED: &str = "sliding speed at the pin's centre, ωR";

/// The derived quantities of a job.
pub(super) fn of(spec: &JobSpec) -> Vec<Derived> {
    let pin = &spec.scene.pin;
    let [_, _, z_m] = pin.extent_m();
    let area_m2 = pin.base_area_m2();
    let (e, nu, rho) = (pin.young_modulus_pa, pin.poisson_ratio, pin.density_kg_m3);
    let (pressure_wave, shear_wave) = (pressure_wave_speed_m_s(e, nu, rho), shear_wave_speed_m_s(e, nu, rho));
    let load_n = spec.scene.load.force_n;
    let nodes = pin.node_count();
    let edges_m = pin.element_edges_m();
    let speed_m_s = rad_per_s_from_rpm(spec.scene.disk.omega_rpm) * spec.scene.disk.track_radius_m;
    let quantity = |symbol, name, value, unit| Derived { symbol, name, value, unit };
    vec![
        quantity("", "nodes of the pin", nodes, ""),
        quantity("", "element edge in x", edges_m[0], "m"),
        quantity("", "element edge in y", edges_m[1], "m"),
        quantity("", "element edge in z", edges_m[2], "m"),
        quantity("c_p", "speed of pressure waves in the pin", pressure_wave, "m/s"),
        quantity("c_s", "speed of shear waves in the pin", shear_wave, "m/s"),
        quantity("h/c_s", "transit time of shear waves over the pin's height", z_m / shear_wave, "s"),
        quantity("F/A", "mean contact pressure", load_n / area_m2, "Pa"),
        quantity("F/(EA)", "mean strain under the load", load_n / (e * area_m2), ""),
        quantity("V", SLIDING_SPEED, speed_m_s, "m/s"),
    ]
}
