//! The height of a base that is not a plane.

use super::roughness::{WaveSum, map_height_m};
use crate::spec::{Base, Pin, Shape};
use std::f64::consts::TAU;

/// The height \[m\] of the undeformed base of a pin over the lowest point that its parts allow, at a point from the pin's axis.
///
/// * Crown of radius R: R − √(R² − r²) at the distance r from the axis.
/// * Rounded edge of radius ρ: ρ − √(ρ² − d²), where d is the distance from the flat part.
/// * Chamfer of width w and height h: h d/w.
/// * Wave: a (1 + sin(2πs/λ)).
///
/// The flat part of a round pin is round. Roughness has no lowest point that is known in advance, so it is not among them.
fn height_m(base: &Base, shape: Shape, size_m: [f64; 2], [x, y]: [f64; 2]) -> f64 {
    let arc = |radius: f64, distance: f64| {
        let inside = distance.min(radius);
        inside * inside / (radius + (radius * radius - inside * inside).max(0.0).sqrt())
    };
    // Distances in x and y from the part of the base that is farther than a width from its edge.
    let beyond = |width: f64| -> [f64; 2] {
        let along = |edge_m: f64, position: f64| (position.abs() - (0.5 * edge_m - width)).max(0.0);
        match shape {
            Shape::Block | Shape::Mesh => [along(size_m[0], x), along(size_m[1], y)],
            Shape::Cylinder => [along(size_m[0], libm::hypot(x, y * (size_m[0] / size_m[1]))), 0.0],
        }
    };
    let crown = base.crown_radius_m.map_or(0.0, |radius| arc(radius, libm::hypot(x, y)));
    let rounded = base.edge_radius_m.map_or(0.0, |radius| {
        let [dx, dy] = beyond(radius);
        arc(radius, libm::hypot(dx, dy))
    });
    let chamfer = base.chamfer_width_m.zip(base.chamfer_height_m).map_or(0.0, |(width, height)| {
        let [dx, dy] = beyond(width);
        height * dx.max(dy) / width
    });
    let wave = base.wave_height_m.zip(base.wave_length_m).map_or(0.0, |(height, length)| {
        let (sin, cos) = libm::sincos(base.wave_direction_deg.unwrap_or(90.0).to_radians());
        height * (1.0 + libm::sin(TAU * (x * cos + y * sin) / length))
    });
    crown + rounded + chamfer + wave
}

/// The base of a pin.
#[derive(Debug)]
pub struct BaseHeights<'a> {
    pin: &'a Pin,
    rough: Option<WaveSum>,
}

impl<'a> BaseHeights<'a> {
    /// The base of this pin.
    pub fn new(pin: &'a Pin) -> Self {
        Self { pin, rough: pin.base.roughness.as_ref().map(WaveSum::new) }
    }

    /// The height \[m\] of the undeformed base at a point \[m\] from the pin's axis, over some plane.
    pub fn height_m(&self, position_m: [f64; 2]) -> f64 {
        let Self { pin, rough } = self;
        let [lx, ly, _] = pin.extent_m();
        let smooth_m = height_m(&pin.base, pin.shape, [lx, ly], position_m);
        let rough_m = rough.as_ref().map_or(0.0, |surface| surface.height_m(position_m));
        // A map has heights outwards, towards the disk.
        let measured_m = pin.base.height_map.as_ref().map_or(0.0, |map| map_height_m(map, position_m));
        smooth_m + rough_m - measured_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn height(base: &Base, x: f64, y: f64) -> f64 {
        height_m(base, Shape::Block, [0.012, 0.015], [x, y])
    }

    /// Protects: every part of a base has its geometry, at points where it is known.
    #[test]
    fn every_part_has_its_height() {
        let near = |found: f64, exact: f64| assert!((found - exact).abs() < 1.0e-15, "{found}, not {exact}");
        let crown = Base { crown_radius_m: Some(0.05), ..Base::default() };
        near(height(&crown, 0.003, 0.004), 0.05 - (0.05_f64 * 0.05 - 0.005 * 0.005).sqrt());
        near(height(&crown, 0.0, 0.0), 0.0);
        let rounded = Base { edge_radius_m: Some(0.001), ..Base::default() };
        near(height(&rounded, 0.005, -0.0065), 0.0);
        near(height(&rounded, 0.006, 0.0), 0.001);
        near(height(&rounded, 0.0, -0.0071), 0.001 - (1.0e-6_f64 - 0.6e-3 * 0.6e-3).sqrt());
        near(height(&rounded, 0.006, 0.0075), 0.001);
        let chamfer =
            Base { chamfer_width_m: Some(0.002), chamfer_height_m: Some(1.0e-4), ..Base::default() };
        near(height(&chamfer, 0.005, 0.006), 0.5e-4);
        near(height(&chamfer, 0.006, 0.0), 1.0e-4);
        let wave = |direction| Base {
            wave_height_m: Some(2.0e-6),
            wave_length_m: Some(0.008),
            wave_direction_deg: direction,
            ..Base::default()
        };
        near(height(&wave(None), 0.003, 0.002), 4.0e-6);
        near(height(&wave(Some(0.0)), 0.002, 0.003), 4.0e-6);
        near(height(&wave(Some(0.0)), -0.002, 0.003), 0.0);
    }

    /// Protects: the edge of a round pin is round.
    #[test]
    fn the_edge_of_a_cylinder_is_round() {
        let base = Base { edge_radius_m: Some(0.001), ..Base::default() };
        for angle in [0.3, 1.2, 2.5, 4.0] {
            let (sin, cos) = libm::sincos(angle);
            for (r, exact) in
                [(0.003, 0.0), (0.004, 0.001), (0.0036, 0.001 - (1.0e-6_f64 - 0.6e-3 * 0.6e-3).sqrt())]
            {
                let found = height_m(&base, Shape::Cylinder, [0.008, 0.008], [r * cos, r * sin]);
                // An angle changes r by its rounding, and the arc is steep at its end.
                assert!(
                    (found - exact).abs() < 1.0e-3 * (f64::EPSILON * 16.0).sqrt(),
                    "{found}, not {exact}"
                );
            }
        }
    }
}
