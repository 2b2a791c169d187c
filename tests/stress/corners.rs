//! The corners of the parameter space that the stress test must reach.

use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::spec::{ClampSide, FrictionLaw, JobSpec, Precision, TopFace};

/// The name of a corner, and whether a job is in it.
type Corner = (&'static str, fn(&JobSpec) -> bool);

/// Longest over shortest edge of the pin's elements.
fn aspect(spec: &JobSpec) -> f64 {
    let pin = &spec.scene.pin;
    let edges: Vec<f64> = (0..3).map(|axis| pin.size_m[axis] / pin.elements[axis] as f64).collect();
    edges.iter().copied().fold(0.0, f64::max) / edges.iter().copied().fold(f64::INFINITY, f64::min)
}

/// ½ β_R ω of the highest mode. Above 1 the mode is over-critically damped.
fn damping_of_highest_mode(spec: &JobSpec) -> f64 {
    let undamped =
        tribosweep_mechanics::spec::Numerics { beta_r_s: 0.0, time_step_s: None, ..spec.numerics.clone() };
    let limit_s = Model::from_scene(&spec.scene, &undamped).map_or(0.0, |model| model.time_step_limit_s());
    if limit_s > 0.0 {
        spec.numerics.beta_r_s * (2.0 / spec.numerics.beta2).sqrt() / limit_s / 2.0
    } else {
        0.0
    }
}

/// Ratio of the given time step to the limit; 0 where none is given.
fn given_over_limit(spec: &JobSpec) -> f64 {
    let Some(given_s) = spec.numerics.time_step_s else { return 0.0 };
    let free = tribosweep_mechanics::spec::Numerics { time_step_s: None, ..spec.numerics.clone() };
    Model::from_scene(&spec.scene, &free).map_or(0.0, |model| given_s / model.time_step_limit_s())
}

/// All corners. The predicates are evaluated for legal cases only.
pub const CORNERS: [Corner; 46] = [
    ("a holder that moves", |s| !s.scene.holder.is_ideal()),
    ("a static coefficient", |s| s.scene.contact.law == FrictionLaw::StaticKinetic),
    ("an exponential law", |s| s.scene.contact.law == FrictionLaw::Exponential),
    ("a law with a table", |s| s.scene.contact.law == FrictionLaw::Table),
    ("a regularised law", |s| s.scene.contact.law == FrictionLaw::Regularised),
    ("a law with a state", |s| s.scene.contact.law == FrictionLaw::PrakashClifton),
    ("a base with gaps", |s| !s.scene.pin.base.is_flat()),
    ("a rough base", |s| s.scene.pin.base.roughness.is_some()),
    ("measured heights", |s| s.scene.pin.base.height_map.is_some()),
    ("a contact layer", |s| s.scene.contact.layer().is_some()),
    ("a disk that is not plane", |s| !s.scene.disk.is_plane()),
    ("single precision", |s| s.numerics.precision == Precision::Single),
    ("single precision, ν = 0.499", |s| {
        s.numerics.precision == Precision::Single && s.scene.pin.poisson_ratio == 0.499
    }),
    ("one element", |s| s.scene.pin.elements == [1, 1, 1]),
    ("ν ≥ 0.49", |s| s.scene.pin.poisson_ratio >= 0.49),
    ("ν = 0.499", |s| s.scene.pin.poisson_ratio == 0.499),
    ("ν < −0.5", |s| s.scene.pin.poisson_ratio < -0.5),
    ("E < 10⁷ Pa", |s| s.scene.pin.young_modulus_pa < 1.0e7),
    ("E > 10¹¹ Pa", |s| s.scene.pin.young_modulus_pa > 1.0e11),
    ("element aspect ratio ≥ 49", |s| aspect(s) >= 49.0),
    ("μ = 0", |s| s.scene.contact.mu == 0.0),
    ("μ = 2", |s| s.scene.contact.mu == 2.0),
    ("speed below 3 mm/s", |s| speed_m_s(s) < 3.0e-3),
    ("speed above 30 m/s", |s| speed_m_s(s) > 30.0),
    ("load below 1 nN", |s| s.scene.load.force_n < 1.0e-9),
    ("load above 10 kN", |s| s.scene.load.force_n > 1.0e4),
    ("no ramp", |s| s.scene.load.ramp_s == 0.0),
    ("ramp over more than half of the run", |s| s.scene.load.ramp_s > 0.5 * s.run.limit_s),
    ("pin's edge at the axis", |s| s.scene.disk.track_radius_m < 0.500_001 * s.scene.pin.size_m[0]),
    ("tied top", |s| s.scene.top == TopFace::TiedInZ),
    ("free top", |s| s.scene.top == TopFace::FreeInZ),
    ("a collet", |s| s.scene.clamp.side == ClampSide::Collet),
    ("whole top clamped", |s| s.scene.clamp.side == ClampSide::WholeTop),
    ("clamp of one node row", |s| s.scene.clamp.side != ClampSide::WholeTop && s.scene.clamp.width_m == 0.0),
    ("β₂ = ½", |s| s.numerics.beta2 == 0.5),
    ("β₂ = 1", |s| s.numerics.beta2 == 1.0),
    ("β_R = 0", |s| s.numerics.beta_r_s == 0.0),
    ("no damping at all", |s| s.numerics.beta_r_s == 0.0 && s.numerics.beta2 == 0.5),
    ("highest mode over-critically damped", |s| damping_of_highest_mode(s) > 1.0),
    ("lowest shear mode over-critically damped", |s| lowest_mode_damping(s) > 1.0),
    ("safety factor 1", |s| s.numerics.safety_factor == 1.0 && s.numerics.time_step_s.is_none()),
    ("time step given at the limit", |s| given_over_limit(s) == 1.0),
    ("time step given above the limit", |s| given_over_limit(s) > 1.01),
    ("fewer steps than an audit interval", |s| steps(s) < 16.0),
    ("more than 5000 steps", |s| steps(s) > 5000.0),
    ("shortest observation of a decay", |s| {
        s.detection.decay_observation_s < 1.01 * shortest_observation_s(s)
    }),
];

/// Speed [m/s] of the disk under the pin's centre.
pub fn speed_m_s(spec: &JobSpec) -> f64 {
    spec.scene.disk.omega_rpm * std::f64::consts::PI / 30.0 * spec.scene.disk.track_radius_m
}

fn shear_speed_m_s(spec: &JobSpec) -> f64 {
    let pin = &spec.scene.pin;
    (pin.young_modulus_pa / (2.0 * (1.0 + pin.poisson_ratio)) / pin.density_kg_m3).sqrt()
}

fn shortest_observation_s(spec: &JobSpec) -> f64 {
    100.0 * spec.scene.pin.size_m[2] / shear_speed_m_s(spec)
}

/// ½ β_R ω of the lowest shear mode of the height, ω = π c_s / 2h.
fn lowest_mode_damping(spec: &JobSpec) -> f64 {
    let omega = std::f64::consts::FRAC_PI_2 * shear_speed_m_s(spec) / spec.scene.pin.size_m[2];
    0.5 * spec.numerics.beta_r_s * omega
}

fn steps(spec: &JobSpec) -> f64 {
    Model::from_scene(&spec.scene, &spec.numerics)
        .map_or(f64::NAN, |model| (spec.run.limit_s / model.time_step_s()).ceil())
}
