//! The drive of a job's lane: friction law, speed and load.

use crate::solver::Drive;
use crate::solver::interface::law::Law;
use crate::spec::{JobSpec, Program};
use crate::units::rad_per_s_from_rpm;

/// The drive of a lane without a job: no motion and no load.
pub(super) const IDLE: Drive = Drive { law: Law::coulomb(0.0), rate: 0.0, force_n: 0.0, ramp_s: 0.0 };

/// Sets the speed and the load of a job with a program for the step that begins at `time_s`: the load at that time, and the
/// speed in the middle of the step. Over a straight part of the table that is the mean speed of the step.
pub(super) fn follow(program: &Program, drive: &mut Drive, time_s: f64, time_step_s: f64) {
    if let Some(omega) = &program.omega_rpm {
        drive.rate = rad_per_s_from_rpm(omega.at(time_s + 0.5 * time_step_s));
    }
    if let Some(force) = &program.force_n {
        drive.force_n = force.at(time_s);
    }
}

/// The drive of the lane of a job. If the job has a program, it has the largest speed and load.
pub fn drive(spec: &JobSpec) -> Drive {
    Drive {
        law: Law::of(&spec.scene.contact),
        rate: rad_per_s_from_rpm(spec.scene.disk.omega_rpm),
        force_n: spec.scene.load.force_n,
        ramp_s: spec.scene.load.ramp_s,
    }
}

/// The drive of a job for the step that begins at `time_s`.
pub fn drive_at(spec: &JobSpec, time_s: f64, time_step_s: f64) -> Drive {
    let mut drive = drive(spec);
    follow(&spec.scene.program, &mut drive, time_s, time_step_s);
    drive
}
