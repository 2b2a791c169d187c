//! The target surface of an elastic disk between its nodes.
//!
//! In polar coordinates the track is a uniform grid. So the patch under a slave node, and the local coordinates in
//! it, follow from the node's radius and angle by division. Slave nodes have their undeformed positions, on the
//! disk turned by ωt. Displacements are 10⁻³ of a patch, and their effect on the gap is a product of two small
//! quantities.

use crate::solver::body::ring::mesh::{RingMesh, Track};
use crate::spec::TargetSurface;

/// Number of nodes of the smooth patch: the four corners and eight nodes around them.
pub const SMOOTH: usize = 12;
/// Number of nodes of the bilinear patch.
pub const BILINEAR: usize = 4;

/// A coordinate along or across the track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchCoord {
    /// Index of the cell.
    pub cell: isize,
    /// Local coordinate in the cell, from 0 to 1. It is outside this range beyond the ends of the track.
    pub part: f64,
}

/// The grid of nodes that carries the target surface under the slave nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    track: Track,
    /// Whether the track is a closed circle.
    endless: bool,
    /// Number of columns and rows beyond a cell's corners that its patch needs.
    margin: usize,
}

/// A node of a patch and its weight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Share {
    /// Column of the node, counted from the first column that the caller gave.
    pub column: usize,
    /// Row of the track.
    pub row: usize,
    /// Value of the node's shape function.
    pub weight: f64,
}

impl Grid {
    /// The grid of a mesh's track.
    pub fn new(mesh: &RingMesh, target: TargetSurface) -> Self {
        let track = *mesh.track();
        let margin = match target {
            TargetSurface::Bilinear => 0,
            TargetSurface::Ferguson => 1,
        };
        Self { track, endless: track.sectors == mesh.nodes_per_axis()[0], margin }
    }

    /// Number of rows of nodes.
    pub fn rows(&self) -> usize {
        self.track.elements + 1
    }

    /// Number of columns beyond a cell's corners that its patch needs.
    pub fn margin(&self) -> isize {
        self.margin as isize
    }

    /// The coordinate along the track of an angle \[rad\]. It is extrapolated beyond the ends of an open track.
    pub fn along(&self, angle_rad: f64) -> PatchCoord {
        let at = (angle_rad - self.track.first_angle_rad) / self.track.sector_rad;
        if self.endless {
            patch_coord(at, isize::MIN, isize::MAX)
        } else {
            patch_coord(at, 0, self.track.sectors as isize - 1)
        }
    }

    /// The coordinate across the track of a radius \[m\].
    pub fn across(&self, radius_m: f64) -> PatchCoord {
        let at = (radius_m - self.track.first_radius_m) / self.track.element_m;
        patch_coord(at, 0, self.track.elements as isize - 1)
    }

    /// The column of the mesh for a column index. The index wraps around on a closed track. On an open track it is
    /// clamped to the ends.
    pub fn track_column(&self, column: isize) -> usize {
        let sectors = self.track.sectors as isize;
        (if self.endless { column.rem_euclid(sectors) } else { column.clamp(0, sectors) }) as usize
    }

    /// Whether a column of nodes exists.
    fn has_column(&self, column: isize) -> bool {
        self.endless || (0..=self.track.sectors as isize).contains(&column)
    }

    /// Shares of the bilinear patch with four nodes. Columns are counted from `first`.
    pub fn bilinear(along: PatchCoord, across: PatchCoord, first: isize) -> [Share; BILINEAR] {
        std::array::from_fn(|n| {
            let (column, row) = (n & 1, n >> 1);
            Share {
                column: (along.cell - first) as usize + column,
                row: across.cell as usize + row,
                weight: linear(along.part)[column] * linear(across.part)[row],
            }
        })
    }

    /// Shares of a bicubic Ferguson patch, columns counted from `first`. It has Hermite polynomials for the values
    /// and tangents at the corners, and zero twist. Tangents are central differences of the neighbours, or
    /// one-sided where a neighbour is missing. So the patches on both sides of an edge have the same tangents
    /// there.
    pub fn ferguson(&self, along: PatchCoord, across: PatchCoord, first: isize) -> [Share; SMOOTH] {
        let [value_v, tangent_v] = hermite(along.part);
        let [value_u, tangent_u] = hermite(across.part);
        let (column, row) = (along.cell, across.cell);
        // Weights of the columns and rows from −1 to 2, counted from the cell's first corner.
        let mut weights = [[0.0; 4]; 4];
        for a in 0..2 {
            for b in 0..2 {
                weights[1 + a][1 + b] += value_v[a] * value_u[b];
                let has = |offset| self.has_column(column + a as isize + offset);
                for (offset, factor) in difference(has(-1), has(1)) {
                    weights[(1 + a as isize + offset) as usize][1 + b] += tangent_v[a] * value_u[b] * factor;
                }
                let rows = 0..self.rows() as isize;
                let has = |offset| rows.contains(&(row + b as isize + offset));
                for (offset, factor) in difference(has(-1), has(1)) {
                    weights[1 + a][(1 + b as isize + offset) as usize] += value_v[a] * tangent_u[b] * factor;
                }
            }
        }
        let mut shares = [Share::default(); SMOOTH];
        let places =
            (0..16).map(|n| (n / 4, n % 4)).filter(|(a, b)| !(matches!(a, 0 | 3) && matches!(b, 0 | 3)));
        for (share, (a, b)) in shares.iter_mut().zip(places) {
            // A node that does not exist has the weight zero. An existing node takes its place.
            let row = (row + b as isize - 1).clamp(0, self.rows() as isize - 1);
            *share = Share {
                column: (column + a as isize - 1 - first) as usize,
                row: row as usize,
                weight: weights[a][b],
            };
        }
        shares
    }
}

