//! The waterfall: spectra of the normal force over the speed, one strip for each job whose spectrum is stored, and a panel
//! for each friction coefficient.

use super::cells::CellEdges;
use super::places::{self, Place};
use crate::analysis::Outcome;
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, Chart, X_LABELS};
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{DrawError, FONT, MARGIN, TEXT, palette};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::spectra::{Spectra, StoredSpectrum};
use crate::report::tooltip::tooltip_text;
use plotters::chart::ChartBuilder;
use plotters::prelude::{BLACK, Circle, PathElement, RGBColor, WHITE};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

const LEGEND_WIDTH: u32 = 300;
const Y_LABELS: u32 = 150;
/// Height of a panel's title [px].
const TITLE: u32 = 60;
/// Height of a panel without its title and without labels of the abscissa [px].
const PANEL: u32 = 460;
/// Number of bands of frequencies in a strip.
const BANDS: usize = 150;
/// The frequencies reach to this multiple of the largest fundamental frequency.
const HARMONICS: f64 = 6.0;
/// Number of colours, and how many decibels each of them stands for.
const COLOURS: u32 = 12;
const DECIBELS: f64 = 5.0;
/// Largest height of a strip [px].
const STRIP: i32 = 140;

/// A job whose spectrum is stored.
struct Strip<'a> {
    place: Place<'a>,
    spectrum: &'a StoredSpectrum,
}

/// The strips of a group, one list for each series that has some.
fn strips<'a>(places: &[Place<'a>], spectra: &'a Spectra) -> Vec<Vec<Strip<'a>>> {
    let strip = |place: &Place<'a>| Some(Strip { place: *place, spectrum: spectra.get(&place.row.job)? });
    let mut all: Vec<Vec<Strip>> = Vec::new();
    for own in places.chunk_by(|a, b| a.series == b.series) {
        let strips: Vec<Strip> = own.iter().filter_map(strip).collect();
        if !strips.is_empty() {
            all.push(strips);
        }
    }
    all
}

/// Largest frequency [Hz] of the figure.
fn last_hz(strips: &[Vec<Strip>]) -> f64 {
    let all = || strips.iter().flatten();
    let is_periodic =
        |strip: &&Strip| strip.place.row.record().is_some_and(|record| record.outcome == Outcome::Periodic);
    let fundamental = all().filter(is_periodic).filter_map(|strip| strip.place.row.record()?.frequency_hz);
    let stored = all().map(|strip| strip.spectrum.last_hz()).fold(0.0, f64::max);
    let wanted = HARMONICS * fundamental.fold(0.0, f64::max);
    // Without a fundamental frequency, the part where the strong lines are.
    let strong = || all().map(|strip| HARMONICS * strongest_hz(strip.spectrum)).fold(0.0, f64::max);
    (if wanted > 0.0 { wanted } else { strong() }).clamp(f64::MIN_POSITIVE, stored.max(f64::MIN_POSITIVE))
}

fn strongest_hz(spectrum: &StoredSpectrum) -> f64 {
    spectrum.lines.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.0, |line| line.0)
}

/// The level [dB re 1 N] of an amplitude [N].
fn level_db(amplitude_n: f64) -> f64 {
    20.0 * amplitude_n.max(1e-12).log10()
}

/// The colour of a level: the number of the step below the highest level.
fn step_below(level: f64, highest: f64) -> u32 {
    (((highest - level) / DECIBELS).max(0.0) as u32).min(COLOURS - 1)
}

fn colour(step: u32) -> RGBColor {
    // Dark is strong: a weak line is nearly white, like the paper.
    if step + 1 == COLOURS { WHITE } else { palette::sequential(f64::from(step) / f64::from(COLOURS - 2)) }
}

