//! What a job's lane is driven by.

use crate::solver::Drive;
use crate::solver::interface::law::Law;
use crate::spec::JobSpec;
use crate::units::rad_per_s_from_rpm;

/// A lane without a job: nothing moves, nothing presses.
pub(super) const IDLE: Drive = Drive { law: Law::Coulomb { mu: 0.0 }, rate: 0.0, force_n: 0.0, ramp_s: 0.0 };

/// What the lane of a job is driven by.
pub fn drive(spec: &JobSpec) -> Drive {
    Drive {
        law: Law::Coulomb { mu: spec.scene.contact.mu },
        rate: rad_per_s_from_rpm(spec.scene.disk.omega_rpm),
        force_n: spec.scene.load.force_n,
        ramp_s: spec.scene.load.ramp_s,
    }
}
