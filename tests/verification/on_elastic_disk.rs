//! R5 The contact on an elastic disk.
//!
//! * A slave node that slides carries t = μN on any patch. Where it crosses an edge, neither slip nor force
//!   may jump. So in steady sliding T/N is a constant of the pin's geometry. (An element-wise update of the
//!   slip from local coordinates loses a part of it at every edge: with Akantu 5.0.7, T falls from 0.399 to
//!   0.31 of N there.)
//! * Action equals reaction: the disk receives the opposite of the contact forces on the pin.
//! * As the disk gets stiffer at constant density, its modes become so fast that they respond statically.
//!   Then its deflection under given forces falls as 1/E, and so does the difference from a rigid disk.

use crate::verification::common::advance;
use crate::verification::elastic::{Below, coarse_scene, drive, free_block, on_block};
use crate::verification::evidence::Evidence;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::support::load;
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, State, TimeStep};
use tribosweep_mechanics::spec::{DiskKind, DiskTimeStep, JobSpec, TargetSurface};

const COULOMB: &str = "Coulomb's law";

fn model(spec: &JobSpec) -> Model {
    Model::from_scene(&spec.scene, &spec.numerics).unwrap()
}

/// T/N and N over time in steady sliding of a pin that crosses several edges, and the number of edges.
fn sliding(target: TargetSurface, time_s: f64) -> (Vec<[f64; 2]>, f64) {
    let mut spec = coarse_scene();
    spec.scene.disk.ring.target = target;
    // The disk is soft enough to show the patches, and the edges come quickly.
    spec.scene.disk.ring.young_modulus_pa = 2.0e10;
    spec.numerics.beta_r_s = 1.0e-6;
    let model = model(&spec);
    let drive = drive(0.1, 100.0);
    let mut state = State::<1>::at_rest(&model);
    let steps = |time_s: f64| (time_s / model.time_step_s()) as usize;
    advance(&model, &drive, &mut state, steps(0.008));
    let begin_rad = state.step as f64 * model.time_step_s() * drive.rate;
    let mut found = Vec::new();
    for _ in 0..steps(time_s) {
        advance(&model, &drive, &mut state, 1);
        let (mut t, mut n) = (0.0, 0.0);
        for (slave, force) in state.contacts.forces(0).enumerate() {
            let [minus_y, x] = model.slaves()[slave].surface_motion;
            // Friction along the disk's motion at the node.
            t += (force[0] * minus_y + force[1] * x) / minus_y.hypot(x);
            n += force[2];
        }
        found.push([t / n, n]);
    }
    let swept_rad = state.step as f64 * model.time_step_s() * drive.rate - begin_rad;
    (found, swept_rad / model.ring().unwrap().mesh().track().sector_rad)
}

/// Protects: a pin slides over several edges with T = μN to 10⁻⁶, on bilinear and on smooth patches. With
/// smooth patches the normal force varies less as nodes pass from patch to patch. This is their purpose.
#[test]
fn riding_over_edges_is_smooth() {
    rides_smoothly(0.015, 2.0, "");
}

/// Protects: the same over more edges.
#[test]
#[ignore = "a run of 38 ms"]
fn riding_over_many_edges_is_smooth() {
    rides_smoothly(0.030, 4.0, ", many edges");
}

fn rides_smoothly(time_s: f64, fewest_edges: f64, form: &str) {
    let quantity = format!("sliding over edges, T/N against μ = 0.1{form}");
    let mut evidence = Evidence::new("R5", quantity, COULOMB);
    let mut waver = Vec::new();
    for target in [TargetSurface::Bilinear, TargetSurface::Ferguson] {
        let (found, edges) = sliding(target, time_s);
        assert!(edges > fewest_edges, "{edges} edges");
        let worst = found.iter().map(|[ratio, _]| (ratio - 0.1).abs()).fold(0.0, f64::max);
        evidence.bounded(format!("{target:?}, {edges:.1} edges"), 0.1 + worst, 0.1, 0.1, 1.0e-6);
        let mean = found.iter().map(|[_, n]| n).sum::<f64>() / found.len() as f64;
        let square = found.iter().map(|[_, n]| (n / mean - 1.0).powi(2)).sum::<f64>() / found.len() as f64;
        waver.push(square.sqrt());
    }
    evidence.judge_bounded(
        "friction is projected on μN node by node; the nodes' slip turns by less than 10⁻³ rad",
    );
    let mut gain = Evidence::new(
        "R5",
        format!("waver of N on Ferguson patches over that on bilinear ones{form}"),
        "kinks of the surface",
    );
    gain.bounded("E = 20 GPa, 6 mm, 100 rpm", waver[1] / waver[0], 0.0, 1.0, 1.0);
    gain.judge_bounded("what has no kinks excites less than what has");
}

