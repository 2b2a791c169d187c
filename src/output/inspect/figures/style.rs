//! Units of the axes, and how lines and contact states are shown.

use crate::inspect::phases::Phase;
use crate::publish::chart::palette::{self, INK, Rgb};
use crate::publish::chart::{At, Cell, Entry, Guide, Layer, Panel, Pen};
use crate::solver::interface::ContactState;

/// Contact states in the order of legends.
pub(super) const STATES: [ContactState; 3] =
    [ContactState::Stick, ContactState::Slip, ContactState::Separated];

/// The colour of a contact state: the paper's colours where colour-blind readers can tell them apart.
pub(super) fn colour_of(state: ContactState) -> Rgb {
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

/// The line of a quantity.
pub(super) fn thick(colour: Rgb) -> Pen {
    Pen::solid(colour, 2.0)
}

/// A line beside or in front of others.
pub(super) fn fine(colour: Rgb) -> Pen {
    Pen::solid(colour, 1.0)
}

/// Adds a horizontal line at a value.
pub(super) fn add_level(panel: &mut Panel, label: &str, at: f64, right: bool) {
    panel.layers.push(Layer::Guide(Guide { label: label.to_owned(), right, ..Guide::level(at, INK) }));
}

/// Adds vertical lines at times, with their labels.
pub(super) fn add_marks(panel: &mut Panel, marks: impl IntoIterator<Item = (String, f64)>) {
    panel.layers.extend(marks.into_iter().map(|(label, at)| Layer::Guide(Guide::mark(at, &label))));
}

/// The rectangles of phases at a part of the ordinate. `place` is that of a time on the abscissa.
pub(super) fn cells(
    phases: &[Phase],
    place: impl Fn(f64) -> f64,
    y: [f64; 2],
    colour: fn(ContactState) -> Rgb,
) -> impl Iterator<Item = Cell> {
    phases.iter().map(move |phase| Cell {
        x: [place(phase.start_s), place(phase.end_s)],
        y,
        fill: Some(colour(phase.state)),
        ..Cell::default()
    })
}

/// Adds rectangles, and the entries of those states whose colour they have.
pub(super) fn add_cells(panel: &mut Panel, cells: Vec<Cell>, colour: fn(ContactState) -> Rgb) {
    for state in STATES {
        if cells.iter().any(|cell| cell.fill == Some(colour(state))) {
            panel.explain(Entry::cell(colour(state), "", state.name()));
        }
    }
    panel.layers.push(Layer::Cells(cells));
}

/// The end of a part of a line.
pub(super) const BREAK: At = (f64::NAN, f64::NAN);

/// The parts of a path of pairs of points, each joined to the one before if it begins where that ended.
pub(super) fn joined(pairs: impl Iterator<Item = Option<[At; 2]>>) -> Vec<At> {
    let mut path: Vec<At> = Vec::new();
    for pair in pairs {
        match pair {
            Some(pair) => path.extend(pair),
            None if path.last().is_some_and(|last| last.0.is_finite()) => path.push(BREAK),
            None => {}
        }
    }
    path
}
