//! The forward-increment solve on a rigid target, in closed form.
//!
//! On a rigid target c Δt² G M⁻¹ Gᵀ is diagonal (G contains the constraint rows, c is the scheme's factor of Δt²a
//! in u_{n+1}). So each slave node is solved by itself, and one pass is exact. With the gap g* of the prediction
//! and the initial gap g₀:
//!
//! ```text
//! g* = g₀ + z*        N = −m g*/(cΔt²)  if g* < 0       t_trial = −m δ*/(cΔt²),  δ* = u*_t − u_t − VΔt
//! ```
//!
//! The pass predicts a block of slave nodes and corrects it at once, so that a step reads and writes their
//! displacements only once. Nodes with a fixed component are solved one by one ([`held`](super::held)).

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::held::HeldNode;
use super::step_data::StepData;
use crate::solver::body::pin::Face;
use crate::solver::field::{Block, FieldOf, in_slots_of};
use crate::solver::interface::LIMIT;
use crate::solver::interface::law::{
    AtNode, FrictionLimit, Frictionless, Law, LawOfLanes, project, with_law,
};
use crate::solver::interface::{Contacts, Interface, MovingRelief, NodesOnLayer, SlaveNode, Status};
use crate::solver::number::Number;
use crate::solver::scheme::StepFactors;
use crate::solver::simd::{dispatch, load, splat};
use fearless_simd::{Simd, prelude::*};

/// The constants of a run.
#[derive(Debug, Clone)]
pub(super) struct DiagonalSolve<const L: usize, R: Number> {
    /// Per slave node: velocity of the target per unit of the drive's rate in x and y, and the mass \[kg\]. The
    /// mass is zero if the pass does not solve the node.
    nodes: FieldOf<L, R>,
    /// Initial gap \[m\] of every slave node, in the first component. Over a relief and on a layer it is the gap of the
    /// undeformed pin at t_{n+1}, over the surface as it then is.
    initial_gap_m: FieldOf<L, R>,
    relief: Option<Box<MovingRelief<L>>>,
    layer: Option<Box<NodesOnLayer>>,
    held: Vec<HeldNode<L>>,
}

impl<const L: usize, R: Number> DiagonalSolve<L, R> {
    pub fn new(interface: &Interface) -> Self {
        Self::in_pass(interface, |node| node.mobile == [true; 3])
    }

    /// A solve whose pass takes some of the nodes. The others are solved one by one.
    pub(super) fn in_pass(interface: &Interface, is_free: impl Fn(&SlaveNode) -> bool) -> Self {
        let nodes: FieldOf<L, R> = interface.field(|node| {
            let [x, y] = node.surface_motion;
            [x, y, if is_free(node) { node.mass_kg } else { 0.0 }]
        });
        let held = interface.slaves().iter().enumerate().filter(|(_, node)| !is_free(node));
        let held = held.map(|(slave, node)| HeldNode::new(nodes.place(slave), *node)).collect();
        let initial_gap_m = interface.field(|node| [node.initial_gap_m, 0.0, 0.0]);
        let place = |slave| nodes.place(slave);
        let relief = interface.relief().map(|relief| MovingRelief::new(relief, interface.slaves(), place));
        let layer = interface.layer().map(|layer| NodesOnLayer::new(*layer, interface.slaves(), place));
        let (relief, layer) = (relief.map(Box::new), layer.map(Box::new));
        Self { nodes, initial_gap_m, relief, layer, held }
    }

    /// Moves the slave nodes. Returns the sum of the contact forces \[N\] on fixed degrees of freedom, which
    /// supports carry.
    pub fn solve(
        &mut self,
        given: &StepData<'_, L, R>,
        face: &mut Face<'_, L, R>,
        contacts: &mut Contacts<L, R>,
    ) -> [[f64; L]; 3] {
        if let Some(relief) = &mut self.relief {
            relief.advance(given, &mut self.initial_gap_m);
        }
        if let Some(layer) = &self.layer {
            layer.compress(given, face, &mut self.initial_gap_m, self.relief.is_some());
        }
        if self.relief.is_some() || self.layer.is_some() {
            for held in &mut self.held {
                held.set_gap(&self.initial_gap_m);
            }
        }
        for held in &mut self.held {
            held.keep(face, contacts);
        }
        let laws = given.drives.each_ref().map(|drive| &drive.law);
        self.pass(given, face, contacts).run(&laws);
        let mut carried_n = [[0.0; L]; 3];
        for held in &self.held {
            held.solve(given, face, contacts, &mut carried_n);
        }
        if let Some(relief) = &self.relief {
            relief.relate(contacts);
        }
        carried_n
    }

