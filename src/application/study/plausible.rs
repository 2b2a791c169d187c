//! Values of single fields that look as if they were in another unit. They are allowed.

use crate::spec::End::{self, At, Beyond, Open};

/// The values of a field that are no sign of another unit, and what is said of others.
#[derive(Debug)]
pub(super) struct Plausible {
    low: End,
    /// What is said of a value below.
    too_low: &'static str,
    high: End,
    /// What is said of a value above.
    too_high: &'static str,
    /// The advice for both.
    pub help: &'static str,
}

impl Plausible {
    /// What is doubtful about a value, and how far it is out, to compare it with others; none if it is plausible.
    pub fn doubt(&self, value: f64) -> Option<(&'static str, f64)> {
        if !self.low.is_below(value) {
            Some((self.too_low, 1.0 / value))
        } else if !self.high.is_above(value) {
            Some((self.too_high, value))
        } else {
            None
        }
    }
}

/// A Young's modulus \[Pa\]: gels begin above the lower end, and diamond has 1.1e12 Pa.
pub(super) static MODULUS: Plausible = Plausible {
    low: At(1.0e4),
    too_low: "softer than any gel, as if it were in GPa or MPa; expected Pa",
    high: At(1.5e12),
    too_high: "stiffer than diamond (1.1e12 Pa); expected Pa",
    help: "1 GPa is 1e9 Pa, and 1 MPa (1 N/mm²) is 1e6 Pa",
};

/// A density \[kg/m³\] of a solid: cork and balsa are above the lower end.
pub(super) static DENSITY: Plausible = Plausible {
    low: At(100.0),
    too_low: "lighter than cork, as if it were in g/cm³; expected kg/m³",
    high: At(25_000.0),
    too_high: "heavier than osmium (22 600 kg/m³); expected kg/m³",
    help: "1 g/cm³ is 1000 kg/m³",
};

/// Lengths from which on millimetres are suspected \[m\].
pub(super) const LONGEST_M: f64 = 1.0;

/// A length of a pin, a disk or a clamp \[m\].
pub(super) static LENGTH: Plausible = Plausible {
    low: Open,
    too_low: "",
    high: Beyond(LONGEST_M),
    too_high: "a length of a metre or more, as if it were in mm; expected m",
    help: "1 mm is 0.001 m",
};

/// The mass \[kg\] of a holder: what moves with a pin has some grams to ten kilograms, those of the rig in `studies/rig.json`.
pub(super) static HOLDER_MASS: Plausible = Plausible {
    low: Open,
    too_low: "",
    high: At(10.0),
    too_high: "heavier than what moves with a pin, as if it were in g; expected kg",
    help: "1 g is 0.001 kg",
};

/// A friction coefficient.
pub(super) static FRICTION: Plausible = Plausible {
    low: Open,
    too_low: "",
    high: At(2.0),
    too_high: "an unusually large friction coefficient",
    help: "expected a number, not per cent",
};