/// Draws the panels of a group.
pub(super) fn draw(layout: &Layout, group: &Group, spectra: &Spectra) -> Result<String, FigureError> {
    let caption = group.caption();
    let y_axis = layout.x_axis();
    let panels = strips(&places::places(layout, group, &y_axis), spectra);
    // All figures of a report have the same axes and colours.
    let of_group = |group| strips(&places::places(layout, group, &y_axis), spectra);
    let everywhere: Vec<Vec<Strip>> = layout.groups.iter().flat_map(of_group).collect();
    let y_axis = match y_axis {
        Axis::Names(_) => y_axis,
        // The strips of the lowest and of the highest speed are as high as the others.
        numbers => {
            let x = everywhere.iter().flatten().map(|strip| strip.place.x);
            CellEdges::of(x, matches!(numbers, Axis::Log(_))).axis
        }
    };
    let looks = places::series(layout);
    let last_hz = last_hz(&everywhere);
    let highest = everywhere
        .iter()
        .flatten()
        .map(|strip| level_db(strip.spectrum.largest_in(0.0, last_hz)))
        .fold(f64::NEG_INFINITY, f64::max);
    let count = panels.len().max(1) as u32;
    let height = canvas::caption_height(&caption) + count * (PANEL + TITLE) + X_LABELS + MARGIN as u32;
    canvas::sheet((canvas::WIDTH, height), |root| {
        let below = canvas::caption(root, &caption)?;
        let (left, right) = below.split_horizontally(canvas::WIDTH - LEGEND_WIDTH);
        if panels.is_empty() {
            let middle = ((canvas::WIDTH / 2) as i32, (PANEL / 2) as i32);
            canvas::write(&below, "no stored spectra", middle, TEXT, HPos::Center)?;
            return Ok(Vec::new());
        }
        draw_scale(&right, highest)?;
        let mut rest = left;
        let mut targets = Vec::new();
        for (number, own) in panels.iter().enumerate() {
            let is_last = number + 1 == panels.len();
            let part = TITLE + PANEL + if is_last { X_LABELS } else { 0 };
            let (here, after) = rest.split_vertically(part);
            let (top, here) = here.split_vertically(TITLE);
            let middle = ((canvas::WIDTH - LEGEND_WIDTH) as i32 / 2, TITLE as i32 * 2 / 3);
            canvas::write(&top, &looks[own[0].place.series].name, middle, TEXT, HPos::Center)?;
            let scale = Scale { last_hz, highest, is_last };
            targets.extend(draw_panel(&here, own, &y_axis, layout.axis_name(), &scale)?);
            rest = after;
        }
        Ok(if places::has_tooltips(group) { targets } else { Vec::new() })
    })
}

/// What all panels share.
struct Scale {
    last_hz: f64,
    highest: f64,
    is_last: bool,
}

fn draw_panel(
    area: &Area,
    strips: &[Strip],
    y_axis: &Axis,
    y_label: &str,
    scale: &Scale,
) -> Result<Vec<TooltipTarget>, DrawError> {
    let (unit, per_unit) = if scale.last_hz >= 1000.0 { ("kHz", 1000.0) } else { ("Hz", 1.0) };
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .margin_top(4)
        .margin_bottom(0)
        .x_label_area_size(if scale.is_last { X_LABELS } else { 0 })
        .y_label_area_size(Y_LABELS)
        .build_cartesian_2d(Axis::Linear(0.0..scale.last_hz / per_unit), y_axis.clone())?;
    let mut mesh = canvas::mesh(&mut chart);
    mesh.disable_mesh().x_label_style((FONT, TEXT)).y_desc(y_label);
    let x_label = format!("frequency [{unit}]");
    if scale.is_last {
        mesh.x_desc(x_label.as_str());
    }
    mesh.draw()?;
    let mut targets = Vec::new();
    let middles: Vec<i32> = strips.iter().map(|strip| chart.backend_coord(&(0.0, strip.place.x)).1).collect();
    for (number, strip) in strips.iter().enumerate() {
        let (from, to) = extent(&middles, number, &chart);
        draw_strip(area, &chart, strip, (from, to), scale, per_unit)?;
        let (left, _) = chart.backend_coord(&(0.0, strip.place.x));
        let (right, _) = chart.backend_coord(&(scale.last_hz / per_unit, strip.place.x));
        targets.push(TooltipTarget {
            shape: Shape::Cell { from: (left, from), to: (right, to.max(from + 1)) },
            title: tooltip_text(strip.place.row),
            data: vec![
                ("job", strip.place.row.job.clone()),
                ("x", value::text(strip.place.at)),
                ("y", value::number(strongest_hz(strip.spectrum))),
            ],
        });
    }
    canvas::whole_frame(&chart)?;
    Ok(targets)
}

/// Top and bottom [px] of a strip: half-way to its neighbours, and not too far. At the ends it is symmetric.
fn extent(middles: &[i32], number: usize, chart: &Chart) -> (i32, i32) {
    let middle = middles[number];
    let inside = chart.plotting_area().strip_coord_spec();
    let (top, height) = (inside.get_base_pixel().1, inside.dim_in_pixel().1 as i32);
    let distance = |sign: i32| {
        let others = middles.iter().map(|other| sign * (other - middle)).filter(|distance| *distance > 0);
        others.min()
    };
    let (above, below) = (distance(-1), distance(1));
    let half = |own: Option<i32>, other: Option<i32>| {
        own.or(other)
            .map_or(STRIP / 2, |distance| distance.div_euclid(2) + distance.rem_euclid(2))
            .min(STRIP / 2)
    };
    ((middle - half(above, below)).max(top), (middle + half(below, above)).min(top + height))
}

