//! The holder of the pin.

use super::check::Violations;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rigid holder between the pin and the frame of the instrument. In a direction with a stiffness it moves, on a spring and a
/// damper, and carries the clamp's nodes (x, y) or the top face (z) with it. Without a stiffness it is ideal: in x and y
/// the clamp does not move, and in z the top face carries the load without any mass of the holder. With a rotational stiffness the
/// top face rotates as a plane.
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
    /// Rotational stiffness (N m/rad) about x, with which the pin rocks in the sliding direction. Absent: it does not rotate about x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotational_stiffness_x_nm_rad: Option<f64>,
    /// Rotational stiffness (N m/rad) about y. Absent: it does not rotate about y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotational_stiffness_y_nm_rad: Option<f64>,
    /// Rotational damper (N m s/rad) about x. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotational_damping_x_nm_s_rad: Option<f64>,
    /// Rotational damper (N m s/rad) about y. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotational_damping_y_nm_s_rad: Option<f64>,
    /// Moment of inertia (kg m²) of the holder about x. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia_x_kg_m2: Option<f64>,
    /// Moment of inertia (kg m²) of the holder about y. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia_y_kg_m2: Option<f64>,
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

/// How slowly a pin moves with its holder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowTimes {
    /// About the longest period \[s\] of a swing, rather too long than too short.
    pub swing_s: f64,
    /// The longest time \[s\] in which a motion without a swing falls to 1/e; 0 without dampers.
    pub relaxation_s: f64,
}

impl Holder {
    /// Whether it does not move in any direction, and has no mass.
    pub fn is_ideal(&self) -> bool {
        self.stiffnesses().iter().all(Option::is_none) && !self.rotates()
    }

    /// Whether it rotates about x or y.
    pub fn rotates(&self) -> bool {
        self.rotations().iter().any(Option::is_some)
    }

