//! R1 Free vibrations of the ring.
//!
//! Problem: the eigenfrequencies of K φ = ω² M φ with the ring's own stiffness and lumped mass. A uniform
//! closed ring is unchanged by a rotation by one sector, so modes have n waves around. Their nodal amplitudes
//! depend on r and z. u_r and u_z vary with cos nθ, u_θ varies with sin nθ (for n = 0 also with sin and cos
//! exchanged, which is torsion). The products of K with such fields give a small dense problem for every n,
//! and no mode is left out. The mirror symmetry about the middle plane splits it into two.
//!
//! The frequencies tend to those of the elastic ring with order 2 in the element size. For smooth modes, the
//! trilinear field makes ω² O(h²) too high and lumping makes it O(h²) too low (G. Strang, G. J. Fix, *An
//! analysis of the finite element method*, 1973, ch. 6). Edges are chords, which lie O(h²) inside the
//! circles.
//!
//! Exact answers for the reference ring (70–120 mm, 85 mm, 210 GPa, ν = 0.3, 7800 kg/m³), all free:
//! * Torsional modes are u_θ = R(r) cos(kπz/H) with the frequencies f² = f_r² + (k c_s/2H)². Free surfaces
//!   allow R = r with f_r = 0. They also allow R = A J₁(κr) + B Y₁(κr), κ = 2πf_r/c_s, with J₂(κa) Y₂(κb) =
//!   J₂(κb) Y₂(κa), because R′ − R/r is −κ times the same expression of second order (K. F. Graff, *Wave
//!   motion in elastic solids*, 1975, ch. 8).
//! * All other modes come from the Rayleigh–Ritz method up to degree 14 (see `ring_ritz`). Its error is less
//!   than its change from degree 12.
//!
//! Modes are matched by their class and rank within it, which refinement does not change. In one mode
//! (`CANCELLING`) the h² errors of the lumped mass, which lower a frequency, and of the trilinear field,
//! which raise it, nearly cancel. The remainder is of higher order and of no single order, so the case there
//! is the overall order from the coarsest mesh on.

use crate::verification::evidence::Evidence;
use crate::verification::ring_ritz;
use crate::verification::ring_tools::{RADII_M, RingBody, STEEL, THICKNESS_M};
use nalgebra::DMatrix;
use std::f64::consts::{PI, TAU};
use tribosweep_mechanics::solver::body::ring::RingMesh;

const RITZ: &str = "Rayleigh–Ritz in cylindrical coordinates, Legendre polynomials to degree 14";
const TORSION: &str = "torsional modes of a free hollow cylinder (Graff 1975)";
/// The mode in which these errors nearly cancel (see the head comment).
const CANCELLING: &str = "n = 3, antisymmetric to the middle plane, mode 1";
const CANCELS: &str = "the h² errors of lumped mass and trilinear field nearly cancel in this mode";
/// The frequencies [Hz] of the Rayleigh–Ritz method.
const STATED: [(&str, f64); 8] = [
    ("n = 2, symmetric to the middle plane, mode 1", 3197.7),
    ("n = 2, symmetric to the middle plane, mode 2", 17564.0),
    ("n = 2, antisymmetric to the middle plane, mode 1", 3614.7),
    ("n = 2, antisymmetric to the middle plane, mode 2", 11838.2),
    ("n = 3, symmetric to the middle plane, mode 1", 7918.0),
    ("n = 3, symmetric to the middle plane, mode 2", 23345.8),
    (CANCELLING, 8520.5),
    ("n = 3, antisymmetric to the middle plane, mode 2", 16308.0),
];
/// Elements in θ, r and z.
const MESHES: [[usize; 3]; 3] = [[36, 3, 5], [72, 6, 10], [144, 12, 20]];

/// A class of modes.
#[derive(Clone, Copy)]
struct Class {
    waves: usize,
    /// u_r ~ sin nθ, u_θ ~ cos nθ, u_z ~ sin nθ instead of cos, sin and cos.
    torsional: bool,
    /// Whether the modes are symmetric about the middle plane.
    symmetric: bool,
}

