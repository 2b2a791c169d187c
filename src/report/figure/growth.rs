//! The map of growth rates: how fast the strongest line of a job in steady sliding grows or decays.

use super::colour_key::{self, Swatch};
use super::map::glyph_key;
use super::plane::{self, CellStyle};
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area};
use crate::publish::plot::{DrawError, MARGIN, TEXT, palette};
use crate::publish::value;
use crate::report::glyph::status_glyph;
use crate::report::layout::{Group, Layout};
use crate::report::row::JobRow;
use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;

/// Height of the colour scale with its heading [px].
pub(super) const SCALE: i32 = 430;
/// Number of colours in it.
const STEPS: i32 = 60;
/// The colour of a job without a growth rate.
pub(super) const NO_VALUE: RGBColor = RGBColor(0xEC, 0xEC, 0xEC);

fn growth_rate(row: &JobRow) -> Option<f64> {
    row.record()?.growth_rate_per_s.filter(|rate| rate.is_finite())
}

/// Draws the growth rates as colours and numbers, and a letter for a job that has none.
pub(super) fn draw(layout: &Layout, group: &Group) -> Result<String, FigureError> {
    // All figures of a report have the same colours.
    let jobs = layout.groups.iter().flat_map(|group| &group.jobs);
    let rates = || jobs.clone().filter_map(|job| growth_rate(job.row));
    let largest = rates().map(f64::abs).fold(0.0, f64::max);
    let style = |row: &JobRow| match growth_rate(row) {
        Some(rate) => {
            CellStyle::new(palette::diverging(share(rate, largest)), rate_text(rate), value::number(rate))
        }
        None => CellStyle::new(NO_VALUE, status_glyph(row).letter.to_string(), String::new()),
    };
    let others = group.jobs.iter().map(|job| job.row).filter(|row| growth_rate(row).is_none());
    let mut entries = glyph_key(others);
    for entry in &mut entries {
        entry.swatch = Swatch::filled(NO_VALUE, entry.swatch.symbol);
    }
    plane::draw(
        layout,
        group,
        style,
        |_| Ok(()),
        |area| {
            let top = if largest > 0.0 {
                draw_scale(area, largest)?;
                MARGIN + SCALE
            } else {
                canvas::write(area, "no growth rates", (0, MARGIN + 20), TEXT, HPos::Left)?;
                MARGIN + 60
            };
            colour_key::draw_column(area, top, &entries)
        },
    )
}

/// A growth rate in a cell.
pub(super) fn rate_text(rate: f64) -> String {
    value::significant(rate, 3).replace('-', "−")
}

/// The place of a rate in the colours from −1 to 1. The root shows the sign of small rates beside large ones.
pub(super) fn share(rate: f64, largest: f64) -> f64 {
    if largest > 0.0 { rate.signum() * (rate.abs() / largest).sqrt() } else { 0.0 }
}

/// Draws the colours of the growth rates from −`largest` to `largest`.
pub(super) fn draw_scale(area: &Area, largest: f64) -> Result<(), DrawError> {
    canvas::write(area, "growth rate [1/s]", (0, MARGIN + 10), TEXT, HPos::Left)?;
    let (top, bottom, width) = (MARGIN + 50, MARGIN + SCALE - 40, 56);
    let y = |share: f64| bottom - ((share + 1.0) / 2.0 * f64::from(bottom - top)).round() as i32;
    // Each colour reaches a pixel into the next one below, so that rounding leaves no gap between them.
    for step in (0..STEPS).rev() {
        let edge = |step: i32| 2.0 * f64::from(step) / f64::from(STEPS) - 1.0;
        let colour = palette::diverging(edge(step) + 1.0 / f64::from(STEPS));
        canvas::fill_rectangle(area, (0, y(edge(step + 1))), (width, y(edge(step)) + 1), colour)?;
    }
    for (rate, label) in Axis::Linear(-largest..largest).labelled_ticks() {
        let at = y(share(rate, largest));
        canvas::fill_rectangle(area, (width, at - 1), (width + 10, at + 1), RGBColor(0, 0, 0))?;
        canvas::write(area, &label.replace('-', "−"), (width + 20, at), TEXT - 4, HPos::Left)?;
    }
    canvas::write(area, "grows", (width + 140, y(0.5)), TEXT - 4, HPos::Left)?;
    canvas::write(area, "decays", (width + 140, y(-0.5)), TEXT - 4, HPos::Left)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the colours are symmetric about zero, and a rate of zero has none.
    #[test]
    fn colours_show_the_sign() {
        assert_eq!((share(-4.0, 16.0), share(16.0, 16.0), share(0.0, 16.0)), (-0.5, 1.0, 0.0));
        assert_eq!(share(-3.0, 0.0), 0.0);
        assert_eq!(palette::diverging(0.0), RGBColor(255, 255, 255));
        let (cold, warm) = (palette::diverging(-1.0), palette::diverging(1.0));
        assert!(cold.2 > cold.0 && warm.0 > warm.2);
    }
}
