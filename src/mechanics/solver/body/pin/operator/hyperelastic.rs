//! Elastic elements with large strains: trilinear hexahedra, 2 × 2 × 2 Gauss points, forces from the undeformed mesh (total Lagrange).
//!
//! With the deformation gradient F, J = det F, C = FᵀF, E = ½(C − 1) and Lamé's λ and G, the energy per undeformed volume is
//!
//! ```text
//! St Venant–Kirchhoff   W = ½λ (tr E)² + G E:E
//! neo-Hookean           W = ½G (tr C − 3 − 2 ln J) + ¼λ (J² − 1 − 2 ln J)
//! ```
//!
//! (J. Bonet and R. D. Wood, *Nonlinear Continuum Mechanics for Finite Element Analysis*, 2008, ch. 6; the last term as in J. C. Simo and
//! T. J. R. Hughes, *Computational Inelasticity*, 1998, ch. 9). For small strains both are Hooke's law. The force on a node is the
//! derivative of Σ W dV by its displacement. A selective element takes the last term of the neo-Hookean law at the ratio θ of the
//! element's volumes, and the first term of the other law at the mean of tr E: then a nearly incompressible material does not lock
//! (J. C. Nagtegaal, D. M. Parks and J. R. Rice, CMAME 4, 1974).
//!
//! A vector holds the lanes of one or of several elements. The sum at a node is over its elements in their order, so that a lane has
//! the same bits for every number of lanes.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::elements::{Elements, LAMBDA, SHEAR, WIDTH};
use super::gradient::{
    Corners, OF_POINT, Slopes, across, cofactor, deformed, gradient, green_strain, slopes_of, spread,
};
use super::node_scratch::NodeScratch;
use super::yielding::Yielding;
use super::{Pass, Past, Product, Scratch, ScratchOf};
use crate::solver::body::pin::GeneralMesh;
use crate::solver::field::FieldOf;
use crate::solver::material::Material;
use crate::solver::number::Number;
use crate::solver::simd::dispatch;
use crate::spec::{MaterialLaw, Plasticity};
use fearless_simd::{Simd, f64x8, prelude::*};

const DOUBLE: &str = "large strains are computed in double precision";

/// Elements with large strains.
#[derive(Debug, Clone)]
pub struct HyperelasticOperator {
    elements: Elements,
    /// When elements yield; none of another law than J₂.
    yielding: Option<Yielding>,
}

impl HyperelasticOperator {
    /// The elements of a mesh. With the law J₂ there is an entry of `yielding` for each material, which is `None` if it stays elastic.
    ///
    /// # Errors
    /// The number of an element that is inverted.
    pub fn new(
        mesh: &GeneralMesh,
        materials: &[Material],
        law: MaterialLaw,
        yielding: &[Option<Plasticity>],
    ) -> Result<Self, usize> {
        let elements = Elements::new(mesh, materials, law)?;
        let yielding = (law == MaterialLaw::J2).then(|| Yielding::new(mesh, yielding));
        Ok(Self { elements, yielding })
    }

    /// When elements yield; returns `None` for another law than J₂.
    pub fn yielding(&self) -> Option<&Yielding> {
        self.yielding.as_ref()
    }

    /// The law.
    pub fn law(&self) -> MaterialLaw {
        self.elements.law
    }

    /// The internal forces of displacements, in one pass over the mesh.
    ///
    /// # Panics
    /// In single precision.
    #[inline(always)]
    pub(super) fn pass<S: Simd, R: Number>(
        &self,
        simd: S,
        pass: &mut impl Pass<S, R>,
        past: &mut Past<'_, R>,
        scratch: &mut NodeScratch<R>,
    ) {
        scratch.read(simd, pass);
        scratch.clear();
        let lanes = scratch.lanes;
        if self.yielding.is_some() {
            scratch.read_undamped(simd, pass);
        }
        let ([x, y], undamped) = scratch.all_fields();
        let (Some(x), Some(y)) = (R::doubles(x), R::doubles(y)) else { panic!("{DOUBLE}") };
        // One function for all passes: it is long.
        match &self.yielding {
            None => self.add_forces(lanes, x, y),
            Some(yielding) => {
                let undamped = R::as_doubles(undamped).unwrap_or_default();
                yielding.add_forces(&self.elements, lanes, [x, undamped], y, &mut past.doubles());
            }
        }
        for line in 0..scratch.layout.lines() {
            scratch.give(simd, line, pass);
        }
    }

