//! Stored energies of an elastic disk and the work of its damping.
//!
//! The disk's step is the central difference with the mass M̃ = M B⁻¹ ([`stages`](crate::solver::disk::stages)), so its
//! kinetic energy is that of `audit` with M̃: ½ v·M(B⁻¹v) − ¼Δt² a·M(B⁻¹a).

use super::audit::Found;
use crate::solver::disk::{DiskBody, DiskState};
use crate::solver::field::{Field, Row, WIDTH, add_slots, in_slots};
use crate::solver::model::Model;
use crate::solver::step::factors;

/// What is kept from before the step.
#[derive(Debug, Clone)]
pub(super) struct DiskAudit<const L: usize> {
    masses_kg: Vec<Row>,
    p: Field<L>,
    /// B⁻¹p.
    momentum_velocity: Field<L>,
    kp: Field<L>,
    scratch: crate::solver::disk::operator::RingScratch<L>,
    elastic_j: [f64; L],
    damping_before_j: [f64; L],
}

impl<const L: usize> DiskAudit<L> {
    pub fn new(body: &DiskBody) -> Self {
        let [columns, rows, planes] = body.mesh().nodes_per_axis();
        let field = || Field::<L>::with_lines(columns, rows * planes);
        Self {
            masses_kg: crate::solver::disk::rows_of(body.masses_kg(), &field()),
            p: field(),
            momentum_velocity: field(),
            kp: field(),
            scratch: crate::solver::disk::operator::RingScratch::new(body.operator()),
            elastic_j: [0.0; L],
            damping_before_j: [0.0; L],
        }
    }

    /// Keeps the state before the step, and what u and p do against K.
    pub fn begin(&mut self, body: &DiskBody, disk: &DiskState<L>, time_step_s: f64, beta_r_s: f64) {
        self.p.clone_from(&disk.p);
        self.momentum_velocity.clone_from(disk.momentum_velocity());
        // K u is not kept.
        let elastic = body.operator().form(&disk.u, &mut self.kp, &mut self.scratch);
        self.elastic_j = elastic.map(|form| 0.5 * form);
        if beta_r_s > 0.0 {
            let form = body.operator().form(&disk.p, &mut self.kp, &mut self.scratch);
            self.damping_before_j = form.map(|form| beta_r_s * time_step_s * form);
        }
    }

    /// Adds the disk's energies at t_n, the time before the step; `begins` are lanes in their first step.
    pub fn add_to(&self, found: &mut Found<L>, disk: &DiskState<L>, model: &Model, begins: &[bool; L]) {
        let dt = model.time_step_s();
        let gain = in_slots(&begins.map(|begins| if begins { 0.0 } else { 0.5 * dt }));
        let scales = begins.map(|begins| factors(0.5, u64::from(!begins)));
        let per_p = in_slots(&scales.map(|(_, p_factor)| 1.0 / (p_factor * dt)));
        let u_scale = in_slots(&scales.map(|(u_factor, _)| u_factor * dt * dt));
        let damps = model.beta_r_s() > 0.0;
        let stride = self.p.blocks_per_line();
        for along in 0..stride {
            let (mut kinetic, mut damping) = ([0.0; WIDTH], [0.0; WIDTH]);
            for at in (along..self.p.blocks().len()).step_by(stride) {
                let mass = &self.masses_kg[at].0;
                for c in 0..3 {
                    let row = |field: &Field<L>| field.blocks()[at].0[c];
                    let (p, q, kp) = (row(&self.p), row(&self.momentum_velocity), row(&self.kp));
                    let (next_p, next_q) = (row(&disk.p), row(disk.momentum_velocity()));
                    for i in 0..WIDTH {
                        let (a, b) = ((next_p[i] - p[i]) * per_p[i], (next_q[i] - q[i]) * per_p[i]);
                        let (v, w) = (p[i] + gain[i] * a, q[i] + gain[i] * b);
                        kinetic[i] += 0.5 * mass[i] * (v * w - 0.25 * dt * dt * (a * b));
                        if damps {
                            damping[i] += model.beta_r_s() * kp[i] * (dt * p[i] + u_scale[i] * a);
                        }
                    }
                }
            }
            add_slots(&mut found.kinetic_j, &kinetic);
            add_slots(&mut found.damping_after_j, &damping);
        }
        for lane in 0..L {
            found.elastic_j[lane] += self.elastic_j[lane];
            found.damping_before_j[lane] += self.damping_before_j[lane];
        }
    }
}
