//! The axes of charts for the drawing library.

pub use crate::publish::chart::Axis;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

impl Axis {
    /// Length of the longest tick label, in characters.
    pub fn longest_label(&self) -> usize {
        self.labelled_ticks().iter().map(|(_, label)| label.chars().count()).max().unwrap_or(0)
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        (f64::from(from) + self.place(*value) * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.labelled_ticks().into_iter().map(|(tick, _)| tick).collect()
    }

    fn range(&self) -> Range<f64> {
        Self::range(self)
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, tick: &f64) -> String {
        let ticks = self.labelled_ticks();
        ticks.into_iter().find(|(at, _)| at == tick).map(|(_, label)| label).unwrap_or_default()
    }
}
