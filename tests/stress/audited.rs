//! A job's run is repeated with its energies balanced at every step. A bound says how well they must close.
//!
//! The balance is an identity of the scheme (`solver::energy`), so in exact arithmetic the imbalance is zero.
//! In floating point the result of every operation has a relative error of at most ε = 2⁻⁵², and in single precision 2⁻²³.
//! Sums over steps are always in double precision. The standard
//! model of rounding (Higham, *Accuracy and Stability of Numerical Algorithms*, ch. 3) turns this into a
//! bound that is computed during the run:
//!
//! * The nodal force of a step is the result of some 40 operations in sequence (sums along x, y and z of
//!   `solver::body::pin::operator::tensor` and about ten more terms). |K| is the sum of the magnitudes of
//!   all its terms, before any of them cancel. At each degree of freedom the error of the force is at most
//!   ~91 ε w, with room for the sums along lines, where w = |K|(|u| + β_R|p|) + m(|u| + Δt|p|)/Δt² +
//!   |external forces|. The term with 1/Δt² is the rounding of u_{n+1} and p_{n+1} themselves, as a force. An
//!   error of the force does the work error × |Δu|. The scheme weights the increments on both sides, and the
//!   numerical damping of β₂ > ½ includes one more.
//! * The step and the ledger each evaluate these sums, so the error counts twice. A step contributes at most
//!   C ε Σ w(|Δu_n| + |Δu_{n−1}| + |Δu_{n−2}|) with C = 200.
//! * The sums of works are rounded once per step and term, in double precision: 8 ε Σ|works so far|.
//! * The drive does its work T·VΔt, and friction takes T·(VΔt − Δu). VΔt, this difference, the direction of T and T itself are
//!   numbers of the fields, so each work has some 16 roundings: 16 ε (work put in + friction). With a tiny load or a fast disk
//!   this is all that counts.
//! * At the end, ½uKu has an error of C ε ½|u||K||u|. The acceleration in the kinetic energy is a difference
//!   of displacements, so that energy has an error of C ε Σ m g (g + |u|/Δt), where g = |p| + |Δu_n|/Δt +
//!   |Δu_{n−1}|/Δt.
//!
//! Terms in ε² are neglected: no run here has 10¹³ steps.

use tribosweep_mechanics::solver::body::pin::operator::{AssembledOperator, Operator};
use tribosweep_mechanics::solver::body::pin::{BlockMesh, PinMesh};
use tribosweep_mechanics::solver::energy::{Energies, EnergyLedger};
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::support::{RockingWay, Support};
use tribosweep_mechanics::solver::{Drive, InLanes, Model, StateOf, step};

/// The numbers of a run's fields.
pub trait Rounded: InLanes<1> {
    /// Largest relative error of an operation.
    const EPSILON: f64;
}

impl Rounded for f64 {
    const EPSILON: f64 = Self::EPSILON;
}

impl Rounded for f32 {
    const EPSILON: f64 = Self::EPSILON as f64;
}

/// Number of roundings of a force, in the step and in the ledger.
const ROUNDINGS: f64 = 200.0;

/// Number of roundings of the works of the drive and of friction.
const FRICTION_ROUNDINGS: f64 = 16.0;

/// Steps between two audits of a job.
pub const JOB_INTERVAL: u64 = tribosweep_mechanics::analysis::lanes::AUDIT_INTERVAL;

/// A run whose energies are balanced at every step.
pub struct Audited<'a, R: Rounded = f64> {
    model: &'a Model,
    /// The drive of the coming steps.
    pub drive: Drive,
    /// The state.
    pub state: StateOf<1, R>,
    every: EnergyLedger<1, R>,
    sampled: EnergyLedger<1, R>,
    /// The magnitudes of the terms of K, row by row.
    magnitudes: Vec<Vec<(usize, f64)>>,
    before: Vec<f64>,
    forces: Vec<f64>,
    increments: [Vec<f64>; 3],
    force_work_j: f64,
    sums_j: f64,
    at_job_audit: Energies,
    highest_stored: f64,
    highest_magnitude: f64,
}

impl<'a, R: Rounded> Audited<'a, R> {
    /// A run from `state` (before its first step).
    #[expect(clippy::large_types_passed_by_value, reason = "a test makes one, whose size does not matter")]
    pub fn new(model: &'a Model, drive: Drive, state: StateOf<1, R>) -> Self {
        let mesh = model.mesh();
        let field = || vec![0.0; state.u.len()];
        Self {
            model,
            drive,
            every: EnergyLedger::new(model, 1),
            sampled: EnergyLedger::new(model, JOB_INTERVAL),
            magnitudes: match mesh {
                PinMesh::Block(block) => magnitudes(block, model.pin().material()).rows(),
                PinMesh::General(_) => magnitudes_of(model.pin().operator()).rows(),
            },
            before: field(),
            forces: field(),
            increments: std::array::from_fn(|_| field()),
            force_work_j: 0.0,
            sums_j: 0.0,
            at_job_audit: Energies::default(),
            highest_stored: 0.0,
            highest_magnitude: 0.0,
            state,
        }
    }

