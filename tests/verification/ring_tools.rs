//! An elastic ring with its stiffness, in Cartesian or nodal directions, and its static solutions; a tool for
//! the other files.

use std::f64::consts::PI;
use tribosweep_mechanics::solver::body::ring::RingMesh;
use tribosweep_mechanics::solver::body::ring::operator::{RingOperator, RingScratch};
use tribosweep_mechanics::solver::field::Field;
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::spec::{DiskTimeStep, Element, Pin, Ring, TargetSurface};

/// The reference ring's steel.
pub const STEEL: Material = Material { young_modulus_pa: 2.1e11, poisson_ratio: 0.3, density_kg_m3: 7800.0 };

/// The reference ring's inner and outer radius.
pub const RADII_M: [f64; 2] = [0.07, 0.12];

/// The reference ring's thickness.
pub const THICKNESS_M: f64 = 0.085;

/// Radius of the pin's centre.
pub const TRACK_RADIUS_M: f64 = 0.0914;

/// A vector per node in its own directions.
pub type Nodal = Field<1>;

/// A ring's mesh with its stiffness and masses.
pub struct RingBody {
    pub mesh: RingMesh,
    pub masses_kg: Vec<f64>,
    operator: RingOperator,
}

/// The graded mesh of the reference ring under a pin that stays at one place of the track.
pub fn graded_mesh(element_size_m: f64, coarse_element_size_m: f64) -> RingMesh {
    let ring = Ring {
        inner_radius_m: RADII_M[0],
        outer_radius_m: RADII_M[1],
        thickness_m: THICKNESS_M,
        young_modulus_pa: STEEL.young_modulus_pa,
        poisson_ratio: STEEL.poisson_ratio,
        density_kg_m3: STEEL.density_kg_m3,
        element_size_m,
        coarse_element_size_m,
        element: Element::Full,
        track_arc_deg: 1.0,
        target: TargetSurface::Bilinear,
        clock: DiskTimeStep::Own,
    };
    RingMesh::under_track(&ring, &Pin::default(), TRACK_RADIUS_M)
}

impl RingBody {
    /// A body of steel.
    pub fn new(mesh: RingMesh) -> Self {
        let (operator, masses_kg) = RingOperator::of_mesh(&mesh, &STEEL);
        Self { mesh, masses_kg, operator }
    }

    /// No displacement.
    pub fn zeros(&self) -> Nodal {
        Field::zeros(self.mesh.layout())
    }

    /// Cartesian position [m] of a node.
    pub fn position_m(&self, node: usize) -> [f64; 3] {
        let [r, angle, z] = self.mesh.polar_m(node);
        [r * angle.cos(), r * angle.sin(), z]
    }

    /// A Cartesian vector in the directions of a node.
    pub fn own(&self, node: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let (sin, cos) = self.mesh.polar_m(node)[1].sin_cos();
        [x * cos + y * sin, y * cos - x * sin, z]
    }

    /// The nodal vectors of a Cartesian vector field over Cartesian positions.
    pub fn field(&self, vector: impl Fn([f64; 3]) -> [f64; 3]) -> Nodal {
        let mut field = self.zeros();
        for node in 0..self.mesh.node_count() {
            let own = self.own(node, vector(self.position_m(node)));
            for c in 0..3 {
                field[3 * node + c] = own[c];
            }
        }
        field
    }

    /// K u.
    pub fn force(&self, u: &Nodal) -> Nodal {
        let mut force = self.zeros();
        self.operator.product(u, &mut force, &mut RingScratch::new(&self.operator));
        force
    }

    /// Applies K to unit vectors of one component at many nodes at once. The nodes are so far apart that no
    /// row of K contains two of them. Every column of K occurs once. `look` receives the unit vectors and the
    /// product.
    fn probe(&self, mut look: impl FnMut(&Nodal, &Nodal)) {
        let [columns, _, _] = self.mesh.nodes_per_axis();
        // The number of columns of a closed ring may not be a multiple of three. The remaining columns get
        // colours of their own.
        let whole = columns - columns % 3;
        let colour = |j: usize| if j < whole { j % 3 } else { 3 + j - whole };
        for number in 0..9 * (3 + columns % 3) {
            for c in 0..3 {
                let mut units = self.zeros();
                for node in 0..self.mesh.node_count() {
                    let [j, i, k] = self.mesh.grid_position(node);
                    if (colour(j) * 3 + i % 3) * 3 + k % 3 == number {
                        units[3 * node + c] = 1.0;
                    }
                }
                look(&units, &self.force(&units));
            }
        }
    }

    /// Σ|K| of every row.
    fn row_sums(&self) -> Vec<f64> {
        let mut sums = vec![0.0; 3 * self.mesh.node_count()];
        self.probe(|_, product| {
            for (sum, k) in sums.iter_mut().zip(product.values()) {
                *sum += k.abs();
            }
        });
        sums
    }

