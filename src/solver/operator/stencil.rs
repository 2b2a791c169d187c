//! The assembled stiffness operator of a uniform block, stored as stencils.
//!
//! All elements of a uniform block are equal, so every node's row of K depends only on whether the
//! node is at the low face, inside, or at the high face of each direction: 27 classes of one
//! 27-point stencil each (52 KiB) instead of one block row per node. The product is the assembled
//! K u, summed over neighbours in a fixed order.

use crate::solver::element::ElementStiffness;
use crate::solver::mesh::BlockMesh;

/// Coefficients of three neighbours in a row (di = −1, 0, 1) for the three components of a node.
type RowStencil = [[f64; 9]; 3];

/// Stencil of one node class: rows (dj, dk), dj fastest.
type ClassStencil = [RowStencil; 9];

/// K of a block of equal elements.
#[derive(Debug, Clone)]
pub struct StencilOperator {
    nodes: [usize; 3],
    classes: Vec<ClassStencil>,
}

/// Position of a node in one direction: low face, inside, high face.
fn class_1d(index: usize, nodes: usize) -> usize {
    if index == 0 {
        0
    } else if index + 1 == nodes {
        2
    } else {
        1
    }
}

impl StencilOperator {
    /// Assembles the stencils of `mesh` from its element matrix.
    pub fn assemble(mesh: &BlockMesh, element: &ElementStiffness) -> Self {
        let mut classes = vec![[[[0.0; 9]; 3]; 9]; 27];
        for (class, stencil) in classes.iter_mut().enumerate() {
            let position = [class % 3, class / 3 % 3, class / 9];
            for a in 0..8_usize {
                // The node is corner `a` of this neighbouring element, which exists unless it lies outside.
                let outside = (0..3).any(|axis| match position[axis] {
                    0 => a >> axis & 1 == 1,
                    2 => a >> axis & 1 == 0,
                    _ => false,
                });
                if outside {
                    continue;
                }
                for b in 0..8_usize {
                    let offset: [usize; 3] =
                        std::array::from_fn(|axis| 1 + (b >> axis & 1) - (a >> axis & 1));
                    let row = &mut stencil[offset[1] + 3 * offset[2]];
                    for r in 0..3 {
                        for c in 0..3 {
                            row[r][3 * offset[0] + c] += element[(3 * a + r, 3 * b + c)];
                        }
                    }
                }
            }
        }
        Self { nodes: mesh.nodes_per_axis(), classes }
    }

    /// Computes `y = K x` for `L` lanes; both arrays are node → component → lane.
    ///
    /// # Panics
    /// If an array's length is not 3 · nodes · L.
    pub fn apply<const L: usize>(&self, x: &[f64], y: &mut [f64]) {
        let [mx, my, mz] = self.nodes;
        assert_eq!(x.len(), 3 * L * mx * my * mz, "x must hold 3 components of {L} lanes per node");
        assert_eq!(y.len(), x.len(), "y must be as long as x");
        for k in 0..mz {
            for j in 0..my {
                self.apply_line::<L>(j, k, x, y);
            }
        }
    }

    /// One line of nodes along x.
    fn apply_line<const L: usize>(&self, j: usize, k: usize, x: &[f64], y: &mut [f64]) {
        let [mx, my, mz] = self.nodes;
        let stride = 3 * L;
        let mut neighbours = [(0_usize, 0_usize); 9];
        let mut count = 0;
        for dk in 0..3 {
            for dj in 0..3 {
                let (jj, kk) = (j + dj, k + dk);
                if (1..=my).contains(&jj) && (1..=mz).contains(&kk) {
                    neighbours[count] = (dj + 3 * dk, stride * mx * ((jj - 1) + my * (kk - 1)));
                    count += 1;
                }
            }
        }
        let neighbours = &neighbours[..count];
        let line_class = 3 * class_1d(j, my) + 9 * class_1d(k, mz);
        let line = stride * mx * (j + my * k);

        let first = &self.classes[line_class];
        let inside = &self.classes[line_class + 1];
        let last = &self.classes[line_class + 2];
        node_product::<L, 6, 3>(first, neighbours, 0, x, &mut y[line..line + stride]);
        for i in 1..mx - 1 {
            let at = line + stride * i;
            node_product::<L, 9, 0>(inside, neighbours, stride * (i - 1), x, &mut y[at..at + stride]);
        }
        let at = line + stride * (mx - 1);
        node_product::<L, 6, 0>(last, neighbours, stride * (mx - 2), x, &mut y[at..at + stride]);
    }
}

