//! B2 The spectrum of a one-dimensional column.
//!
//! Problem: axial vibrations of a bar of length L, with ν = 0, or with u_x = u_y = 0 and c = c_p.
//! * Continuous: f_n = n c/2L with free ends, (2n − 1) c/4L with one end held. Source: d'Alembert (1747). For the
//!   10 mm pin with ν = 0: 31 622.8 Hz and 15 811.4 Hz.
//! * Discrete: lumped linear elements of length h = L/N have exactly ω_n = (2c/h) sin(nπ/2N) with free ends
//!   and (2c/h) sin((2n − 1)π/4N) with one held, modes cos(nπk/N). Source: the dispersion relation of
//!   masses and springs (L. Brillouin, *Wave propagation in periodic structures*, 1946).
//! * In time, the central difference advances a mode by the phase θ per step, sin(θ/2) = ωΔt/2. At cΔt/h = 1
//!   this is θ = nπ/N, the phase of the continuous frequency.
//!
//! Expanding the sine gives the error −(nπ/2N)²/6 against the continuous frequency: order 2.

use crate::verification::common::{
    COLUMN_HEIGHT_M, IDLE, ROUNDINGS_PER_FORCE, advance, axial_bar, level, pin_material, step_at_cfl,
};
use crate::verification::evidence::Evidence;
use nalgebra::DMatrix;
use std::f64::consts::{PI, TAU};
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::{Model, ModelDefinition, State};

const DISCRETE: &str = "dispersion relation of masses and springs (Brillouin 1946)";

fn bar(layers: usize, material: Material) -> ModelDefinition {
    axial_bar(COLUMN_HEIGHT_M, layers, material, false)
}

/// Protects: cos(nπk/N) is an eigenvector of the program's K and M, with exactly ω_n².
#[test]
fn discrete_modes_are_eigenvectors() {
    let layers = 20;
    let mut evidence =
        Evidence::new("B2", "free bar, N = 20, M⁻¹Kφ − ω²φ of all modes over ω_max²", DISCRETE);
    for poisson_ratio in [0.0, 0.3] {
        let model = Model::new(bar(layers, pin_material(poisson_ratio))).unwrap();
        let mesh = model.mesh().block().unwrap();
        let top_rate = 2.0 * model.pin().material().pressure_wave_speed_m_s() / mesh.element_size_m()[2];
        let mut worst: f64 = 0.0;
        for mode in 0..=layers {
            let phase = mode as f64 * PI / layers as f64;
            let omega = top_rate * (phase / 2.0).sin();
            let mut phi = vec![0.0; 3 * mesh.node_count()];
            for node in 0..mesh.node_count() {
                phi[3 * node + 2] = (phase * mesh.grid_position(node)[2] as f64).cos();
            }
            let force = model.pin().stiffness_times(&phi);
            for node in 0..mesh.node_count() {
                let acceleration = force[3 * node + 2] / model.pin().masses_kg()[node];
                worst = worst.max((acceleration - omega * omega * phi[3 * node + 2]).abs());
            }
        }
        evidence.found(format!("ν = {poisson_ratio}"), worst / top_rate.powi(2), 0.0, 1.0);
    }
    // Σ|K||φ|/m is at most ω_max². Ten more roundings are for mass, sines and cosines.
    evidence.judge_exact(ROUNDINGS_PER_FORCE + 10.0);
}