    /// For every motion: the largest component of K u at the nodes that `of` selects. It is relative to Σ|K|
    /// of its row times the largest component of u, which is the size of the terms that cancel.
    pub fn relative_forces(&self, motions: &[Nodal], of: impl Fn([usize; 3]) -> bool) -> Vec<f64> {
        let sums = self.row_sums();
        let largest = |u: &Nodal| u.values().map(f64::abs).fold(0.0, f64::max);
        let picked = |dof: &usize| of(self.mesh.grid_position(dof / 3));
        motions
            .iter()
            .map(|u| {
                let (force, size) = (self.force(u), largest(u));
                (0..sums.len())
                    .filter(picked)
                    .map(|dof| force[dof].abs() / (sums[dof] * size))
                    .fold(0.0, f64::max)
            })
            .collect()
    }

    /// Largest number of roundings of a component of [`Self::relative_forces`].
    ///
    /// A Gauss point's part of an entry of K has 62 roundings: two gradients with 25 each (sums of 8 products
    /// for the Jacobian, 12 for its inverse, 5 for a product with it), a determinant (8) and 4 more. The
    /// parts of 8 points are added, and one of them may be as large as the entry. Rotation into the nodes'
    /// directions takes 2 × 4 roundings and mirroring 4. On either side 4 elements are added, and a row has
    /// 81 products. The angle of a column has one rounding, of up to 2π, for every column before it, and the
    /// vectors rotate with it. A position has 5 roundings of its own.
    pub fn roundings(&self) -> f64 {
        let [columns, _, _] = self.mesh.nodes_per_axis();
        8.0 * 62.0 + 8.0 + 8.0 + 4.0 + 8.0 + 81.0 + PI * columns as f64 + 5.0
    }

    /// Rounding error of u·K u over ε [J], at most: the roundings of each force times its displacement.
    pub fn work_roundings(&self, u: &Nodal) -> f64 {
        let largest = u.values().map(f64::abs).fold(0.0, f64::max);
        let rows = self.row_sums();
        self.roundings() * largest * u.values().zip(rows).map(|(u, sum)| u.abs() * sum).sum::<f64>()
    }

    /// The static displacement under `load`, by conjugate gradients preconditioned with the diagonal. Degrees
    /// of freedom for which `held` is true keep their values of `u`.
    pub fn solve(&self, load: &Nodal, held: impl Fn(usize) -> bool, mut u: Nodal) -> Nodal {
        // The inverse is zero at held degrees of freedom and in the padding, so the search directions are
        // zero there, too.
        let mut inverse = self.zeros();
        self.probe(|units, product| {
            for dof in (0..units.len()).filter(|dof| units[*dof] == 1.0) {
                inverse[dof] = if held(dof) { 0.0 } else { 1.0 / product[dof] };
            }
        });
        let mut scratch = RingScratch::new(&self.operator);
        let (mut product, mut residual, mut z, mut p) =
            (self.force(&u), load.clone(), self.zeros(), self.zeros());
        combine(&mut residual, |r, q| r - q, &product);
        z.blocks_mut().copy_from_slice(inverse.blocks());
        combine(&mut z, |a, r| a * r, &residual);
        p.blocks_mut().copy_from_slice(z.blocks());
        let [start] = residual.dot(&z);
        let mut size = start;
        for _ in 0..MOST_ITERATIONS {
            if size <= LEFT * LEFT * start {
                return u;
            }
            self.operator.product(&p, &mut product, &mut scratch);
            let along = size / p.dot(&product)[0];
            combine(&mut u, |x, p| x + along * p, &p);
            combine(&mut residual, |r, q| r - along * q, &product);
            z.blocks_mut().copy_from_slice(inverse.blocks());
            combine(&mut z, |a, r| a * r, &residual);
            let [next] = residual.dot(&z);
            let turn = next / size;
            combine(&mut p, |p, z| z + turn * p, &z);
            size = next;
        }
        panic!("no static solution after {MOST_ITERATIONS} iterations: {:e} left", (size / start).sqrt());
    }
}

/// Relative residual at which the conjugate gradients stop.
const LEFT: f64 = 1e-11;
const MOST_ITERATIONS: usize = 5000;

/// x ← f(x, y), number by number.
fn combine(x: &mut Nodal, f: impl Fn(f64, f64) -> f64, y: &Nodal) {
    for (x, y) in x.blocks_mut().iter_mut().zip(y.blocks()) {
        for (x, y) in x.0.iter_mut().flatten().zip(y.0.iter().flatten()) {
            *x = f(*x, *y);
        }
    }
}