    /// Does one step.
    pub fn advance(&mut self) {
        let (model, drives) = (self.model, [self.drive]);
        self.before = self.state.u.values().collect();
        self.find_magnitudes();
        self.every.before_step(model, &self.state);
        self.sampled.before_step(model, &self.state);
        step(model, &drives, &mut self.state);
        self.every.after_step(model, &drives, &self.state);
        self.sampled.after_step(model, &drives, &self.state);
        self.add_up();
        if self.sampled.audits(self.state.step - 1) {
            self.at_job_audit = *self.every.energies(0);
            self.find_highest();
        }
    }

    /// Does `steps` steps.
    pub fn run(&mut self, steps: u64) {
        for _ in 0..steps {
            self.advance();
        }
    }

    /// The energies at the last step.
    pub fn energies(&self) -> &Energies {
        self.every.energies(0)
    }

    /// The energies as the job computes them, at its last audit.
    pub fn sampled_energies(&self) -> &Energies {
        self.sampled.energies(0)
    }

    /// The exact energies at the job's last audit.
    pub fn energies_at_job_audit(&self) -> &Energies {
        &self.at_job_audit
    }

    /// Largest ratios at the job's audits: of the stored energy, and of the sum of the magnitudes of its
    /// parts. Both are over the energy put in plus the static compression F²h/(2EA), as in the divergence
    /// guard.
    pub fn highest_ratios(&self) -> [f64; 2] {
        [self.highest_stored, self.highest_magnitude]
    }

    fn find_highest(&mut self) {
        let [lx, ly, lz] = self.model.mesh().size_m();
        let modulus_pa = self.model.pin().material().young_modulus_pa;
        let e = self.every.energies(0);
        let scale_j = e.input_j() + self.drive.force_n.powi(2) * lz / (2.0 * modulus_pa * lx * ly);
        self.highest_stored = self.highest_stored.max((e.kinetic_j + e.elastic_j) / scale_j);
        self.highest_magnitude =
            self.highest_magnitude.max((e.kinetic_j.abs() + e.elastic_j.abs()) / scale_j);
    }

    /// Largest imbalance [J] that rounding can explain.
    pub fn rounding_bound_j(&self) -> f64 {
        let of_fields = R::EPSILON * ROUNDINGS * (self.force_work_j + self.end_terms_j());
        let e = self.every.energies(0);
        let of_friction = R::EPSILON * FRICTION_ROUNDINGS * (e.input_j() + e.friction_j.abs());
        of_fields + of_friction + f64::EPSILON * 8.0 * self.sums_j
    }

    /// Computes w without the contact forces, which the step has not found yet.
    fn find_magnitudes(&mut self) {
        let (dt, beta_r) = (self.model.time_step_s(), self.model.scheme().beta_r_s);
        let strained = self.state.u.values().zip(self.state.p.values());
        let strained: Vec<f64> = strained.map(|(u, p)| u.abs() + beta_r * p.abs()).collect();
        self.forces = times(&self.magnitudes, &strained);
        for (i, force) in self.forces.iter_mut().enumerate() {
            let mass = self.model.pin().masses_kg()[i / 3];
            *force +=
                mass * (self.state.u[i].to_f64().abs() + dt * self.state.p[i].to_f64().abs()) / (dt * dt);
        }
        for Way { form, mass, stiffness, damping } in ways(self.model) {
            let [u, p] = [&self.state.u, &self.state.p].map(|field| -> f64 {
                form.iter().map(|(dof, factor)| factor.abs() * field[*dof].to_f64().abs()).sum()
            });
            let inertia = mass * (u + dt * p) / (dt * dt);
            for (dof, factor) in form {
                self.forces[dof] += factor.abs() * (stiffness * u + damping * p + inertia);
            }
        }
    }

    fn add_up(&mut self) {
        let mesh = self.model.mesh();
        for (contact, slave) in self.state.contacts.forces(0).zip(self.model.slaves()) {
            for c in 0..3 {
                self.forces[3 * slave.node + c] += contact[c].abs();
            }
        }
        // Every top node gets the whole load. This is more than its share, but simpler.
        for node in mesh.top_nodes() {
            self.forces[3 * node + 2] += self.state.load_n[0].abs();
        }
        self.increments.rotate_right(1);
        let mut work_j = 0.0;
        for i in 0..self.before.len() {
            self.increments[0][i] = (self.state.u[i].to_f64() - self.before[i]).abs();
            work_j +=
                self.forces[i] * (self.increments[0][i] + self.increments[1][i] + self.increments[2][i]);
        }
        self.force_work_j += work_j;
        let e = self.every.energies(0);
        self.sums_j += e.input_j() + e.friction_j.abs() + e.damping_j.abs() + e.contact_loss_j.abs();
    }

