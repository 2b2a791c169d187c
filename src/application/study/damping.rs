//! Damping as people know it: a ratio at a frequency, or the β₂ of a scheme at its time step.

use super::json::present;
use crate::spec::{DiskKind, FieldError, JobSpec, Limit, Numerics};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Damping at one frequency, by a damping ratio or by a loss factor, or the damping of the β₂ method at a time step. It gives
/// `numerics.beta_r_s`: damping in proportion to the stiffness, C = `β_R` K, has ζ(f) = `β_R` π f, so at other frequencies it is
/// in proportion to them. With a second frequency, C = `α_R` M + `β_R` K has ζ(f) = `α_R`/(4πf) + `β_R` π f, which is the same at both. The β₂ method has the damping `β_R` = (β₂ − ½) Δt, which depends on the time step, and so on the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Damping {
    /// Damping ratio ζ of a mode at `frequency_hz`, as a fraction of critical damping, 0 ≤ ζ < 1.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub ratio: Option<f64>,
    /// Loss factor η = 2 ζ at `frequency_hz`, 0 ≤ η < 2; instead of `ratio`.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub loss_factor: Option<f64>,
    /// Frequency (Hz) at which the ratio or the loss factor holds.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub frequency_hz: Option<f64>,
    /// A second frequency (Hz) at which the ratio or the loss factor holds, too: the pin then has damping in proportion to its mass as well,
    /// C = `α_R` M + `β_R` K. Between the two frequencies the damping is smaller, and beyond them larger. Rigid disks only.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub second_frequency_hz: Option<f64>,
    /// β₂ of a scheme whose damping the job has, ½ ≤ β₂ ≤ 1; with `at_time_step_s` instead of a ratio and a frequency.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub beta2: Option<f64>,
    /// Time step (s) at which the scheme has this damping. The job's own time step may be another one.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub at_time_step_s: Option<f64>,
    /// Damping ratio ζ of the holder's springs, 0 ≤ ζ < 1, beside any damping of the pin: each spring has the damper 2ζ√(k m), where m is the
    /// mass, or the moment of inertia, of the holder with a rigid pin.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub holder_ratio: Option<f64>,
}

/// The fields that give `β_R`.
pub(super) const OF_PIN: [&str; 6] = [
    "damping.ratio",
    "damping.loss_factor",
    "damping.frequency_hz",
    "damping.second_frequency_hz",
    "damping.beta2",
    "damping.at_time_step_s",
];

/// The parameters that give the holder's dampers themselves.
pub(super) const DAMPERS: [&str; 5] = [
    "holder_damping_x_n_s_m",
    "holder_damping_y_n_s_m",
    "holder_damping_z_n_s_m",
    "holder_rotational_damping_x_nm_s_rad",
    "holder_rotational_damping_y_nm_s_rad",
];

/// A refused value of a field.
fn refused(field: &str, value: f64, expected: impl Into<String>) -> FieldError {
    FieldError { field: field.to_owned(), value: value.to_string(), expected: expected.into() }
}

impl Damping {
    /// Sets what is damped: the pin and the holder.
    ///
    /// # Errors
    /// If a value is missing or out of its range, or if `gives` says that what it sets is given by name as well. Then nothing is set.
    pub(super) fn fill(self, spec: &mut JobSpec, gives: impl Fn(&str) -> bool) -> Result<(), FieldError> {
        let damps_pin = self != Self { holder_ratio: self.holder_ratio, ..Self::default() };
        let Numerics { alpha_r_per_s, beta_r_s, .. } = spec.numerics;
        let is_elastic = spec.scene.disk.kind == DiskKind::Elastic;
        if let Some(second_hz) = self.second_frequency_hz.filter(|_| is_elastic) {
            let expected = "no second frequency with an elastic disk, which would have no damping in proportion to its mass; leave it out";
            return Err(refused("damping.second_frequency_hz", second_hz, expected));
        }
        if let Some(second_hz) = self.second_frequency_hz.filter(|_| gives("alpha_r_per_s")) {
            let expected = "either this or numerics.alpha_r_per_s, not both: each gives α_R";
            return Err(refused("damping.second_frequency_hz", second_hz, expected));
        }
        let is_ratio = self.ratio.is_some() || self.loss_factor.is_some();
        if let Some(alpha) = alpha_r_per_s.filter(|_| is_ratio && gives("alpha_r_per_s")) {
            let expected = "no α_R beside a ratio or a loss factor, which would not hold then; give damping.second_frequency_hz, or \
                            numerics.beta_r_s";
            return Err(refused("numerics.alpha_r_per_s", alpha, expected));
        }
        let (alpha_r_per_s, beta_r_s) = if damps_pin || self.holder_ratio.is_none() {
            let beta_r_s = self.beta_r_s(beta_r_s, gives("beta_r_s"))?;
            self.with_second(beta_r_s).map_or((alpha_r_per_s, beta_r_s), |[alpha, beta]| (Some(alpha), beta))
        } else {
            (alpha_r_per_s, beta_r_s)
        };
        if let Some(ratio) = self.holder_ratio {
            damp_holder(ratio, spec, gives)?;
        }
        (spec.numerics.alpha_r_per_s, spec.numerics.beta_r_s) = (alpha_r_per_s, beta_r_s);
        Ok(())
    }

