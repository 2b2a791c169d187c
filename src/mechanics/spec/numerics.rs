//! Integrator settings and run length.

use super::check::Violations;
use super::limit::LONGEST_LIMIT_S;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strum::{EnumString, IntoStaticStr, VariantArray};

/// The numbers of the pin's displacements, velocities and contact forces.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    Default,
    Serialize,
    Deserialize,
    JsonSchema,
    EnumString,
    IntoStaticStr,
    VariantArray,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Precision {
    /// 64-bit numbers: 16 digits.
    #[default]
    Double,
    /// 32-bit numbers: 7 digits, in about half the time. Rigid disks only. docs/solving.md says what it can do.
    Single,
}

impl Precision {
    /// The name used in study files, for example `single`.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The β₂ integrator, its damping and its time step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Numerics {
    /// β₂ of the time scheme, ½ ≤ β₂ ≤ 1; ½ is the central difference.
    pub beta2: f64,
    /// Stiffness-proportional damping `β_R` (s), C = `β_R` K.
    pub beta_r_s: f64,
    /// Mass-proportional damping `α_R` (1/s) of the pin beside it, C = `α_R` M + `β_R` K. Absent: none. Rigid disks only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alpha_r_per_s: Option<f64>,
    /// Fraction of the stability limit used as the time step when `time_step_s` is not given.
    pub safety_factor: f64,
    /// The time step (s); checked against the stability limit. Absent: `safety_factor` × limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_step_s: Option<f64>,
    /// Precision of the run: `double`, or `single` with a rigid disk. The eigenvalues of steady sliding are always in double
    /// precision.
    pub precision: Precision,
}

impl Default for Numerics {
    fn default() -> Self {
        Self {
            beta2: 0.5,
            // The damping of β₂ = 1 at the time step of 55 ns of Baillet, d'Errico and Berthier (2005).
            beta_r_s: 2.75e-8,
            alpha_r_per_s: None,
            safety_factor: 0.7,
            time_step_s: None,
            precision: Precision::Double,
        }
    }
}

impl Numerics {
    pub(super) fn check(&self, found: &mut Violations) {
        found.within("numerics.beta2", self.beta2);
        found.within("numerics.beta_r_s", self.beta_r_s);
        found.within_if_given("numerics.alpha_r_per_s", self.alpha_r_per_s);
        found.within("numerics.safety_factor", self.safety_factor);
        found.within_if_given("numerics.time_step_s", self.time_step_s);
    }
}

/// What state a run starts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema, IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Start {
    /// The pin is at rest and undeformed, and the load rises.
    #[default]
    Rest,
    /// The limit cycle that the same scene reaches on a mesh of half as many elements in each direction. The run starts from
    /// rest if there is no such cycle, or if a motion on another mesh is not enough to start from; that run then says how large the error of
    /// the mesh is. If two limit cycles are possible, the run may reach another one than from rest.
    Nested,
    /// Rest, after a run of the same scene on that coarser mesh, which says how large the mesh error is.
    Compared,
}

impl Start {
    /// The name used in study files, for example `nested`.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// How long a run lasts, what it starts from and what it averages over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RunControl {
    /// Simulated time (s) after which a run ends whether or not it became periodic. Absent in a study: 0.04 for the pin of
    /// the reference scene, in proportion to their slowest vibrations for other pins, at most 100; with a program, the time of
    /// its last point.
    pub limit_s: f64,
    /// Stop as soon as the state is periodic or has decayed. `false`: always run to `limit_s`.
    pub stop_early: bool,
    /// A run that ends at `limit_s` averages over this last fraction of it.
    pub average_last_fraction: f64,
    /// What state the run starts from.
    pub start: Start,
    /// Length (s), about, of the windows into which a run with a program is cut; `limit_s` is a whole number of them. Absent: a
    /// hundredth of `limit_s`, or 50 times the time in which a shear wave crosses the pin's height if that is longer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window_s: Option<f64>,
}

impl Default for RunControl {
    fn default() -> Self {
        Self {
            limit_s: 0.04,
            stop_early: true,
            average_last_fraction: 0.4,
            start: Start::Rest,
            window_s: None,
        }
    }
}

impl RunControl {
    /// The longest `limit_s` \[s\]; more is taken for a typing error.
    pub const LONGEST_LIMIT_S: f64 = LONGEST_LIMIT_S;

    /// The largest number of windows of a run.
    const MOST_WINDOWS: f64 = 1000.0;

    pub(super) fn check(&self, found: &mut Violations) {
        let limit = self.limit_s;
        found.within("run.limit_s", limit);
        found.within("run.average_last_fraction", self.average_last_fraction);
        if let Some(window) = self.window_s {
            let right = format!("a length > 0 s, from {:e} to 1 of run.limit_s", 1.0 / Self::MOST_WINDOWS);
            let holds = window > 0.0 && window <= limit && window * Self::MOST_WINDOWS >= limit;
            found.require("run.window_s", window, holds, &right);
        }
    }
}
