//! Colours that the drawings of a sheet share.

use crate::publish::chart::Rgb;
pub(super) use crate::publish::chart::palette::INK;

pub(super) const DISK: Rgb = Rgb(0xE9, 0xEC, 0xEF);
pub(super) const DISK_EDGE: Rgb = Rgb(0x8A, 0x93, 0x9C);

/// The edges of elements.
pub(super) const MESH: Rgb = Rgb(0x9A, 0xAB, 0xBC);
/// The sides of the pin.
pub(super) const TOP: Rgb = Rgb(0xF4, 0xF8, 0xFC);
pub(super) const SIDE: Rgb = Rgb(0xE0, 0xEA, 0xF4);
pub(super) const FRONT: Rgb = Rgb(0xCD, 0xDC, 0xEA);