/// Frequencies [Hz] of the ring in a class, ascending; rigid ones are 0.
fn frequencies_hz(body: &RingBody, class: Class) -> Vec<f64> {
    let mesh = &body.mesh;
    let [columns, rows, planes] = mesh.nodes_per_axis();
    let wave = |c: usize, j: usize| {
        let angle = class.waves as f64 * mesh.angles_rad()[j];
        if (c == 1) == class.torsional { angle.cos() } else { angle.sin() }
    };
    // Number of the amplitude of (i, k, c) among the unknowns of the class, and its sign.
    let unknown = |i: usize, k: usize, c: usize| {
        let sign = if (c < 2) == class.symmetric { 1.0 } else { -1.0 };
        let mirrored = planes - 1 - k;
        let missing = (mirrored == k && sign < 0.0) || (class.waves == 0 && (c == 1) != class.torsional);
        (!missing).then_some(((k.min(mirrored) * rows + i) * 3 + c, if k > mirrored { sign } else { 1.0 }))
    };
    let all = rows * planes.div_ceil(2) * 3;
    let (mut stiffness, mut masses) = (DMatrix::<f64>::zeros(all, all), vec![0.0; all]);
    // Lines of nodes with unit amplitudes are so far apart that no row of K contains two of them.
    for number in 0..27 {
        let (c, across, down) = (number / 9, number / 3 % 3, number % 3);
        let mut u = body.zeros();
        for node in 0..mesh.node_count() {
            let [j, i, k] = mesh.grid_position(node);
            if i % 3 == across && k % 3 == down {
                u[3 * node + c] = wave(c, j);
            }
        }
        let force = body.force(&u);
        for k in 0..planes {
            for i in 0..rows {
                let near = |at: usize, end: usize, rest: usize| {
                    (at.saturating_sub(1)..(at + 2).min(end)).find(|at| at % 3 == rest)
                };
                let Some((i_from, k_from)) = near(i, rows, across).zip(near(k, planes, down)) else {
                    continue;
                };
                let Some((column, sign_from)) = unknown(i_from, k_from, c) else { continue };
                for d in 0..3 {
                    let Some((row, sign)) = unknown(i, k, d) else { continue };
                    let work = (0..columns).map(|j| wave(d, j) * force[3 * mesh.node(j, i, k) + d]);
                    stiffness[(row, column)] += sign * sign_from * work.sum::<f64>();
                    if (i, k, c) == (i_from, k_from, d) {
                        let mass = |j| wave(c, j).powi(2) * body.masses_kg[mesh.node(j, i, k)];
                        masses[row] += (0..columns).map(mass).sum::<f64>();
                    }
                }
            }
        }
    }
    let there: Vec<usize> = (0..all).filter(|&unknown| masses[unknown] > 0.0).collect();
    let scaled = DMatrix::from_fn(there.len(), there.len(), |row, column| {
        let (a, b) = (there[row], there[column]);
        0.5 * (stiffness[(a, b)] + stiffness[(b, a)]) / (masses[a] * masses[b]).sqrt()
    });
    let mut found: Vec<f64> =
        scaled.symmetric_eigenvalues().iter().map(|value| value.max(0.0).sqrt() / TAU).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// Relative rounding of a frequency: the eigenvalues of an n × n matrix round by n ε of the largest.
fn rounding(all_hz: &[f64], frequency_hz: f64) -> f64 {
    let largest = all_hz[all_hz.len() - 1] / frequency_hz;
    0.5 * all_hz.len() as f64 * f64::EPSILON * largest * largest
}

/// Records and judges some modes of a class: name, rank, exact frequency [Hz] and its relative uncertainty.
fn judge(class: Class, source: &'static str, modes: &[(String, usize, f64, f64)]) {
    let found: Vec<Vec<f64>> = MESHES
        .iter()
        .map(|elements| {
            let mesh = RingMesh::uniform(TAU, RADII_M, THICKNESS_M, *elements);
            frequencies_hz(&RingBody::new(mesh), class)
        })
        .collect();
    for (name, rank, exact, remainder) in modes {
        let mut evidence = Evidence::new("R1", format!("ring, {name}, frequency [Hz]"), source);
        let mut left = *remainder;
        for ([columns, rows, layers], all) in MESHES.iter().zip(&found) {
            evidence.found(format!("{columns} × {rows} × {layers} elements"), all[*rank], *exact, *exact);
            left = left.max(remainder + rounding(all, *exact));
        }
        if name.as_str() == CANCELLING {
            evidence.judge_overall_order(2.0, 2.0, CANCELS);
        } else {
            evidence.judge_order(2.0, 2.0, left);
        }
    }
}

/// f_r [Hz] of the first torsional mode that shears in r, by bisection.
fn radial_shear_hz() -> f64 {
    let [a, b] = RADII_M;
    let free = |k: f64| libm::jn(2, k * a) * libm::yn(2, k * b) - libm::jn(2, k * b) * libm::yn(2, k * a);
    // π/(b − a), the shear of a strip of this width, is the limit of a thin ring. The next root is at twice
    // that.
    let (mut low, mut high) = (0.5 * PI / (b - a), 1.5 * PI / (b - a));
    assert!(free(low) * free(high) < 0.0, "one root");
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if free(low) * free(middle) > 0.0 { &mut low } else { &mut high }) = middle;
    }
    low * STEEL.shear_wave_speed_m_s() / TAU
}

