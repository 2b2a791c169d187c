//! Contact and friction between pin and disk.

use super::check::Violations;
use super::limit::Limit;
use super::mu_of_speed::MuOfSpeed;
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
    /// The coefficient of `mu_of_speed` at v, times N; in proportion to μ, which is that of the last speed.
    Table,
}

/// What friction in a step uses of the step before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Memory {
    /// Nothing.
    None,
    /// The slip of a node.
    Slip,
    /// The limit of a node, which is a state of friction.
    Limit,
}

/// What a law says about itself, whatever its coefficients are.
struct About {
    /// The fields of a contact that the law uses besides `mu`.
    coefficients: &'static [&'static str],
    memory: Memory,
    /// Whether a node that slips steadily has the friction force μN at every speed, and begins to slip at it.
    has_one_mu: bool,
    /// Whether friction of slow slip is never larger than that of fast slip under the same normal force.
    is_largest_in_slip: bool,
}

impl FrictionLaw {
    fn about(self) -> About {
        let about = |coefficients, memory, has_one_mu, is_largest_in_slip| About {
            coefficients,
            memory,
            has_one_mu,
            is_largest_in_slip,
        };
        match self {
            Self::Coulomb => about(&[], Memory::None, true, true),
            Self::StaticKinetic => about(&["mu_static"], Memory::Slip, false, false),
            Self::Exponential => about(&["mu_static", "speed_m_s", "slope_s_m"], Memory::Slip, false, false),
            Self::Regularised => about(&["speed_m_s"], Memory::None, false, true),
            Self::PrakashClifton => about(&["length_m"], Memory::Limit, true, false),
            Self::Table => about(&["mu_of_speed"], Memory::Slip, false, false),
        }
    }

    /// The name used in study files, for example `static_kinetic`.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The coefficients that the law uses besides `mu`.
    pub fn coefficients(self) -> impl Iterator<Item = &'static Coefficient> {
        COEFFICIENTS.iter().filter(move |coefficient| self.uses(coefficient))
    }

    /// Whether the law uses a coefficient.
    pub fn uses(self, coefficient: &Coefficient) -> bool {
        self.about().coefficients.contains(&coefficient.name)
    }

    /// What friction in a step uses of the step before.
    pub fn memory(self) -> Memory {
        self.about().memory
    }

    /// Whether a node that slips steadily has the friction force μN at every speed, and begins to slip at it.
    pub fn has_one_mu(self) -> bool {
        self.about().has_one_mu
    }

    /// Whether the limit of friction is μN at every node and at every time.
    pub fn is_always_mu(self) -> bool {
        self.has_one_mu() && self.memory() == Memory::None
    }

    /// Whether friction of slow slip is never larger than that of fast slip under the same normal force.
    pub fn is_largest_in_slip(self) -> bool {
        self.about().is_largest_in_slip
    }
}

/// A coefficient of friction that not every law uses: one number, or a list.
#[derive(Debug)]
pub struct Coefficient {
    /// The field of a contact.
    pub name: &'static str,
    /// Its path from the root of a job.
    pub field: &'static str,
    /// The path of one of its numbers, by which their [limit](super::Limit) is found.
    number: &'static str,
    /// Whether a law that uses it cannot do without it.
    is_needed: bool,
    /// Whether it is a pure number, without a unit.
    pub is_ratio: bool,
    /// Its numbers in a contact; none if it is absent.
    pub values: fn(&Contact) -> &[f64],
}

/// The coefficients of friction that not every law uses.
#[rustfmt::skip]
pub static COEFFICIENTS: [Coefficient; 5] = [
    Coefficient { name: "mu_static", field: "scene.contact.mu_static", number: "scene.contact.mu_static", is_needed: true, is_ratio: true, values: |contact| contact.mu_static.as_slice() },
    Coefficient { name: "speed_m_s", field: "scene.contact.speed_m_s", number: "scene.contact.speed_m_s", is_needed: true, is_ratio: false, values: |contact| contact.speed_m_s.as_slice() },
    Coefficient { name: "slope_s_m", field: "scene.contact.slope_s_m", number: "scene.contact.slope_s_m", is_needed: false, is_ratio: false, values: |contact| contact.slope_s_m.as_slice() },
    Coefficient { name: "length_m", field: "scene.contact.length_m", number: "scene.contact.length_m", is_needed: true, is_ratio: false, values: |contact| contact.length_m.as_slice() },
    Coefficient { name: "mu_of_speed", field: "scene.contact.mu_of_speed", number: "scene.contact.mu_of_speed[][]", is_needed: true, is_ratio: false, values: |contact| contact.mu_of_speed.0.as_flattened() },
];

