//! The motion of a pin from one mesh to another, and a run that begins in motion.

use super::body::Freedom;
use super::body::pin::BlockMesh;
use super::interface::solve::RunNumber;
use super::model::Model;
use super::state::StateOf;

/// Displacements and velocities of all nodes of a pin at one time, in the order node → component.
#[derive(Debug, Clone, PartialEq)]
pub struct PinMotion {
    /// Displacements \[m\].
    pub u_m: Vec<f64>,
    /// Velocities \[m/s\].
    pub velocity_m_s: Vec<f64>,
}

impl PinMotion {
    /// The same motion on another mesh of the same block: linear interpolation at the positions of its nodes.
    #[must_use]
    pub fn interpolated(&self, from: &BlockMesh, to: &BlockMesh) -> Self {
        let on_mesh = |values: &[f64]| interpolated(values, from, to);
        Self { u_m: on_mesh(&self.u_m), velocity_m_s: on_mesh(&self.velocity_m_s) }
    }

    /// The motion with the constraints of a model: fixed degrees of freedom are at rest, tied ones move together, and no
    /// slave node is inside a rigid target.
    #[must_use]
    fn constrained(&self, model: &Model) -> Self {
        let mut kept = self.clone();
        let mut of_groups: Vec<Option<[f64; 2]>> = Vec::new();
        for (dof, freedom) in model.pin().freedoms().iter().enumerate() {
            let own = [kept.u_m[dof], kept.velocity_m_s[dof]];
            let moved = match *freedom {
                // Scenes with a holder start from rest.
                Freedom::Free | Freedom::Carried => own,
                Freedom::Fixed => [0.0; 2],
                // Without a holder that moves, scenes tie whole planes, so the members of a tie agree on the other mesh too.
                Freedom::Tied(group) => {
                    of_groups.resize(of_groups.len().max(group + 1), None);
                    *of_groups[group].get_or_insert(own)
                }
            };
            [kept.u_m[dof], kept.velocity_m_s[dof]] = moved;
        }
        for slave in model.slaves() {
            let z = &mut kept.u_m[3 * slave.node + 2];
            *z = z.max(-slave.initial_gap_m);
        }
        kept
    }
}

impl<const L: usize, R: RunNumber> StateOf<L, R> {
    /// The motion of the pin in a lane at the time of its velocities, `t_n − β₂Δt`.
    pub fn motion_of(&self, model: &Model, lane: usize) -> PinMotion {
        let scheme = model.scheme();
        let back_s = scheme.beta2 * scheme.time_step_s;
        let dofs = 0..3 * model.mesh().node_count();
        let velocity_m_s: Vec<f64> = dofs.map(|dof| self.p[dof * L + lane].to_f64()).collect();
        let u_m = velocity_m_s.iter().enumerate();
        let u_m = u_m.map(|(dof, velocity)| self.u[dof * L + lane].to_f64() - back_s * velocity).collect();
        PinMotion { u_m, velocity_m_s }
    }

    /// Sets the motion with which the job in a lane begins. The lane is at rest and on a rigid target.
    ///
    /// The contact forces of a step on a rigid target follow from the motion alone, if the friction law does not use the past.
    /// So nothing else has to be set: the work of the forces at n = 0 has no increment before it.
    ///
    /// # Panics
    /// If the motion is not one of the model's mesh.
    pub fn begin_in_motion(&mut self, model: &Model, lane: usize, motion: &PinMotion) {
        let PinMotion { u_m, velocity_m_s } = motion.constrained(model);
        assert_eq!(u_m.len() * L, self.u.len(), "a motion on the mesh of the model");
        for (dof, (u, velocity)) in u_m.iter().zip(&velocity_m_s).enumerate() {
            self.u[dof * L + lane] = R::from_f64(*u);
            self.p[dof * L + lane] = R::from_f64(*velocity);
        }
    }
}