/// Protects: the pin and the disk receive opposite contact forces at every step.
#[test]
fn action_is_reaction() {
    let mut spec = coarse_scene();
    spec.numerics.beta_r_s = 0.0;
    let model = model(&spec);
    let body = model.ring().unwrap();
    let mut state = State::<1>::at_rest(&model);
    let drive = drive(0.4, 20.0);
    let momentum = |state: &State<1>| -> f64 {
        let field = state.target.ring().unwrap().1.momentum_velocity();
        let free = (0..body.mesh().node_count()).filter(|&node| body.inverse_mass()[node] > 0.0);
        free.map(|node| body.masses_kg()[node] * field[3 * node + 2]).sum()
    };
    let mut evidence =
        Evidence::new("R5", "reaction on the disk over the force on the pin", "Newton's third law");
    let mut worst = (0.0, 0.0, 0.0, 1.0);
    for _ in 0..600 {
        let before = momentum(&state);
        let elastic: f64 = {
            // −Σ K u over the free nodes is all other force on them.
            let u = &state.target.ring().unwrap().1.u;
            let mut product = u.clone();
            let mut scratch =
                tribosweep_mechanics::solver::body::ring::operator::RingScratch::new(body.operator());
            body.operator().product(u, &mut product, &mut scratch);
            (0..body.mesh().node_count())
                .filter(|&node| body.inverse_mass()[node] > 0.0)
                .map(|node| -product[3 * node + 2])
                .sum()
        };
        advance(&model, &drive, &mut state, 1);
        let on_disk = (momentum(&state) - before) / model.time_step_s() - elastic;
        let on_pin: f64 = state.contacts.forces(0).map(|force| force[2]).sum();
        let scale = on_pin + elastic.abs();
        if on_pin > 1.0 && (on_disk + on_pin).abs() / scale >= worst.0 {
            worst = ((on_disk + on_pin).abs() / scale, -on_disk, on_pin, scale);
        }
    }
    evidence.found("the worst of 600 steps", worst.1, worst.2, worst.3);
    // The error is that of a sum over the disk's nodes of rows of K and of momenta. The momenta are the
    // impulse of the forces so far, and they are divided by Δt.
    evidence.judge_exact(
        crate::verification::common::ROUNDINGS_PER_FORCE * (body.mesh().node_count() * 600) as f64,
    );
}

/// Protects: the displacements of the pin after 0.4 ms tend to those on a rigid disk as 1/E.
#[test]
fn a_stiff_disk_tends_to_the_rigid_one() {
    let displacements = |spec: &JobSpec| {
        let model = model(spec);
        let mut state = State::<1>::at_rest(&model);
        let steps = (4.0e-4 / model.time_step_s()).round() as usize;
        advance(&model, &drive(0.4, 7.0), &mut state, steps);
        state.u.values().collect::<Vec<_>>()
    };
    let mut spec = coarse_scene();
    spec.numerics.time_step_s = Some(1.0e-7);
    let rigid = {
        let mut spec = spec.clone();
        spec.scene.disk.kind = DiskKind::Rigid;
        displacements(&spec)
    };
    let size = rigid.iter().map(|v| v * v).sum::<f64>().sqrt();
    let mut evidence = Evidence::new(
        "R5",
        "pin's displacements against those on a rigid disk, over their size",
        "limit E → ∞",
    );
    for young_modulus_pa in [2.1e11, 8.4e11, 3.36e12] {
        spec.scene.disk.ring.young_modulus_pa = young_modulus_pa;
        let found = displacements(&spec);
        let away = found.iter().zip(&rigid).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
        evidence.found(format!("E = {young_modulus_pa:.2e} Pa"), away / size, 0.0, 1.0);
    }
    evidence.judge_overall_order(1.0, 4.0, "nodes that close a step earlier or later shift single values");
}

/// Errors of the nodal contact forces and of the heights of the interface of two blocks under a uniform
/// pressure, at rest.
struct Pressed {
    /// Worst nodal force of the upper block over pressure times tributary area, less one.
    slave: f64,
    /// The same for the forces that the lower block's top nodes receive.
    target: f64,
    /// Worst height of the interface less its mean, over the shortening of both blocks.
    waviness: f64,
}

