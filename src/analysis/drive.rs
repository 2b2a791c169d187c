//! The drive of a job's lane: friction law, speed and load.

use crate::solver::Drive;
use crate::solver::interface::law::Law;
use crate::spec::JobSpec;
use crate::units::rad_per_s_from_rpm;

/// The drive of a lane without a job: no motion and no load.
pub(super) const IDLE: Drive = Drive { law: Law::Coulomb { mu: 0.0 }, rate: 0.0, force_n: 0.0, ramp_s: 0.0 };

/// The drive of the lane of a job.
pub fn drive(spec: &JobSpec) -> Drive {
    Drive {
        law: Law::Coulomb { mu: spec.scene.contact.mu },
        rate: rad_per_s_from_rpm(spec.scene.disk.omega_rpm),
        force_n: spec.scene.load.force_n,
        ramp_s: spec.scene.load.ramp_s,
    }
}
