//! The numbers of elements with large strains, and what all their materials do with them.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::gradient::{Corners, OF_POINT, Slopes, cofactor, gradient, green_strain};
use crate::solver::body::hexahedron::gauss_jacobians;
use crate::solver::body::pin::GeneralMesh;
use crate::solver::material::Material;
use crate::spec::{Element, MaterialLaw};
use fearless_simd::{Simd, f64x8, prelude::*};

/// Slots of a vector.
pub(super) const WIDTH: usize = 8;

/// Places of the numbers of an element behind those of its points: λ \[Pa\], G \[Pa\] and 1/V \[1/m³\].
pub(super) const LAMBDA: usize = 8 * OF_POINT;
pub(super) const SHEAR: usize = LAMBDA + 1;
const INVERSE_VOLUME: usize = LAMBDA + 2;
pub(super) const NUMBERS: usize = LAMBDA + 3;

/// The elements of a mesh.
#[derive(Debug, Clone)]
pub(super) struct Elements {
    pub law: MaterialLaw,
    pub is_selective: bool,
    nodes: Vec<[u32; 8]>,
    /// The numbers of eight elements side by side: group → number → element of the group. The last group is filled up with its last
    /// element.
    numbers: Vec<[f64; WIDTH]>,
}

impl Elements {
    /// The elements of a mesh.
    ///
    /// # Errors
    /// The number of an element that is inverted.
    pub fn new(mesh: &GeneralMesh, materials: &[Material], law: MaterialLaw) -> Result<Self, usize> {
        let count = mesh.elements().len();
        let mut numbers = vec![[0.0; WIDTH]; count.div_ceil(WIDTH) * NUMBERS];
        for slot in 0..count.next_multiple_of(WIDTH) {
            let index = slot.min(count - 1);
            let element = &mesh.elements()[index];
            let material = &materials[element.material];
            let mut of_element = [0.0; NUMBERS];
            let mut volume = 0.0;
            let points = gauss_jacobians(&mesh.corners_m(element)).ok_or(index)?;
            for (point, (inverse, volume_m3)) in points.iter().enumerate() {
                let own = &mut of_element[point * OF_POINT..][..OF_POINT];
                for (place, number) in own[..9].iter_mut().enumerate() {
                    *number = inverse[(place % 3, place / 3)];
                }
                own[9] = *volume_m3;
                volume += volume_m3;
            }
            of_element[LAMBDA] = material.lame_lambda_pa();
            of_element[SHEAR] = material.shear_modulus_pa();
            of_element[INVERSE_VOLUME] = 1.0 / volume;
            for (number, value) in of_element.into_iter().enumerate() {
                numbers[slot / WIDTH * NUMBERS + number][slot % WIDTH] = value;
            }
        }
        let is_selective = mesh.element == Element::Selective;
        let nodes = mesh.elements().iter().map(|element| element.nodes.map(|node| node as u32)).collect();
        Ok(Self { law, is_selective, nodes, numbers })
    }

    /// Number of elements.
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    pub fn of_all(&self, first: usize, number: usize) -> &[f64; WIDTH] {
        &self.numbers[first / WIDTH * NUMBERS + number]
    }

    #[inline(always)]
    pub fn of_one(&self, element: usize, number: usize) -> f64 {
        self.of_all(element, number)[element % WIDTH]
    }

    #[inline(always)]
    pub fn of_some<S: Simd>(&self, simd: S, first: usize, number: usize, lanes: usize) -> f64x8<S> {
        let all = self.of_all(first, number);
        let row: [f64; WIDTH] = std::array::from_fn(|slot| all[first % WIDTH + slot / lanes]);
        f64x8::load_array(simd, row)
    }

    /// The numbers of a group of elements, slot by slot.
    #[inline(always)]
    pub fn rows(&self, first: usize, lanes: usize, rows: &mut [[f64; WIDTH]; NUMBERS]) {
        for (number, row) in rows.iter_mut().enumerate() {
            let all = self.of_all(first, number);
            *row = std::array::from_fn(|slot| all[first % WIDTH + slot / lanes]);
        }
    }

    /// The displacements of the corners of a group of elements.
    #[inline(always)]
    pub fn corners<S: Simd>(&self, first: usize, lanes: usize, x: &[f64], u: &mut Corners<S>) {
        let simd = u[0][0].simd;
        for corner in 0..8 {
            for c in 0..3 {
                if lanes == WIDTH {
                    let node = self.nodes[first][corner] as usize;
                    u[corner][c] = f64x8::from_slice(simd, &x[(3 * node + c) * WIDTH..][..WIDTH]);
                    continue;
                }
                let mut row = [0.0; WIDTH];
                for (nodes, own) in self.nodes[first..].iter().zip(row.chunks_exact_mut(lanes)) {
                    own.copy_from_slice(&x[(3 * nodes[corner] as usize + c) * lanes..][..lanes]);
                }
                u[corner][c] = f64x8::load_array(simd, row);
            }
        }
    }

    /// Adds the forces of a group to its nodes, element after element.
    #[inline(always)]
    pub fn add<S: Simd>(&self, first: usize, force: &Corners<S>, lanes: usize, y: &mut [f64]) {
        if lanes == WIDTH {
            for (corner, &node) in self.nodes[first].iter().enumerate() {
                for c in 0..3 {
                    let sum = &mut y[(3 * node as usize + c) * WIDTH..][..WIDTH];
                    (f64x8::from_slice(force[corner][c].simd, sum) + force[corner][c]).store_slice(sum);
                }
            }
            return;
        }
        let mut rows = [[[0.0; WIDTH]; 3]; 8];
        for corner in 0..8 {
            for c in 0..3 {
                force[corner][c].store_array(&mut rows[corner][c]);
            }
        }
        for (place, nodes) in self.nodes[first..].iter().take(WIDTH / lanes).enumerate() {
            for (corner, &node) in nodes.iter().enumerate() {
                for c in 0..3 {
                    let sums = &mut y[(3 * node as usize + c) * lanes..][..lanes];
                    for (sum, value) in sums.iter_mut().zip(&rows[corner][c][place * lanes..]) {
                        *sum += value;
                    }
                }
            }
        }
    }

    /// The mean over an element of what the term of the law with λ depends on: J − 1, or tr E.
    #[inline(always)]
    pub fn mean<S: Simd>(
        &self,
        simd: S,
        number: &impl Fn(usize) -> f64x8<S>,
        slopes: &Slopes<S>,
    ) -> f64x8<S> {
        let mut sum = f64x8::splat(simd, 0.0);
        for point in 0..8 {
            let h = gradient(simd, number, slopes, point);
            let value = match self.law {
                MaterialLaw::NeoHookean | MaterialLaw::J2 => cofactor(&h).1,
                MaterialLaw::StVenantKirchhoff => {
                    let strain = green_strain(simd, &h);
                    strain[0][0] + strain[1][1] + strain[2][2]
                }
            };
            sum += number(point * OF_POINT + 9) * value;
        }
        sum * number(INVERSE_VOLUME)
    }
}
