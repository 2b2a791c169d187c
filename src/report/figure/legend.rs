//! The legend in the strip beside the plot: friction coefficients by colour, regimes by shape.

use super::Plot;
use super::data::Curve;
use super::marker::{self, regime_label};
use crate::analysis::Regime;
use crate::publish::plot::{self, FigureError, palette};
use crate::publish::value;
use plotters::coord::Shift;
use plotters::prelude::{BLACK, DrawingArea, PathElement, RGBColor, SVGBackend, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoFont, TextStyle};

const REGIMES: [Regime; 5] = [
    Regime::Stable,
    Regime::StickSlip,
    Regime::StickSlipSeparation,
    Regime::SlipSeparation,
    Regime::Undecided,
];
/// Length of a sample of a line [px].
const SAMPLE: i32 = 64;
const GREY: RGBColor = RGBColor(0x50, 0x50, 0x50);

enum Entry {
    Heading(&'static str),
    Space,
    Curve(RGBColor, f64),
    Guide,
    Marker(Regime, bool, &'static str),
}

/// Draws the legend into its strip.
pub(super) fn draw(
    area: &DrawingArea<SVGBackend, Shift>,
    curves: &[Curve],
    plot: Plot,
) -> Result<(), FigureError> {
    let entries = entries(curves, plot);
    let room = area.dim_in_pixel().1 as i32 - 2 * plot::MARGIN;
    let pitch = (room / entries.len().max(1) as i32).min(46);
    // A long legend is set smaller rather than cut.
    let size = plot::TEXT.min(pitch * 5 / 6);
    for (line, entry) in entries.iter().enumerate() {
        draw_entry(area, entry, plot::MARGIN + pitch / 2 + line as i32 * pitch, size)?;
    }
    Ok(())
}

fn entries(curves: &[Curve], plot: Plot) -> Vec<Entry> {
    let mut entries = vec![Entry::Heading("local friction coefficient μ")];
    let colour = |index| palette::colour(index, curves.len());
    entries.extend(curves.iter().enumerate().map(|(i, curve)| Entry::Curve(colour(i), curve.mu)));
    if plot == Plot::MuStar {
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

fn draw_entry(
    area: &DrawingArea<SVGBackend, Shift>,
    entry: &Entry,
    y: i32,
    size: i32,
) -> Result<(), FigureError> {
    let text = |text: String, x: i32| {
        let style = TextStyle::from((plot::FONT, size).into_font()).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(text, (x, y), style))
    };
    let beside = SAMPLE + 18;
    match *entry {
        Entry::Space => Ok(()),
        Entry::Heading(heading) => text(heading.to_owned(), 0),
        Entry::Curve(colour, mu) => {
            area.draw(&PathElement::new([(0, y), (SAMPLE, y)], colour.stroke_width(plot::CURVE_WIDTH)))?;
            text(value::rounded(mu), beside)
        }
        Entry::Guide => {
            for x in (0..SAMPLE).step_by(plot::DASH as usize * 2) {
                let dash = [(x, y), ((x + plot::DASH).min(SAMPLE), y)];
                area.draw(&PathElement::new(dash, BLACK.stroke_width(plot::GUIDE_WIDTH)))?;
            }
            text("μ* = μ".to_owned(), beside)
        }
        Entry::Marker(regime, periodic, label) => {
            marker::draw(area, (SAMPLE / 2, y), regime, periodic, GREY)?;
            text(label.to_owned(), beside)
        }
    }
}