    /// Works \[J\] of the normal forces over the rises of a relief after and before t_n.
    pub fn relief_works_j(&self, contacts: &Contacts<L, R>) -> [[f64; L]; 2] {
        self.relief.as_ref().map_or([[0.0; L]; 2], |relief| relief.works_j(contacts))
    }

    /// The pass over all nodes without a fixed component.
    pub(super) fn pass<'a>(
        &'a self,
        given: &StepData<'a, L, R>,
        face: &'a mut Face<'_, L, R>,
        contacts: &'a mut Contacts<L, R>,
    ) -> FacePass<'a, R> {
        let travel_m = given.drives.each_ref().map(|drive| drive.rate * given.factors.time_step_s);
        let count = self.nodes.blocks().len();
        FacePass {
            travel_m: in_slots_of::<R>(&travel_m),
            factors: given.factors,
            nodes: self.nodes.blocks(),
            initial_gap_m: self.initial_gap_m.blocks(),
            residual: &face.residual.blocks()[..count],
            inverse_mass: face.inverse_mass,
            u: &mut face.u.blocks_mut()[..count],
            p: &mut face.p.blocks_mut()[..count],
            force_n: contacts.force_n.blocks_mut(),
            increment_m: contacts.increment_m.blocks_mut(),
            previous_increment_m: contacts.previous_increment_m.blocks(),
            status: contacts.status.blocks_mut(),
            friction: contacts.friction.blocks_mut(),
        }
    }
}

/// The blocks of the contact face, for any number of lanes.
pub(super) struct FacePass<'a, R: Number> {
    /// Displacement \[m\] of the target over the step per unit of its motion.
    travel_m: R::Row,
    factors: &'a StepFactors<R>,
    nodes: &'a [Block<R>],
    initial_gap_m: &'a [Block<R>],
    residual: &'a [Block<R>],
    inverse_mass: &'a [Block<R>],
    u: &'a mut [Block<R>],
    p: &'a mut [Block<R>],
    force_n: &'a mut [Block<R>],
    increment_m: &'a mut [Block<R>],
    previous_increment_m: &'a [Block<R>],
    status: &'a mut [Block<R>],
    friction: &'a mut [Block<R>],
}

