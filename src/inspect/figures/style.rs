//! Units of the axes, and how contact states are shown.

use crate::publish::plot::palette;
use crate::solver::interface::ContactState;
use plotters::style::RGBColor;

/// Contact states in the order of legends.
pub(super) const STATES: [ContactState; 3] =
    [ContactState::Stick, ContactState::Slip, ContactState::Separated];

/// The position in legends of an entry that has the name of a state.
pub(super) fn legend_position(label: &str) -> Option<usize> {
    STATES.iter().position(|state| state.name() == label)
}

/// The colour of a contact state: the paper's colours where colour-blind readers can tell them apart.
pub(super) fn colour_of(state: ContactState) -> RGBColor {
    match state {
        ContactState::Stick => palette::BLUE,
        ContactState::Slip => palette::GREEN,
        ContactState::Separated => palette::VERMILLION,
    }
}

/// Micrometres per metre, microseconds per second.
pub(super) const MICRO: f64 = 1e6;
/// Millimetres per metre.
pub(super) const MILLI: f64 = 1e3;
/// Megapascals per pascal.
pub(super) const MEGA: f64 = 1e-6;