/// Nodal values, three per node, at the nodes of another mesh of the same block.
fn interpolated(values: &[f64], from: &BlockMesh, to: &BlockMesh) -> Vec<f64> {
    let (cells, parts) = (from.elements(), to.elements());
    let mut found = Vec::with_capacity(3 * to.node_count());
    for node in 0..to.node_count() {
        let grid = to.grid_position(node);
        // Position in elements of the other mesh: a whole number and a fraction, without rounding of the whole number.
        let low: [usize; 3] = std::array::from_fn(|axis| grid[axis] * cells[axis] / parts[axis]);
        let high: [usize; 3] = std::array::from_fn(|axis| (low[axis] + 1).min(cells[axis]));
        let share: [f64; 3] =
            std::array::from_fn(|axis| (grid[axis] * cells[axis] % parts[axis]) as f64 / parts[axis] as f64);
        for c in 0..3 {
            let at = |x: usize, y: usize, z: usize| values[3 * from.node(x, y, z) + c];
            let along_x = |y, z| between(at(low[0], y, z), at(high[0], y, z), share[0]);
            let along_y = |z| between(along_x(low[1], z), along_x(high[1], z), share[1]);
            found.push(between(along_y(low[2]), along_y(high[2]), share[2]));
        }
    }
    found
}

