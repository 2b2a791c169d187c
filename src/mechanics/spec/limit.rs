//! The limits of single fields: one table for the refusals of [`JobSpec::check`](super::JobSpec::check) and for the JSON schema
//! of studies. Limits that depend on other fields are where these fields are.

use End::{At, Beyond, Open};
use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::sync::LazyLock;

/// An end of the values that a field may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// There is none besides that of other fields.
    Open,
    /// The value itself is allowed.
    At(f64),
    /// The value itself is not allowed.
    Beyond(f64),
}

/// The values that a field may have, whatever the other fields are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Path of the field from the root of a job or a study. `[]` is every entry of a list.
    pub field: &'static str,
    /// The lower end.
    pub low: End,
    /// The upper end.
    pub high: End,
    /// What a value outside should be.
    expected: &'static str,
}

impl End {
    /// Whether a value is above this lower end, or is the end where that is allowed.
    pub fn is_below(self, value: f64) -> bool {
        match self {
            Self::Open => true,
            Self::At(low) => value >= low,
            Self::Beyond(low) => value > low,
        }
    }

    /// Whether a value is below this upper end, or is the end where that is allowed.
    pub fn is_above(self, value: f64) -> bool {
        match self {
            Self::Open => true,
            Self::At(high) => value <= high,
            Self::Beyond(high) => value < high,
        }
    }
}

impl Limit {
    /// Whether a finite value is within the limit.
    pub fn holds(&self, value: f64) -> bool {
        value.is_finite() && self.low.is_below(value) && self.high.is_above(value)
    }

    /// What would be right instead of `value`.
    pub fn expected(&self, value: f64) -> String {
        let (least, most) = (*MAGNITUDES.start(), *MAGNITUDES.end());
        let is_too_large = value.is_finite() && value > most && self.high == End::At(most);
        if self.low == End::At(least) && value.is_finite() && value > 0.0 {
            format!("{}, from {least:e} to {most:e}", self.expected)
        } else if is_too_large {
            format!("at most {most:e}")
        } else {
            self.expected.to_owned()
        }
    }

    /// The limit of a field; its entries have numbers: `scene.pin.size_m[0]`.
    pub fn of(field: &str) -> Option<&'static Self> {
        static BY_FIELD: LazyLock<HashMap<&str, &Limit>> =
            LazyLock::new(|| LIMITS.iter().map(|limit| (limit.field, limit)).collect());
        if !field.contains('[') {
            return BY_FIELD.get(field).copied();
        }
        let mut is_inside = false;
        let without_numbers: String = field
            .chars()
            .filter(|c| {
                is_inside = *c == '[' || is_inside && *c != ']';
                !is_inside || *c == '['
            })
            .collect();
        BY_FIELD.get(without_numbers.as_str()).copied()
    }
}

/// Usable magnitudes of positive quantities in SI units; no tribometer has values outside. Within this range everything
/// that the solver computes from them (squares of forces and speeds, masses, stiffness over mass) stays far inside the
/// range of f64. Outside of it a frequency can overflow before the first step.
pub(super) const MAGNITUDES: RangeInclusive<f64> = 1.0e-20..=1.0e20;

/// The longest time limit of a run \[s\]; more is taken for a typing error.
pub(super) const LONGEST_LIMIT_S: f64 = 100.0;

/// Least load \[N\].
pub(super) const LEAST_LOAD_N: f64 = 1.0e-20;

const fn between(field: &'static str, low: End, high: End, expected: &'static str) -> Limit {
    Limit { field, low, high, expected }
}

/// A positive quantity.
const fn positive(field: &'static str, expected: &'static str) -> Limit {
    between(field, At(*MAGNITUDES.start()), At(*MAGNITUDES.end()), expected)
}

/// A quantity that may be zero.
const fn not_negative(field: &'static str, expected: &'static str) -> Limit {
    between(field, At(0.0), At(*MAGNITUDES.end()), expected)
}

/// A length whose least value depends on other fields.
const fn length(field: &'static str, expected: &'static str) -> Limit {
    between(field, Beyond(0.0), At(*MAGNITUDES.end()), expected)
}

