//! Nodes that move in z as a rigid plane: together, and with rotations about x and y, with a mass and inertias of the holder, on
//! springs and dampers to the frame.
//!
//! The displacement of node i is Σ_w s_wi q_w over the ways w of the plane. With the lumped masses m_i of the nodes,
//!
//! ```text
//! Σ_v (I_w δ_wv + Σ_i m_i s_wi s_vi) a_v = −Σ_i s_wi (K (u + β_R p) − F)_i − k_w q_w − d_w p_w
//! ```
//!
//! Springs and dampers act at t_n like K and β_R K. Rotations are small.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::applied::{AppliedSupport, Supported, Way};
use super::weights::{Weights, ones, weights};
use crate::solver::body::EnergySums;
use crate::solver::error::SolverError;
use crate::solver::field::{Block, FieldOf, LaneSlot, Layout, in_slots_of};
use crate::solver::number::Number;
use crate::solver::scheme::{Bound, Scheme};
use crate::solver::simd::{dispatch, load, splat};
use fearless_simd::{Simd, prelude::*};
use nalgebra::DMatrix;

/// The component in which the nodes move.
const Z: usize = 2;

/// One way in which the plane moves.
#[derive(Debug, Clone, PartialEq)]
pub struct RockingWay {
    /// Displacement of each node in z for a unit of the way: 1 for a translation \[m\], an arm \[m\] for a rotation \[rad\].
    pub shares: Vec<f64>,
    /// Mass \[kg\] or inertia \[kg m²\] of the holder, ≥ 0.
    pub inertia: f64,
    /// Stiffness \[N/m\] or \[N m/rad\], ≥ 0.
    pub stiffness: f64,
    /// Damper \[N s/m\] or \[N m s/rad\], ≥ 0.
    pub damping: f64,
}

/// Nodes that move in z as a rigid plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Rocking {
    /// The nodes.
    pub nodes: Vec<usize>,
    /// The ways. The first is the translation in z.
    pub ways: Vec<RockingWay>,
}

impl Rocking {
    /// 3·node + component.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.nodes.iter().map(|node| 3 * node + Z)
    }

    /// Mass and inertias of the holder and of the nodes.
    fn inertias(&self, masses_kg: &[f64]) -> DMatrix<f64> {
        let count = self.ways.len();
        DMatrix::from_fn(count, count, |w, v| {
            let own = if w == v { self.ways[w].inertia } else { 0.0 };
            let shares = self.ways[w].shares.iter().zip(&self.ways[v].shares);
            own + self.nodes.iter().zip(shares).map(|(&node, (a, b))| masses_kg[node] * a * b).sum::<f64>()
        })
    }

    /// The inverse of the masses and inertias.
    ///
    /// # Panics
    /// If the displacements of the nodes do not determine the ways, which [`Rocking::coordinates`] finds.
    fn inverse_inertias(&self, masses_kg: &[f64]) -> DMatrix<f64> {
        let mut matrix = self.inertias(masses_kg);
        // A unit diagonal keeps the determinant of small masses within the range of numbers.
        let scales: Vec<f64> = matrix.diagonal().iter().map(|entry| 1.0 / entry.sqrt()).collect();
        let scale = |matrix: &mut DMatrix<f64>| {
            let count = scales.len();
            for (w, v) in (0..count).flat_map(|w| (0..count).map(move |v| (w, v))) {
                matrix[(w, v)] *= scales[w] * scales[v];
            }
        };
        scale(&mut matrix);
        let mut inverse = matrix.try_inverse().expect("the ways are independent");
        scale(&mut inverse);
        inverse
    }

    /// Each way as a sum over some of the nodes: the positions of these nodes in the list, and the factors of their displacements.
    ///
    /// # Errors
    /// If the displacements of the nodes do not determine the ways.
    pub fn coordinates(&self) -> Result<(Vec<usize>, DMatrix<f64>), SolverError> {
        let count = self.ways.len();
        let mut left = DMatrix::from_fn(self.nodes.len(), count, |i, w| self.ways[w].shares[i]);
        let largest: Vec<f64> = left.column_iter().map(|column| column.amax()).collect();
        let mut chosen = Vec::with_capacity(count);
        for w in 0..count {
            let column = left.column(w);
            let node = column.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            let (node, pivot) = node.map_or((0, 0.0), |(node, pivot)| (node, *pivot));
            if pivot.abs() <= 1e-9 * largest[w] {
                return Err(SolverError::Constraints(format!(
                    "the nodes of a rocking holder do not determine its way {w}"
                )));
            }
            chosen.push(node);
            for v in w + 1..count {
                let factor = left[(node, v)] / pivot;
                for i in 0..self.nodes.len() {
                    let part = factor * left[(i, w)];
                    left[(i, v)] -= part;
                }
            }
        }
        let shares = DMatrix::from_fn(count, count, |i, w| self.ways[w].shares[chosen[i]]);
        let factors = shares.try_inverse().ok_or_else(|| {
            SolverError::Constraints("the nodes of a rocking holder do not determine its ways".to_owned())
        })?;
        Ok((chosen, factors))
    }

    /// The springs and dampers on the masses and inertias. The largest frequency squared is at most the trace of I⁻¹ k.
    pub fn bound(&self, masses_kg: &[f64]) -> Bound {
        let inverse = self.inverse_inertias(masses_kg);
        let trace = |of: fn(&RockingWay) -> f64| -> f64 {
            self.ways.iter().enumerate().map(|(w, way)| inverse[(w, w)] * of(way)).sum()
        };
        Bound { omega_max_rad_s: trace(|way| way.stiffness).sqrt(), damping_per_s: trace(|way| way.damping) }
    }
}

