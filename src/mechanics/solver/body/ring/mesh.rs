//! The structured mesh of the ring.

use super::grading::graded;
use crate::solver::field::Layout;
use crate::spec::{Pin, Ring};
use std::f64::consts::TAU;

/// A ring, or a sector of a ring, of hexahedra in (r, θ, z) with the top face at z = 0.
///
/// Node (j, i, k) is at the angle j, the radius i and the depth k, which is counted from the top downwards. Its
/// index is `j + nθ·(i + nr·k)`. Edges are straight, so the ring is a polygon.
#[derive(Debug, Clone, PartialEq)]
pub struct RingMesh {
    sectors_rad: Vec<f64>,
    angles_rad: Vec<f64>,
    radii_m: Vec<f64>,
    heights_m: Vec<f64>,
    closed: bool,
    track: Track,
}

/// The part of the top face with equal elements. The slave nodes stay on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Track {
    /// Angle \[rad\] of its first column of nodes, which is column 0 of the mesh.
    pub first_angle_rad: f64,
    /// Angle \[rad\] of one sector.
    pub sector_rad: f64,
    /// Number of sectors.
    pub sectors: usize,
    /// First row of nodes.
    pub first_row: usize,
    /// Radius \[m\] of that row.
    pub first_radius_m: f64,
    /// Radial edge \[m\] of the elements.
    pub element_m: f64,
    /// Number of elements in r.
    pub elements: usize,
}

/// The element counts and sizes of a generated mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshReport {
    /// Number of elements in θ, r and z.
    pub elements: [usize; 3],
    /// Longest edge \[m\] of the elements under the track, in θ, r and z.
    pub track_element_m: [f64; 3],
    /// Longest edge \[m\] of all elements.
    pub longest_edge_m: f64,
}

impl RingMesh {
    /// The mesh of a ring under a pin. The pin's centre is at the radius `track_radius_m`. Relative to the ring it
    /// moves from the angle 0 backwards over the ring's arc.
    pub fn under_track(ring: &Ring, pin: &Pin, track_radius_m: f64) -> Self {
        let (fine, coarse) = (ring.element_size_m, ring.coarse_element_size_m);
        let [half_x, half_y] = [pin.size_m[0] / 2.0, pin.size_m[1] / 2.0];
        let (inside, outside) = (track_radius_m - half_x, libm::hypot(track_radius_m + half_x, half_y));
        // The track has one more element on either side, from which patches take tangents. It ends at the edge of
        // the ring if less than half an element would be left there.
        let low =
            if inside - 1.5 * fine <= ring.inner_radius_m { ring.inner_radius_m } else { inside - fine };
        let high =
            if outside + 1.5 * fine >= ring.outer_radius_m { ring.outer_radius_m } else { outside + fine };
        let rows = count(high - low, fine);
        let element_m = (high - low) / rows as f64;
        let inwards = graded(low - ring.inner_radius_m, element_m, coarse);
        let outwards = graded(ring.outer_radius_m - high, element_m, coarse);
        let radii_m: Vec<f64> = (inwards.iter().rev())
            .scan(ring.inner_radius_m, |radius, size| Some(std::mem::replace(radius, *radius + size)))
            .chain((0..rows).map(|row| low + element_m * row as f64))
            .chain(std::iter::once(high))
            .chain(outwards.iter().scan(high, |radius, size| {
                *radius += size;
                Some(*radius)
            }))
            .collect();

        let half_angle = libm::atan2(half_y, inside);
        let arc = ring.track_arc_deg.to_radians();
        let sector = fine / high;
        let span = arc + 2.0 * (half_angle + sector);
        let (first_angle_rad, sectors, sectors_rad) = if span >= TAU - 2.0 * sector {
            let sectors = count(TAU, sector);
            (0.0, sectors, vec![TAU / sectors as f64; sectors])
        } else {
            let sectors = count(span, sector);
            let sector = span / sectors as f64;
            let half_way = graded((TAU - span) / 2.0, sector, (coarse / ring.outer_radius_m).max(sector));
            let mut all = vec![sector; sectors];
            all.extend(&half_way);
            all.extend(half_way.iter().rev());
            (-(span - half_angle - sector), sectors, all)
        };
        let mut heights_m = vec![0.0];
        for size in graded(ring.thickness_m, fine, coarse) {
            heights_m.push(heights_m[heights_m.len() - 1] - size);
        }
        let track = Track {
            first_angle_rad,
            sector_rad: sectors_rad[0],
            sectors,
            first_row: inwards.len(),
            first_radius_m: low,
            element_m,
            elements: rows,
        };
        Self::new(sectors_rad, radii_m, heights_m, true, track)
    }