    fn add_forces(&self, lanes: usize, x: &[f64], y: &mut [f64]) {
        dispatch!(simd => self.add_forces_in(simd, lanes, x, y));
    }

    #[inline(always)]
    fn add_forces_in<S: Simd>(&self, simd: S, lanes: usize, x: &[f64], y: &mut [f64]) {
        for first in (0..self.elements.count()).step_by(WIDTH / lanes) {
            let mut corners = [[f64x8::splat(simd, 0.0); 3]; 8];
            self.elements.corners(first, lanes, x, &mut corners);
            match lanes {
                8 => self.force(
                    simd,
                    #[inline(always)]
                    |number| f64x8::splat(simd, self.elements.of_one(first, number)),
                    &mut corners,
                ),
                1 => self.force(
                    simd,
                    #[inline(always)]
                    |number| f64x8::load_array_ref(simd, self.elements.of_all(first, number)),
                    &mut corners,
                ),
                lanes => self.force(
                    simd,
                    #[inline(always)]
                    |number| self.elements.of_some(simd, first, number, lanes),
                    &mut corners,
                ),
            }
            self.elements.add(first, &corners, lanes, y);
        }
    }

    /// The stored energy \[J\] of displacements in each lane, and the first element that is inverted. It overwrites `work`.
    ///
    /// # Panics
    /// If the scratch is that of another operator, and in single precision.
    pub(super) fn state_of<const L: usize, R: Number>(
        &self,
        u: &FieldOf<L, R>,
        history: &[R],
        work: &mut FieldOf<L, R>,
        scratch: &mut Scratch<R>,
    ) -> ([f64; WIDTH], [Option<usize>; WIDTH]) {
        let Scratch { form, forms, .. } = scratch;
        let ScratchOf::Nodes(nodes) = form else { panic!("the scratch of another operator") };
        let pass = Product { x: u.blocks(), y: work.blocks_mut(), forms };
        dispatch!(simd => nodes.read(simd, &pass));
        let [x, _] = nodes.fields();
        let (Some(x), Some(history)) = (R::doubles(x), R::as_doubles(history)) else { panic!("{DOUBLE}") };
        self.state(L, x, history)
    }

    fn state(&self, lanes: usize, x: &[f64], history: &[f64]) -> ([f64; WIDTH], [Option<usize>; WIDTH]) {
        let (mut energy_j, mut inverted) = ([0.0; WIDTH], [None; WIDTH]);
        for first in (0..self.elements.count()).step_by(WIDTH / lanes) {
            let (energies, volumes) = dispatch!(simd => {
                let mut u = [[f64x8::splat(simd, 0.0); 3]; 8];
                self.elements.corners(first, lanes, x, &mut u);
                let numbers = |number| self.elements.of_some(simd, first, number, lanes);
                match &self.yielding {
                    None => self.energy(simd, numbers, &u),
                    Some(yielding) => yielding.energy(simd, &self.elements, numbers, &u, history, [first, lanes]),
                }
            });
            for slot in 0..WIDTH {
                let (element, lane) = (first + slot / lanes, slot % lanes);
                if element < self.elements.count() {
                    energy_j[lane] += energies[slot];
                    if inverted[lane].is_none() && volumes[slot] <= 0.0 {
                        inverted[lane] = Some(element);
                    }
                }
            }
        }
        (energy_j, inverted)
    }