    /// `α_R` \[1/s\] and `β_R` \[s\] that have the same ratio at the second frequency, from the `β_R` \[s\] that has it at the first one
    /// alone.
    fn with_second(self, alone_s: f64) -> Option<[f64; 2]> {
        let (first_hz, second_hz) = (self.frequency_hz?, self.second_frequency_hz?);
        let beta_r_s = alone_s * first_hz / (first_hz + second_hz);
        Some([beta_r_s * 4.0 * PI * PI * first_hz * second_hz, beta_r_s])
    }

    /// `β_R` \[s\]: ζ / (π f), or (β₂ − ½) Δt.
    fn beta_r_s(self, given_s: f64, gives_beta_r: bool) -> Result<f64, FieldError> {
        if gives_beta_r {
            let expected = "either this or damping, not both: each gives β_R";
            return Err(refused("numerics.beta_r_s", given_s, expected));
        }
        let values = [
            self.ratio,
            self.loss_factor,
            self.frequency_hz,
            self.second_frequency_hz,
            self.beta2,
            self.at_time_step_s,
        ];
        let given: Vec<_> =
            OF_PIN.into_iter().zip(values).filter_map(|(field, value)| Some((field, value?))).collect();
        for &(field, value) in &given {
            if let Some(limit) = Limit::of(field).filter(|limit| !limit.holds(value)) {
                return Err(refused(field, value, limit.expected(value)));
            }
        }
        let Some(&(first, value)) = given.first() else {
            let expected =
                "a ratio or a loss_factor, and frequency_hz; or beta2 and at_time_step_s; or holder_ratio"
                    .to_owned();
            return Err(FieldError { field: "damping".to_owned(), value: "{}".to_owned(), expected });
        };
        if let Some(second_hz) = self.second_frequency_hz.filter(|own| Some(*own) == self.frequency_hz) {
            let expected = "another frequency than damping.frequency_hz, or only one of the two";
            return Err(refused("damping.second_frequency_hz", second_hz, expected));
        }
        let is_of_scheme = self.beta2.is_some() || self.at_time_step_s.is_some();
        if let Some(second_hz) = self.second_frequency_hz.filter(|_| is_of_scheme) {
            let expected =
                "no second frequency beside beta2 and at_time_step_s, which have none; leave it out";
            return Err(refused("damping.second_frequency_hz", second_hz, expected));
        }
        if let Some(second_hz) = self.second_frequency_hz.filter(|_| self.frequency_hz.is_none()) {
            let expected = "the first frequency too: damping.frequency_hz";
            return Err(refused("damping.second_frequency_hz", second_hz, expected));
        }
        let expected = match (
            self.ratio.or(self.loss_factor),
            self.frequency_hz,
            self.beta2,
            self.at_time_step_s,
        ) {
            _ if self.ratio.is_some() && self.loss_factor.is_some() => {
                let expected = "either this or damping.ratio, not both: the loss factor is twice the ratio";
                return Err(refused("damping.loss_factor", given[1].1, expected));
            }
            (Some(_), Some(frequency_hz), None, None) => {
                let ratio = self.ratio.or(self.loss_factor.map(|loss| loss / 2.0)).unwrap_or_default();
                return Ok(ratio / (PI * frequency_hz));
            }
            (None, None, Some(beta2), Some(time_step_s)) => {
                return Ok((beta2 - 0.5) * time_step_s);
            }
            (Some(_), None, None, None) => "the frequency too at which it holds: damping.frequency_hz",
            (None, Some(_), None, None) => "a damping ratio or a loss factor too: ratio or loss_factor",
            (None, None, Some(_), None) => {
                "the time step too at which the scheme has it: damping.at_time_step_s"
            }
            (None, None, None, Some(_)) => "the scheme's β₂ too: damping.beta2",
            _ => "either this with what belongs to it, or beta2 and at_time_step_s, not both: each gives β_R",
        };
        Err(refused(first, value, expected))
    }
}

/// Gives each spring of the holder a damper.
fn damp_holder(ratio: f64, spec: &mut JobSpec, gives: impl Fn(&str) -> bool) -> Result<(), FieldError> {
    const FIELD: &str = "damping.holder_ratio";
    if let Some(limit) = Limit::of(FIELD).filter(|limit| !limit.holds(ratio)) {
        return Err(refused(FIELD, ratio, limit.expected(ratio)));
    }
    if let Some(name) = DAMPERS.into_iter().find(|name| gives(name)) {
        let expected = format!("either this or {name}, not both: each gives a damper of the holder");
        return Err(refused(FIELD, ratio, expected));
    }
    let pin = &spec.scene.pin;
    let Some(pin_kg) = pin.mass_kg() else {
        let expected = "the dampers themselves for a mesh from a file, whose mass is not known here: scene.holder.damping_y_n_s_m";
        return Err(refused(FIELD, ratio, expected));
    };
    let extent_m = pin.extent_m();
    if !spec.scene.holder.damp(ratio, pin_kg, extent_m) {
        let expected = "no ratio without a spring of the holder; give a spring, such as scene.holder.stiffness_y_n_m, or leave this out";
        return Err(refused(FIELD, ratio, expected));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::DAMPERS;
    use crate::study::PARAMETERS;

    /// Protects: a damper that is added to the holder is one of those that a damping ratio of the holder excludes.
    #[test]
    fn every_damper_of_the_holder_is_listed() {
        let of_holder = PARAMETERS.iter().filter(|parameter| parameter.pointer.starts_with("/scene/holder/"));
        let dampers = of_holder.filter(|parameter| parameter.pointer.contains("damping"));
        assert_eq!(dampers.map(|parameter| parameter.name).collect::<Vec<_>>(), DAMPERS);
    }
}
