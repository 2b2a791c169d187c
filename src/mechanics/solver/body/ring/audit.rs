//! Stored energies of a ring and the work of its damping.
//!
//! A step of the ring is the central difference with the mass M̃ = M B⁻¹ ([`stages`](super::stages)). So its
//! kinetic energy is that of a block with M̃ instead of M: ½ v·M(B⁻¹v) − ¼Δt² a·M(B⁻¹a).

use super::operator::RingScratch;
use super::{RingBody, RingState, rows_of};
use crate::solver::body::{EnergySums, add_lanes};
use crate::solver::field::{Field, Row, WIDTH, add_slots, in_slots};
use crate::solver::scheme::Scheme;

/// Evaluates the energies of a ring. It stores values from before the audited step.
#[derive(Debug, Clone)]
pub(in crate::solver) struct RingAudit<const L: usize> {
    masses_kg: Vec<Row>,
    p: Field<L>,
    /// B⁻¹p.
    momentum_velocity: Field<L>,
    kp: Field<L>,
    scratch: RingScratch<L>,
    elastic_j: [f64; L],
    damping_before_j: [f64; L],
}

impl<const L: usize> RingAudit<L> {
    pub fn new(body: &RingBody) -> Self {
        let field = || Field::<L>::zeros(body.mesh().layout());
        Self {
            masses_kg: rows_of(body.masses_kg(), &field()),
            p: field(),
            momentum_velocity: field(),
            kp: field(),
            scratch: RingScratch::new(body.operator()),
            elastic_j: [0.0; L],
            damping_before_j: [0.0; L],
        }
    }

    /// Stores the state before the step, and evaluates uKu and pKp.
    pub fn begin(&mut self, body: &RingBody, scheme: &Scheme, before: &RingState<L>) {
        let Scheme { time_step_s, beta_r_s, .. } = *scheme;
        self.p.clone_from(&before.p);
        self.momentum_velocity.clone_from(before.momentum_velocity());
        // K p overwrites K u below.
        let elastic = body.operator().form(&before.u, &mut self.kp, &mut self.scratch);
        self.elastic_j = elastic.map(|form| 0.5 * form);
        if beta_r_s > 0.0 {
            let form = body.operator().form(&before.p, &mut self.kp, &mut self.scratch);
            self.damping_before_j = form.map(|form| beta_r_s * time_step_s * form);
        }
    }

    /// Adds the energies at t_n, the time before the step. `begins` marks the lanes that have done only their first
    /// step.
    pub fn add_to(
        &self,
        total: &mut EnergySums<L>,
        scheme: &Scheme,
        after: &RingState<L>,
        begins: &[bool; L],
    ) {
        let dt = scheme.time_step_s;
        let gain = in_slots(&begins.map(|begins| if begins { 0.0 } else { 0.5 * dt }));
        let scales = begins.map(|begins| scheme.factors(begins));
        let per_p = in_slots(&scales.map(|(_, p_factor)| 1.0 / (p_factor * dt)));
        let u_scale = in_slots(&scales.map(|(u_factor, _)| u_factor * dt * dt));
        let damps = scheme.beta_r_s > 0.0;
        let stride = self.p.blocks_per_line();
        for along in 0..stride {
            let (mut kinetic, mut damping) = ([0.0; WIDTH], [0.0; WIDTH]);
            for at in (along..self.p.blocks().len()).step_by(stride) {
                let mass = &self.masses_kg[at].0;
                for c in 0..3 {
                    let row = |field: &Field<L>| field.blocks()[at].0[c];
                    let (p, q, kp) = (row(&self.p), row(&self.momentum_velocity), row(&self.kp));
                    let (next_p, next_q) = (row(&after.p), row(after.momentum_velocity()));
                    for i in 0..WIDTH {
                        let (a, b) = ((next_p[i] - p[i]) * per_p[i], (next_q[i] - q[i]) * per_p[i]);
                        let (v, w) = (p[i] + gain[i] * a, q[i] + gain[i] * b);
                        kinetic[i] += 0.5 * mass[i] * (v * w - 0.25 * dt * dt * (a * b));
                        if damps {
                            damping[i] += scheme.beta_r_s * kp[i] * (dt * p[i] + u_scale[i] * a);
                        }
                    }
                }
            }
            add_slots(&mut total.kinetic_j, &kinetic);
            add_slots(&mut total.damping_after_j, &damping);
        }
        add_lanes(&mut total.elastic_j, &self.elastic_j);
        add_lanes(&mut total.damping_before_j, &self.damping_before_j);
    }
}