/// Frequencies [Hz] of the program's K and M, reduced to one displacement per level. The top is held or free.
fn frequencies_hz(model: &Model, top_fixed: bool) -> Vec<f64> {
    let mesh = model.mesh().block().unwrap();
    let levels = mesh.elements()[2] + usize::from(!top_fixed);
    let mut k = DMatrix::<f64>::zeros(levels, levels);
    let mass = |l: usize| level(mesh, l).iter().map(|&node| model.pin().masses_kg()[node]).sum::<f64>();
    for column in 0..levels {
        let mut u = vec![0.0; 3 * mesh.node_count()];
        for node in level(mesh, column) {
            u[3 * node + 2] = 1.0;
        }
        let force = model.pin().stiffness_times(&u);
        for row in 0..levels {
            let sum: f64 = level(mesh, row).iter().map(|node| force[3 * node + 2]).sum();
            k[(row, column)] = sum / (mass(row) * mass(column)).sqrt();
        }
    }
    let mut found: Vec<f64> = k.symmetric_eigenvalues().iter().map(|v| v.max(0.0).sqrt() / TAU).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// Protects: the frequencies from the program's own K and M tend to the continuous ones.
#[test]
fn frequencies_converge_to_the_continuous_bar() {
    for (poisson_ratio, what) in [(0.0, "bar, ν = 0"), (0.3, "confined column, ν = 0.3")] {
        for (top_fixed, ends) in [(false, "free ends"), (true, "one end held")] {
            for n in 1..=3 {
                let quantity = format!("{what}, {ends}, mode {n}, frequency [Hz]");
                let mut evidence = Evidence::new("B2", quantity, "wave equation (d'Alembert)");
                let mut rounding = 0.0;
                for layers in [10, 20, 40, 80] {
                    let material = pin_material(poisson_ratio);
                    let model = Model::new(axial_bar(COLUMN_HEIGHT_M, layers, material, top_fixed)).unwrap();
                    let found = frequencies_hz(&model, top_fixed);
                    let c = material.pressure_wave_speed_m_s();
                    let exact = if top_fixed {
                        (2 * n - 1) as f64 * c / (4.0 * COLUMN_HEIGHT_M)
                    } else {
                        n as f64 * c / (2.0 * COLUMN_HEIGHT_M)
                    };
                    let rank = if top_fixed { n - 1 } else { n };
                    evidence.found(format!("{layers} elements"), found[rank], exact, exact);
                    // Eigenvalues of an n × n matrix round by n ε of the largest one.
                    let largest = found[found.len() - 1] / exact;
                    rounding = layers as f64 * f64::EPSILON * largest * largest;
                }
                evidence.judge_order(2.0, 2.0, rounding);
            }
        }
    }
}

/// Protects: in time each mode oscillates as cos(θn) with the central difference's own θ, below the limit
/// and at it, where θ is that of the continuous bar.
#[test]
fn central_difference_dispersion_is_exact() {
    let layers = 20;
    let steps = 200_u32;
    let mut evidence =
        Evidence::new("B2", "free bar, N = 20, 200 steps in one mode, displacement [m]", DISCRETE);
    for cfl in [0.3, 0.7, 1.0] {
        let base = bar(layers, pin_material(0.0));
        let model = Model::new(ModelDefinition { time_step: step_at_cfl(&base, cfl), ..base }).unwrap();
        for mode in [1, 3, 10, 19] {
            let phase = mode as f64 * PI / layers as f64;
            let theta = if cfl < 1.0 { 2.0 * (cfl * (phase / 2.0).sin()).asin() } else { phase };
            let mut state = State::at_rest(&model);
            // The bar is 2 m above the plane, so that there is no contact.
            for node in 0..model.mesh().block().unwrap().node_count() {
                let k = model.mesh().block().unwrap().grid_position(node)[2] as f64;
                state.u[3 * node + 2] = 2.0 + (phase * k).cos();
            }
            let (mut worst, mut found, mut exact) = (-1.0, 0.0, 0.0);
            for n in 1..=steps {
                advance(&model, &IDLE, &mut state, 1);
                let expected = 2.0 + (theta * f64::from(n)).cos();
                let error = (state.u[2] - expected).abs();
                if error > worst {
                    (worst, found, exact) = (error, state.u[2], expected);
                }
            }
            // A step rounds Δt²M⁻¹K u, of size (ω_maxΔt)²·3 ≤ 12. The error of a step grows at most linearly.
            let per_step = ROUNDINGS_PER_FORCE * 12.0 * f64::EPSILON;
            let bound = per_step * f64::from(steps * steps) / 2.0;
            evidence.bounded(format!("cΔt/h = {cfl}, mode {mode}"), found, exact, 1.0, bound);
        }
    }
    evidence.judge_bounded("rounding: the error of each step drifts away at most linearly");
}