/// Linear interpolation that keeps equal values to the bit.
fn between(a: f64, b: f64, share: f64) -> f64 {
    a + share * (b - a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::energy::EnergyLedger;
    use crate::solver::interface::law::Law;
    use crate::solver::{Drive, State, step};
    use crate::spec::JobSpec;

    fn model(elements: [usize; 3]) -> Model {
        let mut spec = JobSpec::default();
        spec.scene.pin.elements = elements;
        spec.scene.clamp.width_m = 0.002;
        Model::from_scene(&spec.scene, &spec.numerics).unwrap()
    }

    /// A motion that is linear in the coordinates.
    fn block(model: &Model) -> &BlockMesh {
        model.mesh().block().unwrap()
    }

    fn linear(mesh: &BlockMesh) -> PinMotion {
        let of_node = |node| {
            let [x, y, z] = mesh.coordinates_m(node);
            [1.0 + 2.0 * x - y, 3.0 * z, x + y + z - 0.5]
        };
        let u_m: Vec<f64> = (0..mesh.node_count()).flat_map(of_node).collect();
        PinMotion { velocity_m_s: u_m.iter().map(|u| 7.0 * u).collect(), u_m }
    }

    /// Protects: a linear motion is exact on any other mesh, to the rounding of a few operations on numbers of order ten. A
    /// constant motion, and any motion on the same mesh, keep their bits.
    #[test]
    fn linear_motions_are_exact() {
        let from = model([6, 8, 5]);
        let motion = linear(block(&from));
        for elements in [[12, 16, 10], [7, 9, 11], [6, 4, 3]] {
            let to = BlockMesh::new(block(&from).size_m(), elements);
            let (found, expected) = (motion.interpolated(block(&from), &to), linear(&to));
            let pairs = found.u_m.iter().zip(&expected.u_m);
            for (a, b) in pairs.chain(found.velocity_m_s.iter().zip(&expected.velocity_m_s)) {
                assert!((a - b).abs() < 100.0 * f64::EPSILON, "{a} {b}");
            }
            let constant = vec![0.1; 3 * block(&from).node_count()];
            assert!(interpolated(&constant, block(&from), &to).iter().all(|&value| value == 0.1));
        }
        assert_eq!(motion.interpolated(block(&from), block(&from)), motion);
    }

    /// Protects: a run that begins in motion keeps the constraints: no slave node is inside the disk, fixed degrees of freedom
    /// are at rest, and tied ones move together.
    #[test]
    fn a_motion_keeps_the_constraints() {
        let model = model([6, 8, 5]);
        let mut state = State::<2>::at_rest(&model);
        state.begin_in_motion(&model, 1, &linear(block(&model)));
        assert!(state.u.values().step_by(2).all(|u| u == 0.0), "the other lane is at rest");
        let of = |dof: usize| [state.u[2 * dof + 1], state.p[2 * dof + 1]];
        let mut tied = Vec::new();
        for (dof, freedom) in model.pin().freedoms().iter().enumerate() {
            match freedom {
                Freedom::Free | Freedom::Carried => {}
                Freedom::Fixed => assert_eq!(of(dof), [0.0; 2]),
                Freedom::Tied(_) => tied.push(of(dof)),
            }
        }
        assert!(tied.len() > 1 && tied.iter().all(|motion| *motion == tied[0]));
        let gaps: Vec<f64> = model.slaves().iter().map(|slave| of(3 * slave.node + 2)[0]).collect();
        assert!(gaps.iter().all(|&gap| gap >= 0.0) && gaps.contains(&0.0));
    }

    /// Protects: the energies of a run that begins deformed and in motion balance to rounding, with what is stored at its
    /// start counted as put in.
    #[test]
    fn energies_balance_from_a_start_in_motion() {
        energies_balance_after(1000, 100);
    }

    /// Protects: the same later and for longer.
    #[test]
    #[ignore = "2400 steps without optimization"]
    fn energies_balance_for_longer() {
        energies_balance_after(2000, 400);
    }

    fn energies_balance_after(steps_before: usize, steps: usize) {
        let (coarse, fine) = (model([6, 8, 5]), model([12, 15, 10]));
        let drive = Drive { law: Law::coulomb(0.5), rate: 2.0, force_n: 30.0, ramp_s: 0.0 };
        let mut before = State::<1>::at_rest(&coarse);
        for _ in 0..steps_before {
            step(&coarse, &[drive], &mut before);
        }
        let motion = before.motion_of(&coarse, 0).interpolated(block(&coarse), block(&fine));
        let mut state = State::<1>::at_rest(&fine);
        state.begin_in_motion(&fine, 0, &motion);
        let mut ledger = EnergyLedger::<1>::new(&fine, 1);
        for n in 0..steps {
            ledger.before_step(&fine, &state);
            step(&fine, &[drive], &mut state);
            ledger.after_step(&fine, &[drive], &state);
            let energies = ledger.energies(0);
            assert!(energies.initial_j > 0.0);
            assert!(energies.relative_residual() < 1e-11, "step {n}: {energies:?}");
        }
    }

    /// Protects: displacements and velocities of a motion are those of one time. A linear vibration that goes on from it on the
    /// same mesh differs from the vibration itself by a phase of second order in the time step: half a step for twice as many
    /// steps has a quarter of the error.
    #[test]
    fn a_motion_is_that_of_one_time() {
        let error = |refinement: u32| {
            let mut spec = JobSpec::default();
            spec.scene.pin.elements = [3, 4, 3];
            spec.scene.clamp.width_m = 0.004;
            spec.numerics.time_step_s = Some(4.0e-7 / f64::from(refinement));
            let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
            // Without a load, and lifted from the disk, nothing but the pin vibrates.
            let model = model.with_initial_gaps(|_| 1.0);
            let drive = Drive { law: Law::coulomb(0.0), rate: 0.0, force_n: 1.0, ramp_s: 0.0 };
            let mut whole = State::<1>::at_rest(&model);
            for _ in 0..100 * refinement {
                step(&model, &[drive], &mut whole);
            }
            let mut resumed = State::<1>::at_rest(&model);
            resumed.begin_in_motion(&model, 0, &whole.motion_of(&model, 0));
            for _ in 0..100 * refinement {
                step(&model, &[drive], &mut whole);
                step(&model, &[drive], &mut resumed);
            }
            // The resumed run is half a step behind.
            let whole = whole.motion_of(&model, 0).u_m;
            let difference = resumed.u.values().zip(&whole).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            (difference / whole.iter().map(|u| u * u).sum::<f64>()).sqrt()
        };
        let [coarse, fine] = [error(1), error(2)];
        assert!(coarse < 0.05 && (3.0..5.0).contains(&(coarse / fine)), "{coarse} {fine}");
    }
}
