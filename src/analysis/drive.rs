//! The drive of a job's lane: friction law, speed and load.

use crate::solver::Drive;
use crate::solver::interface::law::Law;
use crate::spec::{Contact, FrictionLaw, JobSpec};
use crate::units::rad_per_s_from_rpm;

/// The drive of a lane without a job: no motion and no load.
pub(super) const IDLE: Drive = Drive { law: Law::Coulomb { mu: 0.0 }, rate: 0.0, force_n: 0.0, ramp_s: 0.0 };

/// The drive of the lane of a job.
pub fn drive(spec: &JobSpec) -> Drive {
    Drive {
        law: law(&spec.scene.contact),
        rate: rad_per_s_from_rpm(spec.scene.disk.omega_rpm),
        force_n: spec.scene.load.force_n,
        ramp_s: spec.scene.load.ramp_s,
    }
}

/// The law of a contact. The check of a job refuses a law without its coefficients, so that NaN reaches no run.
fn law(contact: &Contact) -> Law {
    let mu = contact.mu;
    let given = |value: Option<f64>| value.unwrap_or(f64::NAN);
    match contact.law {
        FrictionLaw::Coulomb => Law::Coulomb { mu },
        FrictionLaw::StaticKinetic => Law::StaticKinetic { mu, mu_static: given(contact.mu_static) },
        FrictionLaw::Exponential => Law::Exponential {
            mu,
            mu_static: given(contact.mu_static),
            speed_m_s: given(contact.speed_m_s),
            slope_s_m: contact.slope_s_m.unwrap_or(0.0),
        },
        FrictionLaw::Regularised => Law::Regularised { mu, speed_m_s: given(contact.speed_m_s) },
        FrictionLaw::PrakashClifton => Law::PrakashClifton { mu, length_m: given(contact.length_m) },
    }
}