const RATIO: &str = "a Poisson's ratio with -1 < ν < 0.5";
const COEFFICIENT: &str = "a friction coefficient >= 0";
const STIFFNESS: &str = "a stiffness >= 0 N/m";
const DAMPER: &str = "a damper >= 0 N s/m";
const ROTATIONAL_STIFFNESS: &str = "a stiffness >= 0 N m/rad";
const ROTATIONAL_DAMPER: &str = "a damper >= 0 N m s/rad";
const INERTIA: &str = "an inertia >= 0 kg m²";
const HEIGHT: &str = "a height >= 0 m";
const HALF_AN_EDGE: &str = "a length > 0 m, at most half the shorter edge of the base";
const TILT: &str = "an angle from -30 to 30 degrees";

/// All limits of single fields.
#[rustfmt::skip]
pub static LIMITS: &[Limit] = &[
    positive("scene.pin.size_m[]", "a length > 0 m"),
    // More elements are taken for a typing error.
    between("scene.pin.elements[]", At(1.0), At(1000.0), "a number of elements from 1 to 1000"),
    positive("scene.pin.young_modulus_pa", "a modulus > 0 Pa"),
    between("scene.pin.poisson_ratio", Beyond(-1.0), Beyond(0.5), "a Poisson's ratio with -1 < ν < 0.5 (0.5 is incompressible: no finite wave speed)"),
    positive("scene.pin.density_kg_m3", "a density > 0 kg/m³"),
    positive("scene.pin.plasticity.yield_stress_pa", "a stress > 0 Pa"),
    not_negative("scene.pin.plasticity.hardening_modulus_pa", "a modulus >= 0 Pa"),
    not_negative("scene.pin.plasticity.saturation_stress_pa", "a stress >= 0 Pa"),
    positive("scene.pin.plasticity.saturation_strain", "a strain > 0"),
    not_negative("scene.pin.plasticity.kinematic_modulus_pa", "a modulus >= 0 Pa"),
    positive("scene.pin.plasticity.rate_reference_per_s", "a rate > 0 1/s"),
    between("scene.pin.plasticity.rate_exponent", At(1.0), At(100.0), "an exponent from 1 to 100"),
    positive("scene.pin.diameter_m", "a diameter > 0 m"),
    // The contact is that of small tilts: nodes touch with their base only.
    between("scene.pin.tilt_x_deg", At(-30.0), At(30.0), TILT),
    between("scene.pin.tilt_y_deg", At(-30.0), At(30.0), TILT),
    positive("scene.pin.mesh.length_unit_m", "a length > 0 m"),
    positive("scene.pin.regions[].young_modulus_pa", "a modulus > 0 Pa"),
    between("scene.pin.regions[].poisson_ratio", Beyond(-1.0), Beyond(0.5), RATIO),
    positive("scene.pin.regions[].density_kg_m3", "a density > 0 kg/m³"),
    positive("scene.pin.regions[].plasticity.yield_stress_pa", "a stress > 0 Pa"),
    not_negative("scene.pin.regions[].plasticity.hardening_modulus_pa", "a modulus >= 0 Pa"),
    not_negative("scene.pin.regions[].plasticity.saturation_stress_pa", "a stress >= 0 Pa"),
    positive("scene.pin.regions[].plasticity.saturation_strain", "a strain > 0"),
    not_negative("scene.pin.regions[].plasticity.kinematic_modulus_pa", "a modulus >= 0 Pa"),
    positive("scene.pin.regions[].plasticity.rate_reference_per_s", "a rate > 0 1/s"),
    between("scene.pin.regions[].plasticity.rate_exponent", At(1.0), At(100.0), "an exponent from 1 to 100"),
    length("scene.pin.base.crown_radius_m", "a radius of at least half the diagonal of the base"),
    length("scene.pin.base.edge_radius_m", HALF_AN_EDGE),
    length("scene.pin.base.chamfer_width_m", HALF_AN_EDGE),
    not_negative("scene.pin.base.chamfer_height_m", HEIGHT),
    not_negative("scene.pin.base.wave_height_m", HEIGHT),
    length("scene.pin.base.wave_length_m", "a length > 0 m"),
    between("scene.pin.base.wave_direction_deg", At(-360.0), At(360.0), "an angle from -360 to 360 degrees"),
    not_negative("scene.pin.base.roughness.rms_m", HEIGHT),
    between("scene.pin.base.roughness.seed", At(0.0), Open, "a whole number >= 0"),
    between("scene.pin.base.roughness.hurst", Beyond(0.0), At(1.0), "a Hurst exponent above 0, at most 1"),
    length("scene.pin.base.roughness.longest_m", "a length > 0 m"),
    length("scene.pin.base.roughness.shortest_m", "a length > 0 m"),
    positive("scene.pin.base.height_map.spacing_m", "a distance > 0 m"),
    positive("scene.disk.omega_rpm", "a speed > 0 rpm (the disk always turns towards +y)"),
    length("scene.disk.track_radius_m", "a radius larger than half the pin's width, so that the pin does not lie over the axis"),
    not_negative("scene.disk.runout_m", HEIGHT),
    not_negative("scene.disk.waviness_height_m", HEIGHT),
    between("scene.disk.waviness_count", At(1.0), Open, "a number of waves of at least 1"),
    positive("scene.disk.ring.inner_radius_m", "a length > 0 m"),
    positive("scene.disk.ring.outer_radius_m", "a length > 0 m"),
    positive("scene.disk.ring.thickness_m", "a length > 0 m"),
    positive("scene.disk.ring.element_size_m", "a length > 0 m"),
    positive("scene.disk.ring.coarse_element_size_m", "a length > 0 m"),
    positive("scene.disk.ring.young_modulus_pa", "a modulus > 0 Pa"),
    between("scene.disk.ring.poisson_ratio", Beyond(-1.0), Beyond(0.5), RATIO),
    positive("scene.disk.ring.density_kg_m3", "a density > 0 kg/m³"),
    between("scene.disk.ring.track_arc_deg", Beyond(0.0), At(360.0), "an arc, 0 < track_arc_deg <= 360"),
    not_negative("scene.contact.mu", COEFFICIENT),
    not_negative("scene.contact.mu_static", COEFFICIENT),
    positive("scene.contact.speed_m_s", "a slip speed > 0 m/s"),
    not_negative("scene.contact.slope_s_m", "a rise >= 0 s/m"),
    positive("scene.contact.length_m", "a length > 0 m"),
    not_negative("scene.contact.mu_of_speed[][]", "pairs of a slip speed >= 0 m/s and a friction coefficient >= 0"),
    positive("scene.contact.stiffness_pa_m", "a stiffness > 0 Pa/m"),
    between("scene.contact.stiffness_exponent", At(1.0), At(10.0), "an exponent from 1 to 10"),
    positive("scene.contact.stiffness_pressure_pa", "a pressure > 0 Pa"),
    not_negative("scene.clamp.width_m", "a width >= 0 m (0 holds one node row)"),
    not_negative("scene.holder.mass_kg", "a mass >= 0 kg"),
    not_negative("scene.holder.stiffness_x_n_m", STIFFNESS),
    not_negative("scene.holder.stiffness_y_n_m", STIFFNESS),
    between("scene.holder.stiffness_z_n_m", At(0.0), At(0.0), "0 N/m (the mass rides on the pin) or no such field (nothing moves in z): a spring in z would carry a part of the load. Of an arm that is elastic in z, compare both"),
    not_negative("scene.holder.damping_x_n_s_m", DAMPER),
    not_negative("scene.holder.damping_y_n_s_m", DAMPER),
    not_negative("scene.holder.damping_z_n_s_m", DAMPER),
    not_negative("scene.holder.rotational_stiffness_x_nm_rad", ROTATIONAL_STIFFNESS),
    not_negative("scene.holder.rotational_stiffness_y_nm_rad", ROTATIONAL_STIFFNESS),
    not_negative("scene.holder.rotational_damping_x_nm_s_rad", ROTATIONAL_DAMPER),
    not_negative("scene.holder.rotational_damping_y_nm_s_rad", ROTATIONAL_DAMPER),
    not_negative("scene.holder.inertia_x_kg_m2", INERTIA),
    not_negative("scene.holder.inertia_y_kg_m2", INERTIA),
    between("scene.load.force_n", At(LEAST_LOAD_N), Open, "a load > 0 N, pressing the pin on the disk"),
    between("scene.load.ramp_s", At(0.0), Open, "a duration >= 0 s (0 is a sudden load)"),
    // Entries are a time and a speed or a load.
    not_negative("scene.program.omega_rpm[][]", "a time >= 0 s and a speed >= 0 rpm"),
    not_negative("scene.program.force_n[][]", "a time >= 0 s and a load > 0 N"),
    between("numerics.beta2", At(0.5), At(1.0), "0.5 <= β₂ <= 1 (0.5 is the central difference)"),
    not_negative("numerics.beta_r_s", "a damping time >= 0 s"),
    not_negative("numerics.alpha_r_per_s", "a damping rate >= 0 1/s"),
    between("accuracy.mu_star", At(1.0e-4), At(0.5), "a share of μ* from 0.0001 to 0.5: 0.01 is 1 %"),
    between("numerics.safety_factor", Beyond(0.0), At(1.0), "a fraction of the stability limit, 0 < safety_factor <= 1"),
    between("numerics.time_step_s", Beyond(0.0), Open, "a time step > 0 s"),
    between("run.limit_s", Beyond(0.0), At(LONGEST_LIMIT_S), "a time limit, 0 < limit_s <= 100 s"),
    between("run.average_last_fraction", Beyond(0.0), Beyond(1.0), "a fraction of the run, 0 < average_last_fraction < 1"),
    between("run.window_s", Beyond(0.0), At(LONGEST_LIMIT_S), "a length > 0 s, within run.limit_s"),
    between("detection.cycles", At(2.0), At(10_000.0), "a number of cycles from 2 to 10000"),
    between("detection.tolerance", Beyond(0.0), Beyond(1.0), "0 < tolerance < 1"),
    between("detection.drift_tolerance", Beyond(0.0), Beyond(1.0), "0 < drift_tolerance < 1"),
    between("detection.regime_threshold", At(0.0), Beyond(1.0), "a share, 0 <= regime_threshold < 1"),
    between("damping.ratio", At(0.0), Beyond(1.0), "a fraction of critical damping, 0 <= ratio < 1"),
    between("damping.loss_factor", At(0.0), Beyond(2.0), "twice a damping ratio, 0 <= loss_factor < 2"),
    between("damping.holder_ratio", At(0.0), Beyond(1.0), "a fraction of critical damping, 0 <= holder_ratio < 1"),
    positive("sliding_speed_m_s", "a speed > 0 m/s"),
    between("damping.frequency_hz", Beyond(0.0), Open, "a frequency > 0 Hz"),
    between("damping.second_frequency_hz", Beyond(0.0), Open, "a frequency > 0 Hz"),
    between("damping.beta2", At(0.5), At(1.0), "0.5 <= β₂ <= 1 (0.5 has no damping)"),
    between("damping.at_time_step_s", Beyond(0.0), Open, "a time step > 0 s"),
    between("detection.decay_observation_s", Beyond(0.0), Open, "a duration > 0 s"),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: no field has two limits, and each is found by the name that a message has.
    #[test]
    fn each_field_has_one_limit() {
        for (index, limit) in LIMITS.iter().enumerate() {
            assert!(LIMITS[..index].iter().all(|other| other.field != limit.field), "{}", limit.field);
            let named = limit.field.replace("[]", "[12]");
            assert_eq!(Limit::of(&named), Some(limit), "{named}");
        }
        assert_eq!(Limit::of("scene.pin.shape"), None);
    }

    /// Protects: each end of a limit belongs to it or not, and the message says which end is missed.
    #[test]
    fn ends_are_in_or_out() {
        let ratio = Limit::of("scene.pin.poisson_ratio").unwrap();
        assert_eq!([-1.0, -0.99, 0.49, 0.5].map(|value| ratio.holds(value)), [false, true, true, false]);
        let mu = Limit::of("scene.contact.mu").unwrap();
        assert_eq!([-0.1, 0.0, 1.0e20, 1.1e20].map(|value| mu.holds(value)), [false, true, true, false]);
        assert_eq!((mu.expected(-0.1).as_str(), mu.expected(2.0e20).as_str()), (COEFFICIENT, "at most 1e20"));
        assert!(!mu.holds(f64::NAN) && !mu.holds(f64::INFINITY));
        let modulus = Limit::of("scene.pin.young_modulus_pa").unwrap();
        assert_eq!(modulus.expected(1.0e-21), "a modulus > 0 Pa, from 1e-20 to 1e20");
        assert_eq!(modulus.expected(0.0), "a modulus > 0 Pa");
    }
}
