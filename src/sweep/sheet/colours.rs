//! Colours that the drawings of a sheet share.

use crate::publish::plot::RGBColor;

pub(super) const INK: RGBColor = RGBColor(0x1B, 0x1F, 0x24);
pub(super) const DISK: RGBColor = RGBColor(0xE9, 0xEC, 0xEF);
pub(super) const DISK_EDGE: RGBColor = RGBColor(0x8A, 0x93, 0x9C);

/// The edges of elements.
pub(super) const MESH: RGBColor = RGBColor(0x9A, 0xAB, 0xBC);
/// The sides of the pin.
pub(super) const TOP: RGBColor = RGBColor(0xF4, 0xF8, 0xFC);
pub(super) const SIDE: RGBColor = RGBColor(0xE0, 0xEA, 0xF4);
pub(super) const FRONT: RGBColor = RGBColor(0xCD, 0xDC, 0xEA);
