//! The rotating disk.

use super::check::Violations;
use super::pin::Pin;
use super::ring::Ring;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// What the disk is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DiskKind {
    /// A rigid plane that turns about the disk's axis.
    #[default]
    Rigid,
    /// An elastic ring, whose body is `ring`.
    Elastic,
}

/// The rotating disk. Its surface moves towards +y under the pin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Disk {
    /// What the disk is made of.
    pub kind: DiskKind,
    /// Rotation speed ω [revolutions per minute], > 0: constant, or the largest one of a program.
    pub omega_rpm: f64,
    /// Distance R (m) of the pin's centre from the axis.
    pub track_radius_m: f64,
    /// Amplitude (m) of the axial run-out of a rigid disk: its surface rises and falls once in a revolution. Absent: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub runout_m: Option<f64>,
    /// Amplitude (m) of the waviness of a rigid disk around its axis. Absent: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waviness_height_m: Option<f64>,
    /// Number of waves of the waviness in a revolution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waviness_count: Option<u32>,
    /// The body of an elastic disk; a rigid one does not use it.
    pub ring: Ring,
}

impl Default for Disk {
    fn default() -> Self {
        Self {
            kind: DiskKind::Rigid,
            omega_rpm: 7.0,
            track_radius_m: 0.0914,
            runout_m: None,
            waviness_height_m: None,
            waviness_count: None,
            ring: Ring::default(),
        }
    }
}

/// Largest slope of the surface. The model has its heights, but not its slopes.
const STEEPEST: f64 = 0.1;

impl Disk {
    /// Whether the surface is a plane.
    pub fn is_plane(&self) -> bool {
        self.waves().is_empty()
    }

    /// The amplitude \[m\] and the number of waves in a revolution, of the run-out and of the waviness, where they are not zero.
    pub fn waves(&self) -> Vec<(f64, u32)> {
        let runout = self.runout_m.map(|height_m| (height_m, 1));
        let waviness = self.waviness_height_m.zip(self.waviness_count);
        runout.into_iter().chain(waviness).filter(|(height_m, _)| *height_m != 0.0).collect()
    }

    /// The same disk without run-out and waviness of no height.
    #[must_use]
    pub fn in_use(&self) -> Self {
        let is_wavy = self.waviness_height_m.is_some_and(|height_m| height_m != 0.0);
        Self {
            runout_m: self.runout_m.filter(|height_m| *height_m != 0.0),
            waviness_height_m: self.waviness_height_m.filter(|_| is_wavy),
            waviness_count: self.waviness_count.filter(|_| is_wavy),
            ..self.clone()
        }
    }

    /// Adds every violated limit to `found`.
    pub(super) fn check(&self, pin: &Pin, found: &mut Violations) {
        found.within("scene.disk.omega_rpm", self.omega_rpm);
        let radius = self.track_radius_m;
        found.require(
            "scene.disk.track_radius_m",
            radius,
            radius > pin.extent_m()[0] / 2.0,
            "a radius larger than half the pin's width, so that the pin does not lie over the axis",
        );
        found.limit_magnitude("scene.disk.track_radius_m", radius);
        self.check_surface(pin, found);
        if self.kind == DiskKind::Elastic {
            self.ring.check(pin, radius, found);
        }
    }

    fn check_surface(&self, pin: &Pin, found: &mut Violations) {
        let count = self.waviness_count;
        let heights = [
            ("scene.disk.runout_m", self.runout_m, Some(1)),
            ("scene.disk.waviness_height_m", self.waviness_height_m, count),
        ];
        // The slope is largest at the inner edge of the pin's base.
        let inner_m = self.track_radius_m - 0.5 * pin.extent_m()[0];
        for (field, height, count) in heights {
            let Some(height) = height else { continue };
            found.within(field, height);
            let highest_m = STEEPEST * inner_m / f64::from(count.unwrap_or(1).max(1));
            if inner_m > 0.0 && height.is_finite() && height > highest_m {
                let right = format!(
                    "at most {highest_m:.3e} m, with which no slope under the pin is above {STEEPEST}: slopes are neglected"
                );
                found.add(field, super::check::readable(height), right);
            }
            if self.kind == DiskKind::Elastic && height != 0.0 {
                found.add(
                    field,
                    super::check::readable(height),
                    "0 with an elastic disk: run-out and waviness are those of a rigid disk",
                );
            }
        }
        match (self.waviness_height_m, count) {
            (Some(_), None) => {
                found.add(
                    "scene.disk.waviness_count",
                    "absent",
                    "a number of waves beside waviness_height_m",
                );
            }
            (None, Some(_)) => {
                found.add("scene.disk.waviness_height_m", "absent", "a height beside waviness_count");
            }
            _ => {}
        }
        if let Some(count) = count {
            let shortest_m = super::base::ELEMENTS_OF_WAVE * pin.element_edges_m()[1];
            let most = TAU * self.track_radius_m / shortest_m;
            if count == 0 || f64::from(count) > most {
                let right = format!(
                    "a number from 1 to {}: a wave has at least {} elements",
                    most.floor(),
                    super::base::ELEMENTS_OF_WAVE
                );
                found.add("scene.disk.waviness_count", count, right);
            }
        }
    }
}