fn patch_coord(at: f64, lowest: isize, highest: isize) -> PatchCoord {
    let cell = (at.floor() as isize).clamp(lowest, highest);
    PatchCoord { cell, part: at - cell as f64 }
}

fn linear(part: f64) -> [f64; 2] {
    [1.0 - part, part]
}

/// Cubic Hermite polynomials at `t`: for the values at 0 and 1, and for the tangents at 0 and 1.
fn hermite(t: f64) -> [[f64; 2]; 2] {
    let (t2, t3) = (t * t, t * t * t);
    [[1.0 - 3.0 * t2 + 2.0 * t3, 3.0 * t2 - 2.0 * t3], [t - 2.0 * t2 + t3, t3 - t2]]
}

/// Offsets and factors of the finite difference for a tangent, per cell, from the neighbours that exist.
fn difference(low: bool, high: bool) -> [(isize, f64); 2] {
    match (low, high) {
        (true, true) => [(-1, -0.5), (1, 0.5)],
        (true, false) => [(-1, -1.0), (0, 1.0)],
        (false, true) => [(0, -1.0), (1, 1.0)],
        (false, false) => [(0, 0.0), (0, 0.0)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(target: TargetSurface) -> Grid {
        Grid::new(&RingMesh::uniform(0.4, [0.08, 0.1], 0.01, [10, 8, 2]), target)
    }

    fn value(shares: &[Share], of: impl Fn(f64, f64) -> f64) -> f64 {
        shares.iter().map(|share| share.weight * of(share.column as f64, share.row as f64)).sum()
    }

    /// Protects: both patches reproduce constant and linear functions of the grid's coordinates, up to the edges of
    /// the grid. Inside the grid the smooth patch also reproduces quadratic functions.
    #[test]
    fn polynomials_are_reproduced() {
        for target in [TargetSurface::Bilinear, TargetSurface::Ferguson] {
            let grid = grid(target);
            for (cell, row) in [(0, 0), (4, 3), (9, 7)] {
                for part in [0.0, 0.3, 0.9] {
                    let (along, across) =
                        (PatchCoord { cell, part }, PatchCoord { cell: row, part: 1.0 - part });
                    let (y, x) = (cell as f64 + part, row as f64 + 1.0 - part);
                    let found = |of: &dyn Fn(f64, f64) -> f64| match target {
                        TargetSurface::Bilinear => value(&Grid::bilinear(along, across, 0), of),
                        TargetSurface::Ferguson => {
                            // Columns are counted from −1, because the first patch reaches there.
                            value(&grid.ferguson(along, across, -1), |column, row| of(column - 1.0, row))
                        }
                    };
                    assert!((found(&|_, _| 1.0) - 1.0).abs() < 1e-14);
                    assert!((found(&|column, row| 2.0 * column - row) - (2.0 * y - x)).abs() < 1e-13);
                    if target == TargetSurface::Ferguson && (cell, row) == (4, 3) {
                        let error = found(&|column, row| column * column + row * row) - (y * y + x * x);
                        assert!(error.abs() < 1e-13, "{error}");
                    }
                }
            }
        }
    }

    /// Protects: the interpolated value has no jump where a slave node crosses an edge, along and across the track.
    /// With Ferguson patches the slope has none either; the bilinear slope jumps.
    #[test]
    fn crossing_an_edge_is_smooth() {
        let wavy = |column: f64, row: f64| libm::sin(1.3 * column) * libm::cos(0.7 * row);
        let h = 1e-6;
        for (target, continuous_slope) in [(TargetSurface::Bilinear, false), (TargetSurface::Ferguson, true)]
        {
            let grid = grid(target);
            let at = |y: f64, x: f64| {
                let angle = -0.2 + 0.04 * y;
                let (along, across) = (grid.along(angle), grid.across(0.08 + 0.0025 * x));
                match target {
                    TargetSurface::Bilinear => value(&Grid::bilinear(along, across, 0), wavy),
                    TargetSurface::Ferguson => {
                        value(&grid.ferguson(along, across, -1), |column, row| wavy(column - 1.0, row))
                    }
                }
            };
            for (y, x, along) in [(5.0, 3.4, true), (4.6, 4.0, false)] {
                let shifted = |by: f64| if along { at(y + by, x) } else { at(y, x + by) };
                // The slope has the size 1.
                assert!((shifted(h) - shifted(-h)).abs() < 4.0 * h);
                let (before, after) =
                    ((shifted(-h) - shifted(-2.0 * h)) / h, (shifted(2.0 * h) - shifted(h)) / h);
                assert_eq!((after - before).abs() < 1e-4, continuous_slope, "{target:?}: {before} {after}");
            }
        }
    }
}