    /// Replaces the displacements of the corners by the forces on them: Σ P ∂N/∂X dV with the first Piola–Kirchhoff stress P = ∂W/∂F.
    #[inline(always)]
    fn force<S: Simd>(&self, simd: S, number: impl Fn(usize) -> f64x8<S>, corners: &mut Corners<S>) {
        let all = |value: f64| f64x8::splat(simd, value);
        let mut slopes: Slopes<S> = [[[all(0.0); 3]; 4]; 3];
        slopes_of(simd, corners, &mut slopes);
        let (lambda, shear) = (number(LAMBDA), number(SHEAR));
        let mean =
            if self.elements.is_selective { Some(self.elements.mean(simd, &number, &slopes)) } else { None };
        let mut sums: Slopes<S> = [[[all(0.0); 3]; 4]; 3];
        for point in 0..8 {
            let h = gradient(simd, &number, &slopes, point);
            let p = match self.elements.law {
                // J₂ does not come here: its forces and energies are those of `Yielding`.
                MaterialLaw::NeoHookean | MaterialLaw::J2 => {
                    // P = G (F − (∂J/∂F)/J) + ½λ (θ − 1/θ) ∂J/∂F, with 1 + j = J, 1 + t = θ and ∂J/∂F = 1 + K.
                    let (k, j) = cofactor(&h);
                    let t = mean.unwrap_or(j);
                    let along = all(0.5) * lambda * (t * (all(2.0) + t) / (all(1.0) + t));
                    let over_j = shear / (all(1.0) + j);
                    let of_h = over_j + over_j * j;
                    let of_k = along - over_j;
                    let of_one = over_j * j + along;
                    let mut p = k;
                    for i in 0..3 {
                        for n in 0..3 {
                            p[i][n] = of_h * h[i][n] + of_k * k[i][n];
                        }
                        p[i][i] += of_one;
                    }
                    p
                }
                MaterialLaw::StVenantKirchhoff => {
                    let mut stress = green_strain(simd, &h);
                    let trace = mean.unwrap_or(stress[0][0] + stress[1][1] + stress[2][2]);
                    let (double, pressure) = (shear + shear, lambda * trace);
                    for i in 0..3 {
                        for k in 0..3 {
                            stress[i][k] = double * stress[i][k];
                        }
                        stress[i][i] += pressure;
                    }
                    deformed(&h, &stress)
                }
            };
            let weight = number(point * OF_POINT + 9);
            for a in 0..3 {
                let at = point * OF_POINT + 3 * a;
                let g = [number(at) * weight, number(at + 1) * weight, number(at + 2) * weight];
                let sum = &mut sums[a][across(point, a)];
                for i in 0..3 {
                    sum[i] += p[i][0] * g[0] + p[i][1] * g[1] + p[i][2] * g[2];
                }
            }
        }
        spread(simd, &mut sums, corners);
    }

    /// The energy \[J\] of each slot, and the smallest J of its points.
    #[inline(always)]
    fn energy<S: Simd>(
        &self,
        simd: S,
        number: impl Fn(usize) -> f64x8<S>,
        u: &Corners<S>,
    ) -> ([f64; WIDTH], [f64; WIDTH]) {
        let all = |value: f64| f64x8::splat(simd, value);
        let mut slopes: Slopes<S> = [[[all(0.0); 3]; 4]; 3];
        slopes_of(simd, u, &mut slopes);
        let (lambda, shear) = (number(LAMBDA).to_array(), number(SHEAR).to_array());
        let mean: [f64; WIDTH] = if self.elements.is_selective {
            self.elements.mean(simd, &number, &slopes).to_array()
        } else {
            [0.0; WIDTH]
        };
        let (mut energy_j, mut smallest) = ([0.0; WIDTH], [f64::INFINITY; WIDTH]);
        let mut volume = [0.0; WIDTH];
        for point in 0..8 {
            let h = gradient(simd, &number, &slopes, point);
            let (_, j) = cofactor(&h);
            let strain = green_strain(simd, &h);
            let trace = strain[0][0] + strain[1][1] + strain[2][2];
            let mut square = all(0.0);
            for row in &strain {
                for value in row {
                    square += *value * *value;
                }
            }
            let (j, trace, square): ([f64; WIDTH], [f64; WIDTH], [f64; WIDTH]) =
                (j.to_array(), trace.to_array(), square.to_array());
            let weight: [f64; WIDTH] = number(point * OF_POINT + 9).to_array();
            for slot in 0..WIDTH {
                smallest[slot] = f64::min(smallest[slot], 1.0 + j[slot]);
                volume[slot] += weight[slot];
                // `at` is J − 1, or tr E.
                // J₂ does not come here either.
                let dilation = |at: f64| match self.elements.law {
                    MaterialLaw::NeoHookean | MaterialLaw::J2 => {
                        0.25 * lambda[slot] * (at * (2.0 + at) - 2.0 * libm::log1p(at))
                    }
                    MaterialLaw::StVenantKirchhoff => 0.5 * lambda[slot] * at * at,
                };
                let (at, distortion) = match self.elements.law {
                    MaterialLaw::NeoHookean | MaterialLaw::J2 => {
                        (j[slot], shear[slot] * (trace[slot] - libm::log1p(j[slot])))
                    }
                    MaterialLaw::StVenantKirchhoff => (trace[slot], shear[slot] * square[slot]),
                };
                let own = if self.elements.is_selective { 0.0 } else { dilation(at) };
                energy_j[slot] += weight[slot] * (distortion + own);
                if self.elements.is_selective && point == 7 {
                    energy_j[slot] += volume[slot] * dilation(mean[slot]);
                }
            }
        }
        (energy_j, smallest)
    }
}
