//! Colours that colour-blind readers can tell apart.

/// A colour: red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Rgb(pub u8, pub u8, pub u8);

impl std::fmt::Display for Rgb {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{:02X}{:02X}{:02X}", self.0, self.1, self.2)
    }
}

/// Lines and text. A page shows them light where the reader's system is dark.
pub const INK: Rgb = Rgb(0, 0, 0);
/// The ground. A page shows it dark where the reader's system is dark.
pub const PAPER: Rgb = Rgb(0xFF, 0xFF, 0xFF);
/// Lines of a grid. They change with the ground.
pub const GRID: Rgb = Rgb(0xE4, 0xE4, 0xE4);
/// What belongs to no series.
pub const GREY: Rgb = Rgb(0x70, 0x70, 0x70);
/// A cell without a value.
pub const NO_VALUE: Rgb = Rgb(0xEC, 0xEC, 0xEC);
/// Text and marks on a light cell, which stay dark on a dark page.
pub const DARK: Rgb = Rgb(0x11, 0x11, 0x11);
/// Text on a dark cell, which stays light on paper.
pub const LIGHT: Rgb = Rgb(0xFE, 0xFE, 0xFE);

/// A colour of Okabe and Ito's palette.
pub const BLUE: Rgb = Rgb(0x00, 0x72, 0xB2);
/// A colour of Okabe and Ito's palette.
pub const VERMILLION: Rgb = Rgb(0xD5, 0x5E, 0x00);
/// A colour of Okabe and Ito's palette.
pub const GREEN: Rgb = Rgb(0x00, 0x9E, 0x73);
/// A colour of Okabe and Ito's palette.
pub const PURPLE: Rgb = Rgb(0xCC, 0x79, 0xA7);
/// A colour of Okabe and Ito's palette.
pub const ORANGE: Rgb = Rgb(0xE6, 0x9F, 0x00);
/// A colour of Okabe and Ito's palette.
pub const SKY: Rgb = Rgb(0x56, 0xB4, 0xE9);
/// A colour of Okabe and Ito's palette.
pub const YELLOW: Rgb = Rgb(0xF0, 0xE4, 0x42);

/// Okabe and Ito's palette; the colours with the best contrast to white come first.
const OKABE_ITO: [Rgb; 8] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, INK, YELLOW];

/// Stops of the colour map viridis, without its yellow end, which has too little contrast to white.
const SEQUENCE: [Rgb; 5] = [
    Rgb(0x44, 0x01, 0x54),
    Rgb(0x3B, 0x52, 0x8B),
    Rgb(0x21, 0x91, 0x8C),
    Rgb(0x5E, 0xC9, 0x62),
    Rgb(0xB5, 0xDE, 0x2B),
];

/// The colour of curve `index` of `count`: up to eight distinct colours, and a sequence for more curves.
pub fn colour(index: usize, count: usize) -> Rgb {
    if count <= OKABE_ITO.len() {
        return OKABE_ITO[index];
    }
    sequential(index as f64 / (count - 1) as f64)
}

/// The colour of a value in a sequence; `share` is 0 for the smallest value and 1 for the largest.
pub fn sequential(share: f64) -> Rgb {
    let at = share.clamp(0.0, 1.0) * (SEQUENCE.len() - 1) as f64;
    let stop = (at as usize).min(SEQUENCE.len() - 2);
    let (from, to, share) = (SEQUENCE[stop], SEQUENCE[stop + 1], at - stop as f64);
    mix(from, to, share)
}

/// The colour of a value on both sides of zero, from −1 (blue) over 0 (white) to 1 (vermillion).
pub fn diverging(share: f64) -> Rgb {
    mix(LIGHT, if share < 0.0 { BLUE } else { VERMILLION }, share.abs().min(1.0))
}

/// A colour between two: `from` for a share of 0 and `to` for a share of 1.
pub fn mix(from: Rgb, to: Rgb, share: f64) -> Rgb {
    let channel = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    Rgb(channel(from.0, to.0), channel(from.1, to.1), channel(from.2, to.2))
}

/// Dark or light text, whichever has the higher contrast to a colour.
pub fn contrasting(ground: Rgb) -> Rgb {
    let luma = 0.299 * f64::from(ground.0) + 0.587 * f64::from(ground.1) + 0.114 * f64::from(ground.2);
    if luma > 128.0 { DARK } else { LIGHT }
}

/// A colour light enough to be the ground of curves.
pub fn lightened(colour: Rgb) -> Rgb {
    mix(LIGHT, colour, 0.25)
}