    /// How it rotates about x and y, with inertia \[kg m²\], stiffness \[N m/rad\] and damper \[N m s/rad\] in place of those in a
    /// direction; none where it does not.
    pub fn rotations(&self) -> [Option<HolderDirection>; 2] {
        let of = |inertia: Option<f64>, stiffness: Option<f64>, damping: Option<f64>| {
            Some(HolderDirection {
                mass_kg: inertia.unwrap_or(0.0),
                stiffness_n_m: stiffness?,
                damping_n_s_m: damping.unwrap_or(0.0),
            })
        };
        [
            of(self.inertia_x_kg_m2, self.rotational_stiffness_x_nm_rad, self.rotational_damping_x_nm_s_rad),
            of(self.inertia_y_kg_m2, self.rotational_stiffness_y_nm_rad, self.rotational_damping_y_nm_s_rad),
        ]
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

    /// Gives each spring the damper of this share of critical damping, with a rigid uniform pin of this mass and of these edges \[m\] below the
    /// axes of rotation. Returns whether there is a spring.
    pub fn damp(&mut self, ratio: f64, pin_kg: f64, extent_m: [f64; 3]) -> bool {
        let damper = |way: Option<HolderDirection>, pin: f64| {
            let way = way.filter(|way| way.stiffness_n_m > 0.0)?;
            Some(2.0 * ratio * (way.stiffness_n_m * (way.mass_kg + pin)).sqrt())
        };
        let [x, y, z] = self.directions().map(|way| damper(way, pin_kg));
        let [x_m, y_m, height_m] = extent_m;
        let inertia = |across_m: f64| pin_kg * (height_m * height_m / 3.0 + across_m * across_m / 12.0);
        let [way_x, way_y] = self.rotations();
        let [about_x, about_y] = [damper(way_x, inertia(y_m)), damper(way_y, inertia(x_m))];
        for (field, damper) in [
            (&mut self.damping_x_n_s_m, x),
            (&mut self.damping_y_n_s_m, y),
            (&mut self.damping_z_n_s_m, z),
            (&mut self.rotational_damping_x_nm_s_rad, about_x),
            (&mut self.rotational_damping_y_nm_s_rad, about_y),
        ] {
            *field = damper.or(*field);
        }
        [x, y, z, about_x, about_y].iter().any(Option::is_some)
    }

    /// The longest √(mass over stiffness) \[s\] of its springs with a pin of this mass, and of this height \[m\] below the axes of
    /// rotation; 0 without springs.
    pub(super) fn vibration_time_s(&self, pin_kg: f64, height_m: f64) -> f64 {
        let of = |way: HolderDirection, pin: f64| ((way.mass_kg + pin) / way.stiffness_n_m).sqrt();
        let has_spring = |way: &HolderDirection| way.stiffness_n_m > 0.0;
        let along = self.directions().into_iter().flatten().filter(has_spring).map(|way| of(way, pin_kg));
        let rod = pin_kg * height_m * height_m / 3.0;
        let about = self.rotations().into_iter().flatten().filter(has_spring).map(|way| of(way, rod));
        along.chain(about).fold(0.0, f64::max)
    }

    /// The sum of mass over stiffness \[s²\] of its springs, with a pin of this mass and height below the axes of rotation.
    pub(super) fn sum_of_squares_s2(&self, pin_kg: f64, height_m: f64) -> f64 {
        let of = |way: HolderDirection, pin: f64| (way.mass_kg + pin) / way.stiffness_n_m;
        let has_spring = |way: &HolderDirection| way.stiffness_n_m > 0.0;
        let along = self.directions().into_iter().flatten().filter(has_spring).map(|way| of(way, pin_kg));
        let rod = pin_kg * height_m * height_m / 3.0;
        let about = self.rotations().into_iter().flatten().filter(has_spring).map(|way| of(way, rod));
        along.chain(about).sum()
    }

    /// How far \[m/N\] its springs let the base of a pin of this height move in y under a unit force.
    pub(super) fn softness_y_m_n(&self, height_m: f64) -> f64 {
        let of = |way: Option<HolderDirection>, lever: f64| {
            let stiffness = way.map(|way| way.stiffness_n_m).filter(|stiffness| *stiffness > 0.0);
            stiffness.map_or(0.0, |stiffness| lever * lever / stiffness)
        };
        of(self.directions()[1], 1.0) + of(self.rotations()[0], height_m)
    }

    /// The longest time \[s\] in which its dampers let a motion without a swing fall to 1/e, with a pin of this mass and height:
    /// d/k of a spring with a damper, m/d of a damper alone.
    pub(super) fn relaxation_time_s(&self, pin_kg: f64, height_m: f64) -> f64 {
        let of = |way: HolderDirection, pin: f64| match way {
            HolderDirection { damping_n_s_m: 0.0, .. } => 0.0,
            HolderDirection { stiffness_n_m: 0.0, mass_kg, damping_n_s_m } => (mass_kg + pin) / damping_n_s_m,
            HolderDirection { stiffness_n_m, damping_n_s_m, .. } => damping_n_s_m / stiffness_n_m,
        };
        let along = self.directions().into_iter().flatten().map(|way| of(way, pin_kg));
        let rod = pin_kg * height_m * height_m / 3.0;
        let about = self.rotations().into_iter().flatten().map(|way| of(way, rod));
        along.chain(about).fold(0.0, f64::max)
    }

    /// Adds every violated limit to `found`.
    pub(super) fn check(&self, found: &mut Violations) {
        found.within_if_given("scene.holder.mass_kg", self.mass_kg);
        let axes = ["x", "y", "z"].into_iter().zip(self.stiffnesses()).zip(self.dampings());
        for ((axis, stiffness), damping) in axes {
            let field = format!("scene.holder.stiffness_{axis}_n_m");
            match stiffness {
                Some(stiffness) => _ = found.within(&field, stiffness),
                None if damping.is_some() => {
                    found.add(
                        &field,
                        "absent",
                        format!("a stiffness beside damping_{axis}_n_s_m; 0 is a damper alone"),
                    );
                }
                None => {}
            }
            found.within_if_given(&format!("scene.holder.damping_{axis}_n_s_m"), damping);
        }
        self.check_rotations(found);
        if self.mass_kg.is_some() && self.stiffnesses().iter().all(Option::is_none) {
            found.add(
                "scene.holder.stiffness_y_n_m",
                "absent",
                "a stiffness in x, y or z beside mass_kg, which otherwise has no effect; stiffness_z_n_m = 0 is a mass that moves with the top \
                 face",
            );
        }
    }

    fn check_rotations(&self, found: &mut Violations) {
        let ways = [
            (
                "x",
                self.rotational_stiffness_x_nm_rad,
                self.rotational_damping_x_nm_s_rad,
                self.inertia_x_kg_m2,
            ),
            (
                "y",
                self.rotational_stiffness_y_nm_rad,
                self.rotational_damping_y_nm_s_rad,
                self.inertia_y_kg_m2,
            ),
        ];
        for (axis, stiffness, damping, inertia) in ways {
            let field = format!("scene.holder.rotational_stiffness_{axis}_nm_rad");
            found.within_if_given(&field, stiffness);
            found.within_if_given(&format!("scene.holder.rotational_damping_{axis}_nm_s_rad"), damping);
            found.within_if_given(&format!("scene.holder.inertia_{axis}_kg_m2"), inertia);
            if stiffness.is_none() && (damping.is_some() || inertia.is_some()) {
                let right = "a rotational stiffness, which may be 0, beside its damper and its inertia";
                found.add(&field, "absent", right);
            }
        }
    }
}
