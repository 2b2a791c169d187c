//! The holder of the pin.

use super::check::Violations;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rigid holder between the pin and the frame of the instrument. In a direction with a stiffness it moves, on a spring and a
/// damper, and carries the clamp's nodes (x, y) or the top face (z) with it. Without a stiffness it is ideal: in x and y
/// the clamp does not move, and in z the top face carries the load without any mass of the holder.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Holder {
    /// Mass (kg) that moves with the pin, in every direction with a stiffness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Stiffness (N/m) to the frame in x. Absent: rigid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_x_n_m: Option<f64>,
    /// Stiffness (N/m) to the frame in y, the sliding direction. Absent: rigid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_y_n_m: Option<f64>,
    /// 0 for a mass that moves with the top face in z. A spring in z would carry a part of the load. Absent: no holder in z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_z_n_m: Option<f64>,
    /// Damper (N s/m) in x. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_x_n_s_m: Option<f64>,
    /// Damper (N s/m) in y. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_y_n_s_m: Option<f64>,
    /// Damper (N s/m) in z. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_z_n_s_m: Option<f64>,
}

/// The spring and the damper of one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HolderDirection {
    /// Mass \[kg\].
    pub mass_kg: f64,
    /// Stiffness \[N/m\].
    pub stiffness_n_m: f64,
    /// Damper \[N s/m\].
    pub damping_n_s_m: f64,
}

impl Holder {
    /// Whether it does not move in any direction, and has no mass.
    pub fn is_ideal(&self) -> bool {
        self.stiffnesses().iter().all(Option::is_none)
    }

    fn stiffnesses(&self) -> [Option<f64>; 3] {
        [self.stiffness_x_n_m, self.stiffness_y_n_m, self.stiffness_z_n_m]
    }

    fn dampings(&self) -> [Option<f64>; 3] {
        [self.damping_x_n_s_m, self.damping_y_n_s_m, self.damping_z_n_s_m]
    }

    /// How it moves in x, y and z; none where it is ideal.
    pub fn directions(&self) -> [Option<HolderDirection>; 3] {
        let dampings = self.dampings();
        let stiffnesses = self.stiffnesses();
        std::array::from_fn(|axis| {
            Some(HolderDirection {
                mass_kg: self.mass_kg.unwrap_or(0.0),
                stiffness_n_m: stiffnesses[axis]?,
                damping_n_s_m: dampings[axis].unwrap_or(0.0),
            })
        })
    }

    /// The longest √(mass over stiffness) \[s\] of its springs with a pin of this mass; 0 without springs.
    pub(super) fn vibration_time_s(&self, pin_kg: f64) -> f64 {
        let of =
            |direction: &HolderDirection| ((direction.mass_kg + pin_kg) / direction.stiffness_n_m).sqrt();
        let has_spring = |direction: &HolderDirection| direction.stiffness_n_m > 0.0;
        self.directions()
            .iter()
            .flatten()
            .filter(|direction| has_spring(direction))
            .map(of)
            .fold(0.0, f64::max)
    }

    /// Adds every violated limit to `found`.
    pub(super) fn check(&self, found: &mut Violations) {
        if let Some(mass) = self.mass_kg {
            found.require("scene.holder.mass_kg", mass, mass >= 0.0, "a mass >= 0 kg");
            found.limit_magnitude("scene.holder.mass_kg", mass);
        }
        let axes = ["x", "y", "z"].into_iter().zip(self.stiffnesses()).zip(self.dampings());
        for ((axis, stiffness), damping) in axes {
            let field = format!("scene.holder.stiffness_{axis}_n_m");
            match stiffness {
                Some(stiffness) => {
                    found.require(&field, stiffness, stiffness >= 0.0, "a stiffness >= 0 N/m");
                    found.limit_magnitude(&field, stiffness);
                }
                None if damping.is_some() => {
                    found.add(
                        &field,
                        "absent",
                        format!("a stiffness beside damping_{axis}_n_s_m; 0 is a damper alone"),
                    );
                }
                None => {}
            }
            if let Some(damping) = damping {
                let field = format!("scene.holder.damping_{axis}_n_s_m");
                found.require(&field, damping, damping >= 0.0, "a damper >= 0 N s/m");
                found.limit_magnitude(&field, damping);
            }
        }
        if let Some(stiffness) = self.stiffness_z_n_m.filter(|stiffness| *stiffness > 0.0) {
            let right =
                "0 N/m, a mass that moves with the load: a spring in z would carry a part of the load";
            found.add("scene.holder.stiffness_z_n_m", stiffness, right);
        }
        if self.mass_kg.is_some() && self.is_ideal() {
            found.add(
                "scene.holder.stiffness_y_n_m",
                "absent",
                "a stiffness in at least one direction: without one the holder is ideal, and mass_kg has no effect",
            );
        }
    }
}
