//! Moves the nodes: u_{n+1} and p_{n+1} from the internal forces f at t_n, which the operator gives. Those
//! of linear elasticity are K (u_n + β_R p_n). Damping in proportion to the mass adds α_R m p_n.
//!
//! ```text
//! a_n = −f/m       u_{n+1} = u_n + Δt p_n + c Δt² a_n       p_{n+1} = p_n + d Δt a_n
//! ```
//!
//! Planes without constraints are moved as soon as the forces have passed them, so that a step reads and
//! writes their fields only once. For the other planes the forces are kept as the residual. The load and the
//! supports change the residual, and then these planes are moved. The contact solve moves the contact face.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::PinBody;
use super::line_table::LineTable;
use super::operator::{BlockIndex, Moving, Operator, Past, Scratch};
use crate::solver::body::Freedom;
use crate::solver::field::{Block, FieldOf};
use crate::solver::number::Number;
use crate::solver::scheme::StepFactors;
use crate::solver::simd::{dispatch, load, load_all};
use fearless_simd::{Simd, prelude::*};

/// The slave nodes at t_n, which the contact solve moves to t_{n+1}.
pub struct Face<'a, const L: usize, R: Number = f64> {
    pub u: &'a mut FieldOf<L, R>,
    pub p: &'a mut FieldOf<L, R>,
    /// Internal minus external forces \[N\].
    pub residual: &'a FieldOf<L, R>,
    /// 1/m \[1/kg\] of every degree of freedom, 0 where it is fixed.
    pub inverse_mass: &'a [Block<R>],
}

/// Moves the nodes of a pin in every lane. Nothing in it is carried from step to step.
#[derive(Debug, Clone)]
pub(in crate::solver) struct NodeMotion<const L: usize, R: Number> {
    inverse_masses: InverseMasses<R>,
    /// α_R m \[N s/m\] of every node, if there is damping in proportion to the mass.
    mass_dampers: Option<LineTable<R>>,
    /// Scratch of the internal forces.
    scratch: Scratch<R>,
    /// Internal minus external forces \[N\] on the constrained planes.
    residual: FieldOf<L, R>,
}

/// The inverse masses, which are constant during a run.
#[derive(Debug, Clone)]
struct InverseMasses<R: Number> {
    /// 1/m \[1/kg\] of every node.
    free: LineTable<R>,
    /// 1/m \[1/kg\] of every degree of freedom of a constrained plane. It is 0 where the degree of freedom is
    /// fixed. It is 1 where it is tied or carried, because there the support replaces the residual by minus the acceleration
    /// of the group.
    constrained: Vec<Vec<Block<R>>>,
    constrained_planes: Vec<bool>,
    blocks_per_plane: usize,
}

impl<const L: usize, R: Number> NodeMotion<L, R> {
    pub fn new(pin: &PinBody, alpha_r_per_s: f64) -> Self {
        let mesh = pin.mesh();
        let damper = |node: usize| alpha_r_per_s * pin.masses_kg()[node];
        let mut per_dof = FieldOf::<L, R>::zeros(mesh.layout());
        for (dof, freedom) in pin.freedoms().iter().enumerate() {
            let value = match freedom {
                Freedom::Free => 1.0 / pin.masses_kg()[dof / 3],
                Freedom::Fixed => 0.0,
                Freedom::Tied(_) | Freedom::Carried => 1.0,
            };
            *per_dof.at_mut(per_dof.place(dof / 3), dof % 3) = [R::from_f64(value); L];
        }
        let blocks_per_plane = per_dof.blocks_per_line() * mesh.layout().lines_per_plane;
        let planes = per_dof.blocks().chunks_exact(blocks_per_plane).zip(pin.constrained_planes());
        Self {
            inverse_masses: InverseMasses {
                free: LineTable::new(mesh, L, |node| 1.0 / pin.masses_kg()[node]),
                constrained: planes
                    .map(|(plane, constrained)| if *constrained { plane.to_vec() } else { Vec::new() })
                    .collect(),
                constrained_planes: pin.constrained_planes().to_vec(),
                blocks_per_plane,
            },
            mass_dampers: (alpha_r_per_s > 0.0).then(|| LineTable::new(mesh, L, damper)),
            scratch: pin.operator().scratch(mesh.layout(), L),
            residual: FieldOf::zeros(mesh.layout()),
        }
    }

    /// The residual on the constrained planes. The load and the supports change it.
    pub fn residual_mut(&mut self) -> &mut FieldOf<L, R> {
        &mut self.residual
    }

