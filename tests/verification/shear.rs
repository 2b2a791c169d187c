//! B12 A shear column on a moving plane.
//!
//! A layer of height h, free in y at the top, pressed with p on a plane of speed V. In the k-th
//! interval of 2h/c_s the base slips at (2k−1)V0, V0 = μp/(ρc_s), while that is below V; then it
//! sticks, v = V for ever, with a traction that alternates between two values of opposite sign.
//! Source: d'Alembert's solution. With μp = 66 666.7 Pa and V = 0.25 m/s (pin material, ν = 0.3, for
//! which V0 = 0.067987): v/V0 = 1, 3, 3.677175, …; traction/μp = 1, 1, −0.322825, +0.322825, ….
//! At c_sΔt/h_e = 1 the scheme transports shear waves exactly, so everything holds to rounding.
//!
//! The column's normal degrees of freedom only carry the pressure: all levels above the base are held
//! at the compression that gives p. Poisson's ratio −0.2 keeps the base's own normal mode below its
//! limit at this step; the shear problem depends on G and ρ alone, which are the pin's.

use crate::common::{
    COLUMN_AREA_M2, COLUMN_HEIGHT_M, advance, all_of, column_mesh, definition, level, level_ties,
    pin_material,
};
use tribosweep::solver::constraints::Constraints;
use tribosweep::solver::material::Material;
use tribosweep::solver::{Drive, Model, State};

const LAYERS: usize = 40;
const MU: f64 = 0.4;
const SHEAR_LIMIT_PA: f64 = 66_666.666_666_666_67;
const PLANE_SPEED_M_S: f64 = 0.25;

fn shear_material() -> Material {
    let nu = -0.2;
    let shear_modulus = pin_material(0.3).shear_modulus_pa();
    Material { young_modulus_pa: 2.0 * (1.0 + nu) * shear_modulus, poisson_ratio: nu, density_kg_m3: 2500.0 }
}

fn column() -> (Model, State<1>) {
    let mesh = column_mesh(LAYERS);
    let above: Vec<usize> = (1..=LAYERS).flat_map(|k| level(&mesh, k)).map(|node| 3 * node + 2).collect();
    let fixed = [all_of(&mesh, 0), above].concat();
    let mut ties = level_ties(&mesh, 1);
    ties.push(level_ties(&mesh, 2).swap_remove(0));
    let material = shear_material();
    let model = Model::new(definition(mesh, material, Constraints { fixed, ties })).unwrap();

    let pressure = SHEAR_LIMIT_PA / MU;
    let modulus = material.lame_lambda_pa() + 2.0 * material.shear_modulus_pa();
    let h = model.mesh().element_size_m()[2];
    let mut state = State::at_rest(&model);
    for k in 1..=LAYERS {
        for node in level(model.mesh(), k) {
            state.u[3 * node + 2] = -pressure / modulus * h;
        }
    }
    (model, state)
}

/// Protects: friction, slip → stick and stick in a travelling-wave problem, to rounding.
#[test]
fn base_velocity_climbs_in_steps_and_sticks() {
    let (model, mut state) = column();
    let c_s = model.material().shear_wave_speed_m_s();
    let h = model.mesh().element_size_m()[2];
    assert!((c_s * model.time_step_s() / h - 1.0).abs() < 1e-12, "the limit is c_sΔt/h = 1");
    let unit_speed = SHEAR_LIMIT_PA / (2500.0 * c_s);
    assert!((unit_speed - 0.067_987).abs() < 1e-6, "V0 as published");
    assert!((COLUMN_HEIGHT_M / h - LAYERS as f64).abs() < 1e-9);

    let ratio = PLANE_SPEED_M_S / unit_speed;
    // In the third interval the returning wave brings the base to 5V0 under full friction; holding it at
    // rV0 instead takes (r − 5)V0 ρc_s more, so τ/μp = 1 + (r − 5).
    let stick_traction = ratio - 4.0;
    let drive = Drive { mu: MU, rate: PLANE_SPEED_M_S, force_n: 0.0, ramp_s: 0.0 };
    let mut before = state.u[1];
    for interval in 0..8 {
        let (speed, traction) = match interval {
            0 => (1.0, 1.0),
            1 => (3.0, 1.0),
            k if k % 2 == 0 => (ratio, stick_traction),
            _ => (ratio, -stick_traction),
        };
        for n in 0..2 * LAYERS {
            advance(&model, &drive, &mut state, 1);
            let velocity = (state.u[1] - before) / model.time_step_s();
            before = state.u[1];
            assert!(
                (velocity / unit_speed - speed).abs() < 1e-9,
                "interval {interval}, step {n}: {velocity}"
            );
            // The friction force acts at t_n, where the wave front is exactly at the base when n = 0:
            // there the traction is the mean of the values on both sides of the jump.
            let friction: f64 = state.contacts.force_n.iter().map(|force| force[1][0]).sum();
            let found = friction / (SHEAR_LIMIT_PA * COLUMN_AREA_M2);
            if n > 0 || interval < 2 {
                assert!((found - traction).abs() < 1e-9, "interval {interval}, step {n}: traction {found}");
            }
        }
    }
    assert!((ratio - 3.677_175).abs() < 1e-5 && (stick_traction + 0.322_825).abs() < 1e-5, "as published");
}
