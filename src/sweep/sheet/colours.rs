//! Colours that the drawings of a sheet share.

use crate::publish::plot::RGBColor;

pub(super) const INK: RGBColor = RGBColor(0x1B, 0x1F, 0x24);
pub(super) const DISK: RGBColor = RGBColor(0xE9, 0xEC, 0xEF);
pub(super) const DISK_EDGE: RGBColor = RGBColor(0x8A, 0x93, 0x9C);