impl<R: Number> FacePass<'_, R> {
    fn run(self, laws: &[&Law]) {
        match laws.iter().find(|law| !law.is_idle()) {
            None => dispatch!(simd => self.solve(simd, &LawOfLanes::<Frictionless, R, 0>::NONE)),
            Some(law) => with_law!(law, own => {
                let law = LawOfLanes::new(own, laws, self.factors.time_step_s);
                dispatch!(simd => self.solve(simd, &law));
            }),
        }
    }

    /// Predicts and corrects all nodes without a fixed component. If the law transmits no force, the square root
    /// and the division of the projection are left out.
    #[inline(always)]
    pub(super) fn solve<S: Simd, W: FrictionLimit<N>, const N: usize>(
        self,
        simd: S,
        law: &LawOfLanes<W, R, N>,
    ) {
        let factors = self.factors;
        let zero = splat::<R, S>(simd, 0.0);
        let one = splat::<R, S>(simd, 1.0);
        let mut numbers = [zero; N];
        for (number, row) in numbers.iter_mut().zip(&law.rows) {
            *number = load::<R, S>(simd, row);
        }
        let travel = load::<R, S>(simd, &self.travel_m);
        let u_scale = load::<R, S>(simd, &factors.u_scale);
        let p_scale = load::<R, S>(simd, &factors.p_scale);
        let per_mass = one / u_scale;
        let moving = self.u.iter_mut().zip(self.p);
        let nodes = self.nodes.iter().zip(self.initial_gap_m);
        let fixed = nodes.zip(self.residual).zip(self.inverse_mass);
        let found = (self.force_n.iter_mut())
            .zip(self.increment_m)
            .zip(self.previous_increment_m)
            .zip(self.status)
            .zip(self.friction);
        for (((u, p), (((node, initial_gap), residual), inverse_mass)), found) in moving.zip(fixed).zip(found)
        {
            let ((((force, increment), previous_increment), status), friction) = found;
            let mut before = [zero; 3];
            let mut next_u = [zero; 3];
            let mut next_p = [zero; 3];
            for c in 0..3 {
                before[c] = load::<R, S>(simd, &u.0[c]);
                let residual = load::<R, S>(simd, &residual.0[c]);
                [next_u[c], next_p[c]] = factors.moved(simd, residual, &inverse_mass.0[c], &u.0[c], &p.0[c]);
            }
            let carried = [load::<R, S>(simd, &node.0[0]) * travel, load::<R, S>(simd, &node.0[1]) * travel];
            let mass = load::<R, S>(simd, &node.0[2]);
            let stiffness = mass * per_mass;
            let initial_gap = load::<R, S>(simd, &initial_gap.0[0]);
            let gap = next_u[2] + initial_gap;
            let closed = gap.simd_lt(zero) & mass.simd_gt(zero);
            let normal = closed.select(zero - gap * stiffness, zero);
            let slip = [(next_u[0] - before[0]) - carried[0], (next_u[1] - before[1]) - carried[1]];
            let last_increment =
                [load::<R, S>(simd, &previous_increment.0[0]), load::<R, S>(simd, &previous_increment.0[1])];
            let slipped = load::<R, S>(simd, &status.0[Status::Slips as usize]);
            let trial = if W::TRANSMITS {
                [zero - stiffness * slip[0], zero - stiffness * slip[1]]
            } else {
                [zero; 2]
            };
            let at_node = AtNode {
                normal_n: normal,
                trial_n: trial,
                stiffness_n_m: stiffness,
                last_increment_m: last_increment,
                last_slipped: slipped,
                last_limit_n: load::<R, S>(simd, &friction.0[LIMIT]),
            };
            let limit = W::limit_n(numbers, &at_node);
            let (mut tangential, sticks) = if W::TRANSMITS {
                let projected = project(trial, limit);
                (projected.force_n, projected.sticks & closed)
            } else {
                ([zero; 2], slip[0].simd_eq(zero) & slip[1].simd_eq(zero) & closed)
            };
            let inverse = load::<R, S>(simd, &inverse_mass.0[2]);
            // Constrained displacements are set, not corrected. The rounding of a correction would let a sticking
            // node creep and a closed node sink.
            for c in 0..2 {
                tangential[c] = closed.select(tangential[c], zero);
                let corrected =
                    if W::TRANSMITS { next_u[c] + (u_scale * inverse) * tangential[c] } else { next_u[c] };
                next_u[c] = sticks.select(before[c] + carried[c], corrected);
                if W::TRANSMITS {
                    next_p[c] += (p_scale * inverse) * tangential[c];
                }
                tangential[c].store_array(&mut force.0[c]);
                ((next_u[c] - before[c]) - carried[c]).store_array(&mut increment.0[c]);
            }
            next_u[2] = closed.select(zero - initial_gap, next_u[2]);
            next_p[2] += (p_scale * inverse) * normal;
            normal.store_array(&mut force.0[2]);
            (next_u[2] - before[2]).store_array(&mut increment.0[2]);
            for c in 0..3 {
                next_u[c].store_array(&mut u.0[c]);
                next_p[c].store_array(&mut p.0[c]);
            }
            let is_closed = closed.select(one, zero);
            closed.select(zero, gap).store_array(&mut status.0[Status::Gap as usize]);
            closed.select(limit, zero).store_array(&mut friction.0[LIMIT]);
            is_closed.store_array(&mut status.0[Status::Closed as usize]);
            sticks.select(zero, is_closed).store_array(&mut status.0[Status::Slips as usize]);
        }
    }
}
