//! B18 Hertz: a crowned base on a rigid plane, without friction.
//!
//! An elastic half-space with a spherical crown of radius R under the load F touches a rigid plane in a circle of radius a:
//!
//! ```text
//! a³ = 3 F R (1 − ν²)/(4 E),   p(r) = p₀ √(1 − r²/a²),   p₀ = 3 F/(2π a²)
//! ```
//!
//! (Johnson, *Contact Mechanics*, 1985, eqs. 3.38, 3.39 and 4.22 to 4.24.) The pin is a cube with the edge 12 a. Its finite size changes the
//! pressure at the centre by a share of the order (a/L)³, which is below 10⁻³. The load rises slowly, and forces are averaged
//! over the slowest oscillation.
//!
//! The pressure of a node is its force over its tributary area. It converges irregularly, because the edge of the contact falls
//! anywhere in an element.

use crate::verification::evidence::Evidence;
use std::f64::consts::PI;
use tribosweep_mechanics::analysis::drive;
use tribosweep_mechanics::solver::{Model, State, step};
use tribosweep_mechanics::spec::{Base, ClampSide, JobSpec, TopFace};

const RADIUS_M: f64 = 0.02;

fn scene(elements: usize) -> (JobSpec, f64) {
    let mut spec = JobSpec::default();
    let pin = &spec.scene.pin;
    let force_n = 20.0;
    let cubed = 3.0 * force_n * RADIUS_M * (1.0 - pin.poisson_ratio.powi(2)) / (4.0 * pin.young_modulus_pa);
    let a_m = cubed.cbrt();
    let edge_m = 12.0 * a_m;
    spec.scene.pin.size_m = [edge_m; 3];
    spec.scene.pin.elements = [elements; 3];
    spec.scene.pin.base = Base { crown_radius_m: Some(RADIUS_M), ..Base::default() };
    spec.scene.clamp.side = ClampSide::WholeTop;
    spec.scene.top = TopFace::TiedInZ;
    spec.scene.contact.mu = 0.0;
    spec.scene.load.force_n = force_n;
    spec.scene.load.ramp_s = 20.0 * spec.scene.pin.shear_transit_s();
    spec.numerics.beta_r_s = 2.0e-7;
    (spec, a_m)
}

/// Protects: the gap of a crowned base, by the pressure and the size of Hertz's contact.
#[test]
fn a_crowned_base_has_hertz_pressure() {
    hertz_pressure("", &[16, 24, 36]);
}

/// Protects: the same on a finer mesh.
#[test]
#[ignore = "a mesh of 48 elements in each direction"]
fn a_crowned_base_has_hertz_pressure_on_a_fine_mesh() {
    hertz_pressure(" (fine)", &[24, 36, 48]);
}

fn hertz_pressure(suffix: &str, meshes: &[usize]) {
    let case = |what: &str, source| Evidence::new("B18", format!("{what}{suffix}"), source);
    let mut peak = case("peak pressure under a crowned base [Pa]", "p₀ = 3F/(2πa²)");
    let mut second = case(
        "radius of the contact under a crowned base, from the second moment of the pressure [m]",
        "⟨r²⟩ = (2/5) a²",
    );
    for &elements in meshes {
        let (spec, a_m) = scene(elements);
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let steps = |seconds: f64| (seconds / model.time_step_s()).ceil() as usize;
        let mut state = State::<1>::at_rest(&model);
        for _ in 0..steps(1.2 * spec.scene.load.ramp_s) {
            step(&model, &[drive(&spec)], &mut state);
        }
        let averaged = steps(8.0 * spec.scene.pin.shear_transit_s());
        let mut force_n = vec![0.0; model.slaves().len()];
        for _ in 0..averaged {
            step(&model, &[drive(&spec)], &mut state);
            for (slave, total) in force_n.iter_mut().enumerate() {
                *total += state.contacts.force_of(slave, 0)[2] / averaged as f64;
            }
        }
        let nodes = || model.slaves().iter().zip(&force_n);
        let centre =
            nodes().min_by(|a, b| squared(a.0.position_m).total_cmp(&squared(b.0.position_m))).unwrap();
        let resolution = format!("{:.1} elements over a", elements as f64 / 12.0);
        let exact_pa = 3.0 * spec.scene.load.force_n / (2.0 * PI * a_m * a_m);
        peak.found(&resolution, centre.1 / centre.0.area_m2, exact_pa, exact_pa);
        let total: f64 = force_n.iter().sum();
        let moment: f64 = nodes().map(|(slave, force)| force * squared(slave.position_m)).sum();
        second.found(&resolution, (2.5 * moment / total).sqrt(), a_m, a_m);
    }
    peak.judge_overall_order(1.0, 2.0_f64.sqrt(), "the edge of the contact falls anywhere in an element");
    second.judge_overall_order(1.0, 2.0_f64.sqrt(), "the edge of the contact falls anywhere in an element");
}

fn squared([x, y]: [f64; 2]) -> f64 {
    x * x + y * y
}