/// A rise of friction over the slip speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Rise {
    /// The field of a job that has it.
    pub field: String,
    /// Its slope \[s/m\].
    pub slope_s_m: f64,
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
    /// Friction coefficient over the slip speed, for the law `table`. `mu` is the coefficient of the last speed: another `mu` scales all of
    /// them, and without a `mu` in the study they are as they are.
    #[serde(skip_serializing_if = "MuOfSpeed::is_empty")]
    pub mu_of_speed: MuOfSpeed,
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
            mu_of_speed: MuOfSpeed::default(),
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
        let Self { law, stiffness_pa_m, stiffness_exponent, stiffness_pressure_pa, .. } = self.clone();
        Self { law, stiffness_pa_m, stiffness_exponent, stiffness_pressure_pa, ..Self::default() }
    }

    /// The same contact without the coefficients that its law or its layer does not use.
    #[must_use]
    pub fn in_use(&self) -> Self {
        let exponent =
            self.stiffness_exponent.filter(|exponent| self.stiffness_pa_m.is_some() && *exponent != 1.0);
        let used = |name: &str| self.law.about().coefficients.contains(&name);
        Self {
            mu: self.mu,
            law: self.law,
            mu_static: self.mu_static.filter(|_| used("mu_static")),
            speed_m_s: self.speed_m_s.filter(|_| used("speed_m_s")),
            slope_s_m: self.slope_s_m.filter(|slope| used("slope_s_m") && *slope != 0.0),
            length_m: self.length_m.filter(|_| used("length_m")),
            mu_of_speed: if used("mu_of_speed") { self.mu_of_speed.clone() } else { MuOfSpeed::default() },
            stiffness_pa_m: self.stiffness_pa_m,
            stiffness_exponent: exponent,
            stiffness_pressure_pa: self.stiffness_pressure_pa.filter(|_| exponent.is_some()),
        }
    }

    /// The steepest rise of friction over the slip speed that a step takes from the step before; `None` if there is none.
    pub fn steepest_rise(&self) -> Option<Rise> {
        let (field, slope_s_m) = match self.law {
            FrictionLaw::Exponential => {
                let viscous = self.slope_s_m.unwrap_or(0.0);
                let at_rest = viscous + (self.mu - self.mu_static?) / self.speed_m_s?;
                if at_rest > viscous {
                    ("scene.contact.speed_m_s".to_owned(), at_rest)
                } else {
                    ("scene.contact.slope_s_m".to_owned(), viscous)
                }
            }
            FrictionLaw::Table => {
                let (pair, slope_s_m) = self.mu_of_speed.steepest_rise()?;
                (format!("scene.contact.mu_of_speed[{pair}]"), self.table_scale() * slope_s_m)
            }
            FrictionLaw::Coulomb
            | FrictionLaw::StaticKinetic
            | FrictionLaw::Regularised
            | FrictionLaw::PrakashClifton => return None,
        };
        (slope_s_m > 0.0).then_some(Rise { field, slope_s_m })
    }

    /// The coefficient of fast slip that the table of the law has itself; `None` if the law has no table.
    pub fn table_mu(&self) -> Option<f64> {
        self.mu_of_speed.fast().filter(|mu| self.law == FrictionLaw::Table && *mu > 0.0)
    }

    /// What `mu` makes of the values of the table; NaN without a table.
    fn table_scale(&self) -> f64 {
        self.mu / self.mu_of_speed.fast().unwrap_or(f64::NAN)
    }

    /// How steeply \[s/m\] friction over the normal force rises at least with the speed \[m/s\] of slip, which damps the base.
    pub(super) fn viscous_part_s_m(&self, speed_m_s: f64) -> f64 {
        match self.law {
            FrictionLaw::Regularised => {
                let v0 = self.speed_m_s.unwrap_or(0.0);
                self.mu * v0 / ((speed_m_s + v0) * (speed_m_s + v0))
            }
            FrictionLaw::Exponential => self.slope_s_m.unwrap_or(0.0),
            FrictionLaw::Table => (self.table_scale() * self.mu_of_speed.at(speed_m_s)[1]).max(0.0),
            FrictionLaw::Coulomb | FrictionLaw::StaticKinetic | FrictionLaw::PrakashClifton => 0.0,
        }
    }

    /// Adds every violated limit to `found`.
    pub(super) fn check(&self, found: &mut Violations) {
        found.within("scene.contact.mu", self.mu);
        for coefficient in &COEFFICIENTS {
            let values = (coefficient.values)(self);
            // A table says itself which of its pairs is wrong.
            for value in values.iter().filter(|_| coefficient.number == coefficient.field) {
                found.within(coefficient.number, *value);
            }
            if values.is_empty() && coefficient.is_needed && self.law.uses(coefficient) {
                let right =
                    Limit::of(coefficient.number).map_or_else(String::new, |limit| limit.expected(0.0));
                let law = self.law.name();
                found.add(coefficient.field, "absent", format!("{right} for the friction law {law}"));
            }
        }
        self.mu_of_speed.check(found);
        self.check_layer(found);
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
