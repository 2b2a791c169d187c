//! Elements that yield: J₂ plasticity with large strains (J. C. Simo and T. J. R. Hughes, *Computational Inelasticity*, 1998, ch. 9).
//!
//! C_p is the plastic part of C, with det C_p = 1. With b_e = F C_p⁻¹ Fᵀ and J = det F the stored energy per undeformed volume and the Kirchhoff
//! stress are
//!
//! ```text
//! W = ½G (J^(−2/3) tr b_e − 3) + ½κ (½(θ² − 1) − ln θ)      τ = s + ½κ J (θ − 1/θ) 1      s = G J^(−2/3) dev b_e
//! ```
//!
//! with the bulk modulus κ and θ = J, or the ratio of the volumes of a selective element. The material yields where |s − β| reaches
//! √⅔ σ_y(ε̄). It flows along n = (s − β)/|s − β|: in a step b_e becomes exp(−Δγ n) b_e exp(−Δγ n), whose determinant stays, ε̄ grows by
//! √⅔ Δγ, and the back stress β by ⅔ H_k Δγ n. β is kept as the tensor B of β = dev (J^(−2/3) F B Fᵀ). Δγ is the root of the yield
//! condition, with n of the stress before the flow; steps are small.
//!
//! With damping in proportion to the stiffness, the stress is that of u + β_R p, and this stress is what yields: the damper acts on the elastic
//! strain. The plastic work is that of the stress without the damper.
//!
//! An element keeps its plastic work and, for each point, C_p⁻¹ − 1, ε̄, the rise of the yield stress by hardening, and B. Zeros are an element
//! that has not yielded, and what has not yielded costs a comparison.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::elements::{Elements, LAMBDA, NUMBERS, SHEAR, WIDTH};
use super::gradient::{
    Corners, OF_POINT, Slopes, Tensor, across, cofactor, deformed, gradient, slopes_of, spread,
};
use super::return_mapping::{Matrix, PointState, ROOT, YieldLaw, components, matrix};
use super::{Past, dispatch};
use crate::solver::body::pin::GeneralMesh;
use crate::spec::Plasticity;
use fearless_simd::{Simd, f64x8, prelude::*};

/// Numbers that a point keeps: C_p⁻¹ − 1, ε̄, the rise of the yield stress and, with kinematic hardening, B. The rise follows from ε̄, and is
/// kept because every step looks at it.
const ALPHA: usize = 6;
const RISE: usize = 7;
const BACK: usize = 8;

/// Which elements yield, and when.
#[derive(Debug, Clone)]
pub struct Yielding {
    /// The law of each material; none if it stays elastic.
    laws: Vec<Option<YieldLaw>>,
    /// The material of each element.
    materials: Vec<usize>,
    has_back_stress: bool,
}

impl Yielding {
    pub(super) fn new(mesh: &GeneralMesh, materials: &[Option<Plasticity>]) -> Self {
        let laws: Vec<_> = materials.iter().map(|material| material.as_ref().map(YieldLaw::of)).collect();
        Self {
            has_back_stress: laws.iter().flatten().any(|law| law.kinematic_pa > 0.0),
            laws,
            materials: mesh.elements().iter().map(|element| element.material).collect(),
        }
    }

    fn law(&self, element: usize) -> Option<&YieldLaw> {
        self.laws.get(*self.materials.get(element)?)?.as_ref()
    }

    /// Number of numbers that an element of a pin with these materials keeps: none if no material yields.
    pub fn numbers_per_element(materials: &[Option<Plasticity>]) -> usize {
        let yields = materials.iter().flatten();
        let back =
            yields.clone().any(|material| material.kinematic_modulus_pa.is_some_and(|modulus| modulus > 0.0));
        if yields.count() == 0 { 0 } else { 1 + 8 * if back { BACK + 6 } else { BACK } }
    }

    /// Number of numbers that a point keeps.
    fn of_point(&self) -> usize {
        if self.has_back_stress { BACK + 6 } else { BACK }
    }

    /// Number of numbers that an element keeps: its plastic work \[J\], and those of its points.
    fn of_element(&self) -> usize {
        1 + 8 * self.of_point()
    }

    /// Number of numbers that all elements keep in a lane.
    pub(super) fn history_len(&self) -> usize {
        self.materials.len() * self.of_element()
    }