    /// The contact face, for the contact solve.
    pub fn face<'a>(&'a self, u: &'a mut FieldOf<L, R>, p: &'a mut FieldOf<L, R>) -> Face<'a, L, R> {
        Face { u, p, residual: &self.residual, inverse_mass: &self.inverse_masses.constrained[0] }
    }

    /// Forms the internal forces, moves the planes without constraints, and keeps the forces on the others.
    pub fn advance_free_planes(
        &mut self,
        pin: &PinBody,
        factors: &StepFactors<R>,
        u: &mut FieldOf<L, R>,
        p: &mut FieldOf<L, R>,
        history: &mut [R],
    ) {
        let mut advance = Advance {
            inverse_masses: &self.inverse_masses,
            mass_dampers: self.mass_dampers.as_ref(),
            factors,
            u: u.blocks_mut(),
            p: p.blocks_mut(),
            residual: self.residual.blocks_mut(),
        };
        let past = Past::Followed { history, time_step_s: factors.time_step_s };
        advance.run(pin.operator(), past, &mut self.scratch);
    }

    /// Moves the constrained planes above the contact face by their residual.
    pub fn advance_constrained_planes(
        &self,
        factors: &StepFactors<R>,
        u: &mut FieldOf<L, R>,
        p: &mut FieldOf<L, R>,
    ) {
        let InverseMasses { constrained, blocks_per_plane, .. } = &self.inverse_masses;
        for (plane, inverse) in constrained.iter().enumerate().skip(1) {
            if inverse.is_empty() {
                continue;
            }
            let range = plane * blocks_per_plane..(plane + 1) * blocks_per_plane;
            let residual = &self.residual.blocks()[range.clone()];
            let (u, p) = (&mut u.blocks_mut()[range.clone()], &mut p.blocks_mut()[range]);
            move_nodes(factors, residual, inverse, u, p);
        }
    }
}

/// Moves nodes by their residual.
pub(in crate::solver) fn move_nodes<R: Number>(
    factors: &StepFactors<R>,
    residual: &[Block<R>],
    inverse_mass: &[Block<R>],
    u: &mut [Block<R>],
    p: &mut [Block<R>],
) {
    dispatch!(simd => move_nodes_in(simd, factors, residual, inverse_mass, u, p));
}

#[inline(always)]
fn move_nodes_in<R: Number, S: Simd>(
    simd: S,
    factors: &StepFactors<R>,
    residual: &[Block<R>],
    inverse_mass: &[Block<R>],
    u: &mut [Block<R>],
    p: &mut [Block<R>],
) {
    for (((u, p), residual), inverse) in u.iter_mut().zip(p).zip(residual).zip(inverse_mass) {
        for c in 0..3 {
            let force = load::<R, S>(simd, &residual.0[c]);
            let [next_u, next_p] = factors.moved(simd, force, &inverse.0[c], &u.0[c], &p.0[c]);
            next_u.store_array(&mut u.0[c]);
            next_p.store_array(&mut p.0[c]);
        }
    }
}

struct Advance<'a, R: Number> {
    inverse_masses: &'a InverseMasses<R>,
    mass_dampers: Option<&'a LineTable<R>>,
    factors: &'a StepFactors<R>,
    u: &'a mut [Block<R>],
    p: &'a mut [Block<R>],
    residual: &'a mut [Block<R>],
}

impl<R: Number> Advance<'_, R> {
    fn run(&mut self, operator: &Operator, past: Past<'_, R>, scratch: &mut Scratch<R>) {
        dispatch!(simd => operator.force(simd, self, past, scratch));
    }
}

impl<S: Simd, R: Number> Moving<S, R> for Advance<'_, R> {
    #[inline(always)]
    fn u(&self, simd: S, at: usize) -> [R::Vector<S>; 3] {
        load_all::<R, S>(simd, &self.u[at].0)
    }

    #[inline(always)]
    fn damped(&self, simd: S, at: usize) -> Option<[R::Vector<S>; 3]> {
        if self.factors.beta_r_s == 0.0 {
            return None;
        }
        let beta_r = R::Vector::<S>::splat(simd, self.factors.rounded_beta_r_s);
        let p = load_all::<R, S>(simd, &self.p[at].0);
        Some([beta_r * p[0], beta_r * p[1], beta_r * p[2]])
    }

    #[inline(always)]
    fn take(&mut self, simd: S, index: BlockIndex, mut force: [R::Vector<S>; 3]) {
        if let Some(dampers) = self.mass_dampers {
            let damper = load::<R, S>(simd, dampers.row(index.line, index.along));
            let p = load_all::<R, S>(simd, &self.p[index.at].0);
            for c in 0..3 {
                force[c] += damper * p[c];
            }
        }
        if self.inverse_masses.constrained_planes[index.plane] {
            for c in 0..3 {
                force[c].store_array(&mut self.residual[index.at].0[c]);
            }
            return;
        }
        let inverse_mass = self.inverse_masses.free.row(index.line, index.along);
        let (u, p) = (&mut self.u[index.at].0, &mut self.p[index.at].0);
        for c in 0..3 {
            let [next_u, next_p] = self.factors.moved(simd, force[c], inverse_mass, &u[c], &p[c]);
            next_u.store_array(&mut u[c]);
            next_p.store_array(&mut p[c]);
        }
    }
}