/// One node's product: `W` consecutive values of x per neighbour row, matched to the stencil's
/// columns from `FIRST` on. Partial sums are kept per column and added up at the end, in an order
/// that depends on neither the lane count nor the compiler.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the constants W and FIRST must reach the unrolled loops")]
fn node_product<const L: usize, const W: usize, const FIRST: usize>(
    stencil: &ClassStencil,
    neighbours: &[(usize, usize)],
    start: usize,
    x: &[f64],
    y: &mut [f64],
) {
    let mut sums = [[[0.0; L]; W]; 3];
    for &(row, base) in neighbours {
        let coefficients = &stencil[row];
        let values = &x[base + start..base + start + W * L];
        for r in 0..3 {
            for q in 0..W {
                let coefficient = coefficients[r][FIRST + q];
                for l in 0..L {
                    sums[r][q][l] += coefficient * values[q * L + l];
                }
            }
        }
    }
    for r in 0..3 {
        for l in 0..L {
            let mut total = 0.0;
            for q in 0..W {
                total += sums[r][q][l];
            }
            y[r * L + l] = total;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::AssembledOperator;
    use super::*;
    use crate::solver::element::stiffness;
    use crate::solver::material::Material;

    /// A deterministic, structureless field.
    fn field(n: usize, seed: u64) -> Vec<f64> {
        let mut s = seed;
        (0..n)
            .map(|_| {
                s = s.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (s >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
            })
            .collect()
    }

    /// Protects: the stencils are the assembled K, on every kind of node, down to one-element meshes.
    #[test]
    fn equals_element_by_element_assembly() {
        let material = Material { young_modulus_pa: 1e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 };
        for elements in [[1, 1, 1], [1, 2, 3], [3, 1, 2], [2, 3, 1], [4, 3, 3]] {
            let mesh = BlockMesh::new([0.012, 0.015, 0.010], elements);
            let ke = stiffness(&material, mesh.element_size_m());
            let n = 3 * mesh.node_count();
            let x = field(n, 1);
            let mut reference = vec![0.0; n];
            AssembledOperator::of_block(&mesh, &ke).apply::<1>(&x, &mut reference);
            let mut y = vec![0.0; n];
            StencilOperator::assemble(&mesh, &ke).apply::<1>(&x, &mut y);
            // At most 8·24 terms of size |ke|·½, each rounded once.
            let bound = 192.0 * f64::EPSILON * ke.amax();
            for (a, b) in y.iter().zip(&reference) {
                assert!((a - b).abs() < bound, "{elements:?}: {a} instead of {b}");
            }
        }
    }

    /// Protects: a lane's bits do not depend on the lane count or on its companions.
    #[test]
    fn lanes_do_not_see_each_other() {
        let material = Material { young_modulus_pa: 1e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 };
        let mesh = BlockMesh::new([0.012, 0.015, 0.010], [4, 5, 3]);
        let operator = StencilOperator::assemble(&mesh, &stiffness(&material, mesh.element_size_m()));
        let n = 3 * mesh.node_count();
        let mut x8 = vec![0.0; 8 * n];
        let mut y8 = vec![0.0; 8 * n];
        for lane in 0..8 {
            for (i, v) in field(n, lane as u64).into_iter().enumerate() {
                x8[8 * i + lane] = v;
            }
        }
        operator.apply::<8>(&x8, &mut y8);
        for lane in 0..8 {
            let mut y = vec![0.0; n];
            operator.apply::<1>(&field(n, lane as u64), &mut y);
            assert!((0..n).all(|i| y[i].to_bits() == y8[8 * i + lane].to_bits()), "lane {lane} differs");
        }
    }
}