    /// The place in a history of a number of an element in a lane. The plastic works of all elements come first, because every step looks at
    /// them.
    fn place(&self, element: usize, number: usize, lane: usize, lanes: usize) -> usize {
        let at = if number == 0 {
            element
        } else {
            self.materials.len() + element * (self.of_element() - 1) + number - 1
        };
        at * lanes + lane
    }

    /// The plastic work \[J\] of a lane since its start, and its largest plastic strain.
    pub(super) fn totals(&self, history: &[f64], lane: usize, lanes: usize) -> [f64; 2] {
        let (mut work_j, mut strain) = (0.0, 0.0);
        for element in 0..self.materials.len() {
            let own_j = history[self.place(element, 0, lane, lanes)];
            if own_j != 0.0 {
                work_j += own_j;
                strain = self
                    .strains(history, element, lane, lanes)
                    .fold(strain, |largest: f64, strain| largest.max(strain));
            }
        }
        [work_j, strain]
    }

    /// The plastic strains of the points of an element.
    fn strains<'a>(
        &self,
        history: &'a [f64],
        element: usize,
        lane: usize,
        lanes: usize,
    ) -> impl Iterator<Item = f64> + use<'a> {
        let (first, each) = (self.place(element, 1 + ALPHA, lane, lanes), self.of_point() * lanes);
        (0..8).map(move |point| history[first + point * each])
    }

    /// What the points of an element in the only lane of a history keep.
    pub fn points(&self, history: &[f64], element: usize) -> [PointState; 8] {
        std::array::from_fn(|point| self.read(history, element, point, 0, 1))
    }

    fn read(&self, history: &[f64], element: usize, point: usize, lane: usize, lanes: usize) -> PointState {
        let at = |number| history[self.place(element, 1 + point * self.of_point() + number, lane, lanes)];
        let back = if self.has_back_stress { std::array::from_fn(|i| at(BACK + i)) } else { [0.0; 6] };
        PointState {
            plastic: matrix(std::array::from_fn(at)),
            strain: at(ALPHA),
            rise_pa: at(RISE),
            back: matrix(back),
        }
    }

    fn write(
        &self,
        history: &mut [f64],
        element: usize,
        point: usize,
        lane: usize,
        lanes: usize,
        state: &PointState,
    ) {
        let first = 1 + point * self.of_point();
        let mut put = |number, value| {
            history[self.place(element, first + number, lane, lanes)] = value;
        };
        for (number, value) in components(&state.plastic).into_iter().enumerate() {
            put(number, value);
        }
        put(ALPHA, state.strain);
        put(RISE, state.rise_pa);
        if self.has_back_stress {
            for (number, value) in components(&state.back).into_iter().enumerate() {
                put(BACK + number, value);
            }
        }
    }

    /// A number of a group of elements, slot by slot.
    #[inline(always)]
    fn row(&self, history: &[f64], [first, lanes]: [usize; 2], number: usize) -> [f64; WIDTH] {
        if lanes == WIDTH {
            let mut row = [0.0; WIDTH];
            row.copy_from_slice(&history[self.place(first, number, 0, lanes)..][..WIDTH]);
            return row;
        }
        std::array::from_fn(|slot| {
            let element = first + slot / lanes;
            if element < self.materials.len() {
                history[self.place(element, number, slot % lanes, lanes)]
            } else {
                0.0
            }
        })
    }

    #[inline(always)]
    fn tensor<S: Simd>(&self, simd: S, history: &[f64], group: [usize; 2], number: usize) -> Tensor<S> {
        let load = |i: usize| f64x8::load_array(simd, self.row(history, group, number + i));
        let [xx, yy, zz, xy, yz, xz] = [load(0), load(1), load(2), load(3), load(4), load(5)];
        [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    }

    /// Adds the forces of all elements to the nodes, and follows what they keep. The displacements are those whose stress acts, and the same
    /// without those of damping; the latter are empty if there is no damping.
    pub(super) fn add_forces(
        &self,
        elements: &Elements,
        lanes: usize,
        displacements: [&[f64]; 2],
        y: &mut [f64],
        past: &mut Past<'_, f64>,
    ) {
        dispatch!(simd => self.add_forces_in(simd, elements, lanes, displacements, y, past));
    }

    #[inline(always)]
    fn add_forces_in<S: Simd>(
        &self,
        simd: S,
        elements: &Elements,
        lanes: usize,
        [x, undamped]: [&[f64]; 2],
        y: &mut [f64],
        past: &mut Past<'_, f64>,
    ) {
        let zero = f64x8::splat(simd, 0.0);
        let mut numbers = [[0.0; WIDTH]; NUMBERS];
        for first in (0..self.materials.len()).step_by(WIDTH / lanes) {
            elements.rows(first, lanes, &mut numbers);
            let mut corners = [[zero; 3]; 8];
            elements.corners(first, lanes, x, &mut corners);
            let group = Group { elements, numbers: &numbers, at: [first, lanes], undamped };
            self.force(simd, &group, past, &mut corners);
            elements.add(first, &corners, lanes, y);
        }
    }

    /// Replaces the displacements of the corners by the forces on them, as other materials do.
    #[inline(always)]
    fn force<S: Simd>(&self, simd: S, group: &Group<'_>, past: &mut Past<'_, f64>, corners: &mut Corners<S>) {
        let all = |value: f64| f64x8::splat(simd, value);
        let number = |number: usize| f64x8::load_array_ref(simd, &group.numbers[number]);
        let mut slopes: Slopes<S> = [[[all(0.0); 3]; 4]; 3];
        slopes_of(simd, corners, &mut slopes);
        let shear = number(SHEAR);
        let half_bulk = all(0.5) * (number(LAMBDA) + all(2.0 / 3.0) * shear);
        let is_selective = group.elements.is_selective;
        let mean_pressure = if is_selective {
            let t = group.elements.mean(simd, &number, &slopes);
            half_bulk * (t * (all(2.0) + t) / (all(1.0) + t))
        } else {
            all(0.0)
        };
        let limit = f64x8::load_array(simd, self.limits(group.at));
        let mut has_yielded = self.row(past.history(), group.at, 0).iter().any(|work_j| *work_j != 0.0);
        let mut sums: Slopes<S> = [[[all(0.0); 3]; 4]; 3];
        for point in 0..8 {
            let h = gradient(simd, &number, &slopes, point);
            let (k, j) = cofactor(&h);
            let over_j = all(1.0) / (all(1.0) + j);
            let scale = isochoric(simd, j, over_j);
            let mut s = self.deviator(simd, past.history(), group.at, point, has_yielded, &h, shear * scale);
            let excess = {
                let history = past.history();
                let (mut distance, mut radius) = (s, limit);
                if has_yielded {
                    let first = 1 + point * self.of_point();
                    radius += all(ROOT) * f64x8::load_array(simd, self.row(history, group.at, first + RISE));
                    if self.has_back_stress {
                        let back = self.tensor(simd, history, group.at, first + BACK);
                        let mut back = forward(&h, &back);
                        make_deviator(simd, &mut back, scale);
                        for i in 0..3 {
                            for n in 0..3 {
                                distance[i][n] -= back[i][n];
                            }
                        }
                    }
                }
                square(&distance).simd_gt(radius * radius)
            };
            if excess.any_true()
                && let Past::Followed { history, time_step_s } = past
            {
                self.flow(simd, group, point, &h, history, *time_step_s);
                has_yielded = true;
                s = self.deviator(simd, history, group.at, point, true, &h, shear * scale);
            }
            // P = τ F⁻ᵀ with F⁻ᵀ = (∂J/∂F)/J and ∂J/∂F = 1 + K.
            let pressure =
                if is_selective { mean_pressure } else { half_bulk * (j * (all(2.0) + j) * over_j) };
            for i in 0..3 {
                for n in 0..3 {
                    s[i][n] *= over_j;
                }
                s[i][i] += pressure;
            }
            let weight = number(point * OF_POINT + 9);
            for a in 0..3 {
                let at = point * OF_POINT + 3 * a;
                let g = [number(at) * weight, number(at + 1) * weight, number(at + 2) * weight];
                // (1 + K) g, and then σ times that.
                let turned: [f64x8<S>; 3] =
                    std::array::from_fn(|i| g[i] + (k[i][0] * g[0] + k[i][1] * g[1] + k[i][2] * g[2]));
                let sum = &mut sums[a][across(point, a)];
                for i in 0..3 {
                    sum[i] += s[i][0] * turned[0] + s[i][1] * turned[1] + s[i][2] * turned[2];
                }
            }
        }
        spread(simd, &mut sums, corners);
    }

    /// √⅔ σ₀ \[Pa\] of the slots of a group; infinite where a material does not yield.
    #[inline(always)]
    fn limits(&self, [first, lanes]: [usize; 2]) -> [f64; WIDTH] {
        std::array::from_fn(|slot| {
            self.law(first + slot / lanes).map_or(f64::INFINITY, |law| ROOT * law.yield_stress_pa)
        })
    }

    /// s of a point of a group, for a modulus G J^(−2/3).
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "what the stress of a point depends on")]
    fn deviator<S: Simd>(
        &self,
        simd: S,
        history: &[f64],
        group: [usize; 2],
        point: usize,
        has_yielded: bool,
        h: &Tensor<S>,
        modulus: f64x8<S>,
    ) -> Tensor<S> {
        // b_e − 1 = H + Hᵀ + H Hᵀ + F (C_p⁻¹ − 1) Fᵀ.
        let mut strain = if has_yielded {
            forward(h, &self.tensor(simd, history, group, 1 + point * self.of_point()))
        } else {
            [[f64x8::splat(simd, 0.0); 3]; 3]
        };
        for i in 0..3 {
            for n in i..3 {
                let product = h[i][0] * h[n][0] + h[i][1] * h[n][1] + h[i][2] * h[n][2];
                strain[i][n] += (h[i][n] + h[n][i]) + product;
                strain[n][i] = strain[i][n];
            }
        }
        make_deviator(simd, &mut strain, modulus);
        strain
    }

    /// Lets the slots flow that yield at a point.
    #[inline(never)]
    fn flow<S: Simd>(
        &self,
        simd: S,
        group: &Group<'_>,
        point: usize,
        h: &Tensor<S>,
        history: &mut [f64],
        time_step_s: f64,
    ) {
        let [first, lanes] = group.at;
        let undamped = (!group.undamped.is_empty()).then(|| {
            let mut u = [[f64x8::splat(simd, 0.0); 3]; 8];
            group.elements.corners(first, lanes, group.undamped, &mut u);
            let mut slopes: Slopes<S> = [[[f64x8::splat(simd, 0.0); 3]; 4]; 3];
            slopes_of(simd, &u, &mut slopes);
            let number = |number: usize| f64x8::load_array_ref(simd, &group.numbers[number]);
            arrays(&gradient(simd, &number, &slopes, point))
        });
        let h = arrays(h);
        let of_slot = |rows: &[[[f64; WIDTH]; 3]; 3], slot: usize| -> Matrix {
            Matrix::from_fn(|i, n| rows[i][n][slot])
        };
        for slot in 0..WIDTH {
            let (element, lane) = (first + slot / lanes, slot % lanes);
            let Some(law) = self.law(element) else { continue };
            let mut state = self.read(history, element, point, lane, lanes);
            let (h, shear_pa) = (of_slot(&h, slot), group.numbers[SHEAR][slot]);
            let undamped = undamped.as_ref().map_or(h, |rows| of_slot(rows, slot));
            let Some(work) = law.flow(&mut state, &h, &undamped, shear_pa, time_step_s) else { continue };
            self.write(history, element, point, lane, lanes, &state);
            history[self.place(element, 0, lane, lanes)] += group.numbers[point * OF_POINT + 9][slot] * work;
        }
    }

    /// The energy \[J\] of each slot of a group, and the smallest J of its points.
    #[inline(always)]
    pub(super) fn energy<S: Simd>(
        &self,
        simd: S,
        elements: &Elements,
        number: impl Fn(usize) -> f64x8<S>,
        u: &Corners<S>,
        history: &[f64],
        group: [usize; 2],
    ) -> ([f64; WIDTH], [f64; WIDTH]) {
        let mut slopes: Slopes<S> = [[[f64x8::splat(simd, 0.0); 3]; 4]; 3];
        slopes_of(simd, u, &mut slopes);
        let (shear, lambda): ([f64; WIDTH], [f64; WIDTH]) =
            (number(SHEAR).to_array(), number(LAMBDA).to_array());
        let mean: Option<[f64; WIDTH]> =
            elements.is_selective.then(|| elements.mean(simd, &number, &slopes).to_array());
        let (mut energy_j, mut smallest) = ([0.0; WIDTH], [f64::INFINITY; WIDTH]);
        for point in 0..8 {
            let h = gradient(simd, &number, &slopes, point);
            let j: [f64; WIDTH] = cofactor(&h).1.to_array();
            let turned = forward(&h, &self.tensor(simd, history, group, 1 + point * self.of_point()));
            let mut trace = turned[0][0] + turned[1][1] + turned[2][2];
            for i in 0..3 {
                trace += h[i][i] + h[i][i];
                for n in 0..3 {
                    trace += h[i][n] * h[i][n];
                }
            }
            let trace: [f64; WIDTH] = trace.to_array();
            let weight: [f64; WIDTH] = number(point * OF_POINT + 9).to_array();
            for slot in 0..WIDTH {
                smallest[slot] = f64::min(smallest[slot], 1.0 + j[slot]);
                // J^(−2/3) − 1, for all digits of a small strain.
                let scale = libm::expm1(-2.0 / 3.0 * libm::log1p(j[slot]));
                let distortion = trace[slot] + scale * (3.0 + trace[slot]);
                let t = mean.map_or(j[slot], |mean| mean[slot]);
                let dilation = 0.5 * t * (2.0 + t) - libm::log1p(t);
                let bulk = lambda[slot] + 2.0 / 3.0 * shear[slot];
                energy_j[slot] += weight[slot] * 0.5 * (shear[slot] * distortion + bulk * dilation);
            }
        }
        (energy_j, smallest)
    }
}

