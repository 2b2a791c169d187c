//! The initial gap of a base that is not a plane.

use crate::spec::{Base, Pin};
use std::f64::consts::TAU;

/// The height \[m\] of the undeformed base over the lowest point that its parts allow, at a point from the pin's axis.
///
/// * Crown of radius R: R − √(R² − r²) at the distance r from the axis.
/// * Rounded edge of radius ρ: ρ − √(ρ² − d²), where d is the distance from the flat part.
/// * Chamfer of width w and height h: h d/w.
/// * Wave: a (1 + sin(2πs/λ)).
fn height_m(base: &Base, size_m: [f64; 2], [x, y]: [f64; 2]) -> f64 {
    let arc = |radius: f64, distance: f64| {
        let inside = distance.min(radius);
        inside * inside / (radius + (radius * radius - inside * inside).max(0.0).sqrt())
    };
    let beyond = |edge_m: f64, position: f64, width: f64| (position.abs() - (0.5 * edge_m - width)).max(0.0);
    let crown = base.crown_radius_m.map_or(0.0, |radius| arc(radius, libm::hypot(x, y)));
    let rounded = base.edge_radius_m.map_or(0.0, |radius| {
        arc(radius, libm::hypot(beyond(size_m[0], x, radius), beyond(size_m[1], y, radius)))
    });
    let chamfer = base.chamfer_width_m.zip(base.chamfer_height_m).map_or(0.0, |(width, height)| {
        height * beyond(size_m[0], x, width).max(beyond(size_m[1], y, width)) / width
    });
    let wave = base.wave_height_m.zip(base.wave_length_m).map_or(0.0, |(height, length)| {
        let (sin, cos) = libm::sincos(base.wave_direction_deg.unwrap_or(90.0).to_radians());
        height * (1.0 + libm::sin(TAU * (x * cos + y * sin) / length))
    });
    crown + rounded + chamfer + wave
}

/// The initial gap \[m\] of a node of a pin's base, by its position \[m\] from the pin's axis. Of the nodes at `positions_m` the
/// lowest has none.
pub fn initial_gap_m<'a>(pin: &'a Pin, positions_m: &[[f64; 2]]) -> impl Fn([f64; 2]) -> f64 + use<'a> {
    let size_m = [pin.size_m[0], pin.size_m[1]];
    let height = move |position_m| height_m(&pin.base, size_m, position_m);
    let lowest_m = positions_m.iter().map(|position_m| height(*position_m)).fold(f64::INFINITY, f64::min);
    move |position_m| height(position_m) - lowest_m
}

#[cfg(test)]
mod tests {
    use super::*;

    fn height(base: &Base, x: f64, y: f64) -> f64 {
        height_m(base, [0.012, 0.015], [x, y])
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

    /// Protects: the lowest node touches.
    #[test]
    fn the_lowest_node_has_no_gap() {
        let base = Base { wave_height_m: Some(1.0e-6), wave_length_m: Some(0.0075), ..Base::default() };
        let pin = Pin { base, ..Pin::default() };
        let positions = [[0.0, 0.0], [0.0, 0.001], [0.0, 0.002]];
        let gaps = positions.map(initial_gap_m(&pin, &positions));
        assert_eq!(gaps[0], 0.0);
        assert!(gaps[1] > 0.0 && gaps[2] > gaps[1] - 1.0e-6, "{gaps:?}");
    }
}
