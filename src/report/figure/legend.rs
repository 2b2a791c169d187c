//! The legend in the strip beside the plot: friction coefficients by colour, regimes by shape.

use super::data::{Curve, Ordinate};
use super::marker;
use crate::analysis::Regime;
use crate::publish::plot::canvas::{self, Area};
use crate::publish::plot::{self, DrawError, palette};
use crate::publish::value;
use crate::report::glyph::regime_label;
use plotters::prelude::{BLACK, PathElement, RGBColor};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

const REGIMES: [Regime; 5] = [
    Regime::Stable,
    Regime::StickSlip,
    Regime::StickSlipSeparation,
    Regime::SlipSeparation,
    Regime::Undecided,
];
/// Length of the line in an entry [px].
const LINE_LENGTH: i32 = 64;
const GREY: RGBColor = RGBColor(0x50, 0x50, 0x50);

enum Entry {
    Heading(&'static str),
    Space,
    Curve(RGBColor, f64),
    Guide,
    Marker(Regime, bool, &'static str),
}

/// Draws the legend into its strip.
pub(super) fn draw(area: &Area, curves: &[Curve], plot: Ordinate) -> Result<(), DrawError> {
    let entries = entries(curves, plot);
    let room = area.dim_in_pixel().1 as i32 - 2 * plot::MARGIN;
    let pitch = (room / entries.len().max(1) as i32).min(46);
    // A long legend gets smaller text, so that all of it is on the sheet.
    let size = plot::TEXT.min(pitch * 5 / 6);
    for (line, entry) in entries.iter().enumerate() {
        draw_entry(area, entry, plot::MARGIN + pitch / 2 + line as i32 * pitch, size)?;
    }
    Ok(())
}

fn entries(curves: &[Curve], plot: Ordinate) -> Vec<Entry> {
    let mut entries = vec![Entry::Heading("local friction coefficient μ")];
    let colour = |index| palette::colour(index, curves.len());
    entries.extend(curves.iter().enumerate().map(|(i, curve)| Entry::Curve(colour(i), curve.mu)));
    if plot == Ordinate::MuStar {
        entries.push(Entry::Guide);
    }
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let markers: Vec<Entry> = REGIMES
        .into_iter()
        .filter(|&regime| points().any(|point| point.regime == regime))
        .map(|regime| Entry::Marker(regime, true, regime_label(regime)))
        .collect();
    if !markers.is_empty() {
        entries.extend([Entry::Space, Entry::Heading("contact regime")]);
        entries.extend(markers);
    }
    let hollow = points().find(|point| !point.periodic && point.regime != Regime::Undecided);
    if let Some(point) = hollow {
        entries.push(Entry::Marker(point.regime, false, "hollow: not periodic"));
    }
    entries
}

fn draw_entry(area: &Area, entry: &Entry, y: i32, size: i32) -> Result<(), DrawError> {
    let text = |text: &str, x: i32| canvas::write(area, text, (x, y), size, HPos::Left);
    let beside = LINE_LENGTH + 18;
    match *entry {
        Entry::Space => Ok(()),
        Entry::Heading(heading) => text(heading, 0),
        Entry::Curve(colour, mu) => {
            area.draw(&PathElement::new([(0, y), (LINE_LENGTH, y)], colour.stroke_width(plot::CURVE_WIDTH)))?;
            text(&value::rounded(mu), beside)
        }
        Entry::Guide => {
            for x in (0..LINE_LENGTH).step_by(plot::DASH as usize * 2) {
                let dash = [(x, y), ((x + plot::DASH).min(LINE_LENGTH), y)];
                area.draw(&PathElement::new(dash, BLACK.stroke_width(plot::GUIDE_WIDTH)))?;
            }
            text("μ* = μ", beside)
        }
        Entry::Marker(regime, periodic, label) => {
            marker::draw(area, (LINE_LENGTH / 2, y), regime, periodic, GREY)?;
            text(label, beside)
        }
    }
}
