//! Colours that the colour-blind can tell apart.

use plotters::style::RGBColor;

/// Okabe and Ito's palette, the ones that show best on white first.
const OKABE_ITO: [RGBColor; 8] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
    RGBColor(0xE6, 0x9F, 0x00),
    RGBColor(0x56, 0xB4, 0xE9),
    RGBColor(0x00, 0x00, 0x00),
    RGBColor(0xF0, 0xE4, 0x42),
];

/// Black.
pub const BLACK: RGBColor = RGBColor(0, 0, 0);
/// Contact states, in the paper's colours as far as the colour-blind can tell them apart: blue sticks, green slips, red
/// is separated.
pub const STICK: RGBColor = OKABE_ITO[0];
/// A node in slip.
pub const SLIP: RGBColor = OKABE_ITO[2];
/// A separated node.
pub const SEPARATED: RGBColor = OKABE_ITO[1];

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
    sequence(index as f64 / (count - 1) as f64)
}

/// The colour at a share, from 0 to 1, of the sequence from dark to light.
pub fn sequence(share: f64) -> RGBColor {
    let at = share * (SEQUENCE.len() - 1) as f64;
    let stop = (at as usize).min(SEQUENCE.len() - 2);
    let (from, to, share) = (SEQUENCE[stop], SEQUENCE[stop + 1], at - stop as f64);
    let mix = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    RGBColor(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}