/// A group of elements in the slots of vectors.
struct Group<'a> {
    elements: &'a Elements,
    /// Their numbers, slot by slot.
    numbers: &'a [[f64; WIDTH]; NUMBERS],
    /// The first element, and the number of lanes.
    at: [usize; 2],
    /// The displacements without those of damping; empty if there is no damping.
    undamped: &'a [f64],
}

/// (1 + H) A (1 + H)ᵀ of a symmetric A.
#[inline(always)]
fn forward<S: Simd>(h: &Tensor<S>, a: &Tensor<S>) -> Tensor<S> {
    let half = deformed(h, a);
    let mut whole = half;
    for i in 0..3 {
        for n in 0..3 {
            whole[i][n] += half[i][0] * h[n][0] + half[i][1] * h[n][1] + half[i][2] * h[n][2];
        }
    }
    whole
}

/// Makes a tensor a multiple of its deviator.
#[inline(always)]
fn make_deviator<S: Simd>(simd: S, a: &mut Tensor<S>, factor: f64x8<S>) {
    let mean = f64x8::splat(simd, 1.0 / 3.0) * (a[0][0] + a[1][1] + a[2][2]);
    for i in 0..3 {
        a[i][i] -= mean;
        for n in 0..3 {
            a[i][n] = factor * a[i][n];
        }
    }
}

