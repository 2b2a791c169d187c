//! The scene: pin, disk, contact law, boundary conditions and load.

use super::check::{Violations, readable};
use super::contact::Contact;
use super::disk::{Disk, DiskKind};
use super::elasticity;
use super::holder::{Holder, SlowTimes};
use super::limit::LEAST_LOAD_N;
use super::pin::{Pin, Shape};
use super::program::Program;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use strum::{IntoStaticStr, VariantArray};

/// A pin pressed on a rotating disk. Defaults to the reference scene (Baillet et al. 2005, tables 1 and 2).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Scene {
    /// The deformable pin.
    pub pin: Pin,
    /// The disk it slides on.
    pub disk: Disk,
    /// Contact and friction.
    pub contact: Contact,
    /// Which nodes of the pin's top face are held in x and y.
    pub clamp: Clamp,
    /// How the pin's top face moves in z.
    pub top: TopFace,
    /// The holder of the pin.
    pub holder: Holder,
    /// The normal load on the pin's top face.
    pub load: Load,
    /// How the speed of the disk and the load change in time.
    #[serde(skip_serializing_if = "Program::is_constant")]
    pub program: Program,
}

/// Where on the top face the clamp is.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Serialize,
    Deserialize,
    JsonSchema,
    IntoStaticStr,
    VariantArray,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum ClampSide {
    /// A strip along the −x side, nearest the disk's axis.
    #[default]
    InnerSide,
    /// A strip along the +x side.
    OuterSide,
    /// A strip along the −y end, which meets the moving disk first.
    LeadingEnd,
    /// A strip along the +y end.
    TrailingEnd,
    /// Strips along the −x and +x sides.
    BothSides,
    /// Strips along the −y and +y ends.
    BothEnds,
    /// The whole top face; the width is not used.
    WholeTop,
    /// A collet round the side of the pin, from the top face down over the width. The inside of the top face is free.
    Collet,
}

impl ClampSide {
    /// All of them, in the order of their declaration.
    pub const ALL: &[Self] = <Self as VariantArray>::VARIANTS;

    /// The name used in study files, e.g. `inner_side`.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The direction, 0 for x, 1 for y and 2 for z, across which the strip has its width; none for the whole top.
    pub fn axis_across(self) -> Option<usize> {
        match self {
            Self::InnerSide | Self::OuterSide | Self::BothSides => Some(0),
            Self::LeadingEnd | Self::TrailingEnd | Self::BothEnds => Some(1),
            Self::WholeTop => None,
            Self::Collet => Some(2),
        }
    }
}

/// A clamp: the nodes of the top face within a strip, or round the side of the pin, are held in x and y.
///
/// The strip is a width in metres, so that it means the same on every mesh; a mesh without a node
/// row near that width is refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Clamp {
    /// Where the strip is.
    pub side: ClampSide,
    /// Width (m) of the strip, measured from the edge to the last held node row.
    pub width_m: f64,
}

impl Default for Clamp {
    fn default() -> Self {
        Self { side: ClampSide::InnerSide, width_m: 0.001 }
    }
}

/// How the pin's top face moves in z.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TopFace {
    /// All top nodes share one z displacement; the total normal load acts on it.
    #[default]
    TiedInZ,
    /// Every top node moves freely in z under its tributary share of the load.
    FreeInZ,
}

/// The normal load, ramped linearly from zero and then constant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Load {
    /// Total normal load F (N), pressing the pin towards the disk: after the ramp, or the largest one of a program.
    pub force_n: f64,
    /// Duration (s) of the linear ramp; 0 is a sudden load. Absent in a study: 0.0005 for the pin of the reference scene, in
    /// proportion to their slowest vibrations for other pins; half of `limit_s` if it would not be shorter than that.
    pub ramp_s: f64,
}

impl Default for Load {
    fn default() -> Self {
        Self { force_n: 30.0, ramp_s: 5.0e-4 }
    }
}

/// Times of a creep by friction over which a state must stay the same.
const CREEPS: f64 = 3.0;

impl Scene {
    /// Time \[s\] that the slowest vibrations scale with: the time in which a shear wave crosses the pin's longest
    /// edge, or the longest length ℓ²/h of a part that bends, or √(mass over stiffness) of the holder. NaN for an unphysical material.
    ///
    /// A part of length ℓ and thickness h in the direction of bending has its lowest frequency at about 0.16 c h/ℓ², with
    /// the wave speed c: a slender pin swings more slowly than any wave runs through it. The pin's height bends below
    /// its top face, in x and in y. What is beside a clamped strip bends across it, in the face's plane. In z nothing bends,
    /// because the disk and the top face guide it.
    pub fn vibration_time_s(&self) -> f64 {
        let wave_s = self.wave_time_s();
        let [x, y, z] = self.pin.extent_m();
        let holder_s = self.holder.vibration_time_s(self.pin.density_kg_m3 * x * y * z, z);
        // NaN must remain.
        if holder_s > wave_s { holder_s } else { wave_s }
    }

    /// That time of the pin alone.
    fn wave_time_s(&self) -> f64 {
        let pin = &self.pin;
        let [x, y, z] = pin.extent_m();
        let beside_strip_m = match self.clamp.side.axis_across() {
            Some(0) => x * x / y,
            Some(1) => y * y / x,
            Some(_) | None => 0.0,
        };
        let longest_m = x.max(y).max(z).max(z * z / x.min(y)).max(beside_strip_m);
        // The frequency 0.16 c/ℓ is that of an oscillator with √(m/k) = ℓ/c.
        longest_m
            / elasticity::shear_wave_speed_m_s(pin.young_modulus_pa, pin.poisson_ratio, pin.density_kg_m3)
    }

