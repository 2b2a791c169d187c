//! Colours that the colour-blind can tell apart.

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

/// Okabe and Ito's palette, the ones that show best on white first.
const OKABE_ITO: [RGBColor; 8] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK, YELLOW];

/// Contact states, in the paper's colours as far as the colour-blind can tell them apart: blue sticks, green slips, red
/// is separated.
pub const STICK: RGBColor = BLUE;
/// A node in slip.
pub const SLIP: RGBColor = GREEN;
/// A separated node.
pub const SEPARATED: RGBColor = VERMILLION;

/// Stops of viridis without its yellow end, which is lost on white.
const SEQUENCE: [RGBColor; 5] = [
    RGBColor(0x44, 0x01, 0x54),
    RGBColor(0x3B, 0x52, 0x8B),
    RGBColor(0x21, 0x91, 0x8C),
    RGBColor(0x5E, 0xC9, 0x62),
    RGBColor(0xB5, 0xDE, 0x2B),
];

/// The colour of curve `index` of `count`: distinct ones as long as they last, then a sequence.
pub fn colour(index: usize, count: usize) -> RGBColor {
    if count <= OKABE_ITO.len() {
        return OKABE_ITO[index];
    }
    sequential(index as f64 / (count - 1) as f64)
}

/// The colour of a value, as its share of the way from the smallest to the largest.
pub fn sequential(share: f64) -> RGBColor {
    let at = share.clamp(0.0, 1.0) * (SEQUENCE.len() - 1) as f64;
    let stop = (at as usize).min(SEQUENCE.len() - 2);
    let (from, to, share) = (SEQUENCE[stop], SEQUENCE[stop + 1], at - stop as f64);
    mixed(from, to, share)
}

/// A colour between two.
pub fn mixed(from: RGBColor, to: RGBColor, share: f64) -> RGBColor {
    let mix = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    RGBColor(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

/// Black or white, whichever shows better on a colour.
pub fn ink_on(ground: RGBColor) -> RGBColor {
    let luma = 0.299 * f64::from(ground.0) + 0.587 * f64::from(ground.1) + 0.114 * f64::from(ground.2);
    if luma > 128.0 { BLACK } else { WHITE }
}
