//! Yielding of a material with large strains.

use super::check::Violations;
use super::{JobSpec, MOST_POINTS, MaterialLaw, Strains};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The stress at which a material yields (von Mises), and how that changes with the plastic strain ε̄ and its rate.
///
/// The yield stress is (σ₀ + H ε̄ + Q (1 − exp(−ε̄/ε₀))) (1 + (ε̄'/D)^(1/q)), or a curve over ε̄ with the same factor. It is a Kirchhoff stress,
/// which differs from Cauchy's by the change of volume.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plasticity {
    /// Yield stress σ₀ (Pa) without plastic strain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_stress_pa: Option<f64>,
    /// Linear hardening H (Pa). Absent: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hardening_modulus_pa: Option<f64>,
    /// Hardening Q (Pa) that saturates (Voce). Absent: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub saturation_stress_pa: Option<f64>,
    /// Plastic strain ε₀ after which 63 % of the saturation are reached.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub saturation_strain: Option<f64>,
    /// Points of a curve instead of the other numbers of isotropic hardening: plastic strain and yield stress (Pa), linear between them and
    /// constant beyond the last one. The first one has the plastic strain 0 and the stress `yield_stress_pa`, so that a study with a curve cannot
    /// vary that.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hardening_curve: Vec<[f64; 2]>,
    /// Kinematic hardening (Pa): the rise of the stress over small plastic strains in tension by the shift of the yield surface. At a plastic
    /// strain of 0.3 the shift is 1.2 times as large in tension. Absent: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinematic_modulus_pa: Option<f64>,
    /// Rate of plastic strain D (1/s) at which the yield stress is twice that of slow yielding (Cowper and Symonds). Absent: it does not depend
    /// on the rate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_reference_per_s: Option<f64>,
    /// Exponent q: the yield stress grows by the factor 1 + (ε̄'/D)^(1/q).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_exponent: Option<f64>,
}

impl Plasticity {
    /// Adds every violated limit to `found`; `at` is the path of the object, and `yields` whether the pin has a law that uses it.
    fn check_in(&self, yields: bool, at: &str, found: &mut Violations) {
        if !yields {
            found.add(at, "an object", ONLY_J2);
        }
        let field = |name: &str| format!("{at}.{name}");
        match self.yield_stress_pa {
            Some(stress_pa) => _ = found.within(&field("yield_stress_pa"), stress_pa),
            None => found.add(&field("yield_stress_pa"), "absent", "a stress > 0 Pa"),
        }
        found.within_if_given(&field("hardening_modulus_pa"), self.hardening_modulus_pa);
        found.within_if_given(&field("saturation_stress_pa"), self.saturation_stress_pa);
        found.within_if_given(&field("saturation_strain"), self.saturation_strain);
        found.within_if_given(&field("kinematic_modulus_pa"), self.kinematic_modulus_pa);
        found.within_if_given(&field("rate_reference_per_s"), self.rate_reference_per_s);
        found.within_if_given(&field("rate_exponent"), self.rate_exponent);
        let pairs = [
            ("saturation_stress_pa", self.saturation_stress_pa, "saturation_strain", self.saturation_strain),
            ("rate_reference_per_s", self.rate_reference_per_s, "rate_exponent", self.rate_exponent),
        ];
        for (first, one, second, other) in pairs {
            for (given, absent, name) in [(one, other, second), (other, one, first)] {
                if given.is_some() && absent.is_none() {
                    found.add(
                        &field(name),
                        "absent",
                        format!("a number: {first} and {second} belong together"),
                    );
                }
            }
        }
        self.check_curve(at, found);
    }

    fn check_curve(&self, at: &str, found: &mut Violations) {
        let Some(&[first_strain, first_pa]) = self.hardening_curve.first() else { return };
        for (name, given) in [
            ("hardening_modulus_pa", self.hardening_modulus_pa),
            ("saturation_stress_pa", self.saturation_stress_pa),
        ] {
            if let Some(value) = given {
                found.add(
                    &format!("{at}.{name}"),
                    value,
                    "absent, because a hardening_curve says how it hardens",
                );
            }
        }
        if self.hardening_curve.len() > MOST_POINTS {
            let right = format!("at most {MOST_POINTS} points");
            found.add(&format!("{at}.hardening_curve"), self.hardening_curve.len(), right);
        }
        let yield_stress_pa = self.yield_stress_pa.unwrap_or(f64::NAN);
        if first_strain != 0.0 || first_pa != yield_stress_pa {
            let right = format!("[0, {yield_stress_pa}]: the plastic strain 0 and the yield stress");
            found.add(&format!("{at}.hardening_curve[0]"), format!("[{first_strain}, {first_pa}]"), right);
        }
        for (number, points) in self.hardening_curve.windows(2).enumerate() {
            let [[before, before_pa], [strain, stress_pa]] = [points[0], points[1]];
            let right = "a larger plastic strain and no smaller stress than the point before: softening has no solution that meshes agree on";
            if !(strain > before && strain.is_finite() && stress_pa >= before_pa && stress_pa.is_finite()) {
                let place = format!("{at}.hardening_curve[{}]", number + 1);
                found.add(&place, format!("[{strain}, {stress_pa}]"), right);
            }
        }
    }
}

impl JobSpec {
    /// That a material which yields says when, and that only such a material does.
    pub(super) fn check_plasticity(&self, found: &mut Violations) {
        let pin = &self.scene.pin;
        let yields = pin.material == MaterialLaw::J2;
        match &pin.plasticity {
            None if yields && pin.strains == Strains::Finite => {
                let right = "an object with yield_stress_pa: scene.pin.material = j2 yields";
                found.add("scene.pin.plasticity", "absent", right);
            }
            Some(plasticity) => plasticity.check_in(yields, "scene.pin.plasticity", found),
            None => {}
        }
        if yields && pin.strains == Strains::Small {
            let right = "finite with scene.pin.material = j2: only large strains yield";
            found.add("scene.pin.strains", "small", right);
        }
        for (number, region) in pin.regions.iter().enumerate() {
            let at = format!("scene.pin.regions[{number}].plasticity");
            if let Some(plasticity) = &region.plasticity {
                plasticity.check_in(yields, &at, found);
            }
        }
        if yields && self.continuation.is_some() {
            let right = "absent with scene.pin.material = j2: what a job of a chain hands on is its motion, without the plastic strain";
            found.add("continuation", "present", right);
        }
    }
}

const ONLY_J2: &str = "absent, or scene.pin.material = j2 with scene.pin.strains = finite";