    /// How slowly the pin moves with its holder and under its friction law; none if the holder is ideal and friction has no damper.
    ///
    /// The squares of the periods of oscillators are added: the holder with a rigid pin on each of its springs, the pin alone, and the
    /// holder's mass on the elastic pin. By Dunkerley's formula the true period is about that or shorter.
    pub fn slow_times(&self) -> Option<SlowTimes> {
        let creep_s = self.friction_creep_s();
        let moves = !self.holder.is_ideal();
        if !moves && creep_s == 0.0 {
            return None;
        }
        let [x, y, z] = self.pin.extent_m();
        let pin_kg = self.pin.density_kg_m3 * x * y * z;
        let on_pin_s = (self.holder.mass_kg.unwrap_or(0.0) * z / (self.shear_modulus_pa() * x * y)).sqrt();
        let alone_s = self.wave_time_s();
        let sum_s2 = self.holder.sum_of_squares_s2(pin_kg, z) + alone_s * alone_s + on_pin_s * on_pin_s;
        Some(SlowTimes {
            swing_s: if moves { TAU * sum_s2.sqrt() } else { 0.0 },
            relaxation_s: self.holder.relaxation_time_s(pin_kg, z) + CREEPS * creep_s,
        })
    }

    fn shear_modulus_pa(&self) -> f64 {
        self.pin.young_modulus_pa / (2.0 * (1.0 + self.pin.poisson_ratio))
    }

    /// The time \[s\] in which a friction that rises with the speed lets a displacement of the base fall to 1/e: the damper F ∂μ/∂v over the stiffness of the
    /// pin in shear, of which a strip as the clamp leaves about a half, and the springs of the holder. 0 for the other laws.
    fn friction_creep_s(&self) -> f64 {
        let speed_m_s = self.disk.omega_rpm * TAU / 60.0 * self.disk.track_radius_m;
        let slope_s_m = self.contact.viscous_part_s_m(speed_m_s);
        let [x, y, z] = self.pin.extent_m();
        let softness_m_n = 2.0 * z / (self.shear_modulus_pa() * x * y) + self.holder.softness_y_m_n(z);
        let creep_s = self.load.force_n * slope_s_m * softness_m_n;
        if creep_s.is_finite() { creep_s } else { 0.0 }
    }

    /// Sets the speed and the load to the largest ones of the program, as far as it changes them and `keeps` [speed, load] does
    /// not forbid it.
    pub fn take_largest_of_program(&mut self, keeps: [bool; 2]) {
        let Self { program, disk, load, .. } = self;
        program.raise([&mut disk.omega_rpm, &mut load.force_n], keeps);
    }

    /// Adds every violated limit of the program in a run of `limit_s` to `found`.
    pub(super) fn check_program(&self, limit_s: f64, found: &mut Violations) {
        let constants = [self.disk.omega_rpm, self.load.force_n];
        // The angle of the disk is then the rate times the time.
        let needs_constant_speed = self.disk.kind == DiskKind::Elastic || !self.disk.is_plane();
        self.program.check(limit_s, constants, needs_constant_speed, found);
    }

    /// Adds every violated limit to `found`.
    pub(super) fn check(&self, found: &mut Violations) {
        let pin = &self.pin;
        pin.check(found);
        self.disk.check(pin, found);
        self.contact.check(found);
        self.holder.check(found);
        if self.top == TopFace::FreeInZ
            && let Some(stiffness) = self.holder.stiffness_z_n_m
        {
            let right = "absent, or scene.top = tied_in_z: a rigid holder carries all top nodes alike";
            found.add("scene.holder.stiffness_z_n_m", stiffness, right);
        }
        for (axis, _) in ["x", "y"].into_iter().zip(self.holder.rotations()).filter(|(_, way)| way.is_some())
        {
            if self.top == TopFace::FreeInZ {
                let field = format!("scene.holder.rotational_stiffness_{axis}_nm_rad");
                let right =
                    "absent, or scene.top = tied_in_z: a rigid holder carries all top nodes as a plane";
                found.add(&field, "given", right);
            }
        }
        let width = self.clamp.width_m;
        found.within("scene.clamp.width_m", width);
        if let Some(axis) = self.clamp.side.axis_across().filter(|_| self.pin.shape != Shape::Mesh) {
            // A pin of a wrong size is refused for that.
            let edge = self.pin.extent_m()[axis];
            if edge > 0.0 && width > edge * (1.0 + 1.0e-9) {
                let right = format!(
                    "a width in metres (1 mm is 0.001 m) of at most {} m, the pin's edge in {}",
                    readable(edge),
                    ["x", "y", "z"][axis]
                );
                found.add("scene.clamp.width_m", readable(width), right);
            }
        }
        if self.clamp.side == ClampSide::Collet {
            if width == 0.0 {
                found.add("scene.clamp.width_m", width, "a length > 0 m that the collet holds");
            }
            if self.holder.rotates() {
                let right = "another side with a holder that rotates, which carries the top face alone; \
                             for a chuck, give the pin without its gripped part, and whole_top";
                found.add("scene.clamp.side", self.clamp.side.name(), right);
            }
        }
        let force = self.load.force_n;
        if force > 0.0 && force < LEAST_LOAD_N {
            let right =
                format!("at least {LEAST_LOAD_N:e} N: the energies of less are below the range of numbers");
            found.add("scene.load.force_n", readable(force), right);
        } else {
            found.within("scene.load.force_n", force);
        }
        found.within("scene.load.ramp_s", self.load.ramp_s);
    }
}
