//! Colours that colour-blind readers can tell apart.

use plotters::style::{BLACK, RGBColor, WHITE};

/// A colour of Okabe and Ito's palette.
pub const BLUE: RGBColor = RGBColor(0x00, 0x72, 0xB2);
/// A colour of Okabe and Ito's palette.
pub const VERMILLION: RGBColor = RGBColor(0xD5, 0x5E, 0x00);
/// A colour of Okabe and Ito's palette.
pub const GREEN: RGBColor = RGBColor(0x00, 0x9E, 0x73);
/// A colour of Okabe and Ito's palette.
pub const PURPLE: RGBColor = RGBColor(0xCC, 0x79, 0xA7);
/// A colour of Okabe and Ito's palette.
pub const ORANGE: RGBColor = RGBColor(0xE6, 0x9F, 0x00);
/// A colour of Okabe and Ito's palette.
pub const SKY: RGBColor = RGBColor(0x56, 0xB4, 0xE9);
/// A colour of Okabe and Ito's palette.
pub const YELLOW: RGBColor = RGBColor(0xF0, 0xE4, 0x42);

/// Okabe and Ito's palette; the colours with the best contrast to white come first.
const OKABE_ITO: [RGBColor; 8] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK, YELLOW];

/// Stops of the colour map viridis, without its yellow end, which has too little contrast to white.
const SEQUENCE: [RGBColor; 5] = [
    RGBColor(0x44, 0x01, 0x54),
    RGBColor(0x3B, 0x52, 0x8B),
    RGBColor(0x21, 0x91, 0x8C),
    RGBColor(0x5E, 0xC9, 0x62),
    RGBColor(0xB5, 0xDE, 0x2B),
];

/// The colour of curve `index` of `count`: up to eight distinct colours, and a sequence for more curves.
pub fn colour(index: usize, count: usize) -> RGBColor {
    if count <= OKABE_ITO.len() {
        return OKABE_ITO[index];
    }
    sequential(index as f64 / (count - 1) as f64)
}

/// The colour of a value in a sequence; `share` is 0 for the smallest value and 1 for the largest.
pub fn sequential(share: f64) -> RGBColor {
    let at = share.clamp(0.0, 1.0) * (SEQUENCE.len() - 1) as f64;
    let stop = (at as usize).min(SEQUENCE.len() - 2);
    let (from, to, share) = (SEQUENCE[stop], SEQUENCE[stop + 1], at - stop as f64);
    mix(from, to, share)
}

/// The colour of a value on both sides of zero, from −1 (blue) over 0 (white) to 1 (vermillion).
pub fn diverging(share: f64) -> RGBColor {
    mix(WHITE, if share < 0.0 { BLUE } else { VERMILLION }, share.abs().min(1.0))
}

/// A colour between two: `from` for a share of 0 and `to` for a share of 1.
pub fn mix(from: RGBColor, to: RGBColor, share: f64) -> RGBColor {
    let channel = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    RGBColor(channel(from.0, to.0), channel(from.1, to.1), channel(from.2, to.2))
}

/// Black or white, whichever has the higher contrast to a colour.
pub fn contrasting(ground: RGBColor) -> RGBColor {
    let luma = 0.299 * f64::from(ground.0) + 0.587 * f64::from(ground.1) + 0.114 * f64::from(ground.2);
    if luma > 128.0 { BLACK } else { WHITE }
}