/// A:A.
#[inline(always)]
fn square<S: Simd>(a: &Tensor<S>) -> f64x8<S> {
    let mut sum = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
    let off = a[0][1] * a[0][1] + a[1][2] * a[1][2] + a[0][2] * a[0][2];
    sum += off + off;
    sum
}

/// J^(−2/3) for 1 + j = J, by three steps of Newton's method for y³ J² = 1 from the series in 1/J − 1. Between J = ½ and 2 it has all digits, and
/// six at J = 0.35. Below 0.3 it fails: no metal is compressed as far.
#[inline(always)]
fn isochoric<S: Simd>(simd: S, j: f64x8<S>, over_j: f64x8<S>) -> f64x8<S> {
    let all = |value: f64| f64x8::splat(simd, value);
    let volume = all(1.0) + j;
    let squared = volume * volume;
    let q = -(j * over_j);
    let series = all(4.0 / 81.0) - q * all(7.0 / 243.0);
    let mut y = all(1.0) + q * (all(2.0 / 3.0) - q * (all(1.0 / 9.0) - q * series));
    for _ in 0..3 {
        y = y * (all(4.0) - squared * (y * y * y)) * all(1.0 / 3.0);
    }
    y
}

fn arrays<S: Simd>(tensor: &Tensor<S>) -> [[[f64; WIDTH]; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|n| tensor[i][n].to_array()))
}