/// Frequency [Hz] of the torsional mode with f_r and k half waves in the height.
fn torsion_hz(radial_hz: f64, k: usize) -> f64 {
    radial_hz.hypot(k as f64 * STEEL.shear_wave_speed_m_s() / (2.0 * THICKNESS_M))
}

/// Protects: shear stiffness in θz and rθ and the masses agree with exact modes of the annulus.
#[test]
fn ring_torsional_frequencies_converge_with_order_two() {
    let shear_hz = radial_shear_hz();
    for (symmetric, modes) in [
        (false, vec![("torsion, 1 half wave in z", 0, torsion_hz(0.0, 1))]),
        (
            true,
            vec![
                ("shear, 1 half wave in r", 1, shear_hz),
                ("torsion, 2 half waves in z", 2, torsion_hz(0.0, 2)),
            ],
        ),
    ] {
        let modes: Vec<_> =
            modes.into_iter().map(|(name, rank, exact)| (name.to_owned(), rank, exact, 0.0)).collect();
        judge(Class { waves: 0, torsional: true, symmetric }, TORSION, &modes);
    }
}

/// Protects: the whole stiffness is right: the two lowest modes with two and three waves around, of either
/// symmetry.
#[test]
fn ring_flexural_frequencies_converge_with_order_two() {
    for waves in [2, 3] {
        for symmetric in [true, false] {
            let coarse = ring_ritz::frequencies_hz(waves, 12, symmetric);
            let fine = ring_ritz::frequencies_hz(waves, 14, symmetric);
            let modes: Vec<_> = (0..2)
                .map(|rank| {
                    let parity = if symmetric { "symmetric" } else { "antisymmetric" };
                    let name = format!("n = {waves}, {parity} to the middle plane, mode {}", rank + 1);
                    let remainder = (coarse[rank] / fine[rank] - 1.0).abs() + rounding(&fine, fine[rank]);
                    (name, rank, fine[rank], remainder)
                })
                .collect();
            for (name, _, frequency_hz, _) in &modes {
                let (_, stated) = STATED.iter().find(|(known, _)| known == name).expect("a stated mode");
                assert!((frequency_hz - stated).abs() < 0.1, "{name}: {frequency_hz} Hz, stated {stated} Hz");
            }
            judge(Class { waves, torsional: false, symmetric }, RITZ, &modes);
        }
    }
}

/// Protects: the reference method itself is right. With n = 0 its modes include the torsional ones.
#[test]
fn ring_rayleigh_ritz_finds_the_torsional_modes() {
    let mut evidence = Evidence::new("R1", "ring, torsional modes by Rayleigh–Ritz, frequency [Hz]", TORSION);
    for (symmetric, radial_hz, k) in
        [(false, 0.0, 1), (true, 0.0, 2), (true, radial_shear_hz(), 0), (false, radial_shear_hz(), 1)]
    {
        let exact = torsion_hz(radial_hz, k);
        let nearest = |order: usize| {
            let all = ring_ritz::frequencies_hz(0, order, symmetric);
            let off = |f: &f64| (f - exact).abs();
            let found = *all.iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("modes");
            (found, rounding(&all, exact))
        };
        let ((coarse, _), (fine, rounding)) = (nearest(12), nearest(14));
        // The error falls with every degree, so it is less than the last change.
        let bound = (coarse / fine - 1.0).abs() + rounding;
        evidence.bounded(format!("f_r = {radial_hz:.0} Hz, k = {k}"), fine, exact, exact, bound);
    }
    evidence.judge_bounded("the change from degree 12 to 14 and the rounding of the dense eigenvalues");
}
