//! Contact and friction between pin and disk.

use super::check::Violations;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strum::{IntoStaticStr, VariantArray};

/// How the largest friction force of a node depends on its normal force N, its slip speed v and its past.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Serialize,
    Deserialize,
    JsonSchema,
    IntoStaticStr,
    VariantArray,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum FrictionLaw {
    /// μN.
    #[default]
    Coulomb,
    /// `mu_static` N for a node that begins to slip, μN for one that slips.
    StaticKinetic,
    /// μ + (`mu_static` − μ) exp(−v/`speed_m_s`) + `slope_s_m` v, times N.
    Exponential,
    /// μN v/(v + `speed_m_s`): Coulomb's law without stick.
    Regularised,
    /// Approaches μN within a slip of `length_m`.
    PrakashClifton,
}

impl FrictionLaw {
    /// The name used in study files, for example `static_kinetic`.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The fields of a contact that the law uses besides `mu`.
    pub fn coefficients(self) -> &'static [&'static str] {
        match self {
            Self::Coulomb => &[],
            Self::StaticKinetic => &["mu_static"],
            Self::Exponential => &["mu_static", "speed_m_s", "slope_s_m"],
            Self::Regularised => &["speed_m_s"],
            Self::PrakashClifton => &["length_m"],
        }
    }

    /// Whether a node that slips steadily has the friction force μN at every speed, and begins to slip at it.
    pub fn has_one_mu(self) -> bool {
        matches!(self, Self::Coulomb | Self::PrakashClifton)
    }
}

/// Unilateral contact with friction, the same at every node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Contact {
    /// Local friction coefficient μ ≥ 0: Coulomb's, or that of fast slip under a constant load in other laws.
    pub mu: f64,
    /// The friction law.
    pub law: FrictionLaw,
    /// Coefficient ≥ 0 without slip, for the laws `static_kinetic` and `exponential`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mu_static: Option<f64>,
    /// Slip speed (m/s) that scales the laws `exponential` and `regularised`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// Rise ≥ 0 of the coefficient with the slip speed (s/m) in the law `exponential`. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope_s_m: Option<f64>,
    /// Slip (m) in which the law `prakash_clifton` follows the normal force.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_m: Option<f64>,
    /// Stiffness (Pa/m) of a layer between pin and disk: pressure over depth. Absent: rigid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_pa_m: Option<f64>,
    /// Exponent m ≥ 1 of a layer whose pressure rises like depth^m. Absent: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_exponent: Option<f64>,
    /// Pressure (Pa) at which the layer has the stiffness `stiffness_pa_m`, for an exponent other than 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_pressure_pa: Option<f64>,
}

impl Default for Contact {
    fn default() -> Self {
        Self {
            mu: 0.4,
            law: FrictionLaw::Coulomb,
            mu_static: None,
            speed_m_s: None,
            slope_s_m: None,
            length_m: None,
            stiffness_pa_m: None,
            stiffness_exponent: None,
            stiffness_pressure_pa: None,
        }
    }
}

impl Contact {
    /// Stiffness \[Pa/m\], exponent and pressure \[Pa\] of the layer; none if the contact is rigid. With the exponent 1 the
    /// pressure has no effect.
    pub fn layer(&self) -> Option<[f64; 3]> {
        let exponent = self.stiffness_exponent.unwrap_or(1.0);
        Some([self.stiffness_pa_m?, exponent, self.stiffness_pressure_pa.unwrap_or(1.0)])
    }

    /// The part that all jobs of a batch share: the law and the layer, without the coefficients of friction.
    pub(super) fn shared_part(&self) -> Self {
        let Self { law, stiffness_pa_m, stiffness_exponent, stiffness_pressure_pa, .. } = *self;
        Self { law, stiffness_pa_m, stiffness_exponent, stiffness_pressure_pa, ..Self::default() }
    }

    /// The same contact without the coefficients that its law or its layer does not use.
    #[must_use]
    pub fn in_use(&self) -> Self {
        let exponent =
            self.stiffness_exponent.filter(|exponent| self.stiffness_pa_m.is_some() && *exponent != 1.0);
        let of_law =
            |name: &str, value: Option<f64>| value.filter(|_| self.law.coefficients().contains(&name));
        Self {
            mu: self.mu,
            law: self.law,
            mu_static: of_law("mu_static", self.mu_static),
            speed_m_s: of_law("speed_m_s", self.speed_m_s),
            slope_s_m: of_law("slope_s_m", self.slope_s_m).filter(|slope| *slope != 0.0),
            length_m: of_law("length_m", self.length_m),
            stiffness_pa_m: self.stiffness_pa_m,
            stiffness_exponent: exponent,
            stiffness_pressure_pa: self.stiffness_pressure_pa.filter(|_| exponent.is_some()),
        }
    }

    /// Adds every violated limit to `found`.
    pub(super) fn check(&self, found: &mut Violations) {
        let name = self.law.name();
        let uses = |field: &str| self.law.coefficients().contains(&field);
        found.within("scene.contact.mu", self.mu);
        let missing = |found: &mut Violations, field: &str, what: &str| {
            found.add(field, "absent", format!("{what} for the friction law {name}"));
        };
        match self.mu_static {
            Some(mu) => _ = found.within("scene.contact.mu_static", mu),
            None if uses("mu_static") => {
                missing(found, "scene.contact.mu_static", "a friction coefficient >= 0");
            }
            None => {}
        }
        match self.speed_m_s {
            Some(speed) => _ = found.within("scene.contact.speed_m_s", speed),
            None if uses("speed_m_s") => {
                missing(found, "scene.contact.speed_m_s", "a slip speed > 0 m/s");
            }
            None => {}
        }
        found.within_if_given("scene.contact.slope_s_m", self.slope_s_m);
        self.check_layer(found);
        match self.length_m {
            Some(length) => _ = found.within("scene.contact.length_m", length),
            None if uses("length_m") => {
                missing(found, "scene.contact.length_m", "a length > 0 m");
            }
            None => {}
        }
    }

    fn check_layer(&self, found: &mut Violations) {
        let exponent = self.stiffness_exponent.unwrap_or(1.0);
        found.within("scene.contact.stiffness_exponent", exponent);
        let field = "scene.contact.stiffness_pressure_pa";
        match self.stiffness_pressure_pa {
            Some(pressure) => _ = found.within(field, pressure),
            None if exponent != 1.0 => {
                found.add(field, "absent", "a pressure > 0 Pa for an exponent other than 1");
            }
            None => {}
        }
        let field = "scene.contact.stiffness_pa_m";
        match self.stiffness_pa_m {
            Some(stiffness) => _ = found.within(field, stiffness),
            None if self.stiffness_exponent.is_some() || self.stiffness_pressure_pa.is_some() => {
                found.add(
                    field,
                    "absent",
                    "a stiffness > 0 Pa/m beside stiffness_exponent or stiffness_pressure_pa",
                );
            }
            None => {}
        }
    }
}