    /// A sector of a ring with equal elements, or a whole ring if `angle_rad` is 2π. The track is the whole top
    /// face. `elements` are the numbers of elements in θ, r and z.
    ///
    /// # Panics
    /// If there is no element in a direction.
    pub fn uniform(angle_rad: f64, radii_m: [f64; 2], thickness_m: f64, elements: [usize; 3]) -> Self {
        assert!(elements.iter().all(|&n| n > 0), "a mesh needs at least one element per direction");
        let closed = angle_rad >= TAU;
        let [columns, rows, layers] = elements;
        let along = |length: f64, n: usize| (0..=n).map(move |i| length * i as f64 / n as f64);
        let sector_rad = angle_rad / columns as f64;
        let element_m = (radii_m[1] - radii_m[0]) / rows as f64;
        let track = Track {
            first_angle_rad: if closed { 0.0 } else { -angle_rad / 2.0 },
            sector_rad,
            sectors: columns,
            first_row: 0,
            first_radius_m: radii_m[0],
            element_m,
            elements: rows,
        };
        Self::new(
            vec![sector_rad; columns],
            along(radii_m[1] - radii_m[0], rows).map(|r| radii_m[0] + r).collect(),
            along(thickness_m, layers).map(|z| -z).collect(),
            closed,
            track,
        )
    }

    fn new(
        sectors_rad: Vec<f64>,
        radii_m: Vec<f64>,
        heights_m: Vec<f64>,
        closed: bool,
        track: Track,
    ) -> Self {
        let mut angles_rad = vec![track.first_angle_rad];
        for sector in &sectors_rad[..sectors_rad.len() - usize::from(closed)] {
            angles_rad.push(angles_rad[angles_rad.len() - 1] + sector);
        }
        Self { sectors_rad, angles_rad, radii_m, heights_m, closed, track }
    }

    /// Number of nodes in θ, r and z.
    pub fn nodes_per_axis(&self) -> [usize; 3] {
        [self.angles_rad.len(), self.radii_m.len(), self.heights_m.len()]
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes_per_axis().iter().product()
    }

    /// The layout of a field on all nodes: lines along θ.
    pub fn layout(&self) -> Layout {
        let [columns, rows, planes] = self.nodes_per_axis();
        Layout { nodes_per_line: columns, lines_per_plane: rows, nodes: columns * rows * planes }
    }

    /// The layout of a field on the top face.
    pub fn top_layout(&self) -> Layout {
        let [columns, rows, _] = self.nodes_per_axis();
        Layout { nodes_per_line: columns, lines_per_plane: rows, nodes: columns * rows }
    }

    /// Index of the node at angle j, radius i and depth k.
    pub fn node(&self, j: usize, i: usize, k: usize) -> usize {
        let [columns, rows, _] = self.nodes_per_axis();
        j + columns * (i + rows * k)
    }

    /// (j, i, k) of a node.
    pub fn grid_position(&self, node: usize) -> [usize; 3] {
        let [columns, rows, _] = self.nodes_per_axis();
        [node % columns, node / columns % rows, node / (columns * rows)]
    }

    /// Radius \[m\], angle \[rad\] and height \[m\] of a node in the rotating frame.
    pub fn polar_m(&self, node: usize) -> [f64; 3] {
        let [j, i, k] = self.grid_position(node);
        [self.radii_m[i], self.angles_rad[j], self.heights_m[k]]
    }

    /// Angles \[rad\] of the sectors. Sector j is between the columns j and j + 1.
    pub fn sectors_rad(&self) -> &[f64] {
        &self.sectors_rad
    }

    /// Angles \[rad\] of the columns of nodes.
    pub fn angles_rad(&self) -> &[f64] {
        &self.angles_rad
    }

    /// Radii \[m\] of the rows of nodes.
    pub fn radii_m(&self) -> &[f64] {
        &self.radii_m
    }

    /// Heights \[m\] of the planes of nodes, from 0 at the top downwards.
    pub fn heights_m(&self) -> &[f64] {
        &self.heights_m
    }

    /// Whether the last sector ends at the first column.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The part of the top with equal elements.
    pub fn track(&self) -> &Track {
        &self.track
    }

    /// The element counts and sizes.
    pub fn report(&self) -> MeshReport {
        let track = &self.track;
        let outside = track.first_radius_m + track.element_m * track.elements as f64;
        let steps = |at: &[f64]| at.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        let outer = self.radii_m[self.radii_m.len() - 1];
        let widest = self.sectors_rad.iter().copied().fold(0.0, f64::max);
        MeshReport {
            elements: [self.sectors_rad.len(), self.radii_m.len() - 1, self.heights_m.len() - 1],
            track_element_m: [
                track.sector_rad * outside,
                track.element_m,
                self.heights_m[0] - self.heights_m[1],
            ],
            longest_edge_m: steps(&self.radii_m).max(steps(&self.heights_m)).max(widest * outer),
        }
    }
}

/// Number of equal parts of at most `size`. The factor covers the rounding of decimal lengths.
fn count(length: f64, size: f64) -> usize {
    (length / size * (1.0 - 1.0e-9)).ceil().max(1.0) as usize
}
