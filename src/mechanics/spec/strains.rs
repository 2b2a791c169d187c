//! Small or large strains of the pin.

use super::{DiskKind, Element, JobSpec, Precision, Violations, check};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strum::IntoStaticStr;

/// The strains that a pin may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema, IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Strains {
    /// Small ones: forces are in proportion to displacements.
    #[default]
    Small,
    /// Large strains and rotations. A time step costs more.
    Finite,
}

impl Strains {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "the form that serde calls")]
    pub(super) fn is_small(&self) -> bool {
        *self == Self::Small
    }
}

/// The law of a material with large strains. For small ones all are Hooke's law with Young's modulus and Poisson's ratio.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema, IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum MaterialLaw {
    /// W = ½G (tr C − 3 − 2 ln J) + ¼λ (J² − 1 − 2 ln J), for rubber.
    #[default]
    NeoHookean,
    /// W = ½λ (tr E)² + G E:E, for large rotations. It softens under compression: in uniaxial strain its force is largest at 58 % of the
    /// length.
    StVenantKirchhoff,
    /// For metals. W = ½G (J^(−2/3) tr C − 3) + ½κ (½(J² − 1) − ln J) until the material yields; then it flows (von Mises), with isotropic and
    /// kinematic hardening.
    J2,
}

impl MaterialLaw {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "the form that serde calls")]
    pub(super) fn is_neo_hookean(&self) -> bool {
        *self == Self::NeoHookean
    }
}

impl JobSpec {
    /// What large strains need: a rigid disk, double precision, a scheme without a damping of its own, and elements that have a form for
    /// them.
    pub(super) fn check_strains(&self, found: &mut Violations) {
        let (pin, numerics) = (&self.scene.pin, &self.numerics);
        if pin.strains == Strains::Small {
            return;
        }
        if self.scene.disk.kind == DiskKind::Elastic {
            found.add("scene.disk.kind", "elastic", "rigid with scene.pin.strains = finite");
        }
        if numerics.precision == Precision::Single {
            let right = "double with scene.pin.strains = finite, whose elements are computed in double precision alone";
            found.add("numerics.precision", "single", right);
        }
        if numerics.beta2 != 0.5 {
            let right = "0.5 with scene.pin.strains = finite: what the scheme dissipates is known for linear forces alone";
            found.add("numerics.beta2", check::readable(numerics.beta2), right);
        }
        if pin.element == Element::Incompatible {
            let right = "full or selective with scene.pin.strains = finite: incompatible modes are condensed for one stiffness";
            found.add("scene.pin.element", "incompatible", right);
        }
    }
}