    fn end_terms_j(&self) -> f64 {
        let dt = self.model.time_step_s();
        let magnitude: Vec<f64> = self.before.iter().map(|u| u.abs()).collect();
        let product = times(&self.magnitudes, &magnitude);
        let mut sum_j = 0.0;
        for i in 0..magnitude.len() {
            let speed = self.state.p[i].to_f64().abs() + (self.increments[0][i] + self.increments[1][i]) / dt;
            let mass = self.model.pin().masses_kg()[i / 3];
            sum_j += 0.5 * magnitude[i] * product[i] + mass * speed * (speed + magnitude[i] / dt);
        }
        for Way { form, mass, stiffness, .. } in ways(self.model) {
            let of = |value: &dyn Fn(usize) -> f64| -> f64 {
                form.iter().map(|(dof, factor)| factor.abs() * value(*dof)).sum()
            };
            let speed = of(&|dof| {
                self.state.p[dof].to_f64().abs() + (self.increments[0][dof] + self.increments[1][dof]) / dt
            });
            let u = of(&|dof| magnitude[dof]);
            sum_j += 0.5 * stiffness * u * u + mass * speed * (speed + u / dt);
        }
        sum_j
    }
}

/// A way in which a holder moves, as a form of displacements.
struct Way {
    form: Vec<(usize, f64)>,
    mass: f64,
    stiffness: f64,
    damping: f64,
}

/// The ways of the holders among the supports.
fn ways(model: &Model) -> Vec<Way> {
    let of = |support: &Support| match support {
        Support::Held(held) => vec![Way {
            form: held.tied.dofs().take(1).map(|dof| (dof, 1.0)).collect(),
            mass: held.mass_kg,
            stiffness: held.stiffness_n_m,
            damping: held.damping_n_s_m,
        }],
        Support::Rocking(rocking) => {
            let (chosen, factors) = rocking.coordinates().unwrap();
            let dofs: Vec<usize> = rocking.dofs().collect();
            let way = |(w, way): (usize, &RockingWay)| Way {
                form: chosen.iter().enumerate().map(|(i, &at)| (dofs[at], factors[(w, i)])).collect(),
                mass: way.inertia,
                stiffness: way.stiffness,
                damping: way.damping,
            };
            rocking.ways.iter().enumerate().map(way).collect()
        }
        Support::Fixed(_) | Support::Tied(_) => Vec::new(),
    };
    model.supports().iter().flat_map(of).collect()
}

/// The magnitudes of all terms of K in its tensor form, element by element.
fn magnitudes(mesh: &BlockMesh, material: &Material) -> AssembledOperator {
    let h = mesh.element_size_m();
    let (lambda, shear) = (material.lame_lambda_pa(), material.shear_modulus_pa());
    // Along an axis, corners a and b are on the same side or on opposite sides: ∫NN is 2 or 1 sixths of h,
    // ∫N′N′ is ±1/h, and ∫N′N is ±½.
    let mass =
        |axis: usize, a: usize, b: usize| h[axis] / 6.0 * if (a ^ b) >> axis & 1 == 0 { 2.0 } else { 1.0 };
    let entry = |a: usize, r: usize, b: usize, c: usize| -> f64 {
        let product = |factor: &dyn Fn(usize) -> Option<f64>| -> f64 {
            (0..3).map(|axis| factor(axis).unwrap_or_else(|| mass(axis, a, b))).product()
        };
        if r == c {
            let term = |d: usize| {
                let modulus = if d == r { lambda + 2.0 * shear } else { shear };
                modulus * product(&|axis| (axis == d).then(|| 1.0 / h[axis]))
            };
            (0..3).map(term).sum()
        } else {
            // λ and G multiply two derivatives each, and the operator uses their sum and difference λ ± G.
            2.0 * (lambda.abs() + shear) * product(&|axis| (axis == r || axis == c).then_some(0.5))
        }
    };
    let entries = mesh.element_positions().flat_map(|[i, j, k]| {
        let nodes = mesh.element_nodes(i, j, k);
        (0..24).flat_map(move |row| (0..24).map(move |column| (row, column))).map(move |(row, column)| {
            let (a, r, b, c) = (row / 3, row % 3, column / 3, column % 3);
            (3 * nodes[a] + r, 3 * nodes[b] + c, entry(a, r, b, c))
        })
    });
    AssembledOperator::from_entries(mesh.node_count(), entries).expect("magnitudes are symmetric")
}

/// The magnitudes of all terms of an assembled K.
fn magnitudes_of(operator: &Operator) -> AssembledOperator {
    let Operator::Assembled(operator) = operator else { panic!("an assembled K") };
    let entries = operator.entries().map(|(row, column, k)| (row, column, k.abs()));
    AssembledOperator::from_entries(operator.nodes(), entries).expect("magnitudes are symmetric")
}

fn times(rows: &[Vec<(usize, f64)>], x: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| row.iter().map(|(column, k)| k * x[*column]).sum()).collect()
}