fn pressed(upper: usize, lower: usize, target: TargetSurface) -> Pressed {
    let (size, pressure) = ([0.012, 0.012, 0.006], 1.0e6);
    let material = Material { young_modulus_pa: 1.0e9, poisson_ratio: 0.0, density_kg_m3: 2500.0 };
    let base = free_block(size, [upper, upper, upper], material);
    let load = load::normal_load(&base.mesh);
    // The damping is half of critical for the slowest mode of both blocks on the ground, so the motion dies
    // within some of its periods.
    let slowest = 0.5 * std::f64::consts::PI * material.pressure_wave_speed_m_s() / (2.0 * size[2]);
    let definition =
        ModelDefinition { load, beta_r_s: 1.0 / slowest, time_step: TimeStep::FractionOfLimit(0.9), ..base };
    let below = Below {
        material,
        thickness_m: size[2],
        elements: [lower, lower, lower],
        target,
        clock: DiskTimeStep::Common,
        held: true,
    };
    let model = on_block(definition, &below);
    let force_n = pressure * size[0] * size[1];
    let drive = Drive { law: Law::coulomb(0.0), rate: 0.0, force_n, ramp_s: 0.0 };
    let mut state = State::<1>::at_rest(&model);
    advance(&model, &drive, &mut state, (80.0 / slowest / model.time_step_s()) as usize);
    let body = model.ring().unwrap();
    let disk = state.target.ring().unwrap().1;
    let worst = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
    let slave = worst(
        &mut model
            .slaves()
            .iter()
            .zip(state.contacts.forces(0))
            .map(|(slave, force)| force[2] / (pressure * slave.area_m2) - 1.0),
    );
    // At rest the contact forces on the top nodes are K u.
    let mut product = disk.u.clone();
    let mut scratch = tribosweep_mechanics::solver::body::ring::operator::RingScratch::new(body.operator());
    body.operator().product(&disk.u, &mut product, &mut scratch);
    let nodes = body.mesh().nodes_per_axis();
    let top = nodes[0] * nodes[1];
    let at_end = |index: usize, count: usize| if index == 0 || index + 1 == count { 0.5 } else { 1.0 };
    let cell = size[0] * size[1] / (lower * lower) as f64;
    let target = worst(&mut (0..top).map(|node| {
        let [j, i, _] = body.mesh().grid_position(node);
        -product[3 * node + 2] / (pressure * cell * at_end(j, nodes[0]) * at_end(i, nodes[1])) - 1.0
    }));
    let heights: Vec<f64> = (0..top).map(|node| disk.u[3 * node + 2]).collect();
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let shortening = pressure * 2.0 * size[2] / material.young_modulus_pa;
    let waviness = worst(&mut heights.iter().map(|height| (height - mean) / shortening));
    Pressed { slave, target, waviness }
}

/// Error of the one-pass method itself, over a line (a face is the product of two lines). The slave nodes
/// have their shares of a uniform pressure. Linear shape functions spread these shares over target nodes. The
/// result is the largest deviation from the target nodes' own shares.
fn one_pass_error(upper: usize, lower: usize) -> f64 {
    let end = |index: usize, count: usize| if index == 0 || index == count { 0.5 } else { 1.0 };
    let mut received = vec![0.0; lower + 1];
    for slave in 0..=upper {
        let at = slave as f64 / upper as f64 * lower as f64;
        let cell = (at as usize).min(lower - 1);
        let share = end(slave, upper) / upper as f64;
        received[cell] += (1.0 - (at - cell as f64)) * share;
        received[cell + 1] += (at - cell as f64) * share;
    }
    let off = |(node, force): (usize, &f64)| (force * lower as f64 / end(node, lower) - 1.0).abs();
    received.iter().enumerate().map(off).fold(0.0, f64::max)
}

/// Protects: blocks with the same mesh pass the patch test, to the remainder of the motion. Blocks with
/// different meshes fail it, as node-to-surface contact does: shape functions spread the slave nodes' forces,
/// and the result is not the share of a uniform pressure. The error of the nodal forces does not fall with
/// refinement, but the error of the displacements does.
#[test]
fn the_patch_test_is_passed_by_equal_meshes() {
    for target in [TargetSurface::Bilinear, TargetSurface::Ferguson] {
        let equal = pressed(3, 3, target);
        assert!(equal.target < 1e-6 && equal.waviness < 1e-6 && equal.slave < 1e-6, "{}", equal.target);
    }
    unequal_meshes_converge(&[TargetSurface::Bilinear]);
}

/// Protects: unequal meshes converge with smooth patches too.
#[test]
#[ignore = "two blocks on three meshes"]
fn unequal_meshes_converge_on_smooth_patches() {
    unequal_meshes_converge(&[TargetSurface::Ferguson]);
}

fn unequal_meshes_converge(targets: &[TargetSurface]) {
    for &target in targets {
        let mut evidence = Evidence::new(
            "R5",
            format!("two blocks, meshes 3 : 2, {target:?}, waviness of the interface over the shortening"),
            "uniform stress (Hooke)",
        );
        let mut forces = Evidence::new(
            "R5",
            format!(
                "two blocks, meshes 3 : 2, {target:?}, worst nodal force of the lower one over its share, less one"
            ),
            "uniform stress (Hooke)",
        );
        for refinement in [1, 2, 4] {
            let found = pressed(3 * refinement, 2 * refinement, target);
            let line = one_pass_error(3 * refinement, 2 * refinement);
            let name = format!("{} on {}", 3 * refinement, 2 * refinement);
            forces.bounded(name, found.target, 0.0, 1.0, (1.0 + line) * (1.0 + line) - 1.0);
            evidence.found(format!("{} on {}", 3 * refinement, 2 * refinement), found.waviness, 0.0, 1.0);
        }
        forces.judge_bounded(
            "shares of a uniform pressure spread by bilinear shape functions; the blocks even it out",
        );
        evidence.judge_overall_order(
            1.0,
            2.0,
            "edges and corners have the largest error, and their own order",
        );
    }
}
