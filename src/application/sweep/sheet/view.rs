//! The view of a scene: obliquely from above.

use crate::publish::chart::At;

/// The part of the sheet for the bodies: left, top, right, bottom [px]. The rest is for texts.
const FRAME: [f64; 4] = [70.0, 92.0, 500.0, 400.0];

/// From positions in the scene [m] to positions on the sheet.
pub(super) struct View {
    pub(super) scale: f64,
    shift: At,
}

/// The directions of x, y and z on the sheet, for an eye above the +x side and somewhat before the −y end.
pub(super) const DIRECTIONS: [At; 3] = [(0.57, 0.35), (0.82, -0.24), (0.0, -0.91)];

fn oblique([x, y, z]: [f64; 3]) -> At {
    let along =
        |pick: fn(At) -> f64| x * pick(DIRECTIONS[0]) + y * pick(DIRECTIONS[1]) + z * pick(DIRECTIONS[2]);
    (along(|d| d.0), along(|d| d.1))
}

impl View {
    /// The view in which these positions fill the frame.
    pub(super) fn of(points: &[[f64; 3]]) -> Self {
        let flat: Vec<At> = points.iter().map(|point| oblique(*point)).collect();
        let ends = |pick: fn(&At) -> f64| {
            flat.iter()
                .map(pick)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
        };
        let ((left, right), (top, bottom)) = (ends(|at| at.0), ends(|at| at.1));
        let scale = ((FRAME[2] - FRAME[0]) / (right - left)).min((FRAME[3] - FRAME[1]) / (bottom - top));
        let middle = |low: f64, high: f64| f64::midpoint(low, high);
        Self {
            scale,
            shift: (
                middle(FRAME[0], FRAME[2]) - scale * middle(left, right),
                middle(FRAME[1], FRAME[3]) - scale * middle(top, bottom),
            ),
        }
    }

    pub(super) fn at(&self, point: [f64; 3]) -> At {
        let (u, v) = oblique(point);
        (u * self.scale + self.shift.0, v * self.scale + self.shift.1)
    }
}