/// Draws bands of equal colour as one rectangle, and a dot at the fundamental frequency.
fn draw_strip(
    area: &Area,
    chart: &Chart,
    strip: &Strip,
    (from, to): (i32, i32),
    scale: &Scale,
    per_unit: f64,
) -> Result<(), DrawError> {
    let (left, top) = area.get_base_pixel();
    let width_hz = scale.last_hz / BANDS as f64;
    let step = |band: usize| {
        let from_hz = band as f64 * width_hz;
        step_below(level_db(strip.spectrum.largest_in(from_hz, from_hz + width_hz)), scale.highest)
    };
    let steps: Vec<u32> = (0..BANDS).map(step).collect();
    let x = |band: usize| chart.backend_coord(&(band as f64 * width_hz / per_unit, strip.place.x)).0 - left;
    let mut start = 0;
    for equal in steps.chunk_by(|a, b| a == b) {
        let end = start + equal.len();
        let fill = colour(equal[0]);
        canvas::fill_rectangle(area, (x(start), from - top), (x(end), to - top), fill)?;
        start = end;
    }
    let frequency_hz = strip.place.row.record().and_then(|record| record.frequency_hz);
    if let Some(frequency_hz) = frequency_hz.filter(|f| *f > 0.0 && *f < scale.last_hz) {
        let (x, y) = chart.backend_coord(&(frequency_hz / per_unit, strip.place.x));
        area.draw(&Circle::new((x - left, y - top), 7, WHITE.filled()))?;
        area.draw(&Circle::new((x - left, y - top), 5, BLACK.filled()))?;
    }
    Ok(())
}

fn draw_scale(area: &Area, highest: f64) -> Result<(), DrawError> {
    let size = TEXT - 4;
    canvas::write(area, "amplitude of N", (0, MARGIN + 14), size, HPos::Left)?;
    canvas::write(area, "[dB re 1 N]", (0, MARGIN + 52), size, HPos::Left)?;
    let (top, pitch, width) = (MARGIN + 90, 34, 56);
    for step in 0..COLOURS {
        let y = top + step as i32 * pitch;
        canvas::fill_rectangle(area, (0, y), (width, y + pitch), colour(step))?;
        if step % 2 == 0 {
            let label = value::fixed(highest - f64::from(step) * DECIBELS, 0).replace('-', "−");
            canvas::write(area, &label, (width + 14, y), size, HPos::Left)?;
        }
    }
    let y = top + COLOURS as i32 * pitch;
    let outline = [(0, top), (width, top), (width, y), (0, y), (0, top)];
    area.draw(&PathElement::new(outline, BLACK.stroke_width(1)))?;
    area.draw(&Circle::new((width / 2, y + 44), 5, BLACK.filled()))?;
    canvas::write(area, "fundamental", (width + 14, y + 44), size, HPos::Left)
}

/// The lines of all stored spectra of these jobs as CSV: key, ω and μ of the job, frequency, amplitude.
pub(in crate::report) fn csv(layout: &Layout, spectra: &Spectra) -> std::io::Result<Vec<u8>> {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    let io_error = |error: ::csv::Error| std::io::Error::other(error);
    writer
        .write_record(["job", "omega_rpm", "mu", "frequency_hz", "normal_amplitude_n"])
        .map_err(io_error)?;
    for job in layout.groups.iter().flat_map(|group| &group.jobs) {
        for (frequency_hz, amplitude_n) in spectra.get(&job.row.job).iter().flat_map(|own| &own.lines) {
            let numbers = [job.row.omega_rpm, job.row.mu, *frequency_hz, *amplitude_n].map(value::number);
            let line = std::iter::once(job.row.job.clone()).chain(numbers);
            writer.write_record(line).map_err(io_error)?;
        }
    }
    writer.into_inner().map_err(|error| std::io::Error::other(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a colour stands for 5 dB: the strongest line has the first one, and a line of a thousandth, 60 dB less,
    /// the last one.
    #[test]
    fn colours_are_levels() {
        let highest = level_db(20.0);
        let step = |amplitude_n: f64| step_below(level_db(amplitude_n), highest);
        assert_eq!((step(20.0), step(20.0 * 10f64.powf(-0.3)), step(0.02), step(0.0)), (0, 1, 11, 11));
        assert_eq!(colour(11), WHITE);
    }
}