/// A rigid plane in every lane.
#[derive(Debug, Clone)]
pub(super) struct AppliedRocking<const L: usize, R: Number> {
    /// The nodes by planes, and the shares of each way on them in the same order.
    members: Vec<(Weights<R>, Vec<Weights<R>>)>,
    ways: Vec<RockingWay>,
    /// The inverse of the masses and inertias.
    inverse: DMatrix<f64>,
    /// Nodes whose displacements give the ways, and their factors: q_w = Σ factor(w, i) u(i).
    places: Vec<LaneSlot>,
    factors: DMatrix<f64>,
    /// q, its p and its acceleration at t_n, by ways.
    motion: Vec<[[f64; L]; 3]>,
}

impl<const L: usize, R: Number> AppliedRocking<L, R> {
    /// # Panics
    /// If the nodes do not determine the ways, which the model has checked.
    pub fn new(rocking: &Rocking, layout: Layout, masses_kg: &[f64]) -> Self {
        let (chosen, factors) = rocking.coordinates().expect("the model has checked the nodes");
        let inverse = rocking.inverse_inertias(masses_kg);
        let dofs: Vec<usize> = rocking.dofs().collect();
        let field = FieldOf::<L, R>::zeros(layout);
        let mut members: Vec<_> = ones(layout, L, &dofs).into_iter().map(|own| (own, Vec::new())).collect();
        for way in &rocking.ways {
            let shares: Vec<(usize, f64)> = dofs.iter().copied().zip(way.shares.iter().copied()).collect();
            for ((_, of_ways), shares) in members.iter_mut().zip(weights(layout, L, &shares)) {
                of_ways.push(shares);
            }
        }
        Self {
            members,
            ways: rocking.ways.clone(),
            inverse,
            places: chosen.iter().map(|&at| field.place(rocking.nodes[at])).collect(),
            factors,
            motion: vec![[[0.0; L]; 3]; rocking.ways.len()],
        }
    }

    /// The ways of a field on the nodes.
    fn ways_of(&self, field: &FieldOf<L, R>) -> Vec<[f64; L]> {
        let values: Vec<[f64; L]> =
            self.places.iter().map(|&place| field.at(place, Z).map(R::to_f64)).collect();
        let way = |w: usize| -> [f64; L] {
            std::array::from_fn(|lane| {
                values.iter().enumerate().map(|(i, value)| self.factors[(w, i)] * value[lane]).sum()
            })
        };
        (0..self.ways.len()).map(way).collect()
    }

    /// Replaces the residual of every node by minus its acceleration.
    #[inline(always)]
    fn set<S: Simd>(&self, simd: S, residual: &mut [Block<R>], of_ways: &[R::Row]) {
        for (own, shares) in &self.members {
            let first = own.plane * own.rows.len();
            for (at, (block, mask)) in residual[first..].iter_mut().zip(&own.rows).enumerate() {
                let row = &mut block.0[Z];
                let mut value = splat::<R, S>(simd, 0.0);
                for (shares, way) in shares.iter().zip(of_ways) {
                    value += load::<R, S>(simd, &shares.rows[at].0) * load::<R, S>(simd, way);
                }
                let is_member = load::<R, S>(simd, &mask.0).simd_gt(splat::<R, S>(simd, 0.0));
                is_member.select(value, load::<R, S>(simd, row)).store_array(row);
            }
        }
    }
}

impl<const L: usize, R: Number> AppliedSupport<L, R> for AppliedRocking<L, R> {
    fn act(&mut self, pin: &mut Supported<'_, L, R>, reaction_n: &mut [[f64; L]; 3]) {
        let (u, p) = (self.ways_of(pin.u), self.ways_of(pin.p));
        let count = self.ways.len();
        let mut sums: Vec<[f64; L]> = (0..count)
            .map(|w| {
                let RockingWay { stiffness, damping, .. } = &self.ways[w];
                std::array::from_fn(|lane| stiffness * u[w][lane] + damping * p[w][lane])
            })
            .collect();
        // The frame carries the force of the translation's spring and damper.
        for (reaction, carried) in reaction_n[Z].iter_mut().zip(&sums[0]) {
            *reaction -= carried;
        }
        for (_, shares) in &self.members {
            for (shares, sum) in shares.iter().zip(&mut sums) {
                shares.add_up(pin.residual.blocks(), sum);
            }
        }
        let minus_a: Vec<[f64; L]> = (0..count)
            .map(|w| {
                std::array::from_fn(|lane| (0..count).map(|v| self.inverse[(w, v)] * sums[v][lane]).sum())
            })
            .collect();
        let rows: Vec<R::Row> = minus_a.iter().map(|way| in_slots_of::<R>(way)).collect();
        dispatch!(simd => self.set(simd, pin.residual.blocks_mut(), &rows));
        self.motion = (0..count).map(|w| [u[w], p[w], minus_a[w].map(|minus_a| -minus_a)]).collect();
    }

    fn add_energies(
        &self,
        scheme: &Scheme,
        steps_done: &[u64; L],
        u_after: &FieldOf<L, R>,
        total: &mut EnergySums<L>,
    ) {
        let after = self.ways_of(u_after);
        for ((way, motion), after) in self.ways.iter().zip(&self.motion).zip(&after) {
            let RockingWay { inertia, stiffness, damping, .. } = *way;
            Way { inertia, stiffness, damping }.add_energies(scheme, steps_done, motion, after, total);
        }
    }

    fn motion(&self) -> Option<(usize, [[f64; L]; 2])> {
        let [u, _, a] = self.motion[0];
        Some((Z, [u, a]))
    }

    fn boxed(&self) -> Box<dyn AppliedSupport<L, R>> {
        Box::new(self.clone())
    }
}
