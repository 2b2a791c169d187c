//! The legend in the strip beside the plot: values of the curves' parameter by colour, sources by line or mark, regimes by
//! shape.

use super::data::{Curve, Point};
use super::style::{SourceStyle, colour};
use super::{band, marker};
use crate::analysis::Regime;
use crate::publish::plot::canvas::{self, Area};
use crate::publish::plot::{self, DrawError};
use crate::report::glyph::regime_label;
use crate::report::layout::Layout;
use crate::report::scalar::{FREQUENCY, MU_STAR, Scalar};
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
/// The colour of bands in the legend.
const BAND: RGBColor = RGBColor(0xD5, 0xD5, 0xD5);

enum Entry {
    Heading(String),
    Space,
    Curve(RGBColor, SourceStyle, String),
    Guide,
    Band,
    Marker(Regime, bool, &'static str),
    Outside,
}

/// Draws the legend of all these curves into its strip. `is_outside` says whether a point is beyond the axis.
pub(super) fn draw<'a>(
    area: &Area,
    layout: &Layout,
    curves: impl IntoIterator<Item = &'a Curve<'a>>,
    scalar: &Scalar,
    is_outside: bool,
) -> Result<(), DrawError> {
    let mut entries = entries(layout, &curves.into_iter().collect::<Vec<_>>(), scalar);
    entries.extend(is_outside.then_some(Entry::Outside));
    let (width, height) = area.dim_in_pixel();
    let room = height as i32 - 2 * plot::MARGIN;
    let pitch = (room / entries.len().max(1) as i32).min(46);
    // A long legend gets smaller text, so that all of it is on the sheet.
    let size = plot::TEXT.min(pitch * 5 / 6);
    for (line, entry) in entries.iter().enumerate() {
        draw_entry(area, entry, plot::MARGIN + pitch / 2 + line as i32 * pitch, size, width as i32)?;
    }
    Ok(())
}

fn entries(layout: &Layout, curves: &[&Curve], scalar: &Scalar) -> Vec<Entry> {
    let is_shown = |series: usize| {
        // Stable jobs have no frequency: a legend with their curves would promise something that is not there.
        scalar != *FREQUENCY
            || curves.iter().any(|curve| *curve.series == layout.series[series] && !curve.points.is_empty())
    };
    let shown: Vec<_> = (0..layout.series.len()).filter(|&series| is_shown(series)).collect();
    let mut entries = Vec::new();
    let named = shown.iter().map(|&index| &layout.series[index]);
    let mut values: Vec<_> = named.filter(|series| !series.value.is_null()).collect();
    values.dedup_by_key(|series| series.value_index);
    if !values.is_empty() {
        entries.push(Entry::Heading(layout.dimension(layout.by).title.clone()));
    }
    entries.extend(values.iter().map(|series| {
        let style =
            if layout.has_sources() { SourceStyle::Line(0) } else { SourceStyle::of(layout, series.source) };
        Entry::Curve(colour(layout, series), style, layout.dimension(layout.by).text(&series.value))
    }));
    if scalar == *MU_STAR {
        entries.push(Entry::Guide);
    }
    if band::exists(curves.iter().flat_map(|curve| &curve.points), scalar) {
        entries.push(Entry::Band);
    }
    if layout.has_sources() {
        entries.extend([Entry::Space, Entry::Heading("source".to_owned())]);
        let sources = layout.sources.iter().enumerate();
        entries.extend(sources.map(|(index, source)| {
            Entry::Curve(GREY, SourceStyle::of(layout, index), source.name.to_owned())
        }));
    }
    entries.extend(markers(curves));
    entries
}

/// The entries of the shapes that occur.
fn markers(curves: &[&Curve]) -> Vec<Entry> {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let mut entries: Vec<Entry> = REGIMES
        .into_iter()
        .filter(|&regime| points().any(|point| point.regime == Some(regime)))
        .map(|regime| Entry::Marker(regime, true, regime_label(regime)))
        .collect();
    if !entries.is_empty() {
        entries.splice(0..0, [Entry::Space, Entry::Heading("contact regime".to_owned())]);
    }
    let hollow = |point: &&Point| !point.periodic && point.regime != Some(Regime::Undecided);
    if let Some(regime) = points().find(hollow).and_then(|point| point.regime) {
        entries.push(Entry::Marker(regime, false, "hollow: not periodic"));
    }
    entries
}

fn draw_entry(area: &Area, entry: &Entry, y: i32, size: i32, width: i32) -> Result<(), DrawError> {
    let text = |text: &str, x: i32| {
        let fitting = canvas::fitting_size(text.chars().count(), width - x);
        canvas::write(area, text, (x, y), size.min(fitting), HPos::Left)
    };
    let beside = LINE_LENGTH + 18;
    match entry {
        Entry::Space => Ok(()),
        Entry::Heading(heading) => text(heading, 0),
        Entry::Curve(colour, SourceStyle::Mark(number), label) => {
            marker::draw_measured(area, (LINE_LENGTH / 2, y), SourceStyle::Mark(*number), *colour)?;
            text(label, beside)
        }
        Entry::Curve(colour, style, label) => {
            let dash = style.dash().map_or((LINE_LENGTH, 0), |(line, gap)| (line as i32, gap as i32));
            let style = colour.stroke_width(plot::CURVE_WIDTH);
            for x in (0..LINE_LENGTH).step_by((dash.0 + dash.1) as usize) {
                area.draw(&PathElement::new([(x, y), ((x + dash.0).min(LINE_LENGTH), y)], style))?;
            }
            text(label, beside)
        }
        Entry::Guide => {
            for x in (0..LINE_LENGTH).step_by(plot::DASH as usize * 2) {
                let dash = [(x, y), ((x + plot::DASH).min(LINE_LENGTH), y)];
                area.draw(&PathElement::new(dash, BLACK.stroke_width(plot::GUIDE_WIDTH)))?;
            }
            text("μ* = μ", beside)
        }
        Entry::Band => {
            let half = size / 2;
            canvas::fill_rectangle(area, (0, y - half), (LINE_LENGTH, y + half), BAND)?;
            text("error of mesh and step", beside)
        }
        Entry::Marker(regime, periodic, label) => {
            marker::draw(area, (LINE_LENGTH / 2, y), *regime, *periodic, GREY)?;
            text(label, beside)
        }
        Entry::Outside => {
            marker::draw_outside(area, (LINE_LENGTH / 2, y + 12), true, GREY)?;
            text("outside of the axis", beside)
        }
    }
}
