//! The body of an elastic disk.

use super::check::Violations;
use super::pin::{Element, Pin};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An elastic ring, meshed with hexahedra in (r, θ, z), whose top face is the target of the contact. The nodes of
/// its inner radius turn rigidly at ω and are fixed in z. Defaults to the steel disk of Baillet et al. 2005.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Ring {
    /// Inner radius (m).
    pub inner_radius_m: f64,
    /// Outer radius (m).
    pub outer_radius_m: f64,
    /// Thickness (m).
    pub thickness_m: f64,
    /// Young's modulus (Pa).
    pub young_modulus_pa: f64,
    /// Poisson's ratio, −1 < ν < 0.5.
    pub poisson_ratio: f64,
    /// Density [kg/m³].
    pub density_kg_m3: f64,
    /// Largest edge (m) of the elements under the track.
    pub element_size_m: f64,
    /// Largest edge (m) of the elements far from it.
    pub coarse_element_size_m: f64,
    /// The element.
    #[serde(skip_serializing_if = "Element::is_full")]
    pub element: Element,
    /// Arc [°] that the pin's centre may sweep during the run; under it the mesh is fine. 360: all around.
    pub track_arc_deg: f64,
    /// How the target surface is interpolated between its nodes.
    pub target: TargetSurface,
    /// How the disk's time step is chosen.
    pub clock: DiskTimeStep,
}

/// The target surface between its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TargetSurface {
    /// Four-node quadrilaterals.
    #[default]
    Bilinear,
    /// Bicubic Ferguson patches, with continuous tangents across their edges.
    Ferguson,
}

/// How the disk's time step is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
// The name in the schema is older than that of the type.
#[schemars(rename = "Clock")]
pub enum DiskTimeStep {
    /// The disk takes as many stages in each step of the pin as it needs to be stable.
    #[default]
    Own,
    /// One stage: the step of both bodies is the smaller of the two.
    Common,
}

impl Default for Ring {
    fn default() -> Self {
        Self {
            inner_radius_m: 0.070,
            outer_radius_m: 0.120,
            thickness_m: 0.085,
            young_modulus_pa: 2.1e11,
            poisson_ratio: 0.3,
            density_kg_m3: 7800.0,
            element_size_m: 0.0025,
            coarse_element_size_m: 0.012,
            element: Element::Full,
            track_arc_deg: 25.0,
            target: TargetSurface::Bilinear,
            clock: DiskTimeStep::Own,
        }
    }
}

/// Largest number of elements in one direction: more are taken for a typing error.
const MAX_ELEMENTS: f64 = 2000.0;

/// Estimated number of elements per direction in the transition from the fine to the coarse mesh.
const GRADED_ELEMENTS: f64 = 5.0;

/// Largest number of nodes: about a gigabyte of fields, and days of run time.
const MAX_NODES: f64 = 2.0e6;

/// Relative tolerance when lengths or angles are compared: decimal values are rounded.
pub(super) const ROUNDING: f64 = 1.0 + 1.0e-9;

impl Ring {
    /// Estimated number of nodes of the disk when `pin` slides at the radius `track_m` [m]: the mesh is fine under the
    /// track and coarse elsewhere.
    pub(crate) fn estimated_nodes(&self, pin: &Pin, track_m: f64) -> f64 {
        let (fine, coarse) = (self.element_size_m, self.coarse_element_size_m);
        let nodes_along = |length_m: f64, fine_part_m: f64| {
            fine_part_m.min(length_m) / fine + (length_m - fine_part_m).max(0.0) / coarse + GRADED_ELEMENTS
        };
        let around_m = std::f64::consts::TAU * track_m;
        let around = nodes_along(around_m, around_m * self.track_arc_deg / 360.0 + pin.extent_m()[1]);
        let across = nodes_along(self.outer_radius_m - self.inner_radius_m, pin.extent_m()[0]);
        around * across * nodes_along(self.thickness_m, fine)
    }

    /// Adds every violated limit to `found`, for a disk on which `pin` slides at the radius `track_m` [m].
    pub(super) fn check(&self, pin: &Pin, track_m: f64, found: &mut Violations) {
        let field = |name: &str| format!("scene.disk.ring.{name}");
        for (name, value) in [
            ("inner_radius_m", self.inner_radius_m),
            ("outer_radius_m", self.outer_radius_m),
            ("thickness_m", self.thickness_m),
            ("element_size_m", self.element_size_m),
            ("coarse_element_size_m", self.coarse_element_size_m),
            ("young_modulus_pa", self.young_modulus_pa),
            ("poisson_ratio", self.poisson_ratio),
            ("density_kg_m3", self.density_kg_m3),
            ("track_arc_deg", self.track_arc_deg),
        ] {
            found.within(&field(name), value);
        }
        let (fine, coarse) = (self.element_size_m, self.coarse_element_size_m);
        found.require(
            &field("coarse_element_size_m"),
            coarse,
            coarse >= fine,
            &format!("at least element_size_m = {fine}"),
        );
        let longest = (std::f64::consts::TAU * track_m).max(self.thickness_m).max(self.outer_radius_m);
        found.require(
            &field("element_size_m"),
            fine,
            fine * MAX_ELEMENTS >= longest,
            &format!(
                "at least {:e} m: no more than {MAX_ELEMENTS} elements in a direction",
                longest / MAX_ELEMENTS
            ),
        );
        // The disk must reach one element beyond the pin's corners: the tangents at a patch's corners need its neighbours.
        let [half_x, half_y] = [pin.extent_m()[0] / 2.0, pin.extent_m()[1] / 2.0];
        let (low, high) = (track_m - half_x - fine, libm::hypot(track_m + half_x, half_y) + fine);
        let nodes = self.estimated_nodes(pin, track_m);
        if nodes > MAX_NODES {
            found.add(
                &field("element_size_m"),
                fine,
                format!("larger elements here or in coarse_element_size_m: about {nodes:.1e} nodes, at most {MAX_NODES:.0e}"),
            );
        }
        found.require(
            &field("inner_radius_m"),
            self.inner_radius_m,
            self.inner_radius_m <= low * ROUNDING,
            &format!("at most {low:.6} m, an element inside of the pin's inner side"),
        );
        found.require(
            &field("outer_radius_m"),
            self.outer_radius_m,
            self.outer_radius_m * ROUNDING >= high,
            &format!("at least {high:.6} m, an element outside of the pin's outer corners"),
        );
    }
}
